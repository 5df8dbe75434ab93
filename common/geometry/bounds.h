// Axis-aligned boxes, possibly unbounded, and the slab test against a ray.
#pragma once
#include <emmintrin.h>

#include "common/geometry/ray.h"
#include "common/math/number.h"
#include "common/math/vec.h"

namespace rayfarm {

/// Closed. Empty when low > high in some axis.
struct Box {
  Vec3d low{infinity, infinity, infinity};
  Vec3d high{-infinity, -infinity, -infinity};

  bool is_empty() const { return !(low.x <= high.x && low.y <= high.y && low.z <= high.z); }
  bool is_bounded() const { return max_abs(low) < infinity && max_abs(high) < infinity; }
};

/// A box that no ray meets.
inline Box nowhere() { return {{infinity, infinity, infinity}, {infinity, infinity, infinity}}; }
inline Box everywhere() { return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}; }

inline Box hull(const Box& a, const Box& b) {
  return {{least(a.low.x, b.low.x), least(a.low.y, b.low.y), least(a.low.z, b.low.z)},
          {greatest(a.high.x, b.high.x), greatest(a.high.y, b.high.y), greatest(a.high.z, b.high.z)}};
}

inline Box overlap(const Box& a, const Box& b) {
  return {{greatest(a.low.x, b.low.x), greatest(a.low.y, b.low.y), greatest(a.low.z, b.low.z)},
          {least(a.high.x, b.high.x), least(a.high.y, b.high.y), least(a.high.z, b.high.z)}};
}

/// Half the surface: the chance of a ray to meet the box is in proportion to it.
inline double half_area(const Box& b) {
  if (b.is_empty()) return 0;
  const Vec3d e = b.high - b.low;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

/// Where the ray is in the box (not empty, or nowhere()), 0 <= entry; it misses when entry > exit.
/// Conservative: rounding never loses a box. Source: T. Ize, Robust BVH Ray Traversal, JCGT 2(2), 2013.
struct BoxSpan {
  double entry, exit;
};

/// Two axes at once and without a jump: which way it goes nobody can predict.
inline BoxSpan span_in(const Box& box, const RayQuery& q, double t_max) {
  const auto xy = [](const Vec3d& v) { return _mm_loadu_pd(&v.x); };
  const auto z = [](const Vec3d& v) { return _mm_load_sd(&v.z); };
  // 0 * infinity is NaN, and of NaN and another number these take the second; in this order of arguments a ray in the
  // box's face counts as inside.
  const auto nearer = [](__m128d a, __m128d b) { return _mm_min_pd(b, a); };
  const auto farther = [](__m128d a, __m128d b) { return _mm_max_pd(a, b); };
  const __m128d low = _mm_mul_pd(_mm_sub_pd(xy(box.low), xy(q.ray.origin)), xy(q.inverse));
  const __m128d high = _mm_mul_pd(_mm_sub_pd(xy(box.high), xy(q.ray.origin)), xy(q.inverse));
  const __m128d low_z = _mm_mul_sd(_mm_sub_sd(z(box.low), z(q.ray.origin)), z(q.inverse));
  const __m128d high_z = _mm_mul_sd(_mm_sub_sd(z(box.high), z(q.ray.origin)), z(q.inverse));
  const __m128d wider = _mm_set1_pd(1 + 8 * unit_roundoff);
  const __m128d near = nearer(low, high), far = _mm_mul_pd(farther(low, high), wider);
  const __m128d near_z = nearer(low_z, high_z), far_z = _mm_mul_sd(farther(low_z, high_z), wider);
  // Finite, so that what is infinitely far (nowhere) is missed.
  const __m128d last = _mm_set_sd(least(t_max, std::numeric_limits<double>::max()));
  const __m128d entry =
      _mm_max_sd(near_z, _mm_max_sd(_mm_unpackhi_pd(near, near), _mm_max_sd(near, _mm_setzero_pd())));
  const __m128d exit = _mm_min_sd(far_z, _mm_min_sd(_mm_unpackhi_pd(far, far), _mm_min_sd(far, last)));
  return {_mm_cvtsd_f64(entry), _mm_cvtsd_f64(exit)};
}

/// A line as wide as 2 * margin: boxes that it only nearly passes are found, too.
struct WideLine {
  Vec3d origin, inverse;  // inverse: of the direction; infinite where it is 0
  double margin;
};

inline BoxSpan span_in(const Box& box, const WideLine& line, double t_max) {
  double entry = 0, exit = least(t_max, std::numeric_limits<double>::max());
  for (int axis = 0; axis < 3; ++axis) {
    const double o = line.origin[axis], inverse = line.inverse[axis];
    const double a = (box.low[axis] - line.margin - o) * inverse,
                 b = (box.high[axis] + line.margin - o) * inverse;
    entry = greatest(entry, least(a, b));
    exit = least(exit, greatest(b, a) * (1 + 8 * unit_roundoff));
  }
  return {entry, exit};
}

}  // namespace rayfarm
