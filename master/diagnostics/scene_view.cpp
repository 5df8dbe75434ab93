#include "master/diagnostics/scene_view.h"

#include <nlohmann/json.hpp>

#include "common/math/overload.h"
#include "common/render/world_parts.h"
#include "master/diagnostics/leaf_names.h"

namespace rayfarm {
namespace {

using nlohmann::json;

template <class Vector>
json json_of(const Vector& v) {
  return {v.x, v.y, v.z};
}

/// What a camera has beside its place and directions.
json json_of_lens(const Camera& camera) {
  return std::visit(Overload{[](const PerspectiveCamera& c) {
                               return json{{"kind", "perspective"}, {"angle_deg", c.angle_deg}};
                             },
                             [](const FisheyeCamera& c) {
                               return json{{"kind", "fisheye"}, {"angle_deg", c.angle_deg}};
                             },
                             [](const ParabolicCamera& c) {
                               return json{{"kind", "parabolic"}, {"radius", c.radius}, {"size", c.size}};
                             },
                             [](const OrthographicCamera& c) {
                               return json{{"kind", "orthographic"}, {"width", c.width}};
                             }},
                    camera);
}

json json_of_camera(const Camera& camera) {
  json all = json_of_lens(camera);
  std::visit(
      [&](const auto& c) {
        all["from"] = json_of(c.from), all["direction"] = json_of(c.direction), all["up"] = json_of(c.up);
      },
      camera);
  return all;
}

json json_of_light(const Light& light) {
  return std::visit(
      Overload{[](const AmbientLight& l) {
                 return json{{"kind", "ambient"}, {"intensity", json_of(l.intensity)}};
               },
               [](const PointLight& l) {
                 return json{{"kind", "point"}, {"at", json_of(l.at)}, {"intensity", json_of(l.intensity)}};
               },
               [](const RectangleLight& l) {
                 return json{{"kind", "rectangle"},       {"at", json_of(l.at)},
                             {"width", json_of(l.width)}, {"height", json_of(l.height)},
                             {"dim", json_of(l.dim)},     {"intensity", json_of(l.intensity)}};
               }},
      light);
}

/// Limits that are infinite are null.
json json_of_parameters(const Solid& solid) {
  json parameters = json::object();
  std::visit(
      [&](const auto& s) {
        for (const auto& [name, value] : s.numbers())
          parameters[name] = std::isfinite(value) ? json(value) : json();
      },
      solid);
  return parameters;
}

json json_of_matrix(const Affine& m) {
  json rows = json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rows.push_back(m.linear[column][row]);
    rows.push_back(m.offset[row]);
  }
  return rows;
}

json json_of_box(const Box& box) {
  if (!box.is_bounded() || box.is_empty()) return nullptr;
  return {{"min", json_of(box.low)}, {"max", json_of(box.high)}};
}

/// By leaf, for the first ones: within what they are combined with.
std::vector<Box> visible_boxes(const World::Parts& world, std::size_t leaves) {
  std::vector<Box> boxes(leaves);
  for (const CsgItem& item : world.items)
    if (item.leaf < leaves) boxes[item.leaf] = item.box;
  return boxes;
}

}  // namespace

json scene_view(const ReadyScene& ready) {
  const World::Parts& world = ready.world().parts();
  const std::size_t shown = std::min(world.leaves.size(), most_solids_shown);
  const std::vector<Box> boxes = visible_boxes(world, shown);
  const std::vector<bool> subtracted = subtracted_leaves(world.scene);
  json lights = json::array(), solids = json::array();
  for (const Light& light : world.scene.lights) lights.push_back(json_of_light(light));
  for (std::size_t leaf = 0; leaf < shown; ++leaf)
    solids.push_back({{"leaf", leaf},
                      {"name", ready.leaf_names()[leaf]},
                      {"subtracted", subtracted[leaf]},
                      {"kind", kind_of(world.leaves[leaf].solid)},
                      {"color", json_of(world.surfaces[leaf].color)},
                      {"box", json_of_box(boxes[leaf])},
                      {"matrix", json_of_matrix(world.placements[leaf].map)},
                      {"parameters", json_of_parameters(world.leaves[leaf].solid)}});
  return {{"background", json_of(world.scene.background)},
          {"camera", json_of_camera(world.scene.camera)},
          {"lights", std::move(lights)},
          {"solids", std::move(solids)},
          {"truncated", shown < world.leaves.size()}};
}

}  // namespace rayfarm
