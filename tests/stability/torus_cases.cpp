// S8: tori hit broadly and grazed, near and far, thick and thin; S9: their special lines, and rays that start on them.
#include "tests/stability/cases.h"
#include "tests/stability/ferrari.h"
#include "tests/stability/quad_solids.h"
#include "tests/stability/scenes.h"
#include "tests/stability/sturm.h"

namespace rayfarm::stability {
namespace {

double one_of(std::initializer_list<double> values, RandomRays& random) {
  return values.begin()[static_cast<std::size_t>(random.uniform(0, static_cast<double>(values.size())))];
}

struct Shot {
  Torus torus;
  Ray ray;
};

/// Towards the tube of a torus, a half within 10^-9 to 10^-3 r of touching it.
Shot broad_or_grazing(double distance, RandomRays& random) {
  Shot shot{{one_of({1.01, 2, 10, 100, 1000}, random), 1}, {}};
  const double turn = random.uniform(-4, 4), around = random.uniform(-4, 4);
  const Vec3d out{std::cos(turn), std::sin(turn), 0};
  const Vec3d spoke = out * std::cos(around) + Vec3d{0, 0, std::sin(around)};
  Vec3d away = random.direction();
  double from_centre = random.uniform(0, 0.99);
  if (random.uniform(0, 1) < 0.5) {
    away = normalized(cross(spoke, away));
    from_centre = 1 + std::copysign(std::pow(10.0, random.uniform(-9, -3)), random.uniform(-1, 1));
  }
  const Vec3d target = out * shot.torus.R + spoke * from_centre;
  const double far = distance * (shot.torus.R + 1);
  shot.ray.origin = target + away * far, shot.ray.direction = normalized(target - shot.ray.origin);
  return shot;
}

/// In the plane of the top circle but for 10^-k, along the axis, through the centre, along a Villarceau circle's plane,
/// of ring and spindle tori.
Shot special(double k, RandomRays& random) {
  Shot shot{{one_of({0.5, 0.9, 1.1, 2, 20}, random), 1}, {}};
  const double R = shot.torus.R, size = R + 1, turn = random.uniform(-4, 4), off = std::pow(10.0, -k);
  const Vec3d in_plane{std::cos(turn), std::sin(turn), 0};
  Ray& ray = shot.ray;
  switch (static_cast<int>(random.uniform(0, 4))) {
    case 0:
      ray.direction = in_plane;
      ray.origin =
          Vec3d{random.uniform(-size, size), random.uniform(-size, size), 1 - off} - in_plane * (3 * size);
      break;
    case 1:
      ray.direction = {off * random.uniform(-1, 1), off * random.uniform(-1, 1), 1};
      ray.origin = Vec3d{off * random.uniform(-1, 1), 0, 0} - ray.direction * (3 * size);
      break;
    case 2:
      ray.direction = random.direction();
      ray.origin = random.direction() * off - ray.direction * (3 * size);
      break;
    default: {  // the plane through the centre that touches the tube on both sides
      const double sine = std::min(1 / R, 1.0), cosine = std::sqrt(1 - sine * sine);
      const double along = random.uniform(-4, 4);
      ray.direction = {std::cos(along), std::sin(along) * cosine, std::sin(along) * sine};
      const Vec3d across{-std::sin(along), std::cos(along) * cosine, std::cos(along) * sine};
      ray.origin =
          across * random.uniform(-size, size) - ray.direction * (3 * size) + random.direction() * off;
    }
  }
  return shot;
}

/// The line's spans ahead that are longer than 10^-6 r and cannot come or go when the ray moves by 4 ulp.
std::vector<Quad> sure_crossings(const Shot& shot) {
  const QuadSpans spans = quad_spans(shot.torus, quad(shot.ray));
  const Quad size = length(quad(shot.ray.origin)) + shot.torus.R + 1;
  const Quad deep = 8 * Quad(std::numeric_limits<double>::epsilon()) * size;  // a chord c is c^2 / 8r deep
  const Quad least = std::max(Quad(1e-6), sqrt(16 * deep));
  std::vector<Quad> kept;
  for (const Quad t : spans.at)
    if (!kept.empty() && t - kept.back() < least)
      kept.pop_back();
    else
      kept.push_back(t);
  return kept;
}

std::vector<double> found_by_ours(const Shot& shot) {
  const Leaf leaf = make_leaf(shot.torus, bounded(Affine{}));
  const Crossings c = crossings(leaf, RayQuery(shot.ray));
  std::vector<double> at;
  for (int i = 0; i < c.count; ++i) at.push_back(c.at[static_cast<std::size_t>(i)].t);
  return at;
}

/// An odd number from outside, a sure crossing that is not found to 64 eps of the torus' size (and of t), or one found
/// where none is.
bool is_wrong(const Shot& shot, const std::vector<double>& found) {
  if (found.size() % 2 == 1) return true;
  const double size = shot.torus.R + shot.torus.r, eps = std::numeric_limits<double>::epsilon();
  for (const Quad t : sure_crossings(shot)) {
    const bool seen = std::any_of(found.begin(), found.end(), [&](double x) {
      return fabs(Quad(x) - t) < Quad(1e-4) * shot.torus.r + Quad(1e-3) * fabs(t) * eps / Quad(1e-13);
    });
    if (!seen) return true;
  }
  for (const double t : found) {
    const Vec3d p =
        surface_of(shot.torus, LocalRay<double>{shot.ray.origin, shot.ray.direction}, t, true).point;
    const QuadVec q = quad(p);
    const Quad rho = sqrt(q.x * q.x + q.y * q.y) - shot.torus.R;
    const Quad off = fabs(sqrt(rho * rho + q.z * q.z) - shot.torus.r);
    const Quad lemon =
        sqrt((rho + 2 * Quad(shot.torus.R)) * (rho + 2 * Quad(shot.torus.R)) + q.z * q.z) - shot.torus.r;
    if (std::min(off, fabs(lemon)) > 64 * eps * size) return true;
  }
  return false;
}

template <class MakeShot, class Method>
RunBatch wrong(MakeShot make, Method method) {
  return ray_by_ray<RandomRays>([=](double driver, RandomRays& random) {
    const Shot shot = make(driver, random);
    return is_wrong(shot, method(shot));
  });
}

/// A ray that starts on the torus finds what a line through the same point has ahead.
RunBatch lost_from_surface() {
  return ray_by_ray<RandomRays>([](double, RandomRays& random) {
    const Torus torus{one_of({0.5, 0.9, 1.1, 2, 20}, random), 1};
    Shot shot = broad_or_grazing(3, random);
    shot.torus = torus;
    const double turn = random.uniform(-4, 4), around = random.uniform(-4, 4);
    const Vec3d out{std::cos(turn), std::sin(turn), 0};
    const Vec3d spoke = out * std::cos(around) + Vec3d{0, 0, std::sin(around)};
    if (torus.R + std::cos(around) < 0) return false;  // on the lemon, which is no surface
    const Vec3d d = random.direction();
    const LocalRay<double> ray{out * torus.R + spoke, d, 4 * unit_roundoff * (torus.R + 1), 0};
    const bool inward = dot(d, spoke) < 0;
    const Crossings found = crossings_from_surface(torus, ray, inward);
    if (found.starts_inside != (found.count % 2 == 1)) return true;
    const QuadSpans truth = quad_spans(torus, {quad(ray.origin), quad(ray.direction)});
    std::ptrdiff_t ahead = std::count_if(truth.at.begin(), truth.at.end(), [](Quad t) { return t > 1e-6; });
    // Nearer than that, the crossing at the origin is one of them or not.
    const bool near = std::any_of(truth.at.begin(), truth.at.end(),
                                  [](Quad t) { return fabs(t) > 1e-13 && fabs(t) < 1e-5; });
    return !near && std::fabs(dot(d, spoke)) > 1e-6 && ahead != found.count;
  });
}

}  // namespace

std::vector<Case> torus_cases() {
  const std::vector<double> distances{3, 10, 1e2, 1e3, 1e4, 1e5, 1e6}, digits{2, 4, 6, 8, 10, 12, 14};
  const CellSize size{10'000, 100'000'000, 500}, special_size{4'000, 100'000'000, 500};
  return {{"S8 torus",
           "tori, broad and grazing",
           "distance / size",
           distances,
           {{"Ferrari", "double", wrong(broad_or_grazing, found_by_ferrari<Shot>), {}},
            {"Ferrari, shifted", "double", wrong(broad_or_grazing, found_by_shifted_ferrari<Shot>), {}},
            {"Sturm, shifted", "double", wrong(broad_or_grazing, found_by_sturm<Shot>), {}},
            {"ours", "double", wrong(broad_or_grazing, found_by_ours), 0.0}},
           size},
          {"S9 torus",
           "special lines of tori",
           "-log10 of the offset",
           digits,
           {{"Ferrari", "double", wrong(special, found_by_ferrari<Shot>), {}},
            {"Ferrari, shifted", "double", wrong(special, found_by_shifted_ferrari<Shot>), {}},
            {"Sturm, shifted", "double", wrong(special, found_by_sturm<Shot>), {}},
            {"ours", "double", wrong(special, found_by_ours), 1e-6}},
           special_size},
          {"S9 torus, from its surface",
           "rays that start on tori",
           "one",
           {1},
           {{"ours", "double", lost_from_surface(), 0.0}},
           special_size}};
}

}  // namespace rayfarm::stability
