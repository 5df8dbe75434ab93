// S5: rays along a cylinder's axis, S6: through a cone's apex or along a generator, S7: along the face of a half-space.
#include "tests/stability/cases.h"
#include "tests/stability/naive_quadrics.h"
#include "tests/stability/quad_solids.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

/// What is known of a solid along a ray: the side at its origin, the crossings ahead of it.
struct Ahead {
  bool inside = false;
  std::vector<double> at;

  void pass(double t) {
    if (t > 0)
      at.push_back(t);
    else
      inside = !inside;
  }
};

Ahead truth_of(const Solid& solid, const Ray& ray) {
  const QuadSpans spans = quad_spans(solid, quad(ray));
  Ahead ahead{spans.starts_inside, {}};
  for (const Quad t : spans.at) ahead.pass(static_cast<double>(t));
  return ahead;
}

auto ours(const Solid& solid) {
  return [leaf = make_leaf(solid, bounded(Affine{}))](const Ray& ray) {
    const Crossings c = crossings(leaf, RayQuery(ray));
    Ahead ahead{c.starts_inside, {}};
    for (int i = 0; i < c.count; ++i) ahead.at.push_back(c.at[static_cast<std::size_t>(i)].t);
    return ahead;
  };
}

/// Wrong side at the origin or a wrong number of crossings ahead. Spans narrower than 64 eps of the distance count
/// for nothing, on either side.
bool differ(const Ahead& found, const Ahead& truth, double size) {
  const double least = 64 * std::numeric_limits<double>::epsilon() * size;
  const auto counted = [&](const Ahead& a) {
    std::vector<double> kept;
    for (const double t : a.at)
      if (!kept.empty() && t - kept.back() < least)
        kept.pop_back();
      else
        kept.push_back(t);
    return kept;
  };
  const std::vector<double> f = counted(found), t = counted(truth);
  if (!t.empty() && t.front() < least) return false;  // the origin lies in the surface
  return found.inside != truth.inside || f.size() != t.size();
}

template <class MakeRay, class Method>
RunBatch wrong(const Solid& solid, MakeRay make_ray, Method method) {
  return ray_by_ray<RandomRays>([=](double driver, RandomRays& random) {
    const Ray ray = make_ray(driver, random);
    return differ(method(ray), truth_of(solid, ray), 1 + max_abs(ray.origin));
  });
}

/// The original's way with a solid of revolution: the roots of its quadric, cut by its caps; without roots, nothing.
template <class Roots>
Ahead revolved(const Roots& roots, double low, double high, const Ray& ray) {
  Ahead ahead;
  if (!roots.real) return ahead;
  const double a = (low - ray.origin.z) / ray.direction.z, b = (high - ray.origin.z) / ray.direction.z;
  const double enter = std::max(roots.first, std::min(a, b)), leave = std::min(roots.last, std::max(a, b));
  if (enter < leave) ahead.pass(enter), ahead.pass(leave);
  return ahead;
}

// S5. -------------------------------------------------------------------------------------------------------

const Cylinder drum{-1, 1};

/// Within an angle of the axis; half of them exactly along it.
Ray ray_along_axis(double angle, RandomRays& random) {
  Ray ray;
  ray.origin = {random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-3, 3)};
  const double turn = random.uniform(-4, 4), off = random.uniform(0, 1) < 0.5 ? 0 : angle;
  ray.direction = {off * std::cos(turn), off * std::sin(turn), random.uniform(0, 1) < 0.5 ? 1.0 : -1.0};
  return ray;
}

Ahead plain_cylinder(const Ray& ray) {
  return revolved(plain_roots(unit_tube<double>, ray.origin, ray.direction), drum.z_min, drum.z_max, ray);
}

// S6. -------------------------------------------------------------------------------------------------------

const Cone hourglass{-1, 1};

