// rayfarm render: a picture by this PC alone.
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "master/cli/commands.h"
#include "master/cli/interrupt.h"
#include "master/cli/local_render.h"
#include "master/cli/picture_options.h"
#include "master/cli/print_json.h"
#include "master/cli/progress_line.h"
#include "master/cli/text.h"
#include "master/files/picture_facts.h"
#include "master/http/settings_json.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

struct RenderArguments {
  PictureOptions picture;
  unsigned threads = std::max(1u, std::thread::hardware_concurrency());
  bool json = false;
};

/// None in the first 5 %: there is too little to learn from.
std::optional<std::chrono::seconds> time_left(double fraction, Clock::duration elapsed) {
  if (fraction < 0.05) return std::nullopt;
  return std::chrono::duration_cast<std::chrono::seconds>(elapsed * ((1 - fraction) / fraction));
}

void print_summary(const RenderArguments& a, const PreparedScene& scene, const RayCounters& counters,
                   double seconds) {
  const RenderSettings& s = scene.settings;
  const std::uint64_t samples = std::uint64_t{s.width} * s.height * s.spp;
  if (a.json) {
    const nlohmann::json summary{{"output", a.picture.output}, {"scene_hash", scene.hash},
                                 {"settings", to_json(s)},     {"seconds", seconds},
                                 {"samples", samples},         {"counters", to_json(counters)}};
    print_json(summary);
    return;
  }
  std::printf("%s: %ux%u in %.2f s, %s samples, %s rays, bad samples: %llu\n", a.picture.output.c_str(),
              s.width, s.height, seconds, short_count(static_cast<double>(samples)).c_str(),
              short_count(static_cast<double>(counters.rays())).c_str(),
              static_cast<unsigned long long>(counters.bad_samples));
}

ExitCode render(const RenderArguments& a) {
  check_writable(a.picture.output);
  note_interrupts();
  PreparedScene scene = prepare(a.picture);

  const auto begin = Clock::now();
  const World world(std::move(scene.scene));
  std::optional<LocalRender> rendered;
  {
    ProgressLine line;
    rendered = render_locally(world, scene.settings, a.threads, interrupted, [&](const Film& film) {
      const double pixels = static_cast<double>(film.size().width) * film.size().height;
      const double fraction = static_cast<double>(film.pixels_done()) / pixels;
      line.show(fraction, "rendering", time_left(fraction, Clock::now() - begin));
    });
  }
  if (!rendered) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

  write_picture(a.picture.output,
                {rendered->film.size(), rendered->film.filled(), facts_of(scene.hash, scene.settings)},
                a.picture.curve());
  print_summary(a, scene, rendered->counters, seconds);
  return ExitCode::done;
}

}  // namespace

void add_render_command(CLI::App& app, Command& chosen) {
  const auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Render a scene on this PC");
  add_picture_options(*command, arguments->picture);
  command->add_option("--threads", arguments->threads, "Threads to use (default: all of this PC)")
      ->check(CLI::Range(1u, 1024u));
  command->add_flag("--json", arguments->json, "Summary as JSON");
  command->footer("Example: rayfarm render scenes/circus.lua -o circus.png --size 1280x720 --spp 64");
  command->callback([arguments, &chosen] { chosen = [arguments] { return render(*arguments); }; });
}

}  // namespace rayfarm
