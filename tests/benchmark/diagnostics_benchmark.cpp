// What collecting maps or a point cloud adds to a render: CPU time on one thread. Each tile is rendered plainly,
// with maps and with a cloud by turns, each of them first once, and counts with its median of five rounds: so what
// else the PC does now and then counts for none. Prints a table.
#include <time.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <functional>

#include "master/diagnostics/collecting_render.h"
#include "master/script/script.h"

namespace rayfarm {
namespace {

constexpr std::size_t rounds = 5, variants = 5;
const std::function<bool()> never = [] { return false; };

/// Of this process, in the kernel too: a cloud's file is written.
double cpu_seconds() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double median(std::array<double, rounds> values) {
  std::sort(values.begin(), values.end());
  return values[rounds / 2];
}

/// The maps of these kinds.
std::vector<const MapKind*> kinds_with(const std::function<bool(const MapKind&)>& is_wanted) {
  std::vector<const MapKind*> kinds;
  for (const MapKind& kind : all_maps())
    if (kind.source != MapSource::farm && is_wanted(kind)) kinds.push_back(&kind);
  return kinds;
}

void measure(const std::string& scene, std::uint32_t spp) {
  const World world(evaluate_file(RAYFARM_SOURCE_DIR "/scenes/" + scene + ".lua", {}, 0).scene);
  const RenderSettings settings{.width = 320, .height = 180, .spp = spp};
  const std::vector<std::uint32_t> order = centre_first({settings.width, settings.height});
  std::vector<std::array<std::array<double, rounds>, variants>> seconds(order.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    CloudFile cloud(std::filesystem::temp_directory_path() / "rayfarm-benchmark.ply", {});
    std::array<CollectingRender, variants> renders{
        CollectingRender(world, settings, {}),
        CollectingRender(world, settings, {map_named("depth"), map_named("normal")}),
        CollectingRender(world, settings,
                         kinds_with([](const MapKind& kind) { return kind.source != MapSource::time; })),
        CollectingRender(world, settings, kinds_with([](const MapKind&) { return true; })),
        CollectingRender(world, settings, {})};
    renders.back().also_collect(cloud);
    for (std::size_t tile = 0; tile < order.size(); ++tile)
      for (std::size_t turn = 0; turn < variants; ++turn) {
        const std::size_t i = (turn + round) % variants;
        const double before = cpu_seconds();
        renders[i].render_tile(order[tile], all_passes, never);
        seconds[tile][i][round] = cpu_seconds() - before;
      }
  }
  std::array<double, variants> sums{};
  for (const auto& of_tile : seconds)
    for (std::size_t i = 0; i < variants; ++i) sums[i] += median(of_tile[i]);

  const double samples = static_cast<double>(settings.width) * settings.height * settings.spp;
  const double plain = sums[0];
  std::printf("%-20s %4u %8.1f", scene.c_str(), spp, 1e9 * plain / samples);
  for (std::size_t i = 1; i < variants; ++i) {
    const double extra = sums[i] - plain;
    std::printf("  %8.1f ns %5.1f %%", 1e9 * extra / samples, 100 * extra / plain);
  }
  std::printf("\n");
}

}  // namespace
}  // namespace rayfarm

int main() {
  std::printf("%-20s %4s %8s  %19s  %19s  %19s  %19s\n", "ns a primary sample", "spp", "plain",
              "+ depth, normal", "+ all maps but cost", "+ all maps", "+ cloud");
  for (const char* scene : {"sphere_plane", "hedgehog_in_the_cage", "circus", "sphere_flake"})
    for (const std::uint32_t spp : {4u, 16u}) rayfarm::measure(scene, spp);
}
