// Rays, in world space and in a solid's local space. The parameter t is shared: a direction is transformed,
// never renormalised, so the t of all solids are directly comparable.
#pragma once
#include <cstdint>
#include <limits>

#include "common/math/number.h"
#include "common/math/vec.h"

namespace rayfarm {

constexpr std::uint32_t no_leaf = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

/// What fills a place of a scene with nested media: a material's number, or one of these.
constexpr std::uint32_t unknown_medium = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t empty_space = unknown_medium - 1;

/// Of the scene's material. To which a ray was sent that leaves a surface is known, not computed: by it errors show.
enum class Side : std::uint8_t { outside, inside, unknown };

/// Whether a ray sent to that side cannot pass a surface so.
inline bool contradicts(Side side, bool entering) {
  return side == (entering ? Side::inside : Side::outside);
}

/// Points origin + t * direction, t > 0.
///
/// A ray that starts on a surface names the leaf it leaves and the side: of that leaf the crossing at the
/// origin is known, not computed, so no distance has to be called too small (accuracy without an epsilon).
/// For all other leaves origin_error decides what lies at the origin. Source of the idea: self-intersection
/// by identity in Cycles (Blender D6250), the coincident flag of OpenMC.
struct Ray {
  Vec3d origin{}, direction{};
  double origin_error = 0;               // each coordinate is within this of the exact point
  std::uint32_t left_surface = no_leaf;  // Leaf::surface
  bool into_leaf = false;                // the ray goes to the inner side of it
  Side side = Side::unknown;
  std::uint32_t medium = unknown_medium;  // into which the ray was sent
  std::uint32_t left_part = no_part;      // of that leaf: the triangle or patch, where there are such
};

inline bool is_sent_inside(const Ray& ray) { return ray.side == Side::inside || ray.medium < empty_space; }

/// A ray with what every box and leaf asks of it, derived once.
struct RayQuery {
  explicit RayQuery(const Ray& r)
      : ray(r),
        inverse{1 / (r.direction.x + 0.0), 1 / (r.direction.y + 0.0), 1 / (r.direction.z + 0.0)},  // -0 as +0
        origin_size(max_abs(r.origin)),
        direction_size(max_abs(r.direction)),
        size(greatest(origin_size, r.origin_error * 0x1p46)) {}

  Ray ray;
  Vec3d inverse;                       // of the direction; infinite where it is 0
  double origin_size, direction_size;  // largest component
  double size;                         // of the origin; its error is at most 2^-46 of it
};

/// A ray in a leaf's local space, with bounds on each component's error, rounding and the transform's uncertainty
/// included. Errors of single axes are `share` of these.
template <class T>
struct LocalRay {
  Vec3<T> origin{}, direction{};
  T origin_error{};     // of the line wherever it is at the solid, but for the next:
  T direction_error{};  // adds up along the line from the origin
  T spread{};           // of the direction in all: a smaller component may as well be none
  Vec3<T> aside{};      // see Leaf::aside
  Vec3<T> share{T(1), T(1), T(1)};
};

}  // namespace rayfarm
