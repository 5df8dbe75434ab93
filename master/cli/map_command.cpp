// rayfarm map: depths, normals, counts and costs, pixel by pixel.
#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <memory>
#include <thread>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_diagnostics.h"
#include "master/cli/picture_options.h"
#include "master/cli/progress_line.h"
#include "master/diagnostics/map_file.h"
#include "master/diagnostics/map_picture.h"
#include "master/files/atomic_write.h"
#include "master/files/ending.h"
#include "master/files/image_file.h"

namespace rayfarm {
namespace {

struct MapArguments {
  PictureOptions picture;
  std::optional<JobNumber> job;
  std::string kind, reduction = "majority", output;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool compatible = false, legend = false, partial = false;
  std::string palette = "original";
  std::optional<std::string> range;  // LOW,HIGH

  bool to_csv() const { return ending_of(output) == ".csv"; }
  bool to_exr() const { return ending_of(output) == ".exr"; }
};

std::optional<MapRange> range_of(const MapArguments& a) {
  if (!a.range) return std::nullopt;
  MapRange range;
  const char *begin = a.range->data(), *end = begin + a.range->size();
  const auto [comma, low_error] = std::from_chars(begin, end, range.low);
  const bool two = low_error == std::errc{} && comma != end && *comma == ',';
  const auto [last, high_error] = std::from_chars(two ? comma + 1 : end, end, range.high);
  if (!two || high_error != std::errc{} || last != end || !(range.low < range.high) ||
      !std::isfinite(range.high - range.low))
    throw SettingsError("--range wants LOW,HIGH, LOW less than HIGH, as in 0,64; is " + *a.range);
  return range;
}

void write(const MapArguments& a, const PreparedScene& scene, const Map& map, const MapRequest& request) {
  const MapOrigin origin{request, scene.hash, scene.settings};
  if (a.to_csv()) {
    const std::string text = csv(map, title_of(origin));
    write_atomically(a.output, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
    return;
  }
  const MapColors colors{*palette_named(a.palette), range_of(a)};
  Picture picture = a.to_exr() ? raw(map, *request.kind)
                    : a.legend ? colored_with_legend(map, *request.kind, colors)
                               : colored(map, *request.kind, colors);
  picture.facts = facts_of(origin);
  write_picture(a.output, picture);
}

MapRequest request_of(const MapArguments& a) {
  const MapRequest request{map_named(a.kind), *reduction_named(a.reduction), a.compatible};
  if (request.kind->source == MapSource::farm && !a.job)
    throw SettingsError("the map " + a.kind +
                        " is of a job of the farm, not of a scene; name a job instead: " + "rayfarm map " +
                        a.kind + " --job ID");
  if (a.compatible && !request.kind->has_compatible)
    throw SettingsError("the map " + a.kind + " has no --compat: the original renderer's is the same");
  const bool has_range = request.kind->scale == MapScale::depth || request.kind->scale == MapScale::count;
  if (range_of(a) && !has_range)
    throw SettingsError("the map " + a.kind + " has no range of values; leave --range out");
  return request;
}

ExitCode fetch_map(const MapArguments& a) {
  const std::optional<MapRange> range = range_of(a);
  const Query query{{"format", a.to_csv()   ? "csv"
                               : a.to_exr() ? "exr"
                                            : "png"},
                    {"reduce", a.reduction},
                    {"compat", a.compatible ? "1" : ""},
                    {"scale", a.palette},
                    {"low", range ? number_text(range->low) : ""},
                    {"high", range ? number_text(range->high) : ""},
                    {"legend", a.legend ? "1" : ""},
                    {"frame", frame_text(a.picture.frame)}};
  const std::string what = "maps/" + a.kind;
  if (a.partial)
    write_partly_made_for_job(*a.job, what, query, a.output);
  else
    write_made_for_job(*a.job, what, query, "mapping", a.output);
  return ExitCode::done;
}

ExitCode make_map(const MapArguments& a) {
  if (!a.to_csv() && !a.to_exr() && ending_of(a.output) != ".png")
    throw FileError("cannot tell what to write from the name " + a.output +
                    "; let it end in .png, .exr or .csv");
  const MapRequest request = request_of(a);
  check_place(a.output);
  if (a.job) return fetch_map(a);
  note_interrupts();
  PreparedScene scene = prepare(a.picture);
  const World world(std::move(scene.scene));
  std::optional<Map> map;
  {
    ProgressLine line;
    map = map_of(world, scene.settings, request, a.threads, interrupted,
                 [&](std::uint32_t done, std::uint32_t all) {
                   line.show(static_cast<double>(done) / all, "mapping", std::nullopt);
                 });
  }
  if (!map) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  write(a, scene, *map, request);
  return ExitCode::done;
}

}  // namespace

void add_map_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<MapArguments>();
  CLI::App* command = app.add_subcommand("map", "Write a map of what lies behind the pixels");
  std::vector<std::string> names;
  std::string kinds;
  for (const MapKind& kind : all_maps()) {
    names.emplace_back(kind.name);
    kinds += "\n  " + names.back() + ": " + std::string(kind.help);
  }
  command->add_option("KIND", arguments->kind, map_names())->required()->check(CLI::IsMember(names));
  const std::span<const std::string_view> reductions = reduction_names();
  add_sample_options(*command, arguments->picture);
  command->add_option("--threads", arguments->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  add_job_option(*command, arguments->job);
  command
      ->add_option("-o,--output", arguments->output,
                   "File to write: .png (colours), .exr (raw values) or .csv (raw values, a line a row)")
      ->required();
  command
      ->add_option("--reduce", arguments->reduction,
                   "How samples become a depth, normal or coverage: majority (default: the surface that most "
                   "show), second, third or fourth (those that fewer show), mean, closest or median")
      ->check(CLI::IsMember(std::vector<std::string>(reductions.begin(), reductions.end())));
  command->add_flag("--compat", arguments->compatible,
                    "As the original renderer: all-rays without shadow rays, its formula of normal-camera");
  command
      ->add_option(
          "--scale", arguments->palette,
          "Colours of a .png: original (default: as the original renderer) or perceptual (equal steps "
          "look equal)")
      ->check(CLI::IsMember({"original", "perceptual"}));
  command->add_option(
      "--range", arguments->range,
      "Values of the first and last colour, LOW,HIGH, to compare pictures; else the map's own");
  command->add_flag("--partial", arguments->partial, "Of a job: what is there; exit code 7 unless it is all")
      ->needs("--job");
  command->add_flag("--legend", arguments->legend, "What the colours mean, beside the .png");
  command->footer("Kinds:" + kinds +
                  "\nExamples:\n  rayfarm map depth scenes/circus.lua -o depth.png\n  rayfarm map worker "
                  "--job 7 -o who.png");
  command->callback([arguments, &chosen] { chosen = [arguments] { return make_map(*arguments); }; });
}

}  // namespace rayfarm
