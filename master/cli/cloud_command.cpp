// rayfarm cloud: the surface points that a picture's rays meet.
#include <CLI/CLI.hpp>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <memory>
#include <thread>

#include "common/work/each_tile.h"
#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_diagnostics.h"
#include "master/cli/picture_options.h"
#include "master/cli/progress_line.h"
#include "master/diagnostics/collecting_render.h"

namespace rayfarm {
namespace {

struct CloudArguments {
  PictureOptions picture;
  std::optional<JobNumber> job;
  std::string output;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool ascii = false, compact = false, visible_only = false;
  std::optional<double> voxel;
  std::optional<std::uint32_t> points;  // of a job

  CloudOptions options() const {
    const PlyForm form = ascii ? PlyForm::ascii : compact ? PlyForm::compact : PlyForm::binary;
    return {form, voxel.value_or(0), visible_only};
  }
};

void check_arguments(const CloudArguments& a) {
  if (a.voxel && !(*a.voxel > 0 && std::isfinite(*a.voxel)))
    throw SettingsError("--voxel wants a size above 0, in scene units");
  check_cloud_place(a.output);
}

ExitCode fetch_cloud(const CloudArguments& a) {
  write_made_for_job(*a.job, "cloud.ply",
                     {{"points", a.points ? std::to_string(*a.points) : ""},
                      {"voxel", a.voxel ? number_text(*a.voxel) : ""},
                      {"form", a.ascii     ? "ascii"
                               : a.compact ? "compact"
                                           : ""},
                      {"visible", a.visible_only ? "1" : ""},
                      {"frame", frame_text(a.picture.frame)}},
                     "collecting", a.output);
  return ExitCode::done;
}

ExitCode make_cloud(const CloudArguments& a) {
  check_arguments(a);
  if (a.job) return fetch_cloud(a);
  note_interrupts();
  PreparedScene scene = prepare(a.picture);
  scene.settings.shadows = false;  // they decide no ray that goes on
  const World world(std::move(scene.scene));
  const Size size{scene.settings.width, scene.settings.height};
  CloudFile cloud(a.output, a.options());
  CollectingRender collecting(world, scene.settings, {});
  collecting.also_collect(cloud);
  std::atomic<std::uint32_t> done = 0;
  bool complete = false;
  {
    ProgressLine line;
    const auto collect = [&](std::uint32_t tile) {
      if (!collecting.render_tile(tile, all_passes, interrupted)) return false;
      ++done;
      return true;
    };
    complete = each_tile(size, a.threads, collect, [&] {
      line.show(static_cast<double>(done) / tile_count(size), "collecting", std::nullopt);
    });
  }
  if (!complete) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  const std::uint64_t points = cloud.commit();
  std::printf("%s: %llu points\n", a.output.c_str(), static_cast<unsigned long long>(points));
  return ExitCode::done;
}

}  // namespace

void add_cloud_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<CloudArguments>();
  CLI::App* command =
      app.add_subcommand("cloud", "Write the surface points that a picture's rays meet, as PLY");
  add_sample_options(*command, arguments->picture);
  command->add_option("--threads", arguments->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  add_job_option(*command, arguments->job);
  command->add_option("-o,--output", arguments->output, "File to write, .ply")->required();
  CLI::Option* ascii = command->add_flag("--ascii", arguments->ascii, "As text");
  command
      ->add_flag("--compact", arguments->compact,
                 "Normals as two 16-bit octahedral numbers: 19 instead of 27 bytes a point")
      ->excludes(ascii);
  command->add_option(
      "--voxel", arguments->voxel,
      "At most one point in each cube of this size; memory grows with the cubes, not the rays");
  command->add_flag("--visible", arguments->visible_only,
                    "Only where primary rays end, not reflected and refracted ones");
  command
      ->add_option("--points", arguments->points,
                   "With --job: at most so many, evenly over the picture (default 200000)")
      ->check(CLI::Range(1u, 2'000'000u))
      ->needs("--job");
  command->footer(
      "Examples:\n  rayfarm cloud scenes/circus.lua -o circus.ply --voxel 0.02\n  rayfarm cloud --job 7 -o "
      "job.ply");
  command->callback([arguments, &chosen] { chosen = [arguments] { return make_cloud(*arguments); }; });
}

}  // namespace rayfarm
