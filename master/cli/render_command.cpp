// rayfarm render: a picture, or those of an animation, by this PC alone.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "master/cli/commands.h"
#include "master/cli/frame_files.h"
#include "master/cli/interrupt.h"
#include "master/cli/local_render.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/cli/progress_line.h"
#include "master/cli/scene_frames.h"
#include "master/cli/text.h"
#include "master/cli/video.h"
#include "master/diagnostics/collecting_render.h"
#include "master/files/ending.h"
#include "master/files/picture_facts.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

struct RenderArguments {
  PictureOptions picture;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool json = false;
  std::vector<std::string> aovs;
  std::string cloud;  // file; empty: none
  std::string video;  // of the frames; empty: none
};

/// A frame that is written.
struct RenderedFrame {
  std::string output;
  std::string scene_hash;
  RenderSettings settings;
  RayCounters counters;
  double seconds = 0;
};

/// None in the first 5 %: there is too little to learn from.
std::optional<std::chrono::seconds> time_left(double fraction, Clock::duration elapsed) {
  if (fraction < 0.05) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::seconds>(elapsed * ((1 - fraction) / fraction));
}

std::uint64_t samples_of(const RenderSettings& s) { return std::uint64_t{s.width} * s.height * s.spp; }

nlohmann::json to_json(const RenderedFrame& frame) {
  return {{"output", frame.output},
          {"scene_hash", frame.scene_hash},
          {"settings", to_json(frame.settings)},
          {"seconds", frame.seconds},
          {"samples", samples_of(frame.settings)},
          {"counters", to_json(frame.counters)}};
}

/// What all of them took together, as one of the name.
RenderedFrame sum_of(const std::string& name, const std::vector<RenderedFrame>& frames) {
  RenderedFrame sum{name, {}, frames.front().settings, {}, 0};
  for (const RenderedFrame& frame : frames) {
    sum.counters += frame.counters;
    sum.seconds += frame.seconds;
  }
  return sum;
}

void print_summary(const RenderArguments& a, const std::vector<RenderedFrame>& frames) {
  const RenderedFrame sum = sum_of(a.picture.frames ? a.picture.output : frames.front().output, frames);
  const RenderSettings& s = sum.settings;
  const auto samples = static_cast<double>(samples_of(s) * frames.size());
  const std::string count = a.picture.frames ? std::to_string(frames.size()) + " frames of " : "";
  std::printf("%s: %s%ux%u in %.2f s, %s samples, %s rays, bad samples: %llu, lost rays: %llu\n",
              sum.output.c_str(), count.c_str(), s.width, s.height, sum.seconds, short_count(samples).c_str(),
              short_count(static_cast<double>(sum.counters.rays())).c_str(),
              static_cast<unsigned long long>(sum.counters.bad_samples),
              static_cast<unsigned long long>(sum.counters.lost));
}

nlohmann::json json_of(const RenderArguments& a, const std::vector<RenderedFrame>& frames) {
  if (!a.picture.frames) return to_json(frames.front());
  nlohmann::json all = nlohmann::json::array();
  for (const RenderedFrame& frame : frames) all.push_back(to_json(frame));
  const RenderedFrame sum = sum_of(a.picture.output, frames);
  return {{"output", sum.output},
          {"frames", std::move(all)},
          {"seconds", sum.seconds},
          {"counters", to_json(sum.counters)}};
}

/// The maps to put beside the picture.
std::vector<const MapKind*> aovs_of(const RenderArguments& a) {
  std::vector<const MapKind*> kinds;
  for (const MapKind& kind : all_maps()) {
    const auto is = [&](std::string_view name) {
      return std::find(a.aovs.begin(), a.aovs.end(), name) != a.aovs.end();
    };
    if (kind.source != MapSource::farm && (is(kind.name) || is("all"))) kinds.push_back(&kind);
  }
  if (!kinds.empty() && ending_of(a.picture.output) != ".exr")
    throw SettingsError("--aovs are channels of an .exr; let -o end in .exr");
  return kinds;
}

Picture picture_of(const PreparedScene& scene, const Film& film, const std::vector<const MapKind*>& aovs,
                   std::vector<Map>& maps) {
  Picture picture{film.size(), film.filled(), facts_of(scene.hash, scene.settings)};
  for (std::size_t i = 0; i < aovs.size(); ++i)
    picture.groups.push_back(
        {{aovs[i]->channels.begin(), aovs[i]->channels.end()}, std::move(maps[i].values)});
  return picture;
}

std::vector<std::string> outputs_of(const std::vector<RenderedFrame>& frames) {
  std::vector<std::string> files;
  for (const RenderedFrame& frame : frames) files.push_back(frame.output);
  return files;
}

