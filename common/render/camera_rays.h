// Primary rays: a camera made ready for a film of a certain shape.
#pragma once
#include "common/geometry/ray.h"
#include "common/render/tile.h"
#include "common/scene/scene.h"

namespace rayfarm {

/// x runs from 0 to width (rightwards), y from 0 to height (downwards); a pixel's centre is at +0.5.
class CameraRays {
 public:
  CameraRays(const Camera& camera, Size film);
  Ray ray(double x, double y) const;  // unit direction

 private:
  Vec3d origin_, forward_, right_, up_;  // right_ and up_ as long as half the film plane at distance 1
  double width_, height_;
};

}  // namespace rayfarm
