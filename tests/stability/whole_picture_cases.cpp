// S26 and S30: whole pictures of the bundled scenes, whose bits must not depend on who renders them or on the unit
// of length, and whose values hardly on where the scene lies.
#include <cmath>
#include <cstring>
#include <filesystem>

#include "common/render/render.h"
#include "common/work/each_tile.h"
#include "master/script/script.h"
#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"
#include "tests/support/moved_scene.h"

namespace rayfarm::stability {
namespace {

constexpr Size size{80, 60};  // four tiles

RenderSettings settings() {
  RenderSettings s;
  s.width = size.width, s.height = size.height, s.spp = 1;
  return s;
}

const auto never = [] { return false; };

Film rendered(const Scene& scene) {
  const World world(scene);
  Film film(size);
  for (std::uint32_t tile = 0; tile < tile_count(size); ++tile) {
    const auto images = render_tile(world, settings(), tile, all_passes, never);
    for (const PassImage& image : *images) film.put(tile, image);
  }
  return film;
}

struct Bundled {
  Scene scene;
  Film film;
};

/// Every script in scenes/, as it is without parameters; evaluated once.
const std::vector<Bundled>& bundled() {
  static const std::vector<Bundled> all = [] {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(RAYFARM_SOURCE_DIR "/scenes"))
      if (entry.path().extension() == ".lua") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<Bundled> scenes;
    for (const auto& file : files) {
      scenes.push_back({evaluate_file(file, {}, 0).scene, {}});
      scenes.back().film = rendered(scenes.back().scene);
    }
    return scenes;
  }();
  return all;
}

std::uint64_t pixels_that_differ(const Film& a, const Film& b) {
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.rgb().size(); i += 3)
    count += std::memcmp(&a.rgb()[i], &b.rgb()[i], 3 * sizeof(float)) != 0;
  return count;
}

double rmse(const Film& a, const Film& b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.rgb().size(); ++i) {
    const double d = double{a.rgb()[i]} - b.rgb()[i];
    squares += d * d;
  }
  return std::sqrt(squares / static_cast<double>(a.rgb().size()));
}

/// Calls check(scene, batch) for each bundled scene.
template <class Check>
RunBatch each_scene(Check check) {
  return [check](const Batch& batch) {
    Tally tally;
    for (const Bundled& b : bundled()) tally += check(b, batch);
    return tally;
  };
}

Tally in_another_unit(const Bundled& b, const Batch& batch) {
  const Film film = rendered(scaled(b.scene, static_cast<int>(batch.driver)));
  return {std::uint64_t{size.width} * size.height, pixels_that_differ(b.film, film)};
}

Tally elsewhere(const Bundled& b, const Batch& batch) {
  RandomRays random(batch.seed);
  const Vec3d by = random.direction() * batch.driver;
  return {1, rmse(b.film, rendered(shifted(b.scene, {by.x, by.y, by.z}))) > 1e-6};
}

/// By several threads, pass by pass in an order of chance, each tile stopped in its middle and begun again.
Tally by_many(const Bundled& b, const Batch& batch) {
  const World world(b.scene);
  std::mutex mutex;  // guards film
  Film film(size);
  const auto work = [&](std::uint32_t tile) {
    int questions = 0;
    render_tile(world, settings(), tile, all_passes, [&] { return ++questions > 500; });
    for (int i = 0; i < pass_count; ++i) {
      const int pass = static_cast<int>((batch.seed + tile + static_cast<std::uint64_t>(i)) % pass_count);
      const auto images = render_tile(world, settings(), tile, PassSet{1} << pass, never);
      const std::lock_guard lock(mutex);
      for (const PassImage& image : *images) film.put(tile, image);
    }
    return true;
  };
  each_tile(size, static_cast<unsigned>(batch.driver), work, [] {});
  return {std::uint64_t{size.width} * size.height, pixels_that_differ(b.film, film)};
}

std::vector<double> exponents() {
  std::vector<double> all;
  for (int k = -20; k <= 20; ++k)
    if (k != 0) all.push_back(k);
  return all;
}

}  // namespace

std::vector<Case> same_bits_cases() {
  return {{"S26",
           "pixels that differ: threads, order, retries",
           "threads",
           {1, 2, 3, 7},
           {{"ours", "double", each_scene(by_many), 0.0}},
           {1, 100, 1}}};
}

std::vector<Case> whole_scene_cases() {
  return {{"S30 scale",
           "pixels that differ when lengths are times 2^k",
           "k",
           exponents(),
           {{"ours", "double", each_scene(in_another_unit), 0.0}},
           {1, 1, 1}},
          {"S30 shift",
           "scenes with RMSE above 1e-6 when moved",
           "distance moved, units of the scene",
           {1, 1e2, 1e4, 1e6},
           {{"ours", "double", each_scene(elsewhere), 0.0}},
           {1, 100, 1}}};
}

}  // namespace rayfarm::stability
