// What collecting maps or a point cloud adds to a render: CPU time on one thread. Each tile is rendered plainly, with maps
// and with a cloud by turns: what slows the PC for longer slows all of them. What a turn takes beyond the plain one of
// its round counts with its median of all rounds; each turn has its stack elsewhere within a page, so that no variant
// wins by where it lies. Plain is rendered twice: what the second seems to add is as exact as the figures are. Prints a
// table; scenes can be named.
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

constexpr std::size_t rounds = 15, variants = 6;
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

/// Runs body() with the stack so many bytes further down: where it lies within a page alone makes a render 1 % faster or
/// slower.
template <class Body>
[[gnu::noinline]] void run_below(std::size_t bytes, Body&& body) {
  void* const room = __builtin_alloca(bytes + 1);
  asm volatile("" ::"r"(room) : "memory");
  body();
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
  const RenderSettings settings{.width = 320, .height = 192, .spp = spp};
  const std::vector<std::uint32_t> order = centre_first({settings.width, settings.height});
  std::vector<std::array<std::array<double, rounds>, variants>> seconds(order.size());
  for (std::size_t round = 0; round < rounds; ++round) {
    CloudFile cloud(std::filesystem::temp_directory_path() / "rayfarm-benchmark.ply", {});
    std::array<CollectingRender, variants> renders{
        CollectingRender(world, settings, {}),
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
        run_below((round * variants + turn) * 1168 % 4096,
                  [&] { renders[i].render_tile(order[tile], all_passes, never); });
        seconds[tile][i][round] = cpu_seconds() - before;
      }
  }
  std::array<double, variants> sums{};  // of the first: its time; of others: what they add to it
  for (const auto& of_tile : seconds)
    for (std::size_t i = 0; i < variants; ++i) {
      std::array<double, rounds> values = of_tile[i];
      if (i > 0)
        std::transform(values.begin(), values.end(), of_tile[0].begin(), values.begin(), std::minus<>());
      sums[i] += median(values);
    }

  const double samples = 1.0 * settings.width * settings.height * settings.spp;
  std::printf("%-20s %4u %8.1f", scene.c_str(), spp, 1e9 * sums[0] / samples);
  for (std::size_t i = 1; i < variants; ++i)
    std::printf("  %8.1f ns %5.1f %%", 1e9 * sums[i] / samples, 100 * sums[i] / sums[0]);
  std::printf("\n");
}

}  // namespace
}  // namespace rayfarm

int main(int count, char** words) {
  std::printf("%-20s %4s %8s  %19s  %19s  %19s  %19s  %19s\n", "ns a primary sample", "spp", "plain",
              "plain again", "+ depth, normal", "+ all maps but cost", "+ all maps", "+ cloud");
  const std::array<const char*, 4> known{"sphere_plane", "hedgehog_in_the_cage", "circus", "sphere_flake"};
  const bool is_told = count > 1;
  for (std::size_t i = 0; i < (is_told ? static_cast<std::size_t>(count) - 1 : known.size()); ++i)
    for (const std::uint32_t spp : {4u, 16u}) rayfarm::measure(is_told ? words[i + 1] : known[i], spp);
}
