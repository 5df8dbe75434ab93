// rayfarm trace: the rays behind a pixel.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/job_diagnostics.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/diagnostics/leaf_names.h"
#include "master/diagnostics/pixel_trace.h"
#include "master/files/atomic_write.h"
#include "master/files/ending.h"
#include "master/files/image_file.h"

namespace rayfarm {
namespace {

struct TraceArguments {
  PictureOptions picture;
  std::optional<JobNumber> job;
  std::string pixel, sample = "0", svg_file;
  std::uint32_t ray = 0;
  bool json = false;
};

/// The whole text as a number; none for anything else.
std::optional<std::uint32_t> number_in(std::string_view text) {
  std::uint32_t number = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
  return number;
}

/// "X,Y". Throws SettingsError.
Pixel pixel_of(const std::string& text) {
  const std::size_t comma = std::min(text.find(','), text.size());
  const auto x = number_in(std::string_view(text).substr(0, comma));
  const auto y = comma < text.size() ? number_in(std::string_view(text).substr(comma + 1)) : std::nullopt;
  if (!x || !y) throw SettingsError("--pixel wants X,Y, as in 320,240, is " + text);
  return {*x, *y};
}

void check_svg(const std::string& file) {
  if (file.empty()) return;
  if (ending_of(file) != ".svg")
    throw FileError("the drawing is an SVG; let the name " + file + " end in .svg");
  check_place(file);
}

ExitCode trace_job(const TraceArguments& a) {
  const Pixel pixel = pixel_of(a.pixel);
  const Query query{{"x", std::to_string(pixel.x)},
                    {"y", std::to_string(pixel.y)},
                    {"sample", a.sample},
                    {"story", std::to_string(a.ray)},
                    {"frame", frame_text(a.picture.frame)}};
  if (!a.svg_file.empty()) {
    Query drawn = query;
    drawn.emplace_back("format", "svg");
    write_made_for_job(*a.job, "trace", drawn, "tracing", a.svg_file);
  }
  print_job_trace(*a.job, query, a.json);
  return ExitCode::done;
}

ExitCode trace(const TraceArguments& a) {
  check_svg(a.svg_file);
  if (a.job) return trace_job(a);
  PreparedScene scene = prepare(a.picture);
  const Pixel pixel = pixel_of(a.pixel);
  const SampleChoice choice = sample_choice(a.sample, scene.settings);
  auto names = std::make_shared<std::vector<std::string>>(leaf_names(scene.scene));
  const World world(std::move(scene.scene));
  const PixelTrace trace = pixel_trace(world, names, scene.settings, pixel, choice, a.ray);

  if (!a.svg_file.empty()) {
    const std::string svg = svg_of(trace);
    write_atomically(a.svg_file, {reinterpret_cast<const std::uint8_t*>(svg.data()), svg.size()});
  }
  if (a.json) {
    print_json(to_json(trace));
  } else {
    for (std::string& name : *names) name = printable(name);
    std::fputs(text_of(trace).c_str(), stdout);
  }
  return ExitCode::done;
}

}  // namespace

void add_trace_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<TraceArguments>();
  CLI::App* command = app.add_subcommand("trace", "Show the rays behind a pixel");
  add_sample_options(*command, arguments->picture);
  add_job_option(*command, arguments->job);
  command->add_option("--pixel", arguments->pixel, "X,Y from the upper left, from 0")->required();
  command->add_option("--sample", arguments->sample, "Number of a sample (default 0), all or centre");
  command->add_option(
      "--ray", arguments->ray,
      "Which of the sample's rays the story of solids is told along, by its number (default 0)");
  command->add_option("-o,--output", arguments->svg_file, "Draw the rays, .svg");
  command->add_flag("--json", arguments->json, "Rays as JSON");
  command->footer(
      "Examples:\n  rayfarm trace scenes/circus.lua --pixel 320,240 --sample all -o rays.svg\n  rayfarm "
      "trace --job 7 --pixel 320,240");
  command->callback([arguments, &chosen] { chosen = [arguments] { return trace(*arguments); }; });
}

}  // namespace rayfarm
