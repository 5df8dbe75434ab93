#include "tests/reference/original_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rayfarm::reference {
namespace {

// Roots in closed form. Source of the method: J. Schwarze, Cubic and Quartic Roots, Graphics Gems, 1990. ------------

constexpr double smallest = 1e-10;  // what is nearer to zero is zero

using Roots = std::vector<double>;

Roots quadratic_roots(double b, double c) {  // x^2 + b x + c
  const double discriminant = b * b / 4 - c;
  if (discriminant < 0) return {};
  const double root = std::sqrt(discriminant);
  return {-b / 2 - root, -b / 2 + root};
}

double cubic_root(double b, double c, double d) {  // one of x^3 + b x^2 + c x + d
  const double p = (c - b * b / 3) / 3, q = (2 * b * b * b / 27 - b * c / 3 + d) / 2;
  const double discriminant = q * q + p * p * p;
  if (discriminant >= 0)
    return std::cbrt(std::sqrt(discriminant) - q) - std::cbrt(std::sqrt(discriminant) + q) - b / 3;
  return 2 * std::sqrt(-p) * std::cos(std::acos(-q / std::sqrt(-p * p * p)) / 3) - b / 3;
}

Roots quartic_roots(double b, double c, double d, double e) {  // of x^4 + b x^3 + c x^2 + d x + e, ascending
  const double bb = b * b;
  const double p = c - 3 * bb / 8, q = bb * b / 8 - b * c / 2 + d;
  const double r = -3 * bb * bb / 256 + bb * c / 16 - b * d / 4 + e;
  const double z = cubic_root(-p / 2, -r, r * p / 2 - q * q / 8);
  double u = z * z - r, v = 2 * z - p;
  if (std::fabs(u) < smallest) u = 0;
  if (std::fabs(v) < smallest) v = 0;
  if (u < 0 || v < 0) return {};
  u = std::sqrt(u), v = q < 0 ? -std::sqrt(v) : std::sqrt(v);
  Roots roots = quadratic_roots(v, z - u);
  for (const double root : quadratic_roots(-v, z + u)) roots.push_back(root);
  for (double& root : roots) root -= b / 4;
  std::sort(roots.begin(), roots.end());
  return roots;
}

// Solids. -----------------------------------------------------------------------------------------------------------

constexpr double shift = 0.001;

Spans spans_by_formula(const Torus& torus, const Ray& local) {
  const glm::dvec3 o(local.origin), d(local.direction);
  const double R = torus.R, r = torus.r;
  const double dd = glm::dot(d, d), od = glm::dot(o, d), k = glm::dot(o, o) + R * R - r * r;
  const double four = 4 * R * R;
  const double a = dd * dd;
  const Roots roots = quartic_roots(
      4 * dd * od / a, (2 * dd * k + 4 * od * od - four * (d.x * d.x + d.y * d.y)) / a,
      (4 * k * od - 2 * four * (o.x * d.x + o.y * d.y)) / a, (k * k - four * (o.x * o.x + o.y * o.y)) / a);
  Spans spans;
  for (const double t : roots) {
    const Vec p = local.origin + Real(t) * local.direction;
    const Real level = glm::dot(p, p) + Real(R) * R - Real(r) * r, ring = level - 2 * Real(R) * R;
    spans.crossings.push_back(
        {.t = t - shift, .to_point = shift, .gradient = Vec(ring * p.x, ring * p.y, level * p.z)});
  }
  return spans;
}

Spans spans_by_rules(const Solid& solid, const Ray& local) {
  if (const auto* torus = std::get_if<Torus>(&solid)) return spans_by_formula(*torus, local);
  const Vec& d = local.direction;
  const bool is_missed = (std::holds_alternative<Cylinder>(solid) && d.x == 0 && d.y == 0) ||
                         (std::holds_alternative<Plane>(solid) && d.z == 0);
  return is_missed ? Spans{} : spans_of(solid, local);
}

/// A sheet as a wall without an end: behind its front is inside, up to the next crossing or for ever.
Spans spans_with_inside(const std::vector<Crossing>& crossings, const Ray& local) {
  if (crossings.empty()) return {};
  return {glm::dot(crossings.front().gradient, local.direction) > 0, crossings};
}

/// What one part has on the surface of the whole.
std::vector<Spans> whole_scene(const Scene& scene, const std::vector<Leaf>& leaves, const Ray& ray,
                               const Rules& rules) {
  return {spans_of(scene, leaves, ray, rules)};
}

bool is_far_enough(const Crossing& c, const Ray& ray) {
  return c.t > 0 && c.t * c.t * glm::dot(ray.direction, ray.direction) > 1e-8L;
}

}  // namespace

Rules original_rules() {
  return {.spans = spans_by_rules,
          .coincidence = 0,
          .is_ahead = is_far_enough,
          .of_sheet = spans_with_inside,
          .blockers = whole_scene};
}

}  // namespace rayfarm::reference
