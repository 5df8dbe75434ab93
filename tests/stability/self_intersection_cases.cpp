// S19: rays that leave the surface which they start on. Of a ball nothing is met outward, the far side inward.
// Methods that push the ray's start away are set beside ours, which knows the crossing at the start.
#include <bit>

#include "common/render/hit.h"
#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

struct Ball {
  Vec3d center;
  double radius;
};

/// From 3 to 30 radii away, at the ball; and a direction at that sine above the surface it hits.
Ray ray_at(const Ball& ball, RandomRays& random) {
  return ray_towards(ball.center + random.in_box(0.5) * ball.radius, ball.radius * random.uniform(3, 30),
                     random);
}

Vec3d leaving(const Vec3d& normal, double sine, RandomRays& random) {
  const Vec3d along = normalized(cross(normal, random.direction()));
  return along * std::sqrt(1 - sine * sine) + normal * sine;
}

/// What drives a cell: the ball's size, how far off it is, how flat rays leave it.
struct Setup {
  Ball ball;
  double sine;
};
using SetUp = Setup (*)(double driver, RandomRays& random);

Setup by_scale(double scale, RandomRays& random) {
  return {{random.in_box(100) * scale, scale}, random.uniform(1e-3, 1)};
}
Setup by_offset(double offset, RandomRays& random) {
  return {{random.direction() * offset, 1}, random.uniform(1e-3, 1)};
}
Setup by_angle(double sine, RandomRays& random) { return {{random.in_box(10), 1}, sine}; }

RunBatch ours(SetUp set_up) {
  return [set_up](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [ball, sine] = set_up(batch.driver, random);
    const Vec3d c = ball.center;
    const World world(
        scene_of({solid_node(Sphere{}, translation({c.x, c.y, c.z}) * scaling(glm::dvec3(ball.radius)))}));
    WorldWorkspace workspace;
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const RayQuery query(ray_at(ball, random));
      const auto first = first_boundary(world.parts(), query, workspace);
      if (!first) {
        ++tally.failures;
        continue;
      }
      const Hit hit = hit_at(world.parts(), query, *first);
      const Vec3d out = leaving(hit.normal, sine, random);
      const Ray outward = ray_from(hit, out, true), inward = ray_from(hit, -out, false);
      const auto acne = first_boundary(world.parts(), RayQuery(outward), workspace);
      const auto far = first_boundary(world.parts(), RayQuery(inward), workspace);
      // The chord of the ball is 2 r sin; its end is known to within the rounding of the coordinates.
      const double chord = 2 * ball.radius * sine,
                   slack = 64 * unit_roundoff * (max_abs(c) + ball.radius) / sine;
      tally.failures += acne || !far || far->entering || std::fabs(far->t - chord) > slack;
    }
    return tally;
  };
}

// How others push the start away. ------------------------------------------------------------------------------

/// Along the ray: what is nearer than this is not met.
struct AtLeast {
  double absolute = 0, relative_to_radius = 0;
};

template <class T>
Vec3<T> number(const Vec3d& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

/// Along the normal by an error bound of the point. Source: M. Pharr, W. Jakob, G. Humphreys, Physically Based
/// Rendering, section 6.8.6.
template <class T>
struct ByErrorBox {
  Vec3<T> operator()(const Vec3<T>& p, const Vec3<T>& n) const {
    constexpr T gamma5 = 5 * std::numeric_limits<T>::epsilon() / 2;
    const T d = gamma5 * (std::fabs(n.x * p.x) + std::fabs(n.y * p.y) + std::fabs(n.z * p.z));
    Vec3<T> moved = p + n * d;
    for (int i = 0; i < 3; ++i)
      moved[i] = std::nextafter(
          moved[i], n[i] > 0 ? std::numeric_limits<T>::infinity() : -std::numeric_limits<T>::infinity());
    return moved;
  }
};

/// By a number of floats along the normal. Source: C. Waechter and N. Binder, A Fast and Robust Method for
/// Avoiding Self-Intersection, Ray Tracing Gems, chapter 6, 2019.
struct ByFloats {
  Vec3<float> operator()(const Vec3<float>& p, const Vec3<float>& n) const {
    Vec3<float> moved = p;
    for (int i = 0; i < 3; ++i) {
      const int step = static_cast<int>(256 * n[i]);
      const float by_bits = std::bit_cast<float>(std::bit_cast<int>(p[i]) + (p[i] < 0 ? -step : step));
      moved[i] = std::fabs(p[i]) < 1.0f / 32 ? p[i] + n[i] / 65536 : by_bits;
    }
    return moved;
  }
};

template <class T>
struct Unmoved {
  Vec3<T> operator()(const Vec3<T>& p, const Vec3<T>&) const { return p; }
};

/// The smaller and the larger root, if any. Source of the discriminant: Haines, Guenther, Akenine-Moeller, Ray
/// Tracing Gems, chapter 7, so that the start is what is compared.
template <class T>
std::optional<std::array<T, 2>> roots(const Vec3<T>& o, const Vec3<T>& d, const Vec3<T>& c, T r) {
  const Vec3<T> oc = o - c;
  const T b = -dot(oc, d);
  const Vec3<T> l = oc + d * b;
  const T disc = r * r - dot(l, l);
  if (!(disc >= 0)) return std::nullopt;
  const T q = b + std::copysign(std::sqrt(disc), b), other = (dot(oc, oc) - r * r) / q;
  return std::array<T, 2>{std::min(q, other), std::max(q, other)};
}

template <class T, class Push>
RunBatch pushed(SetUp set_up, AtLeast at_least, Push push) {
  return [set_up, at_least, push](const Batch& batch) {
    RandomRays random(batch.seed);
    const auto [ball, sine] = set_up(batch.driver, random);
    const Vec3<T> c = number<T>(ball.center);
    const T r = T(ball.radius), least_t = T(at_least.absolute + at_least.relative_to_radius * ball.radius);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Ray ray = ray_at(ball, random);
      const Vec3<T> o = number<T>(ray.origin), d = normalized(number<T>(ray.direction));
      const auto first = roots(o, d, c, r);
      if (!first) continue;
      const Vec3<T> p = c + normalized(o + d * (*first)[0] - c) * r, n = normalized(p - c);
      const Vec3<T> out = normalized(number<T>(leaving(Vec3d{n.x, n.y, n.z}, sine, random)));
      const auto acne = roots(push(p, n), out, c, r);
      const auto far = roots(push(p, -n), -out, c, r);
      const bool finds_far = far && (*far)[1] > least_t;
      tally.failures += (acne && (*acne)[1] > least_t) || !finds_far;
    }
    return tally;
  };
}

