// rayfarm fetch: the picture of a job into a file of this PC.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/job_picture.h"
#include "master/cli/master_api.h"
#include "master/cli/print_json.h"
#include "master/cli/text.h"
#include "master/cli/whole_number.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct FetchArguments {
  JobNumber id = 0;
  std::string output;
  bool partial = false, srgb = false, json = false;
};

ExitCode fetch(const FetchArguments& a) {
  note_interrupts();
  const json job = get_json(job_target(a.id));
  const std::string number = std::to_string(a.id),
                    output = a.output.empty() ? std::string(job.at("output")) : a.output;
  if (output.empty()) throw CommandError(ExitCode::usage, "job " + number + " names no output; say -o FILE");
  check_writable(output);
  const std::string state = job.at("state");
  if (state != "done" && !a.partial)
    throw CommandError(ExitCode::failed, "job " + number + " is " + state + ", " +
                                             percent(job.at("pixels_done"), job.at("pixels_total")) +
                                             " done; take what is there with --partial");

  const Film film = fetch_film(job);
  write_job_picture(output, job, film, a.srgb ? PngCurve::srgb : PngCurve::gamma22);
  const std::uint64_t total = std::uint64_t{film.size().width} * film.size().height;
  if (a.json)
    print_json(
        {{"job", a.id}, {"output", output}, {"pixels_done", film.pixels_done()}, {"pixels_total", total}});
  else
    std::printf("%s\n", printable(output).c_str());
  if (film.is_complete()) return ExitCode::done;
  throw CommandError(ExitCode::partly_done, "only " + percent(film.pixels_done(), total) +
                                                " of the pixels were there, coarser ones fill the rest");
}

}  // namespace

void add_fetch_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<FetchArguments>();
  CLI::App* command = app.add_subcommand("fetch", "Write a job's picture to a file");
  command->add_option("ID", arguments->id, "The job's number")->required()->check(whole_number());
  command->add_option("-o,--output", arguments->output,
                      "File, .exr or .png (default: the one that submit named)");
  command->add_flag("--partial", arguments->partial, "Also when pixels are missing; the exit code is then 7");
  command->add_flag("--srgb", arguments->srgb, "PNG with the sRGB curve instead of gamma 2.2");
  command->add_flag("--json", arguments->json, "Result as JSON");
  command->footer("Example: rayfarm fetch 3 --partial -o so_far.png");
  command->callback([arguments, &chosen] { chosen = [arguments] { return fetch(*arguments); }; });
}

}  // namespace rayfarm
