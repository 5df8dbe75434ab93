// rayfarm fetch: the pictures of a job into files of this PC.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/frame_files.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_picture.h"
#include "master/cli/job_progress.h"
#include "master/cli/master_api.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/cli/whole_number.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct FetchArguments {
  JobNumber id = 0;
  std::optional<std::uint32_t> frame;
  std::string output;
  bool partial = false, srgb = false, json = false;
};

/// A picture that was written.
struct Fetched {
  std::string output;
  std::uint32_t frame = 0;
  std::uint64_t pixels_done = 0, pixels_total = 0;

  bool is_whole() const { return pixels_done == pixels_total; }
};

json to_json(const Fetched& f) {
  return {{"output", f.output},
          {"frame", f.frame},
          {"pixels_done", f.pixels_done},
          {"pixels_total", f.pixels_total}};
}

/// Writes it if it is whole, or that does not matter: what was done may turn out to be damaged when it is read.
Fetched fetch_frame(const FetchArguments& a, const json& job, const json& frame, const std::string& file) {
  const Film film = fetch_film(a.id, frame.at("frame"));
  const std::uint64_t total = std::uint64_t{film.size().width} * film.size().height;
  Fetched fetched{file, frame.at("frame"), film.pixels_done(), total};
  if (a.partial || fetched.is_whole())
    write_job_picture(file, job, frame, film, a.srgb ? PngCurve::srgb : PngCurve::gamma22);
  return fetched;
}

ExitCode fetch_one(const FetchArguments& a, const json& job, const json& frame, const std::string& file) {
  check_writable(file);
  const std::string state = frame.at("state");
  if (state != "done" && !a.partial)
    throw CommandError(ExitCode::failed,
                       (a.frame ? "frame " + std::to_string(*a.frame) + " of " : std::string()) + "job " +
                           std::to_string(a.id) + " is " + state + ", " +
                           percent(frame.at("pixels_done"), frame.at("pixels_total")) +
                           " done; take what is there with --partial");

  const Fetched fetched = fetch_frame(a, job, frame, file);
  if (!fetched.is_whole() && !a.partial)
    throw CommandError(ExitCode::failed, "job " + std::to_string(a.id) + ": " +
                                             printable(get_json(job_target(a.id)).at("message")) +
                                             "; nothing was written; take what is there with --partial");
  if (a.json) {
    json answer = to_json(fetched);
    answer["job"] = a.id;
    print_json(answer);
  } else {
    std::printf("%s\n", printable(file).c_str());
  }
  if (fetched.is_whole()) return ExitCode::done;
  throw CommandError(ExitCode::partly_done, "only " + percent(fetched.pixels_done, fetched.pixels_total) +
                                                " of the pixels were there, coarser ones fill the rest");
}

/// Those that are done, and what is there of the others with --partial.
ExitCode fetch_all(const FetchArguments& a, const json& job, const json& frames, const std::string& pattern) {
  expect_place_for_frame("-o", pattern);
  check_writable(frame_file(pattern, frames.front().at("frame")));
  json written = json::array();
  std::size_t complete = 0;
  for (const json& frame : frames) {
    const bool is_wanted = frame.at("state") == "done" || (a.partial && frame.at("pixels_done") > 0);
    if (!is_wanted || !frame.at("is_kept").get<bool>()) continue;
    const Fetched fetched = fetch_frame(a, job, frame, frame_file(pattern, frame.at("frame")));
    if (!fetched.is_whole() && !a.partial) continue;
    complete += fetched.is_whole();
    written.push_back(to_json(fetched));
    if (!a.json) std::printf("%s\n", printable(fetched.output).c_str());
  }
  if (a.json)
    print_json({{"job", a.id}, {"output", pattern}, {"frames", written}, {"frames_total", frames.size()}});
  if (complete == frames.size()) return ExitCode::done;
  const std::string message = printable(get_json(job_target(a.id)).at("message"));
  throw CommandError(ExitCode::partly_done, "only " + std::to_string(complete) + " of " +
                                                std::to_string(frames.size()) + " frames were there whole" +
                                                (message.empty() ? "" : "; " + message));
}

ExitCode fetch(const FetchArguments& a) {
  note_interrupts();
  const json job = get_json(job_target(a.id));
  const std::string output = a.output.empty() ? std::string(job.at("output")) : a.output;
  if (output.empty())
    throw CommandError(ExitCode::usage, "job " + std::to_string(a.id) + " names no output; say -o FILE");
  const json frames = frames_of(a.id);
  if (!a.frame && is_animation(job)) return fetch_all(a, job, frames, output);
  if (!a.frame) return fetch_one(a, job, frames.front(), frame_file(output, frames.front().at("frame")));
  for (const json& frame : frames)
    if (frame.at("frame") == *a.frame) return fetch_one(a, job, frame, frame_file(output, *a.frame));
  throw CommandError(ExitCode::usage, "job " + std::to_string(a.id) + " has no frame " +
                                          std::to_string(*a.frame) + ", but " + frames_text(job));
}

}  // namespace

void add_fetch_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<FetchArguments>();
  CLI::App* command = app.add_subcommand("fetch", "Write a job's picture, or those of its frames, to files");
  command->add_option("ID", arguments->id, "The job's number")->required()->check(whole_number());
  command->add_option("-o,--output", arguments->output,
                      "File, .exr or .png (default: the one that submit named); #### is the frame's number");
  command->add_option("--frame", arguments->frame,
                      "Only this frame of an animation (default: all that are done)");
  command->add_flag("--partial", arguments->partial, "Also what misses pixels; the exit code is then 7");
  command->add_flag("--srgb", arguments->srgb, "PNG with the sRGB curve instead of gamma 2.2");
  command->add_flag("--json", arguments->json, "Result as JSON");
  command->footer("Examples:\n  rayfarm fetch 3 --partial -o so_far.png\n  rayfarm fetch 7 -o turn.####.png");
  command->callback([arguments, &chosen] { chosen = [arguments] { return fetch(*arguments); }; });
}

}  // namespace rayfarm
