// S1: whether a ray meets a sphere, S2: how far off the surface the point is that it gets, S3: the same of spheres
// scaled into slabs and needles. Swept along the distance, where a discriminant about the ray's origin loses its digits.
#include "common/render/hit.h"
#include "tests/stability/cases.h"
#include "tests/stability/naive_quadrics.h"
#include "tests/stability/quad.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

/// A half of the rays broad, with random directions; a half grazing along an axis, where their distance from the
/// centre is exact: 1 but for 10^-3 to 10^-16.
Ray ray_at_sphere(double distance, RandomRays& random) {
  Ray ray;
  if (random.uniform(0, 1) < 0.5) {
    const Vec3d from = random.direction(), across = normalized(cross(from, random.direction()));
    ray.origin = from * distance;
    ray.direction = normalized(across * random.uniform(0, 1.05) - ray.origin);
    return ray;
  }
  const int axis = static_cast<int>(random.uniform(0, 3));
  const double off = std::pow(10.0, random.uniform(-16, -3)), turn = random.uniform(-4, 4);
  const double b = random.uniform(0, 1) < 0.5 ? 1 + off : 1 - off;
  ray.origin[axis] = -distance, ray.direction[axis] = random.uniform(0.5, 2);
  ray.origin[(axis + 1) % 3] = b * std::cos(turn), ray.origin[(axis + 2) % 3] = b * std::sin(turn);
  return ray;
}

/// Not inlined: where the vectorizer of g++ 12 sees double(float(x)) beside its use, it takes x.
template <class T>
[[gnu::noinline]] Ray rounded_to(const Ray& ray) {
  const Vec3<T> o = in<T>(ray.origin), d = in<T>(ray.direction);
  Ray r;
  r.origin = {o.x, o.y, o.z}, r.direction = {d.x, d.y, d.z};
  return r;
}

/// How far from the centre the line passes.
Quad impact(const Ray& ray) {
  const QuadVec o = quad(ray.origin), d = quad(ray.direction);
  return length(o - d * (dot(o, d) / dot(d, d)));
}

// What a method finds: whether there is a hit, and the nearest point of the surface.
template <class T>
struct Found {
  bool hit = false;
  T t{};
  Vec3<T> point{};
};

template <class T, class Solve>
auto by_roots(Solve solve) {
  return [solve](const Ray& ray) -> Found<T> {
    const Vec3<T> o = in<T>(ray.origin), d = in<T>(ray.direction);
    const Roots<T> roots = solve(o, d);
    if (!roots.real || !(roots.last > 0)) return {};
    const T t = roots.first > 0 ? roots.first : roots.last;
    return {true, t, o + d * t};
  };
}

template <class T>
auto plain() {
  return by_roots<T>([](const auto& o, const auto& d) { return plain_roots(unit_sphere<T>, o, d); });
}
template <class T>
auto q_form() {
  return by_roots<T>([](const auto& o, const auto& d) { return q_form_roots(unit_sphere<T>, o, d); });
}
template <class T>
auto closest_approach_form() {
  return by_roots<T>([](const auto& o, const auto& d) { return closest_approach_roots(o, d); });
}

/// As the renderer does: the first surface of a world.
class OursInWorld {
 public:
  explicit OursInWorld(const Affine& placed = {}) : world_(scene_of({solid_node(Sphere{}, placed)})) {}

  Found<double> operator()(const Ray& ray) {
    const RayQuery query(ray);
    const auto boundary = first_boundary(world_.parts(), query, workspace_);
    if (!boundary) return {};
    return {true, boundary->t, hit_at(world_.parts(), query, *boundary).point};
  }

 private:
  World world_;
  WorldWorkspace workspace_;
};

