#include "tests/stability/quad_solids.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "common/math/overload.h"

namespace rayfarm::stability {
namespace {

const Quad endless = HUGE_VALQ;

struct Chord {
  Quad enter = -endless, leave = endless;

  void cut(Quad from, Quad to) { enter = std::max(enter, from), leave = std::min(leave, to); }
  void cut_all() { cut(endless, -endless); }
};

void cut_slab(Chord& chord, Quad o, Quad d, Quad low, Quad high) {
  if (d == 0) {
    if (!(o > low && o < high)) chord.cut_all();
    return;
  }
  const Quad a = (low - o) / d, b = (high - o) / d;
  chord.cut(std::min(a, b), std::max(a, b));
}

/// |p| < radius for the components that o and d have.
void cut_ball(Chord& chord, const QuadVec& o, const QuadVec& d, Quad radius = 1) {
  const Quad dd = dot(d, d);
  if (dd == 0) {
    if (!(dot(o, o) < radius * radius)) chord.cut_all();
    return;
  }
  const Quad t = -dot(o, d) / dd;
  const QuadVec p = o + d * t;
  const Quad rest = radius * radius - dot(p, p);
  if (rest <= 0) return chord.cut_all();
  const Quad half = sqrt(rest / dd);
  chord.cut(t - half, t + half);
}

void add(QuadSpans& spans, const Chord& chord) {
  if (!(chord.enter < chord.leave)) return;
  if (chord.enter == -endless)
    spans.starts_inside = true;
  else
    spans.at.push_back(chord.enter);
  if (chord.leave != endless) spans.at.push_back(chord.leave);
}

QuadSpans cone_spans(const Cone& cone, const QuadRay& r) {
  const auto metric = [](const QuadVec& a, const QuadVec& b) { return a.x * b.x + a.y * b.y - a.z * b.z; };
  const QuadVec &o = r.origin, &d = r.direction, m = cross(o, d);
  const Quad a = metric(d, d), b = metric(o, d), rest = m.x * m.x + m.y * m.y - m.z * m.z;
  QuadSpans spans;
  if (rest <= 0) return spans;
  const Quad root = sqrt(rest), q = b < 0 ? root - b : -root - b;
  std::array<Chord, 2> nappes;
  if (a == 0) {
    (b < 0 ? nappes[0].enter : nappes[0].leave) = metric(o, o) / q;
    nappes[1].cut_all();
  } else {
    const Quad first = std::min(metric(o, o) / q, q / a), last = std::max(metric(o, o) / q, q / a);
    if (a < 0)
      nappes = {Chord{-endless, first}, Chord{last, endless}};
    else
      nappes = {Chord{first, last}, Chord{endless, -endless}};
  }
  for (Chord& nappe : nappes) {
    cut_slab(nappe, o.z, d.z, cone.z_min, cone.z_max);
    add(spans, nappe);
  }
  return spans;
}

/// The hull of its three boxes, twelve tubes and eight balls.
Chord rounded_cube_chord(const RoundedCube& cube, const QuadRay& ray) {
  const Quad r = cube.r, far = 1 - r;
  Chord all{endless, -endless};
  const auto add_part = [&](const Chord& part) {
    if (!(part.enter < part.leave)) return;
    all.enter = std::min(all.enter, part.enter), all.leave = std::max(all.leave, part.leave);
  };
  for (int axis = 0; axis < 3; ++axis) {
    Chord box;
    for (int i = 0; i < 3; ++i)
      cut_slab(box, ray.origin[i], ray.direction[i], i == axis ? 0 : r, i == axis ? 1 : far);
    add_part(box);
  }
  for (int number = 0; number < 32; ++number) {
    const int axis = number / 8;  // of a tube; 3: a ball
    QuadVec o = ray.origin, d = ray.direction;
    Chord part;
    for (int i = 0; i < 3; ++i) {
      o[i] = o[i] - (number >> i & 1 ? far : r);
      if (i != axis) continue;
      cut_slab(part, ray.origin[i], ray.direction[i], r, far);
      o[i] = d[i] = 0;
    }
    cut_ball(part, o, d, r);
    add_part(part);
  }
  return all;
}

using Quartic = std::array<Quad, 5>;  // by rising power

Quad value(const Quartic& f, int degree, Quad x) {
  Quad v = 0;
  for (int i = degree; i >= 0; --i) v = v * x + f[static_cast<std::size_t>(i)];
  return v;
}

/// Where a polynomial changes its sign between low and high: once at most between those of its derivative.
std::vector<Quad> sign_changes(const Quartic& f, int degree, Quad low, Quad high) {
  if (degree == 0) return {};
  Quartic derivative{};
  for (std::size_t i = 1; i <= static_cast<std::size_t>(degree); ++i) derivative[i - 1] = f[i] * Quad(i);
  std::vector<Quad> ends = sign_changes(derivative, degree - 1, low, high), found;
  ends.insert(ends.begin(), low), ends.push_back(high);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    Quad a = ends[i], b = ends[i + 1], x = (a + b) / 2;
    const Quad enough = (high - low) * Quad(1e-28);  // a step of Newton's method leaves less
    const bool negative = value(f, degree, a) < 0;
    if (negative == (value(f, degree, b) < 0)) continue;
    for (int step = 0; step < 200 && b - a > enough; ++step) {
      const Quad fx = value(f, degree, x), slope = value(derivative, degree - 1, x);
      ((fx < 0) == negative ? a : b) = x;
      const Quad newton = slope != 0 ? x - fx / slope : a;
      const Quad next = newton > a && newton < b && step % 4 != 3 ? newton : (a + b) / 2;
      if (fabs(next - x) <= enough) break;
      x = next;
    }
    found.push_back(x);
  }
  return found;
}

QuadSpans torus_spans(const Torus& torus, const QuadRay& ray) {
  const Quad speed = length(ray.direction), R = torus.R, r = torus.r;
  const QuadVec u = ray.direction * (1 / speed);
  const Quad shift = -dot(ray.origin, u);
  const QuadVec p = ray.origin + u * shift;
  const Quad pp = dot(p, p), reach = (R + r) * (R + r) - pp;
  QuadSpans spans;
  if (reach <= 0) return spans;
  const Quad end = sqrt(reach) * (1 + Quad(1e-12)), k = pp + (R - r) * (R + r), four = 4 * R * R;
  const Quad a = u.x * u.x + u.y * u.y, b = p.x * u.x + p.y * u.y, c = p.x * p.x + p.y * p.y;
  for (const Quad s : sign_changes({k * k - four * c, -2 * four * b, 2 * k - four * a, 0, 1}, 4, -end, end))
    spans.at.push_back((shift + s) / speed);
  return spans;
}

}  // namespace

QuadSpans quad_spans(const Solid& solid, const QuadRay& r) {
  const QuadVec &o = r.origin, &d = r.direction;
  QuadSpans spans;
  Chord chord;
  std::visit(Overload{[&](const Sphere&) { cut_ball(chord, o, d); },
                      [&](const Cube&) {
                        for (int axis = 0; axis < 3; ++axis) cut_slab(chord, o[axis], d[axis], 0, 1);
                      },
                      [&](const Plane&) { cut_slab(chord, o.z, d.z, -endless, 0); },
                      [&](const Cylinder& c) {
                        cut_ball(chord, {o.x, o.y, 0}, {d.x, d.y, 0});
                        cut_slab(chord, o.z, d.z, c.z_min, c.z_max);
                      },
                      [&](const Cone& c) { spans = cone_spans(c, r), chord.cut_all(); },
                      [&](const RoundedCube& c) { chord = rounded_cube_chord(c, r); },
                      [&](const Torus& t) { spans = torus_spans(t, r), chord.cut_all(); },
                      [](const auto& faceted) {
                        throw std::invalid_argument(std::string(faceted.name) + " has cases of its own");
                      }},
             solid);
  add(spans, chord);
  return spans;
}

}  // namespace rayfarm::stability
