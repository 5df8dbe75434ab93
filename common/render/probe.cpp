#include "common/render/probe.h"

#include "common/render/trace.h"

namespace rayfarm {

Probe probe(const World& world, const RenderSettings& settings, double x, double y,
            std::array<double, 2> light_uv) {
  const auto dvec = [](const Vec3d& v) { return glm::dvec3{v.x, v.y, v.z}; };
  Tracer<CountingObserver> tracer(world, settings);
  Probe result;
  if (const std::optional<Hit> hit = tracer.first_hit(x, y))
    result.first_hit = {hit->t, dvec(hit->point), dvec(hit->normal),
                        hit->leaf};  // primary directions are unit
  const auto light_point = [&](std::uint32_t) { return Sample2D{light_uv[0], light_uv[1]}; };
  result.color = dvec(tracer.radiance(x, y, light_point));
  return result;
}

}  // namespace rayfarm
