#include "common/render/shade.h"

#include <cmath>

#include "common/math/deterministic.h"
#include "common/math/number.h"

namespace rayfarm {

PhongWeights phong_weights(const Material& m, double index, double a, bool viewer_outside) {
  const double schlick = m.schlick * deterministic::integer_power(1 - least(std::fabs(a), 1), 5);
  PhongWeights k{m.diffuse * (1 - schlick), m.specular + schlick * (m.diffuse + m.transmission),
                 m.transmission * (1 - schlick)};
  if (!viewer_outside && a <= 0) {
    const double cos_total = index > 1 ? std::sqrt(index * index - 1) / index : 0;
    if (-a <= cos_total) {
      k.specular += k.transmission;
      if (k.specular + k.diffuse > 1) k.specular = 1 - k.diffuse;
    }
  }
  return k;
}

std::optional<Vec3d> refracted(const Vec3d& d, const Vec3d& n, double index) {
  double cosine = dot(n, d);
  const bool from_inside = cosine < 0;
  const Vec3d facing = from_inside ? -n : n;
  cosine = std::fabs(cosine);
  const double ratio = from_inside ? index : 1 / index;
  const double square = 1 - ratio * ratio * (1 - cosine * cosine);
  if (square <= 0) return std::nullopt;
  return facing * (ratio * cosine - std::sqrt(square)) - d * ratio;
}

Vec3d phong(const Material& m, double index, const Vec3d& color, const Vec3d& n, const Vec3d& to_viewer,
            double cos_view, const Vec3d& to_light) {
  const double a = dot(n, to_light);
  const bool viewer_outside = cos_view > 0;
  const PhongWeights k = phong_weights(m, index, a, viewer_outside);
  // Seen from inside, the light comes through: its highlight lies where refraction sends it.
  const std::optional<Vec3d> highlight =
      viewer_outside ? std::optional(mirrored(to_light, n)) : refracted(to_light, n, index);
  const double share = viewer_outside ? 1 : k.transmission;
  Vec3d sum = color * (share * k.diffuse * a);
  const double along = highlight ? dot(*highlight, to_viewer) : 0;
  if (along > 0) {
    const double white = share * k.specular * deterministic::integer_power(along, m.exponent);
    sum += {white, white, white};
  }
  return sum;
}

Vec3d phong_ambient(const Material& m, const Vec3d& color, bool viewer_outside) {
  return color * (viewer_outside ? m.ambient : m.ambient * m.transmission);
}

}  // namespace rayfarm
