#include "common/render/camera_rays.h"

#include <algorithm>

#include "common/math/deterministic.h"
#include "common/math/overload.h"

namespace rayfarm {
namespace {

/// Unit, whatever the length: its square may not be a number.
Vec3d direction_of(const glm::dvec3& v) {
  const double size = max_abs(Vec3d{v.x, v.y, v.z});
  return normalized(Vec3d{v.x / size, v.y / size, v.z / size});
}

/// The view is left-handed: seen along +z with y up, +x is to the right.
CameraAxes axes_of(const Camera& camera) {
  return std::visit(
      [](const auto& c) {
        const Vec3d forward = direction_of(c.direction);
        const Vec3d left = normalized(cross(forward, direction_of(c.up)));
        return CameraAxes{-left, normalized(cross(left, forward)), forward};
      },
      camera);
}

CameraRays::Lens lens_of(const Camera& camera, const CameraAxes& axes, Size film) {
  const auto rectangle = [&](auto lens, double half_width) {
    return CameraRays::Lens(
        decltype(lens){axes.right * half_width, axes.up * (half_width * film.height / film.width)});
  };
  return std::visit(
      Overload{
          [&](const PerspectiveCamera& c) {
            return rectangle(CameraRays::Perspective{}, deterministic::tan_deg(c.angle_deg / 2));
          },
          [&](const OrthographicCamera& c) { return rectangle(CameraRays::Orthographic{}, c.width / 2); },
          [&](const FisheyeCamera& c) { return CameraRays::Lens(CameraRays::Fisheye{c.angle_deg / 2}); },
          [&](const ParabolicCamera& c) {
            return CameraRays::Lens(CameraRays::Parabolic{c.radius, c.size});
          },
      },
      camera);
}

/// From the film's middle, right and up; 1 at the edges of the disc that it holds.
struct DiscPoint {
  double right, up;
  double square() const { return right * right + up * up; }
};

Ray ray_along(const Vec3d& origin, const Vec3d& direction) {
  Ray r;
  r.origin = origin, r.direction = normalized(direction);
  return r;
}

Ray ray_at(const CameraRays::Fisheye& lens, const Vec3d& from, const CameraAxes& axes, const DiscPoint& p) {
  const double r = std::sqrt(p.square());
  if (r == 0) return ray_along(from, axes.forward);
  const double angle_deg = r * lens.half_angle_deg;
  const Vec3d aside = axes.right * (p.right / r) + axes.up * (p.up / r);
  return ray_along(
      from, axes.forward * deterministic::cos_deg(angle_deg) + aside * deterministic::sin_deg(angle_deg));
}

Ray ray_at(const CameraRays::Parabolic& lens, const Vec3d& from, const CameraAxes& axes, const DiscPoint& p) {
  const double u = p.right * lens.radius, v = p.up * lens.radius, depth = (1 - u * u - v * v) / 2;
  const Vec3d mirror = axes.right * u + axes.up * v + axes.forward * depth;
  return ray_along(from + mirror * lens.size, mirror);
}

}  // namespace

CameraRays::CameraRays(const Camera& camera, Size film)
    : from_(std::visit([](const auto& c) { return vec(c.from); }, camera)),
      axes_(axes_of(camera)),
      lens_(lens_of(camera, axes_, film)),
      width_(film.width),
      height_(film.height),
      side_(std::min(width_, height_)) {}

std::optional<Ray> CameraRays::ray(double x, double y) const {
  const auto through_rectangle = [&](const Vec3d& middle, const auto& lens) {
    return middle + lens.half_width * (2 * x / width_ - 1) - lens.half_height * (2 * y / height_ - 1);
  };
  const auto through_disc = [&](const auto& lens) -> std::optional<Ray> {
    const DiscPoint p{(2 * x - width_) / side_, (height_ - 2 * y) / side_};
    if (p.square() > 1) return std::nullopt;
    return ray_at(lens, from_, axes_, p);
  };
  return std::visit(Overload{[&](const Perspective& lens) {
                               return std::optional(ray_along(from_, through_rectangle(axes_.forward, lens)));
                             },
                             [&](const Orthographic& lens) {
                               return std::optional(ray_along(through_rectangle(from_, lens), axes_.forward));
                             },
                             through_disc},
                    lens_);
}

}  // namespace rayfarm
