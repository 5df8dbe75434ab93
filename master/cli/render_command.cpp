// rayfarm render: a picture by this PC alone.
#include <CLI/CLI.hpp>
#include <algorithm>
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
#include "master/diagnostics/collecting_render.h"
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
  std::printf("%s: %ux%u in %.2f s, %s samples, %s rays, bad samples: %llu, lost rays: %llu\n", a.picture.output.c_str(),
              s.width, s.height, seconds, short_count(static_cast<double>(samples)).c_str(),
              short_count(static_cast<double>(counters.rays())).c_str(),
              static_cast<unsigned long long>(counters.bad_samples),
              static_cast<unsigned long long>(counters.lost));
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
  if (!kinds.empty() && !a.picture.output.ends_with(".exr"))
    throw SettingsError("--aovs are channels of an .exr; let -o end in .exr");
  return kinds;
}

/// The cloud of the same samples, when it is asked for.
std::optional<CloudFile> cloud_of(const RenderArguments& a) {
  if (a.cloud.empty()) return std::nullopt;
  return std::optional<CloudFile>(std::in_place, a.cloud, CloudOptions{});
}

Picture picture_of(const PreparedScene& scene, const Film& film, const std::vector<const MapKind*>& aovs,
                   std::vector<Map>& maps) {
  Picture picture{film.size(), film.filled(), facts_of(scene.hash, scene.settings)};
  for (std::size_t i = 0; i < aovs.size(); ++i)
    picture.groups.push_back(
        {{aovs[i]->channels.begin(), aovs[i]->channels.end()}, std::move(maps[i].values)});
  return picture;
}

ExitCode render(const RenderArguments& a) {
  check_writable(a.picture.output);
  if (!a.cloud.empty()) check_place(a.cloud);
  const std::vector<const MapKind*> aovs = aovs_of(a);
  note_interrupts();
  PreparedScene scene = prepare(a.picture);

  const auto begin = Clock::now();
  const World world(std::move(scene.scene));
  const Size size{scene.settings.width, scene.settings.height};
  CollectingRender collecting(world, scene.settings, aovs);
  std::optional<CloudFile> cloud = cloud_of(a);
  if (cloud) collecting.also_collect(*cloud);
  std::optional<LocalRender> rendered;
  {
    ProgressLine line;
    const auto render = [&](std::uint32_t tile) {
      return collecting.render_tile(tile, all_passes, interrupted);
    };
    rendered = render_locally(size, a.threads, render, [&](const Film& film) {
      const double pixels = static_cast<double>(film.size().width) * film.size().height;
      const double fraction = static_cast<double>(film.pixels_done()) / pixels;
      line.show(fraction, "rendering", time_left(fraction, Clock::now() - begin));
    });
  }
  if (!rendered) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
  const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();

  if (cloud) cloud->commit();
  write_picture(a.picture.output, picture_of(scene, rendered->film, aovs, collecting.maps()),
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
  command->add_flag("--json", arguments->json, "Summary as JSON");
  command->footer("Example: rayfarm render scenes/circus.lua -o circus.png --size 1280x720 --spp 64");
  command->callback([arguments, &chosen] { chosen = [arguments] { return render(*arguments); }; });
}

}  // namespace rayfarm
