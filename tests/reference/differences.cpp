// Draws the crops of DIFFERENCES.md: differences FOLDER. In each picture the original's way is on the left, ours on the
// right, pixel by pixel through the pixel centres, enlarged.
#include <cstdio>
#include <fstream>
#include <functional>
#include <iterator>

#include "common/render/probe.h"
#include "master/files/image_file.h"
#include "master/script/script.h"
#include "tests/reference/original_rules.h"
#include "tests/reference/reference_tracer.h"

namespace rayfarm {
namespace {

struct Crop {
  std::string name;
  Scene scene;
  std::uint32_t width, height;          // of the film
  std::uint32_t x0, y0, columns, rows;  // of it
  std::uint32_t enlargement;
};

using ColorAt = std::function<glm::dvec3(double x, double y)>;

/// `pixel` as a block of the half of the picture that begins at the column `left`.
void put_block(Picture& picture, std::uint32_t left, std::uint32_t column, std::uint32_t row,
               std::uint32_t enlargement, const glm::dvec3& color) {
  for (std::uint32_t y = row * enlargement; y < (row + 1) * enlargement; ++y)
    for (std::uint32_t x = left + column * enlargement; x < left + (column + 1) * enlargement; ++x)
      for (int c = 0; c < 3; ++c)
        picture.rgb[3 * (std::size_t{y} * picture.size.width + x) + static_cast<std::size_t>(c)] =
            static_cast<float>(color[c]);
}

Picture drawn(const Crop& crop) {
  constexpr std::uint32_t gap = 6;  // white, between the two
  const std::uint32_t half = crop.columns * crop.enlargement;
  Picture picture{{2 * half + gap, crop.rows * crop.enlargement}, {}, {}};
  picture.rgb.assign(std::size_t{3} * picture.size.width * picture.size.height, 1.0f);

  const ReferenceTracer original(crop.scene, reference::original_rules());
  const ReferenceSettings film{.width = double(crop.width), .height = double(crop.height)};
  const World world(crop.scene);
  RenderSettings settings;
  settings.width = crop.width, settings.height = crop.height;
  const std::pair<std::uint32_t, ColorAt> halves[] = {
      {0, [&](double x, double y) { return original.sample(film, x, y).color; }},
      {half + gap, [&](double x, double y) {
         return probe(world, settings, x, y, {0.5, 0.5}).color;
       }}};
  for (const auto& [left, color_at] : halves)
    for (std::uint32_t row = 0; row < crop.rows; ++row)
      for (std::uint32_t column = 0; column < crop.columns; ++column)
        put_block(picture, left, column, row, crop.enlargement,
                  color_at(crop.x0 + column + 0.5, crop.y0 + row + 0.5));
  return picture;
}

// Scenes. -----------------------------------------------------------------------------------------------------------

std::string text_of(const std::string& scene) {
  std::ifstream in(std::string(RAYFARM_SOURCE_DIR) + "/scenes/" + scene + ".lua");
  return {std::istreambuf_iterator<char>(in), {}};
}

Scene scene_of(const std::string& text) { return evaluate({"difference", text, {}, 0}).scene; }

/// A thousandth of its size.
Scene made_small(Scene scene) {
  const double k = 1e-3;
  scene.nodes[0].parent_from_node = scaling(glm::dvec3(k)) * scene.nodes[0].parent_from_node;
  std::get<PerspectiveCamera>(scene.camera).from *= k;
  for (Light& light : scene.lights)
    if (auto* point = std::get_if<PointLight>(&light)) point->at *= k;
  return scene;
}

/// `root` seen along z by a camera on the axis.
Scene seen_along_z(const std::string& root) {
  return scene_of(R"(return scene{
    camera = perspective{ from = {0, 0, -6}, angle = 30 }, background = {0, 0.05, 0.07},
    lights = { ambient(0.8), point{ at = {-5, 4, -6} } }, root = )" +
                  root + " }");
}

std::vector<Crop> crops() {
  // The front faces are one plane, to which the two cubes come by different turns.
  const Scene touching = seen_along_z(R"(union{
    cube{}:translate(-0.5, -0.5, -0.5):rotate_z(45):rotate_y(20):color{1, 0, 0},
    cube{}:translate(-0.5, -0.5, -0.5):scale(2.6, 1.8, 1):rotate_y(50):rotate_y(-30):color(1) })");
  const Scene cloth_before_ball = seen_along_z(R"(union{
    bezier{ { { {-1, -1, 0}, {0, -1, 1}, {0, -1, -1}, {1, -1, 0} }, { {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0} },
              { {-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {1, 0, 0} }, { {-1, 1, 0}, {0, 1, 1}, {0, 1, -1}, {1, 1, 0} } } }
        :scale(1.2):material(phong{ color = {0.9, 0.6, 0.1}, ambient = 1, transmission = 0.4, index = 1 })
        :texture(checker{ 4, 4, {0.2, 0.2, 0.7} }),
    sphere{}:scale(0.4):translate(0.3, 0.3, -1.5):color{0.8, 0, 0} })");
  const Scene stick_in_ball = seen_along_z(R"(union{
    cylinder{ -1.1, 1.1 }:scale(0.12, 0.12, 1):rotate_x(90):color{0.8, 0.2, 0},
    sphere{}:scale(0.6):material(phong{ color = {0.1, 0.2, 0.3}, diffuse = 0.1, transmission = 0.8, index = 1 }):no_shadow(),
    plane{}:rotate_x(-110):translate(0, -0.9, 0):color(0.9) })");
  const Scene far_ring = scene_of(R"(return scene{
    camera = perspective{ from = {0, 1500, -5000}, direction = {0, -0.3, 1}, angle = 0.032 }, background = {0, 0.05, 0.07},
    lights = { ambient(0.8), point{ at = {-2500, 2000, -3000} } },
    root = torus{ 1, 0.3 }:rotate_x(70):color{0.9, 0.6, 0.1} })");
  const Scene half_ball =
      seen_along_z("intersection{ sphere{}, plane{}:rotate_x(-90):translate(0, 0.3, 0) }:color{0.8, 0.6, 0}");
  return {{"torus", far_ring, 120, 80, 0, 0, 120, 80, 3},
          {"sheet", cloth_before_ball, 90, 80, 0, 0, 90, 80, 4},
          {"no_shadow", stick_in_ball, 120, 80, 0, 0, 120, 80, 3},
          {"contact", touching, 90, 60, 0, 0, 90, 60, 4},
          {"axial_cylinder", seen_along_z("cylinder{ -1, 1 }:color{0.1, 0.7, 0}"), 45, 45, 0, 0, 45, 45, 5},
          {"parallel_plane", half_ball, 45, 45, 0, 0, 45, 45, 5},
          {"small_scene", made_small(scene_of(text_of("sphere_plane"))), 640, 480, 150, 280, 160, 70, 2}};
}

}  // namespace
}  // namespace rayfarm

int main(int count, char** arguments) try {
  if (count != 2) {
    std::fputs("usage: differences FOLDER\n", stderr);
    return 2;
  }
  for (const rayfarm::Crop& crop : rayfarm::crops()) {
    const std::string file = std::string(arguments[1]) + "/" + crop.name + ".png";
    rayfarm::write_picture(file, drawn(crop));
    std::puts(file.c_str());
  }
} catch (const std::exception& error) {
  std::fprintf(stderr, "differences: %s\n", error.what());
  return 1;
}