/// Our solver with floats, and where they leave it in doubt with doubles.
Found<float> ours_in_float(const Ray& ray) {
  const LocalRay<float> local{in<float>(ray.origin), in<float>(ray.direction)};
  Interval<float> i = interval_of(Sphere{}, local);
  if (i.is_in_doubt()) {
    const Interval<double> d = interval_of(Sphere{}, LocalRay<double>{ray.origin, ray.direction});
    if (!(d.enter.t < d.leave.t)) return {};
    i.enter.t = static_cast<float>(d.enter.t), i.leave.t = static_cast<float>(d.leave.t);
  }
  if (!(i.enter.lo <= i.leave.hi) || !(i.leave.t > 0)) return {};
  const bool entering = i.enter.t > 0;
  const SurfacePoint s = surface_of(Sphere{}, LocalRay<double>{ray.origin, ray.direction}, 0, entering);
  return {true, entering ? i.enter.t : i.leave.t, in<float>(s.point)};
}

/// Hit or miss; nearer to the rim than 64 eps there is no right answer for doubles.
template <class T, class Make>
RunBatch wrong_hits(Make make) {
  return [make](const Batch& batch) {
    auto method = make();
    return ray_by_ray<RandomRays>([&](double distance, RandomRays& random) {
      const Ray ray = rounded_to<T>(ray_at_sphere(distance, random));
      const Quad b = impact(ray), eps = std::numeric_limits<double>::epsilon();
      if (fabs(b - 1) <= 64 * eps) return false;
      return method(ray).hit != (b < 1);
    })(batch);
  };
}

/// Farther off the surface than 4 ulp of t and of the radius.
template <class T, class Make>
RunBatch off_surface(Make make) {
  return [make](const Batch& batch) {
    auto method = make();
    return ray_by_ray<RandomRays>([&](double distance, RandomRays& random) {
      const Ray ray = rounded_to<T>(ray_at_sphere(distance, random));
      const auto found = method(ray);
      if (!found.hit) return false;
      const QuadVec p{found.point.x, found.point.y, found.point.z};
      const T eps = std::numeric_limits<T>::epsilon();
      return fabs(length(p) - 1) > 4 * eps * (std::fabs(found.t) * length(in<T>(ray.direction)) + 1);
    })(batch);
  };
}

const std::vector<double> far{1e1, 1e2, 1e4, 1e6, 1e8, 1e10, 1e12, 1e14};
const std::vector<double> far_in_float{1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};

// S3. -------------------------------------------------------------------------------------------------------

/// Distance of a point from the scaled sphere, to first order, in 113 bits.
Quad distance_from(const glm::dvec3& scale, const Vec3d& p) {
  const QuadVec q{Quad(p.x) / scale.x, Quad(p.y) / scale.y, Quad(p.z) / scale.z};
  const QuadVec gradient{q.x / scale.x, q.y / scale.y, q.z / scale.z};
  return fabs(length(q) - 1) * length(q) / length(gradient);
}

/// Towards the surface within a few units of the origin, under angles down to 10^-6.
Ray ray_at_scaled(const glm::dvec3& scale, RandomRays& random) {
  Vec3d target = random.direction();
  for (int i = 0; i < 3; ++i)
    if (scale[i] > 10) target[i] *= 5 / scale[i];
  target = normalized(target);
  const Vec3d at{target.x * scale.x, target.y * scale.y, target.z * scale.z};
  const Vec3d n = normalized(Vec3d{target.x / scale.x, target.y / scale.y, target.z / scale.z});
  const Vec3d along = normalized(cross(n, random.direction()));
  const double angle = std::pow(10.0, random.uniform(-6, 0));
  Ray ray;
  ray.direction = -normalized(along + n * angle);
  ray.origin = at - ray.direction * 7.0;
  return ray;
}

glm::dvec3 scale_of(double stretch, RandomRays& random) {
  const glm::dvec3 shapes[] = {{1, stretch, 1}, {stretch, 1.5, stretch}, {stretch, stretch, stretch}};
  return shapes[static_cast<int>(random.uniform(0, 3))];
}

