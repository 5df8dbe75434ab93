#include "common/render/camera_rays.h"

#include "common/math/deterministic.h"

namespace rayfarm {
namespace {

Vec3d vec(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

}  // namespace

CameraRays::CameraRays(const Camera& camera, Size film) : width_(film.width), height_(film.height) {
  const auto& perspective = std::get<PerspectiveCamera>(camera);
  origin_ = vec(perspective.from);
  forward_ = normalized(vec(perspective.direction));
  // The view is left-handed: seen along +z with y up, +x is to the right.
  const Vec3d left = normalized(cross(forward_, vec(perspective.up)));
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
