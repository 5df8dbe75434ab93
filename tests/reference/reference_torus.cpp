#include "tests/reference/reference_torus.h"

#include <array>
#include <cmath>

namespace rayfarm::reference {
namespace {

using Quad = __float128;

// Coefficients by rising power.
struct Polynomial {
  std::array<Quad, 5> c{};
  int degree = 0;
};

Quad value_at(const Polynomial& f, Quad x) {
  Quad value = 0;
  for (int i = f.degree; i >= 0; --i) value = value * x + f.c[i];
  return value;
}

Polynomial derivative_of(const Polynomial& f) {
  Polynomial df{{}, f.degree - 1};
  for (int i = 1; i <= f.degree; ++i) df.c[i - 1] = f.c[i] * Quad(i);
  return df;
}

bool is_negative_at(const Polynomial& f, Quad x) { return value_at(f, x) < 0; }

// The place of the one change of sign in [low, high], to 1e-31 of its width: Newton's steps, halving where
// they are too long or leave the bracket.
Quad sign_change_in(const Polynomial& f, const Polynomial& df, Quad low, Quad high) {
  const bool negative_low = is_negative_at(f, low);
  const Quad enough = (high - low) * Quad(1e-31);
  Quad x = low + (high - low) / 2;
  while (high - low > enough) {
    const Quad value = value_at(f, x), slope = value_at(df, x);
    ((value < 0) == negative_low ? low : high) = x;
    const Quad newton = slope == 0 ? low : x - value / slope, step = newton > x ? newton - x : x - newton;
    if (slope != 0 && step <= enough) break;
    const bool trusted = low < newton && newton < high && step < (high - low) / 2;
    x = trusted ? newton : low + (high - low) / 2;
  }
  return x;
}

// All places in [low, high] where f changes its sign, ascending: between neighbouring sign changes of its
// derivative f is monotone.
std::vector<Quad> sign_changes(const Polynomial& f, Quad low, Quad high) {
  if (f.degree == 0) return {};
  const Polynomial df = derivative_of(f);
  std::vector<Quad> ends = sign_changes(df, low, high), changes;
  ends.insert(ends.begin(), low);
  ends.push_back(high);
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    if (is_negative_at(f, ends[i]) != is_negative_at(f, ends[i + 1]))
      changes.push_back(sign_change_in(f, df, ends[i], ends[i + 1]));
  return changes;
}

Quad square_root(Quad x) {
  Quad root = std::sqrt(static_cast<Real>(x));
  for (int i = 0; i < 2 && root > 0; ++i) root = (root + x / root) / 2;
  return root;
}

struct QuadVec {
  Quad x, y, z;
};

QuadVec along(const QuadVec& o, const QuadVec& d, Quad t) {
  return {o.x + t * d.x, o.y + t * d.y, o.z + t * d.z};
}
Quad dot(const QuadVec& a, const QuadVec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

}  // namespace

Spans spans_of_torus(const Torus& torus, const Ray& local) {
  // The line as p + tau u: p its point nearest to the centre, u of unit length, t = shift + tau / speed.
  const QuadVec o{local.origin.x, local.origin.y, local.origin.z};
  const QuadVec d{local.direction.x, local.direction.y, local.direction.z};
  const Quad speed = square_root(dot(d, d)), shift = -dot(o, d) / dot(d, d);
  const QuadVec p = along(o, d, shift), u{d.x / speed, d.y / speed, d.z / speed};

  // Outside the ball about the torus there is nothing to find.
  const Quad R = torus.R, r = torus.r, pp = dot(p, p);
  const Quad reach = (R + r) * (R + r) - pp;
  if (reach <= 0) return {};
  const Quad end = square_root(reach) * (1 + Quad(1e-15));

  const Quad A = pp + R * R - r * r, four = 4 * R * R;
  const Quad a = u.x * u.x + u.y * u.y, b = p.x * u.x + p.y * u.y, c = p.x * p.x + p.y * p.y;
  const Polynomial f{{A * A - four * c, -2 * four * b, 2 * A - four * a, 0, 1}, 4};

  Spans spans;
  for (const Quad tau : sign_changes(f, -end, end)) {
    const QuadVec q = along(p, u, tau);
    const Quad k = dot(q, q) + R * R - r * r, ring = k - 2 * R * R;
    spans.crossings.push_back({.t = static_cast<Real>(shift + tau / speed),
                               .gradient = Vec(static_cast<Real>(ring * q.x), static_cast<Real>(ring * q.y),
                                               static_cast<Real>(k * q.z))});
  }
  return spans;
}

}  // namespace rayfarm::reference