/// The point may be 8 eps of the distance off, or of the smallest half axis where that is more.
template <class MakeMethod>
RunBatch off_scaled(MakeMethod make) {
  return [make](const Batch& batch) {
    RandomRays random(batch.seed);
    const glm::dvec3 scale = scale_of(batch.driver, random);
    auto method = make(scale);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const Ray ray = ray_at_scaled(scale, random);
      const Found<double> found = method(ray);
      const double size = std::min({scale.x, scale.y, scale.z});
      if (found.hit)
        tally.failures += distance_from(scale, found.point) >
                          8 * std::numeric_limits<double>::epsilon() * std::max(size, length(ray.origin));
    }
    return tally;
  };
}

auto plain_in_local(const glm::dvec3& scale) {
  return [scale](const Ray& ray) -> Found<double> {
    const auto local = [&](const Vec3d& v) { return Vec3d{v.x / scale.x, v.y / scale.y, v.z / scale.z}; };
    const Roots<double> roots = plain_roots(unit_sphere<double>, local(ray.origin), local(ray.direction));
    if (!roots.real) return {};
    return {true, roots.first, ray.origin + ray.direction * roots.first};
  };
}

/// One quadric in world space, its entries spread by the square of the scale.
auto quadric_in_world(const glm::dvec3& scale) {
  return [scale](const Ray& ray) -> Found<double> {
    const Quadric<double> q{{1 / (scale.x * scale.x), 1 / (scale.y * scale.y), 1 / (scale.z * scale.z)}, 1};
    const Roots<double> roots = plain_roots(q, ray.origin, ray.direction);
    if (!roots.real) return {};
    return {true, roots.first, ray.origin + ray.direction * roots.first};
  };
}

auto ours_in_world(const glm::dvec3& scale) { return OursInWorld(scaling(scale)); }

}  // namespace

std::vector<Case> sphere_cases() {
  const auto world = [] { return OursInWorld(); };
  const auto in_float = [] { return ours_in_float; };
  return {{"S1 sphere",
           "hit or miss of a sphere",
           "distance / radius",
           far,
           {{"plain discriminant", "double", wrong_hits<double>(plain<double>), {}},
            {"closest approach", "double", wrong_hits<double>(closest_approach_form<double>), {}},
            {"ours", "double", wrong_hits<double>(world), 0.0}}},
          {"S1 sphere in float",
           "hit or miss of a sphere, float",
           "distance / radius",
           far_in_float,
           {{"plain discriminant", "float", wrong_hits<float>(plain<float>), {}},
            {"closest approach", "float", wrong_hits<float>(closest_approach_form<float>), {}},
            {"ours", "float", wrong_hits<float>(in_float), 1e-4}}},
          {"S2 sphere",
           "point off a sphere by 4 ulp",
           "distance / radius",
           far,
           {{"plain roots", "double", off_surface<double>(plain<double>), {}},
            {"q form", "double", off_surface<double>(q_form<double>), {}},
            {"closest approach", "double", off_surface<double>(closest_approach_form<double>), {}},
            {"ours", "double", off_surface<double>(world), 0.0}}},
          {"S2 sphere in float",
           "point off a sphere by 4 ulp, float",
           "distance / radius",
           far_in_float,
           {{"plain roots", "float", off_surface<float>(plain<float>), {}},
            {"closest approach", "float", off_surface<float>(closest_approach_form<float>), {}},
            {"ours", "float", off_surface<float>(in_float), 0.0}}},
          {"S3 scaled sphere",
           "point off a slab or needle",
           "scale",
           {1e-6, 1e-4, 1e-2, 1, 1e2, 1e3, 1e5, 1e7},
           {{"plain roots, local", "double", off_scaled(plain_in_local), {}},
            {"quadric in the world", "double", off_scaled(quadric_in_world), {}},
            {"ours", "double", off_scaled(ours_in_world), 0.0}}}};
}

}  // namespace rayfarm::stability
