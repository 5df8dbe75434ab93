// Random rays and points for geometry tests; a seed always gives the same ones.
#pragma once
#include <random>

#include "common/geometry/ray.h"

namespace rayfarm {

class RandomRays {
 public:
  explicit RandomRays(std::uint64_t seed) : random_(seed) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3d in_box(double half) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
  Vec3d direction() {
    for (;;) {
      const Vec3d d = in_box(1);
      if (dot(d, d) > 0.01 && dot(d, d) < 1) return normalized(d);
    }
  }
  /// From a sphere of that radius towards a point of the box.
  Ray towards_box(double radius, double half) {
    const Vec3d origin = direction() * radius;
    Ray r;
    r.origin = origin, r.direction = normalized(in_box(half) - origin);
    return r;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace rayfarm
