#include "tests/reference/reference_solids.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "tests/reference/reference_torus.h"

namespace rayfarm::reference {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity(), pi = std::numbers::pi_v<Real>;

// A convex solid's part of the line, cut down by one boundary after the other.
struct Chord {
  Real enter = -infinity, leave = infinity;
  Vec enter_gradient{0}, leave_gradient{0};

  void clip(Real t0, const Vec& g0, Real t1, const Vec& g1) {
    if (t0 > enter) enter = t0, enter_gradient = g0;
    if (t1 < leave) leave = t1, leave_gradient = g1;
  }
  void clip_all() { enter = infinity, leave = -infinity; }
};

// Keeps what has dot(gradient, p) < limit.
void clip_half_space(Chord& chord, const Ray& ray, const Vec& gradient, Real limit) {
  if (std::isinf(limit)) return;
  const Real excess = glm::dot(gradient, ray.origin) - limit, slope = glm::dot(gradient, ray.direction);
  if (slope > 0) chord.clip(-infinity, gradient, -excess / slope, gradient);
  if (slope < 0) chord.clip(-excess / slope, gradient, infinity, gradient);
  if (slope == 0 && excess >= 0) chord.clip_all();
}

// Keeps what is nearer than 1 to the origin, the components that `axes` makes zero not counted.
void clip_unit_ball(Chord& chord, const Ray& ray, const Vec& axes) {
  const Vec o = ray.origin * axes, d = ray.direction * axes;
  const Real dd = glm::dot(d, d);
  if (dd == 0) {
    if (glm::dot(o, o) >= 1) chord.clip_all();
    return;
  }
  const Real t_closest = -glm::dot(o, d) / dd;
  const Vec closest = o + t_closest * d;
  const Real rest = 1 - glm::dot(closest, closest);
  if (rest <= 0) return chord.clip_all();
  const Real half = std::sqrt(rest / dd);
  chord.clip(t_closest - half, closest - half * d, t_closest + half, closest + half * d);
}

Chord chord_of(const Sphere&, const Ray& ray) {
  Chord chord;
  clip_unit_ball(chord, ray, Vec(1, 1, 1));
  return chord;
}

Chord chord_of(const Cube&, const Ray& ray) {
  Chord chord;
  for (int axis = 0; axis < 3; ++axis) {
    Vec out(0);
    out[axis] = 1;
    clip_half_space(chord, ray, -out, 0);
    clip_half_space(chord, ray, out, 1);
  }
  return chord;
}

Chord chord_of(const Plane&, const Ray& ray) {
  Chord chord;
  clip_half_space(chord, ray, Vec(0, 0, 1), 0);
  return chord;
}

Chord chord_of(const Cylinder& cylinder, const Ray& ray) {
  Chord chord;
  clip_unit_ball(chord, ray, Vec(1, 1, 0));
  clip_half_space(chord, ray, Vec(0, 0, -1), -Real(cylinder.z_min));
  clip_half_space(chord, ray, Vec(0, 0, 1), cylinder.z_max);
  return chord;
}

// From the first to the last of its 27 parts: along each axis a part lies before, beside or behind the core [r,1-r]^3.
Chord chord_of(const RoundedCube& cube, const Ray& ray) {
  const Real r = cube.r;
  Chord whole{infinity, -infinity};
  for (int part = 0; part < 27; ++part) {
    const int places[] = {part % 3, part / 3 % 3, part / 9};
    Chord chord;
    Vec centre(r), beyond(1);
    for (int axis = 0; axis < 3; ++axis) {
      if (places[axis] == 2) centre[axis] = 1 - r;
      if (places[axis] != 1) continue;
      Vec along(0);
      along[axis] = 1, beyond[axis] = 0;
      clip_half_space(chord, ray, -along, -r);
      clip_half_space(chord, ray, along, 1 - r);
    }
    if (beyond != Vec(0)) clip_unit_ball(chord, {(ray.origin - centre) / r, ray.direction / r}, beyond);
    if (!(chord.enter < chord.leave)) continue;
    if (chord.enter < whole.enter) whole.enter = chord.enter, whole.enter_gradient = chord.enter_gradient;
    if (chord.leave > whole.leave) whole.leave = chord.leave, whole.leave_gradient = chord.leave_gradient;
  }
  return whole;
}

Spans spans_of_chord(const Chord& chord) {
  Spans spans;
  if (!(chord.enter < chord.leave)) return spans;
  spans.starts_inside = chord.enter == -infinity;
  if (!spans.starts_inside) spans.crossings.push_back({.t = chord.enter, .gradient = chord.enter_gradient});
  if (chord.leave != infinity)
    spans.crossings.push_back({.t = chord.leave, .gradient = chord.leave_gradient});
  return spans;
}

Spans spans_of_solid(const Mesh&, const Ray&) {
  throw std::invalid_argument("of a mesh: spans_of_surface()");
}
Spans spans_of_solid(const Bezier&, const Ray&) {
  throw std::invalid_argument("of patches: spans_of_surface()");
}
Spans spans_of_solid(const Torus& torus, const Ray& ray) { return spans_of_torus(torus, ray); }

// x^2 + y^2 - z^2 < 0 between the roots, or before the first and after the last.
Spans spans_of_solid(const Cone& cone, const Ray& ray) {
  const Vec metric(1, 1, -1);
  const Vec o = ray.origin, d = ray.direction;
  const Real a = glm::dot(d * metric, d), b = glm::dot(o * metric, d), c = glm::dot(o * metric, o);
  const Vec m = glm::cross(o, d);
  const Real rest = glm::dot(m * metric, m);  // b^2 - a c
  if (rest <= 0 || a == 0) return {};
  const Real root = std::sqrt(rest), q = -(b + std::copysign(root, b));
  const Real first = std::min(c / q, q / a), last = std::max(c / q, q / a);
  const auto gradient = [&](Real t) { return metric * (o + t * d); };

  std::vector<Chord> nappes(1);
  nappes[0].clip(first, gradient(first), last, gradient(last));
  if (a < 0) {
    nappes.assign(2, {});
    nappes[0].clip(-infinity, Vec(0), first, gradient(first));
    nappes[1].clip(last, gradient(last), infinity, Vec(0));
  }
  Spans spans;
  for (Chord& nappe : nappes) {
    clip_half_space(nappe, ray, Vec(0, 0, -1), -Real(cone.z_min));
    clip_half_space(nappe, ray, Vec(0, 0, 1), cone.z_max);
    const Spans part = spans_of_chord(nappe);
    spans.starts_inside = spans.starts_inside || part.starts_inside;
    spans.crossings.insert(spans.crossings.end(), part.crossings.begin(), part.crossings.end());
  }
  return spans;
}

template <class Convex>
Spans spans_of_solid(const Convex& solid, const Ray& ray) {
  return spans_of_chord(chord_of(solid, ray));
}

// Texture coordinates. ----------------------------------------------------------------------------------------------

Real turn(Real y, Real x) { return std::atan2(y, x) / (2 * pi) + 0.5L; }

Uv uv_of_solid(const Sphere&, const Vec& p, const Vec&) {
  const Real s = std::hypot(p.x, p.y);
  return {s == 0 ? 0 : turn(p.y, p.x), std::atan2(s, p.z) / pi};
}
Uv uv_of_solid(const Cube&, const Vec& p, const Vec& gradient) {
  if (gradient.x != 0) return {p.y, p.z};
  return gradient.y != 0 ? Uv(p.x, p.z) : Uv(p.x, p.y);
}
Uv uv_of_solid(const RoundedCube&, const Vec& p, const Vec& gradient) {
  const Vec size = glm::abs(gradient);
  if (size.x >= std::max(size.y, size.z)) return {p.y, p.z};
  return size.y >= size.z ? Uv(p.x, p.z) : Uv(p.x, p.y);
}
Uv uv_of_solid(const Plane&, const Vec& p, const Vec&) { return {p.x, p.y}; }
Uv uv_of_solid(const Cylinder&, const Vec& p, const Vec& gradient) {
  return {gradient.z != 0 ? 0 : turn(p.y, p.x), p.z};
}
Uv uv_of_solid(const Cone&, const Vec& p, const Vec& gradient) {
  return {gradient.x == 0 && gradient.y == 0 ? 0 : turn(p.y, p.x), p.z};
}
Uv uv_of_solid(const Torus& torus, const Vec& p, const Vec&) {
  const Real R = torus.R, rho = std::hypot(p.x, p.y), to_near = rho - R, to_far = -(rho + R);
  const auto off_tube = [&](Real s) { return std::abs(s * s + p.z * p.z - Real(torus.r) * torus.r); };
  const Real s = off_tube(to_near) <= off_tube(to_far) ? to_near : to_far;
  return {turn(p.y, p.x), turn(s, p.z)};
}
template <class Faceted>
Uv uv_of_solid(const Faceted&, const Vec&, const Vec&) {  // its crossings have them
  throw std::invalid_argument("a surface's crossings have texture coordinates");
}

}  // namespace

Spans spans_of(const Solid& solid, const Ray& local) {
  return std::visit([&](const auto& s) { return spans_of_solid(s, local); }, solid);
}

Uv uv_of(const Solid& solid, const Vec& local, const Vec& gradient) {
  return std::visit([&](const auto& s) { return uv_of_solid(s, local, gradient); }, solid);
}

}  // namespace rayfarm::reference
