// One chosen ray of the renderer: what it hits first and the light along it.
#pragma once
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "common/render/settings.h"
#include "common/render/world.h"

namespace rayfarm {

struct ProbeHit {
  double distance = 0;  // Euclidean
  glm::dvec3 point{0.0};
  glm::dvec3 normal{0.0};  // unit, out of the material
  std::uint32_t leaf = 0;  // number in preorder among the leaves
};

struct Probe {
  std::optional<ProbeHit> first_hit;
  glm::dvec3 color{0.0};
};

/// The ray through film point (x, y), 0..width and 0..height; light_uv is the point on every area light.
Probe probe(const World& world, const RenderSettings& settings, double x, double y,
            std::array<double, 2> light_uv);

}  // namespace rayfarm
