#include "common/math/affine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "common/math/deterministic.h"

namespace rayfarm {

Affine translation(const glm::dvec3& by) { return {glm::dmat3(1.0), by}; }

Affine scaling(const glm::dvec3& by) {
  glm::dmat3 linear(0.0);
  for (int i = 0; i < 3; ++i) linear[i][i] = by[i];
  return {linear, glm::dvec3(0.0)};
}

Affine rotation_deg(int axis, double degrees) {
  const double c = deterministic::cos_deg(degrees), s = deterministic::sin_deg(degrees) + 0.0;
  const int y = (axis + 1) % 3, z = (axis + 2) % 3;
  glm::dmat3 linear(1.0);
  linear[y][y] = c, linear[z][y] = 0.0 - s;  // 0 - s, not -s: no negative zeros
  linear[y][z] = s, linear[z][z] = c;
  return {linear, glm::dvec3(0.0)};
}

Affine rotation_deg(const glm::dvec3& axis, double degrees) {
  // Scaled by the largest component first, so that no length over- or underflows.
  const double largest = std::max({std::fabs(axis.x), std::fabs(axis.y), std::fabs(axis.z)});
  const glm::dvec3 a = axis / largest;
  const glm::dvec3 k = a / std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
  const double c = deterministic::cos_deg(degrees), s = deterministic::sin_deg(degrees), t = 1.0 - c;

  glm::dmat3 linear;
  linear[0] = {t * k.x * k.x + c, t * k.x * k.y + s * k.z, t * k.x * k.z - s * k.y};
  linear[1] = {t * k.x * k.y - s * k.z, t * k.y * k.y + c, t * k.y * k.z + s * k.x};
  linear[2] = {t * k.x * k.z + s * k.y, t * k.y * k.z - s * k.x, t * k.z * k.z + c};
  return {linear, glm::dvec3(0.0)};
}

bool is_invertible(const Affine& m) {
  const glm::dmat3& a = m.linear;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!std::isfinite(a[i][j]) || !std::isfinite(m.offset[i])) return false;

  const std::array<double, 6> products{a[0][0] * a[1][1] * a[2][2],  a[1][0] * a[2][1] * a[0][2],
                                       a[2][0] * a[0][1] * a[1][2],  -a[2][0] * a[1][1] * a[0][2],
                                       -a[1][0] * a[0][1] * a[2][2], -a[0][0] * a[2][1] * a[1][2]};
  double determinant = 0, magnitude = 0;
  for (const double p : products) determinant += p, magnitude += std::fabs(p);

  // Each product carries two roundings, the sum five more: below this nothing of the determinant is left.
  const double lost = 8 * std::numeric_limits<double>::epsilon() * magnitude;
  return std::fabs(determinant) > lost && std::isnormal(determinant) && std::isnormal(1.0 / determinant);
}

}  // namespace rayfarm
