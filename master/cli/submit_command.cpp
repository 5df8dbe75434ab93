// rayfarm submit: the script is evaluated here, the scene goes to the farm.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/cli/commands.h"
#include "master/cli/frame_files.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_picture.h"
#include "master/cli/job_progress.h"
#include "master/cli/master_api.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/cli/scene_frames.h"
#include "master/cli/video.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct SubmitArguments {
  PictureOptions picture;
  std::string name, key;
  std::string video;  // of the frames; empty: none
  std::string verify = "none";
  int priority = 50;
  bool hold = false, watch = false, wait = false, json = false;
};

SceneData sent_scene(PreparedScene& scene) {
  if (scene.bytes.size() > largest_scene)
    throw CommandError(ExitCode::usage, "the scene takes " + std::to_string(scene.bytes.size() >> 20) +
                                            " MB; at most " + std::to_string(largest_scene >> 20) +
                                            " can be submitted");
  return {scene.hash, std::make_shared<const std::vector<std::uint8_t>>(std::move(scene.bytes))};
}

/// Those that the master has not got.
void upload(const std::vector<AssetData>& assets) {
  for (const AssetData& asset : assets) {
    if (get_json("/api/v1/assets/" + asset.hash).value("is_here", false)) continue;
    if (asset.bytes->size() > largest_scene)
      throw CommandError(ExitCode::usage, "a mesh or picture of the scene takes " +
                                              std::to_string(asset.bytes->size() >> 20) + " MB; at most " +
                                              std::to_string(largest_scene >> 20) + " can be submitted");
    post_json("/api/v1/assets", {{"data", base64(*asset.bytes)}});
  }
}

JobSpec spec_of(const SubmitArguments& a, const FrameRange& frames, PreparedScene first) {
  JobSpec spec;
  spec.name = a.name.empty() ? std::filesystem::path(a.picture.scene_file).stem().string() : a.name;
  spec.output = a.picture.output;
  SceneData scene = sent_scene(first);
  spec.scene_hash = std::move(scene.hash);
  spec.scene_bytes = std::move(scene.bytes);
  spec.assets = std::move(first.assets);
  spec.settings = first.settings;
  if (a.picture.frames) spec.frames = frames;
  spec.priority = a.priority;
  spec.hold = a.hold;
  spec.key = a.key;
  spec.verification = parse_verification(a.verify);
  return spec;
}

/// Who submitted is told how the job goes on, and gets its pictures as they are done.
class Watch {
 public:
  explicit Watch(const SubmitArguments& a)
      : shows_(a.watch), stays_(a.watch || a.wait), writer_(a.picture.output, a.picture.curve()) {
    if (stays_) line_.emplace();
  }
  void news(const json& job) {
    if (!stays_) return;
    if (line_) shows_ ? show(*line_, job) : show_pause(*line_, job);
    writer_.write_done(job);
  }
  bool stays() const { return stays_; }
  void end() { line_.reset(); }
  std::vector<std::string> files() const { return writer_.files(); }

 private:
  bool shows_, stays_;
  std::optional<ProgressLine> line_;
  FrameWriter writer_;
};

/// Sends the scenes of the frames after the first, as fast as the farm takes them; the job as it is then.
json send_frames(SceneFrames& frames, json job, Watch& watch) {
  const std::string target = job_target(job.at("id"));
  const auto while_full = [&] {
    job = get_json(target);
    watch.news(job);
  };
  frames.skip_to(job.at("frames").at("sent"));
  while (job.at("frames").at("sent") < frames.range().count()) {
    PreparedScene scene = frames.take();
    upload(scene.assets);
    const SubmittedFrame frame{scene.settings.frame, sent_scene(scene), scene.assets};
    job = post_json_patiently(target + "/frames", to_json(frame), while_full);
    watch.news(job);
  }
  return job;
}

