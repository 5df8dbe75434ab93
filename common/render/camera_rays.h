// Primary rays: a camera made ready for a film of a certain shape.
#pragma once
#include <optional>

#include "common/geometry/ray.h"
#include "common/render/tile.h"
#include "common/scene/scene.h"

namespace rayfarm {

/// Unit, at right angles.
struct CameraAxes {
  Vec3d right{}, up{}, forward{};
};

/// x runs from 0 to width (rightwards), y from 0 to height (downwards); a pixel's centre is at +0.5.
class CameraRays {
 public:
  CameraRays(const Camera& camera, Size film);

  /// Unit direction. None outside the disc of a camera whose picture is one: there the film is black.
  std::optional<Ray> ray(double x, double y) const;

  const Vec3d& from() const { return from_; }
  const CameraAxes& axes() const { return axes_; }

  /// What of the film is seen: a rectangle, half_width and half_height the vectors to its sides (at distance 1,
  /// or from a film that stands in the scene) ...
  struct Perspective {
    Vec3d half_width, half_height;
  };
  struct Orthographic {
    Vec3d half_width, half_height;
  };
  /// ... or a disc.
  struct Fisheye {
    double half_angle_deg;
  };
  struct Parabolic {
    double radius, size;
  };
  using Lens = std::variant<Perspective, Orthographic, Fisheye, Parabolic>;

 private:
  Vec3d from_;
  CameraAxes axes_;
  Lens lens_;
  double width_, height_, side_;  // side_: the shorter one
};

}  // namespace rayfarm
