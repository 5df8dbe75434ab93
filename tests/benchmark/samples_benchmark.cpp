// What a primary sample costs, with all rays that follow from it, in each bundled scene: one thread, whole tiles,
// as in a farm.
#include <benchmark/benchmark.h>

#include "common/render/render.h"
#include "master/script/script.h"

namespace rayfarm {
namespace {

void primary_samples(benchmark::State& state, const std::string& scene,
                     const std::map<std::string, std::string>& params) {
  const World world(evaluate_file(RAYFARM_SOURCE_DIR "/scenes/" + scene + ".lua", params, 0).scene);
  const RenderSettings settings{.width = 320, .height = 180, .spp = 4};
  const Size film{settings.width, settings.height};
  for (auto _ : state)
    for (std::uint32_t tile = 0; tile < tile_count(film); ++tile)
      benchmark::DoNotOptimize(render_tile(world, settings, tile, all_passes, [] { return false; }));
  const double samples = static_cast<double>(state.iterations()) * film.width * film.height * settings.spp;
  state.counters["sample"] =
      benchmark::Counter(samples, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

using Params = std::map<std::string, std::string>;
BENCHMARK_CAPTURE(primary_samples, sphere_plane, "sphere_plane", Params{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(primary_samples, hedgehog_in_the_cage, "hedgehog_in_the_cage", Params{})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(primary_samples, circus, "circus", Params{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(primary_samples, sphere_flake, "sphere_flake", Params{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(primary_samples, test_scene, "test_scene", Params{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(primary_samples, test_scene_rectangle, "test_scene", Params{{"light", "rectangle"}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace rayfarm
