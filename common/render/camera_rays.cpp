#include "common/render/camera_rays.h"

#include "common/math/deterministic.h"

namespace rayfarm {
namespace {

/// Unit, whatever the length: its square may not be a number.
Vec3d direction_of(const glm::dvec3& v) {
  const double size = max_abs(Vec3d{v.x, v.y, v.z});
  return normalized(Vec3d{v.x / size, v.y / size, v.z / size});
}

}  // namespace

CameraRays::CameraRays(const Camera& camera, Size film) : width_(film.width), height_(film.height) {
  const auto& perspective = std::get<PerspectiveCamera>(camera);
  origin_ = {perspective.from.x, perspective.from.y, perspective.from.z};
  forward_ = direction_of(perspective.direction);
  // The view is left-handed: seen along +z with y up, +x is to the right.
  const Vec3d left = normalized(cross(forward_, direction_of(perspective.up)));
  const Vec3d top = normalized(cross(left, forward_));
  const double half_width = deterministic::tan_deg(perspective.angle_deg / 2);
  right_ = left * -half_width;
  up_ = top * (half_width * height_ / width_);
}

Ray CameraRays::ray(double x, double y) const {
  const double across = 2 * x / width_ - 1, down = 2 * y / height_ - 1;
  Ray r;
  r.origin = origin_;
  r.direction = normalized(forward_ + right_ * across - up_ * down);
  return r;
}

}  // namespace rayfarm