/// Past the apex at that distance, a third of the rays through it; a half of all along a generator but for an angle
/// as small.
Ray ray_past_apex(double distance, RandomRays& random) {
  const Vec3d past = random.direction() * (random.uniform(0, 1) < 0.3 ? 0 : distance);
  Ray ray;
  ray.direction = random.direction();
  if (random.uniform(0, 1) < 0.5) {
    const double turn = random.uniform(-4, 4);
    ray.direction = normalized(Vec3d{std::cos(turn), std::sin(turn), 1} + random.direction() * distance);
  }
  ray.origin = past - ray.direction * random.uniform(2, 10);
  return ray;
}

/// Both nappes, by the roots of the double cone.
Ahead q_form_cone(const Ray& ray) {
  const Roots<double> roots = q_form_roots(unit_cone<double>, ray.origin, ray.direction);
  const Vec3d& d = ray.direction;
  if (!roots.real || d.x * d.x + d.y * d.y > d.z * d.z)
    return revolved(roots, hourglass.z_min, hourglass.z_max, ray);
  Ahead ahead;
  const double a = (hourglass.z_min - ray.origin.z) / d.z, b = (hourglass.z_max - ray.origin.z) / d.z;
  const double low = std::min(a, b), high = std::max(a, b);
  if (low < roots.first) ahead.pass(low), ahead.pass(std::min(roots.first, high));
  if (roots.last < high) ahead.pass(std::max(roots.last, low)), ahead.pass(high);
  return ahead;
}

/// An odd number of crossings from outside.
template <class Method>
RunBatch odd(Method method) {
  return ray_by_ray<RandomRays>([method](double driver, RandomRays& random) {
    const Ahead found = method(ray_past_apex(driver, random));
    return found.inside != (found.at.size() % 2 == 1);
  });
}

// S7. -------------------------------------------------------------------------------------------------------

/// Above, below or on the face, sinking, rising or level.
Ray ray_along_face(double slope, RandomRays& random) {
  const double heights[] = {1, -1, 0, std::pow(10.0, random.uniform(-15, 3))};
  const double slopes[] = {slope, -slope, 0};
  Ray ray;
  ray.origin = {random.uniform(-3, 3), random.uniform(-3, 3),
                heights[static_cast<int>(random.uniform(0, 4))]};
  const double turn = random.uniform(-4, 4);
  ray.direction = {std::cos(turn), std::sin(turn), slopes[static_cast<int>(random.uniform(0, 3))]};
  if (ray.origin.z == 0 && ray.direction.z == 0) ray.origin.z = 1;  // in the face there is no right answer
  return ray;
}

/// A level ray has no crossing, and without one it is outside; the first crossing tells the side before it.
Ahead plain_half_space(const Ray& ray) {
  if (ray.direction.z == 0) return {};
  Ahead ahead{ray.direction.z > 0, {}};
  ahead.pass(-ray.origin.z / ray.direction.z);
  return ahead;
}

}  // namespace

std::vector<Case> quadric_cases() {
  return {{"S5 cylinder",
           "rays along a cylinder's axis",
           "angle to the axis",
           {5e-324, 1e-300, 1e-170, 1e-100, 1e-30, 1e-16, 1e-8, 1e-3, 1},
           {{"plain roots", "double", wrong(drum, ray_along_axis, plain_cylinder), {}},
            {"ours", "double", wrong(drum, ray_along_axis, ours(drum)), 0.0}}},
          {"S6 cone",
           "past the apex, along generators",
           "distance from apex or generator",
           {1e-16, 1e-14, 1e-12, 1e-9, 1e-6, 1e-3, 1},
           {{"q form", "double", wrong(hourglass, ray_past_apex, q_form_cone), {}},
            {"q form, odd", "double", odd(q_form_cone), {}},
            {"ours", "double", wrong(hourglass, ray_past_apex, ours(hourglass)), 0.0},
            {"ours, odd", "double", odd(ours(hourglass)), 0.0}}},
          {"S7 half-space",
           "along the face of a half-space",
           "slope",
           {1e-300, 1e-200, 1e-100, 1e-30, 1e-16, 1e-8, 1e-3, 1},
           {{"plain", "double", wrong(Plane{}, ray_along_face, plain_half_space), {}},
            {"ours", "double", wrong(Plane{}, ray_along_face, ours(Plane{})), 0.0}}}};
}

}  // namespace rayfarm::stability
