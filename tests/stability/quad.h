// Ground truth: 113-bit numbers (GCC's __float128) on the very inputs of a method, so that only the method's own
// error is counted.
#pragma once
#include <quadmath.h>

#include "common/geometry/ray.h"
#include "common/math/affine.h"
#include "common/math/vec.h"

namespace rayfarm::stability {

using Quad = __float128;
using QuadVec = Vec3<Quad>;

inline Quad sqrt(Quad x) { return sqrtq(x); }
inline Quad fabs(Quad x) { return fabsq(x); }
inline QuadVec quad(const Vec3d& v) { return {v.x, v.y, v.z}; }
inline Quad length(const QuadVec& v) { return sqrtq(dot(v, v)); }
inline QuadVec unit(const QuadVec& v) { return v * (Quad(1) / length(v)); }

/// A map in 113 bits, p' = row * p + offset, exact in its numbers; chains of maps are multiplied here.
struct QuadAffine {
  QuadVec row[3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  QuadVec offset{0, 0, 0};
};

inline QuadAffine quad(const Affine& m) {
  QuadAffine q;
  for (int i = 0; i < 3; ++i) {
    q.row[i] = {m.linear[0][i], m.linear[1][i], m.linear[2][i]};
    q.offset[i] = m.offset[i];
  }
  return q;
}
inline QuadVec direction(const QuadAffine& m, const QuadVec& d) {
  return {dot(m.row[0], d), dot(m.row[1], d), dot(m.row[2], d)};
}
inline QuadVec point(const QuadAffine& m, const QuadVec& p) { return direction(m, p) + m.offset; }

/// First b, then a.
inline QuadAffine operator*(const QuadAffine& a, const QuadAffine& b) {
  QuadAffine product;
  for (int i = 0; i < 3; ++i)
    product.row[i] = b.row[0] * a.row[i].x + b.row[1] * a.row[i].y + b.row[2] * a.row[i].z;
  product.offset = point(a, b.offset);
  return product;
}

inline QuadAffine inverse(const QuadAffine& m) {
  const QuadVec x = cross(m.row[1], m.row[2]), y = cross(m.row[2], m.row[0]), z = cross(m.row[0], m.row[1]);
  const Quad over = Quad(1) / dot(m.row[0], x);
  QuadAffine out;
  out.row[0] = QuadVec{x.x, y.x, z.x} * over;
  out.row[1] = QuadVec{x.y, y.y, z.y} * over;
  out.row[2] = QuadVec{x.z, y.z, z.z} * over;
  out.offset = -direction(out, m.offset);
  return out;
}

struct QuadRay {
  QuadVec origin, direction;
};
inline QuadRay quad(const Ray& r) { return {quad(r.origin), quad(r.direction)}; }
inline QuadRay moved(const QuadAffine& by, const QuadRay& r) {
  return {point(by, r.origin), direction(by, r.direction)};
}

}  // namespace rayfarm::stability
