#include "tests/support/simple_job.h"

#include <thread>

namespace rayfarm {

Scene simple_scene() {
  Scene scene;
  scene.nodes.push_back({Solid{Sphere{}}, {}, 0, {}, {}, "ball"});
  scene.materials.push_back({});
  scene.camera = PerspectiveCamera{{0, 0, -5}, {0, 0, 1}, {0, 1, 0}, 50};
  scene.lights.push_back(AmbientLight{});
  return scene;
}

SceneData scene_data(const Scene& scene) {
  const auto bytes = std::make_shared<const Bytes>(encode_scene(scene));
  return {sha256_hex(*bytes), bytes};
}

std::optional<std::vector<PassImage>> position_tile(const RenderSettings& settings, std::uint32_t tile,
                                                    PassSet passes, const std::function<bool()>& stop) {
  return position_area(settings, tile_at({settings.width, settings.height}, tile), passes, stop);
}

std::optional<std::vector<PassImage>> position_area(const RenderSettings& settings, const Tile& area,
                                                    PassSet passes, const std::function<bool()>& stop) {
  std::vector<PassImage> images;
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(passes >> pass & 1)) continue;
    if (stop()) return std::nullopt;
    PassImage image;
    image.pass = pass;
    for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
      image.rgb.insert(image.rgb.end(), {float(x), float(y), float(settings.seed)});
    });
    image.counters.primary = image.rgb.size() / 3 * settings.spp;
    images.push_back(std::move(image));
  }
  return images;
}

TileRenderer prepare_positions(Scene) { return position_area; }

PrepareScene Gate::prepare() {
  return [this](Scene) -> TileRenderer {
    return [this](const RenderSettings& settings, const Tile& area, PassSet passes,
                  const std::function<bool()>& stop) -> std::optional<std::vector<PassImage>> {
      ++begun_;
      begun_.notify_all();
      while (!open_) {
        if (stop()) {
          ++stopped_;
          stopped_.notify_all();
          return std::nullopt;
        }
        std::this_thread::yield();
      }
      return position_area(settings, area, passes, stop);
    };
  };
}

namespace {

void wait_for(const std::atomic<int>& count, int least) {
  for (int now = count; now < least; now = count) count.wait(now);
}

}  // namespace

void Gate::wait_for_begun(int tiles) { wait_for(begun_, tiles); }
void Gate::wait_for_stopped(int tiles) { wait_for(stopped_, tiles); }

void Gate::open() { open_ = true; }

}  // namespace rayfarm