Case self_case(const std::string& name, const std::string& title, const std::string& driver,
               std::vector<double> sweep, SetUp set_up) {
  return {"S19 " + name,
          title,
          driver,
          std::move(sweep),
          {{"absolute 1e-4", "double", pushed<double>(set_up, {1e-4, 0}, Unmoved<double>{}), {}},
           {"relative 1e-4 R", "double", pushed<double>(set_up, {0, 1e-4}, Unmoved<double>{}), {}},
           {"error box", "double", pushed<double>(set_up, {}, ByErrorBox<double>{}), {}},
           {"Waechter-Binder", "float", pushed<float>(set_up, {}, ByFloats{}), {}},
           {"ours, by identity", "double", ours(set_up), 0.0}},
          {100'000, 100'000'000, 500}};
}

// Gaps. --------------------------------------------------------------------------------------------------------

/// From the top of a box up to another one above it: the gap must be seen. The driver is its width, in units of
/// the rounding of the coordinates.
Tally across_gap(const Batch& batch) {
  RandomRays random(batch.seed);
  const double height = std::exp2(std::floor(random.uniform(-20, 20)));  // of the gap's place
  const double gap = batch.driver * 2 * unit_roundoff * height;
  const World world(
      scene_of({operation_node(CsgOp::unite, 2),
                solid_node(Cube{}, translation({0, 0, 0}) * scaling(glm::dvec3(height))),
                solid_node(Cube{}, translation({0, 0, height + gap}) * scaling(glm::dvec3(height)))}));
  WorldWorkspace workspace;
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    Ray ray;
    ray.origin = {height * random.uniform(0.3, 0.7), height * random.uniform(0.3, 0.7), height * 0.5};
    ray.direction = normalized(Vec3d{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 1});
    const RayQuery query(ray);
    const auto top = first_boundary(world.parts(), query, workspace);
    if (!top || top->entering) {
      ++tally.failures;
      continue;
    }
    const Hit hit = hit_at(world.parts(), query, *top);
    const auto above = first_boundary(world.parts(), RayQuery(ray_from(hit, ray.direction, true)), workspace);
    tally.failures += hit.leaf != 0 || !above || !above->entering || above->leaf != 1;
  }
  return tally;
}

}  // namespace

std::vector<Case> self_intersection_cases() {
  return {self_case("scale", "leaving a ball: acne or leak", "radius", {1e-6, 1e-3, 1, 1e3, 1e6}, by_scale),
          self_case("offset", "leaving a ball: acne or leak", "distance of the ball from the origin / radius",
                    {1, 10, 100, 1e3}, by_offset),
          self_case("angle", "leaving a ball: acne or leak", "sine above the surface",
                    {1e-8, 1e-6, 1e-4, 1e-2, 0.5}, by_angle),
          {"S19 gap",
           "contact gaps not seen from the surface",
           "gap / (eps * coordinate)",
           {64, 256, 1024, 1e4, 1e6},
           {{"ours, by identity", "double", across_gap, 0.0}},
           {50'000, 100'000'000, 500}}};
}

}  // namespace rayfarm::stability
