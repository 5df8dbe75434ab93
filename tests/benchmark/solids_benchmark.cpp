// What being right costs: our solvers against the textbook's on the same rays, one after the other in one run.
#include <benchmark/benchmark.h>

#include "common/geometry/leaf.h"
#include "tests/common/geometry/rays.h"
#include "tests/stability/ferrari.h"
#include "tests/stability/naive_quadrics.h"

namespace rayfarm {
namespace {

constexpr int ray_count = 4096;

std::vector<RayQuery> rays_at(double size) {
  RandomRays random(1);
  std::vector<RayQuery> rays;
  for (int i = 0; i < ray_count; ++i) rays.emplace_back(random.towards_box(4 * size, size));
  return rays;
}

Leaf placed(const Solid& solid) {
  return make_leaf(solid, bounded(translation({0.1, 0.2, 0.3}) * rotation_deg(1, 30)));
}

/// Aimed at points within the tube of a torus.
std::vector<RayQuery> rays_at_tube(const Torus& torus) {
  RandomRays random(2);
  std::vector<RayQuery> rays;
  for (int i = 0; i < ray_count; ++i) {
    Vec3d out = random.direction();
    out.z = 0;
    const Vec3d target = normalized(out) * torus.R + random.direction() * (torus.r * random.uniform(0, 1));
    Ray ray;
    ray.origin = random.direction() * (4 * (torus.R + torus.r));
    ray.direction = normalized(target - ray.origin);
    rays.emplace_back(ray);
  }
  return rays;
}

/// Time of one ray.
template <class Count>
void run(benchmark::State& state, const std::vector<RayQuery>& rays, Count crossings_of_ray) {
  for (auto _ : state)
    for (const RayQuery& ray : rays) benchmark::DoNotOptimize(crossings_of_ray(ray));
  state.counters["ray"] = benchmark::Counter(static_cast<double>(state.iterations()) * ray_count,
                                             benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void ours(benchmark::State& state, const Solid& solid, double size) {
  const Leaf leaf = placed(solid);
  run(state, rays_at(size), [&](const RayQuery& ray) { return crossings(leaf, ray).count; });
}

/// As the renderer first looks.
void glancing(benchmark::State& state, const Solid& solid, double size) {
  const Leaf leaf = placed(solid);
  run(state, rays_at(size), [&](const RayQuery& ray) {
    const Glance g = glance(leaf, ray);
    return g.verdict == Glance::Verdict::unsure ? crossings(leaf, ray).count : static_cast<int>(g.verdict);
  });
}

/// A textbook solver in the leaf's local space, which it has for nothing but the move.
template <class Solve>
void textbook(benchmark::State& state, const Solid& solid, double size, Solve solve) {
  const Leaf leaf = placed(solid);
  run(state, rays_at(size), [&](const RayQuery& ray) {
    const LocalRay<double> local = to_local(leaf, ray);
    return solve(local.origin, local.direction);
  });
}

using stability::plain_roots;
int sphere_roots(const Vec3d& o, const Vec3d& d) {
  return plain_roots(stability::unit_sphere<double>, o, d).real;
}
int tube_roots(const Vec3d& o, const Vec3d& d) {
  return plain_roots(stability::unit_tube<double>, o, d).real;
}
int cone_roots(const Vec3d& o, const Vec3d& d) {
  return plain_roots(stability::unit_cone<double>, o, d).real;
}

template <int R_percent, int r_percent>
int torus_roots(const Vec3d& o, const Vec3d& d) {
  double roots[4];
  return stability::torus_roots({R_percent / 100.0, r_percent / 100.0}, o, d, roots);
}

void hit_torus(benchmark::State& state, const Torus& torus) {
  const Leaf leaf = make_leaf(torus, {});
  run(state, rays_at_tube(torus), [&](const RayQuery& ray) { return crossings(leaf, ray).count; });
}

template <class Solve>
void hit_textbook_torus(benchmark::State& state, const Torus& torus, Solve solve) {
  const Leaf leaf = make_leaf(torus, {});
  run(state, rays_at_tube(torus), [&](const RayQuery& ray) {
    const LocalRay<double> local = to_local(leaf, ray);
    return solve(local.origin, local.direction);
  });
}

BENCHMARK_CAPTURE(textbook, sphere, Sphere{}, 1, sphere_roots);
BENCHMARK_CAPTURE(ours, sphere, Sphere{}, 1);
BENCHMARK_CAPTURE(glancing, sphere, Sphere{}, 1);
BENCHMARK_CAPTURE(textbook, cylinder, Cylinder{-1, 1}, 1, tube_roots);
BENCHMARK_CAPTURE(ours, cylinder, Cylinder{-1, 1}, 1);
BENCHMARK_CAPTURE(glancing, cylinder, Cylinder{-1, 1}, 1);
BENCHMARK_CAPTURE(textbook, cone, Cone{-1, 1}, 1, cone_roots);
BENCHMARK_CAPTURE(ours, cone, Cone{-1, 1}, 1);
BENCHMARK_CAPTURE(ours, cube, Cube{}, 1);
BENCHMARK_CAPTURE(glancing, cube, Cube{}, 1);
BENCHMARK_CAPTURE(ours, plane, Plane{}, 1);
BENCHMARK_CAPTURE(glancing, plane, Plane{}, 1);
BENCHMARK_CAPTURE(textbook, torus_1_025, Torus{1, 0.25}, 1.25, (torus_roots<100, 25>));
BENCHMARK_CAPTURE(ours, torus_1_025, Torus{1, 0.25}, 1.25);
BENCHMARK_CAPTURE(textbook, torus_2_1, Torus{2, 1}, 3, (torus_roots<200, 100>));
BENCHMARK_CAPTURE(ours, torus_2_1, Torus{2, 1}, 3);
BENCHMARK_CAPTURE(textbook, spindle, Torus{0.5, 0.8}, 1.3, (torus_roots<50, 80>));
BENCHMARK_CAPTURE(ours, spindle, Torus{0.5, 0.8}, 1.3);
BENCHMARK_CAPTURE(hit_textbook_torus, torus_1_025, Torus{1, 0.25}, (torus_roots<100, 25>));
BENCHMARK_CAPTURE(hit_torus, torus_1_025, Torus{1, 0.25});
BENCHMARK_CAPTURE(hit_textbook_torus, torus_2_1, Torus{2, 1}, (torus_roots<200, 100>));
BENCHMARK_CAPTURE(hit_torus, torus_2_1, Torus{2, 1});
BENCHMARK_CAPTURE(hit_textbook_torus, torus_1_001, Torus{1, 0.01}, (torus_roots<100, 1>));
BENCHMARK_CAPTURE(hit_torus, torus_1_001, Torus{1, 0.01});
BENCHMARK_CAPTURE(hit_textbook_torus, spindle, Torus{0.5, 0.8}, (torus_roots<50, 80>));
BENCHMARK_CAPTURE(hit_torus, spindle, Torus{0.5, 0.8});

}  // namespace
}  // namespace rayfarm
