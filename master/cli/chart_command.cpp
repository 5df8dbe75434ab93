// rayfarm chart: error against time of all samplers, or the stability suite's failures against conditioning.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <thread>

#include "master/charts/convergence.h"
#include "master/charts/csv.h"
#include "master/charts/stability_table.h"
#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/local_render.h"
#include "master/cli/picture_options.h"
#include "master/cli/progress_line.h"
#include "master/cli/text.h"
#include "master/files/atomic_write.h"

namespace rayfarm {
namespace {

namespace fs = std::filesystem;

struct ChartArguments {
  PictureOptions picture;
  std::string folder, stability_csv;
  std::vector<std::string> cases;  // beginnings of names; empty: all
  std::uint32_t most_spp = 256;
  std::optional<std::uint32_t> reference_spp;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
};

void write_text(const fs::path& file, const std::string& text) {
  write_atomically(file, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::printf("%s\n", file.c_str());
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError("cannot make the folder " + folder.string() + ": " + error.message());
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Film film_of(const World& world, const RenderSettings& settings, unsigned threads) {
  auto rendered = render_locally(world, settings, threads, interrupted, [](const Film&) {});
  if (!rendered) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  return std::move(rendered->film);
}

double rmse(const Film& a, const Film& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb().size(); ++i)
    sum += (double{a.rgb()[i]} - b.rgb()[i]) * (double{a.rgb()[i]} - b.rgb()[i]);
  return std::sqrt(sum / static_cast<double>(a.rgb().size()));
}

/// 1, 4, 16 ... samples a pixel: the numbers that all samplers take.
std::vector<ConvergencePoint> measured(const World& world, RenderSettings settings, const ChartArguments& a) {
  constexpr SamplerKind samplers[] = {SamplerKind::sobol, SamplerKind::jitter, SamplerKind::regular,
                                      SamplerKind::random, SamplerKind::adapt1};
  const auto of = [&](SamplerKind sampler, std::uint32_t spp, std::uint64_t seed) {
    RenderSettings s = settings;
    s.sampler = sampler, s.spp = spp, s.seed = seed;
    check(s);
    return s;
  };
  ProgressLine line;
  const std::uint32_t reference_spp = a.reference_spp.value_or(16 * a.most_spp);
  line.show(0, "reference of " + std::to_string(reference_spp) + " samples a pixel", std::nullopt);
  const Film reference = film_of(world, of(SamplerKind::sobol, reference_spp, settings.seed + 1), a.threads);
  std::vector<ConvergencePoint> points;
  for (const SamplerKind sampler : samplers)
    for (std::uint32_t spp = 1; spp <= a.most_spp; spp *= 4) {
      const double begin = cpu_seconds();
      const Film film = film_of(world, of(sampler, spp, settings.seed), a.threads);
      points.push_back({std::string(name_of(sampler)), spp, cpu_seconds() - begin, rmse(film, reference)});
      line.show(static_cast<double>(points.size()) / (std::size(samplers) * (1 + std::log2(a.most_spp) / 2)),
                points.back().sampler, std::nullopt);
    }
  return points;
}

ExitCode chart_samplers(const ChartArguments& a) {
  note_interrupts();
  PreparedScene scene = prepare(a.picture);
  make_folder(a.folder);
  const World world(std::move(scene.scene));
  const std::vector<ConvergencePoint> points = measured(world, scene.settings, a);
  const std::string name = fs::path(a.picture.scene_file).stem();
  const Chart chart = convergence_chart(name + ": error against time", points);
  write_text(fs::path(a.folder) / (name + "_samplers.csv"), convergence_csv(points));
  write_text(fs::path(a.folder) / (name + "_samplers.svg"), svg_of({&chart, 1}));
  return ExitCode::done;
}

ExitCode chart_stability(const ChartArguments& a) {
  std::ifstream in(a.stability_csv, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw FileError("cannot read " + a.stability_csv);
  std::vector<StabilityRow> rows;
  try {
    rows = stability_rows(text);
  } catch (const CsvError& error) {
    throw FileError(a.stability_csv + ": " + error.what());
  }
  std::erase_if(rows, [&](const StabilityRow& row) {
    return !a.cases.empty() && std::ranges::none_of(a.cases, [&](const std::string& begin) {
      return row.name.starts_with(begin);
    });
  });
  if (rows.empty()) throw FileError(a.stability_csv + " has no row to chart");
  make_folder(a.folder);
  write_text(fs::path(a.folder) / "stability.svg", svg_of(stability_charts(rows), 3));
  return ExitCode::done;
}

ExitCode chart(const ChartArguments& a) {
  if (a.stability_csv.empty() == a.picture.scene_file.empty())
    throw CommandError(ExitCode::usage, "chart wants a SCENE or --stability CSV, and not both");
  return a.stability_csv.empty() ? chart_samplers(a) : chart_stability(a);
}

}  // namespace

void add_chart_command(CLI::App& app, Command& chosen) {
  const auto a = std::make_shared<ChartArguments>();
  a->picture.size = "160x120";
  CLI::App* command = app.add_subcommand(
      "chart", "Chart the error of all samplers against time, or failures against conditioning");
  command->add_option("SCENE", a->picture.scene_file, "Scene script (Lua)");
  command->add_option("-o,--output", a->folder, "Folder for the charts (SVG) and tables (CSV)")->required();
  command->add_option("--size", a->picture.size, "Width and height in pixels (default 160x120)");
  command->add_option("--most-spp", a->most_spp, "Samples per pixel of the longest renders (default 256)")
      ->check(CLI::Range(1u, max_spp / 16));
  command->add_option("--reference-spp", a->reference_spp,
                      "Samples per pixel of the reference (default 16 times that)");
  command->add_option("--seed", a->picture.seed,
                      "Seed of the random numbers; the reference has the next one (default 0)");
  command->add_option("--frame", a->picture.frame, "Frame of an animation, from 0");
  command
      ->add_option("-p,--param", a->picture.params, "A parameter of the script, key=value; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--threads", a->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  command->add_option("--stability", a->stability_csv,
                      "stability.csv of the stability suite, instead of a scene");
  command->add_option("--cases", a->cases, "Of these cases alone, by the beginnings of their names: S13,S16")
      ->delimiter(',');
  command->footer(
      "Examples:\n  rayfarm chart scenes/circus.lua -o charts\n"
      "  rayfarm chart --stability build/tests/stability/stability.csv -o charts");
  command->callback([a, &chosen] { chosen = [a] { return chart(*a); }; });
}

}  // namespace rayfarm