/// A job without all its scenes would wait for ever.
json sent_whole(SceneFrames& frames, const json& job, Watch& watch) {
  const std::string id = job.at("id").dump();
  try {
    return send_frames(frames, job, watch);
  } catch (const std::exception& error) {
    watch.end();
    if (interrupted())
      throw CommandError(ExitCode::interrupted, "interrupted; job " + id +
                                                    " still waits for frames: rayfarm cancel " + id +
                                                    ", or submit it again with the same --id");
    const auto* failure = dynamic_cast<const CommandError*>(&error);
    if (failure && failure->code == ExitCode::master_unreachable)
      throw CommandError(failure->code, failure->what() + ("; job " + id) +
                                            " lacks frames: submit it again with the same --id");
    post_json(job_target(job.at("id")) + "/cancel", json::object());
    std::fprintf(stderr, "rayfarm: job %s is cancelled\n", id.c_str());
    throw;
  }
}

void check_files(const SubmitArguments& a) {
  if (a.picture.frames) expect_place_for_frame("-o", a.picture.output);
  check_writable(frame_file(a.picture.output, 0));
  if (a.video.empty()) return;
  if (!a.watch && !a.wait) throw SettingsError("--video is made of the pictures here: add --wait or --watch");
  check_video(a.video, a.picture.output);
}

ExitCode submit(const SubmitArguments& a) {
  check_files(a);
  note_interrupts();
  SceneFrames frames(a.picture);
  const JobSpec spec = spec_of(a, frames.range(), frames.take());
  upload(spec.assets);
  const json submitted = post_json("/api/v1/jobs", to_json(spec));
  const JobNumber id = submitted.at("id");
  if (!a.json) print_json(id);
  std::fflush(stdout);  // the frames' scenes may take long to send
  Watch watch(a);
  const json sent = sent_whole(frames, submitted, watch);
  if (a.json && !watch.stays()) print_json(sent);
  if (!watch.stays()) return ExitCode::done;

  const json ended = await_end(id, [&](const json& job) { watch.news(job); });
  watch.end();
  if (a.json) print_json(ended);
  expect_done(ended);
  if (!a.json)
    std::fprintf(stderr, "lost rays: %llu\n", ended.at("counters").at("lost").get<unsigned long long>());
  if (!a.video.empty()) write_video(a.video, watch.files(), frames.frames_per_second());
  return ExitCode::done;
}

}  // namespace

void add_submit_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<SubmitArguments>();
  SubmitArguments& a = *arguments;
  CLI::App* command = app.add_subcommand("submit", "Send a scene to the farm; prints the job's id");
  add_picture_options(*command, a.picture);
  command->add_option("--name", a.name, "Name of the job (default: the script's)");
  command->add_option("--priority", a.priority, "0 to 99, higher first (default 50)")
      ->check(CLI::Range(0, 99));
  command
      ->add_option("--verify", a.verify,
                   "How far workers are believed: none, audit=P (a share P of their tiles is rendered by "
                   "somebody else, too) or quorum=N (each tile by N workers); default none")
      ->type_name("none|audit=P|quorum=N")
      ->check([](const std::string& text) {
        try {
          parse_verification(text);
          return std::string();
        } catch (const SettingsError& error) {
          return std::string(error.what());
        }
      });
  command->add_flag("--hold", a.hold, "Start paused");
  command->add_option("--id", a.key, "A key of your own: the same key gives the same job again");
  CLI::Option* watch = command->add_flag("--watch", a.watch, "Show the progress, then write the picture");
  command->add_flag("--wait", a.wait, "Wait in silence, then write the picture")->excludes(watch);
  command->add_option("--video", a.video, "A video to make of the frames by ffmpeg, e.g. name.mp4")
      ->needs("--frames");
  command->add_flag("--json", a.json, "The job as JSON");
  command->footer(
      "Examples:\n  rayfarm submit scenes/sphere_flake.lua -p depth=5 -o flake.exr --watch\n"
      "  rayfarm submit scenes/animated_scene.lua --frames 0-499 -o turn.####.png --watch\n"
      "The master is the one that RAYFARM_MASTER names, by default http://127.0.0.1:5412.");
  command->callback([arguments, &chosen] { chosen = [arguments] { return submit(*arguments); }; });
}

}  // namespace rayfarm