/// The progress over all frames.
class Progress {
 public:
  explicit Progress(const FrameRange& frames) : frames_(frames) {}
  void begin(std::uint32_t place) { place_ = place; }
  void show(const Film& film) {
    const double pixels = static_cast<double>(film.size().width) * film.size().height;
    const double fraction = (place_ + static_cast<double>(film.pixels_done()) / pixels) / frames_.count();
    const std::string what =
        frames_.count() == 1 ? "rendering" : "rendering frame " + std::to_string(frames_.at(place_));
    line_.show(fraction, what, time_left(fraction, Clock::now() - begin_));
  }

 private:
  FrameRange frames_;
  std::uint32_t place_ = 0;
  Clock::time_point begin_ = Clock::now();
  ProgressLine line_;
};

/// Nothing when it was interrupted; then nothing is written.
std::optional<RenderedFrame> render_frame(const RenderArguments& a, PreparedScene scene, Progress& progress) {
  const auto begin = Clock::now();
  const World world(std::move(scene.scene));
  const std::uint32_t frame = scene.settings.frame;
  const std::vector<const MapKind*> aovs = aovs_of(a);
  CollectingRender collecting(world, scene.settings, aovs);
  std::optional<CloudFile> cloud;
  if (!a.cloud.empty()) cloud.emplace(frame_file(a.cloud, frame), CloudOptions{});
  if (cloud) collecting.also_collect(*cloud);
  const auto render = [&](std::uint32_t tile) {
    return collecting.render_tile(tile, all_passes, interrupted);
  };
  const Size size{scene.settings.width, scene.settings.height};
  const auto rendered =
      render_locally(size, a.threads, render, [&](const Film& film) { progress.show(film); });
  if (!rendered) return std::nullopt;
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

  if (cloud) cloud->commit();
  RenderedFrame written{frame_file(a.picture.output, frame), scene.hash, scene.settings, rendered->counters,
                        seconds};
  write_picture(written.output, picture_of(scene, rendered->film, aovs, collecting.maps()),
                a.picture.curve());
  return written;
}

void check_files(const RenderArguments& a) {
  const auto check_place_for_frame = [&](const char* option, const std::string& file) {
    if (a.picture.frames && !file.empty()) expect_place_for_frame(option, file);
  };
  check_place_for_frame("-o", a.picture.output);
  check_place_for_frame("--cloud", a.cloud);
  check_writable(frame_file(a.picture.output, 0));
  if (!a.cloud.empty()) check_cloud_place(frame_file(a.cloud, 0));
  aovs_of(a);
  if (!a.video.empty()) check_video(a.video, a.picture.output);
}

/// Frame after frame, each written when it is done; fewer than all when it was interrupted.
std::vector<RenderedFrame> render_frames(const RenderArguments& a, SceneFrames& frames) {
  std::vector<RenderedFrame> written;
  Progress progress(frames.range());
  while (written.size() < frames.range().count()) try {
      progress.begin(static_cast<std::uint32_t>(written.size()));
      std::optional<RenderedFrame> frame = render_frame(a, frames.take(), progress);
      if (!frame) break;
      written.push_back(std::move(*frame));
    } catch (const CommandError& error) {
      if (error.code != ExitCode::interrupted) throw;
      break;
    }
  return written;
}

ExitCode render(const RenderArguments& a) {
  check_files(a);
  note_interrupts();
  SceneFrames frames(a.picture);
  const std::vector<RenderedFrame> written = render_frames(a, frames);
  if (written.empty()) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  if (written.size() < frames.range().count())
    throw CommandError(ExitCode::interrupted,
                       "interrupted; the frames up to " + written.back().output + " are written");
  if (!a.video.empty()) write_video(a.video, outputs_of(written), frames.frames_per_second());
  if (a.json)
    print_json(json_of(a, written));
  else
    print_summary(a, written);
  return ExitCode::done;
}

}  // namespace

void add_render_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Render a scene on this PC");
  add_picture_options(*command, arguments->picture);
  command->add_option("--threads", arguments->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  std::vector<std::string> names{"all"};
  for (const MapKind& kind : all_maps())
    if (kind.source != MapSource::farm) names.emplace_back(kind.name);
  command
      ->add_option(
          "--aovs", arguments->aovs,
          "Maps of the same samples, as channels of the .exr, with commas between: all, or some of " +
              CLI::detail::join(std::vector<std::string>(names.begin() + 1, names.end()), ", "))
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  command->add_option("--cloud", arguments->cloud,
                      "A .ply to write with the surface points that the same rays met");
  command->add_option("--video", arguments->video, "A video to make of the frames by ffmpeg, e.g. name.mp4")
      ->needs("--frames");
  command->add_flag("--json", arguments->json, "Summary as JSON");
  command->footer(
      "Examples:\n  rayfarm render scenes/circus.lua -o circus.png --size 1280x720 --spp 64\n"
      "  rayfarm render scenes/animated_scene.lua --frames 0-99 -o turn.####.png --video turn.mp4");
  command->callback([arguments, &chosen] { chosen = [arguments] { return render(*arguments); }; });
}

}  // namespace rayfarm
