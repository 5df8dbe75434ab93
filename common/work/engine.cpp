#include "common/work/engine.h"

#include <array>
#include <cstring>

#include "common/net/codec.h"
#include "common/render/render.h"

namespace rayfarm {
namespace {

Asset asset_of(const AssetContent& content) { return decode_asset(asset_data(content)); }

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  return mesh;
}

BezierGrid hill() {
  BezierGrid grid{1, 1, {}};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) {
      const bool is_inner = row % 3 != 0 && column % 3 != 0;
      grid.points.push_back({column / 3.0, is_inner ? 0.9 : 0.0, 1 - row / 3.0});
    }
  return grid;
}

Image four_pixels() {
  return {2, 2, std::vector<std::uint8_t>{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 0}};
}

Node node(NodeContent content, const Affine& parent_from_node = {},
          std::optional<std::uint32_t> material = {}) {
  Node made;
  made.content = std::move(content);
  made.parent_from_node = parent_from_node;
  made.material = material;
  return made;
}

/// Turned by angles without a pattern, so that nothing is special.
Affine placed(double x, double y, double z, double size) {
  return translation({x, y, z}) * rotation_deg(0, 31) * rotation_deg(1, 47) * scaling(glm::dvec3(size));
}

/// One of each kind, near the origin.
Scene test_scene() {
  Scene scene;
  scene.assets = {asset_of(tetrahedron()), asset_of(hill()), asset_of(four_pixels())};
  Material glass, mirror;
  glass.transmission = 0.8, mirror.specular = 0.9, mirror.diffuse = 0.1;
  scene.materials = {Material{}, glass, mirror};
  scene.nodes = {
      node(Operation{CsgOp::unite, 11}, {}, 0),
      node(Solid{Sphere{}}, placed(-1.5, 1, 0, 0.6), 1),
      node(Operation{CsgOp::subtract, 2}),
      node(Solid{Cube{}}, placed(-0.5, 0.6, 0, 0.8)),
      node(Solid{Cylinder{-2, 2}}, placed(-0.3, 0.9, 0.2, 0.3)),
      node(Operation{CsgOp::exclusive_or, 2}),
      node(Solid{Torus{1, 0.4}}, placed(1, 1, 0, 0.5), 2),
      node(Solid{Cone{-1, 1}}, placed(1, 1, 0, 0.7)),
      node(Operation{CsgOp::intersect, 2}),
      node(Solid{Torus{0.5, 0.9}}, placed(0, -1, -1, 0.5), 1),
      node(Solid{Sphere{}}, placed(0.2, -1, -1, 0.7)),
      node(Solid{Mesh{0, true}}, placed(-1.5, -1, 0, 1)),
      node(Solid{Bezier{1}}, placed(0.8, -1, 0, 1), 2),
      node(Solid{Plane{}}, translation({0, 0, 2})),
      node(Solid{Plane{}}, translation({0, -2, 0}) * rotation_deg(0, -90)),
      node(Solid{RoundedCube{0.2}}, placed(-0.5, -1.5, 0.5, 0.6)),
      node(Glow{Sphere{}, {0.5, 0.2, 0.1}, 3}, placed(1, 1, -1, 0.5)),
      node(Glow{Cylinder{}, {0.1, 0.2, 0.5}, 8}, placed(-1, 0, -1, 0.2)),
  };
  scene.nodes[13].textures = {Checker{2.5, 1.5, {0.2, 0.3, 0.9}}, Stripes{1.2, 0.7, {0.9, 0.1, 0.2}}};
  scene.nodes[14].textures = {ImageTexture{2, 0.7, 1.3, true}};
  scene.lights = {AmbientLight{glm::dvec3(0.7)}, PointLight{{-3, 4, -4}, glm::dvec3(0.8)},
                  RectangleLight{{2, 3, -3}, {1, 0, 0.2}, {0.1, 1, 0}, glm::dvec3(2), {0.5, 0.3, 0.1}}};
  return scene;
}

template <class Value>
void append(Bytes& bytes, const Value& value) {
  const std::size_t at = bytes.size();
  bytes.resize(at + sizeof value);
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

void append_render(Bytes& bytes, const Scene& scene, SamplerKind sampler) {
  const RenderSettings settings{.width = 48, .height = 48, .spp = 4, .sampler = sampler, .seed = 7};
  const World world(scene);
  const auto images = render_tile(world, settings, 0, all_passes, [] { return false; });
  for (const PassImage& image : *images) {
    for (const float value : image.rgb) append(bytes, value);
    append(bytes, image.counters);
  }
}

std::string measured() {
  const glm::dvec3 from(0.3, 0.2, -6), direction(0, 0, 1), up(0, 1, 0);
  const std::array<Camera, 5> cameras{
      PerspectiveCamera{from, direction, up, 45}, FisheyeCamera{from, direction, up, 60},
      ParabolicCamera{from, direction, up, 0.4, 0.5}, OrthographicCamera{from, direction, up, 5},
      PerspectiveCamera{from, direction, up, 20}};
  Scene scene = test_scene();
  Bytes bytes;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    scene.camera = cameras[i];
    if (i + 1 == cameras.size())
      scene.nested_media = true, scene.nodes[12].content = Solid{Cube{}};  // no sheets in it
    append_render(bytes, scene, static_cast<SamplerKind>(i));
  }
  return sha256_hex(bytes);
}

}  // namespace

const std::string& engine_fingerprint() {
  static const std::string fingerprint = measured();
  return fingerprint;
}

}  // namespace rayfarm
