// S11: lines through the edges and corners of a closed mesh. Whoever comes from outside towards a point of its surface
// must enter it, and must leave it as often.
#include <limits>

#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"
#include "tests/support/surfaces.h"

namespace rayfarm::stability {
namespace {

LocalRay<double> line_of(const Vec3d& from, const Vec3d& to) { return {from, to - from, 0, 0, {}}; }

/// Source: T. Moeller, B. Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, JGT 2(1), 1997.
template <class T>
bool moeller_trumbore(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& c, const Vec3<T>& o,
                      const Vec3<T>& d) {
  const Vec3<T> e1 = b - a, e2 = c - a, p = cross(d, e2);
  const T det = dot(e1, p);
  if (det == 0) return false;
  const Vec3<T> from_a = o - a;
  const T u = dot(from_a, p) / det;
  if (!(u >= 0 && u <= 1)) return false;
  const Vec3<T> q = cross(from_a, e1);
  const T v = dot(d, q) / det;
  return v >= 0 && u + v <= 1 && dot(e2, q) / det > 0;
}

template <class T>
Vec3<T> rounded(const Vec3d& v) {
  return {T(v.x), T(v.y), T(v.z)};
}

/// At a corner or at a point of an edge, from all around.
LocalRay<double> ray_at_edge(const TriangleMesh& mesh, const Vec3d& middle, RandomRays& random) {
  const IndexTriple& t =
      mesh.triangles[static_cast<std::size_t>(random.uniform(0, double(mesh.triangles.size())))];
  const Vec3d &a = mesh.points[t[0]], &b = mesh.points[t[1]];
  const double along = random.uniform(0, 1) < 0.5 ? 0 : random.uniform(0, 1);
  return line_of(middle + random.direction() * 5.0, a + (b - a) * along);
}

/// A ray aimed at the rim of the ball may pass it: what hits is told by the sign of the volume that the exact mesh
/// has there, so only rays are counted that go on to a point well inside.
LocalRay<double> through_inside(const LocalRay<double>& ray, const Vec3d& middle, const Vec3d& size,
                                RandomRays& random) {
  const Vec3d target = ray.origin + ray.direction, inside = middle + random.in_box(0.3) * size;
  return line_of(target + (target - inside) * 4.0, target);
}

struct Ball {
  TriangleMesh mesh = ball_mesh(8, 13);
  Vec3d middle{}, size{1, 1, 1};
};
Ball moved_ball(double offset) {
  Ball ball;
  ball.middle = {offset, -0.7 * offset, 0.3 * offset};
  for (Vec3d& p : ball.mesh.points) p += ball.middle;
  return ball;
}
Ball flat_ball(double ratio) {
  Ball ball;
  ball.size = {1, 1, 1 / ratio};
  for (Vec3d& p : ball.mesh.points) p = p * ball.size;
  return ball;
}

template <class MakeBall>
RunBatch ours(MakeBall make_ball) {
  return [make_ball](const Batch& batch) {
    RandomRays random(batch.seed);
    const Ball ball = make_ball(batch.driver);
    const auto facets = make_facets(ball.mesh);
    FacetPath path;
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const LocalRay<double> ray =
          through_inside(ray_at_edge(ball.mesh, ball.middle, random), ball.middle, ball.size, random);
      find_path(*facets, ray, {}, path);
      const Nearest nearest = nearest_crossing(*facets, ray, {}, infinity);
      const bool enters = nearest.crossing && (!nearest.is_sure || nearest.crossing->entering);
      tally.failures += path.starts_inside || path.crossings.size() != 2 || !enters;
    }
    return tally;
  };
}

template <class T, class MakeBall>
RunBatch textbook(MakeBall make_ball) {
  return [make_ball](const Batch& batch) {
    RandomRays random(batch.seed);
    const Ball ball = make_ball(batch.driver);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) {
      const LocalRay<double> ray =
          through_inside(ray_at_edge(ball.mesh, ball.middle, random), ball.middle, ball.size, random);
      int hits = 0;
      for (const IndexTriple& t : ball.mesh.triangles)
        hits += moeller_trumbore(rounded<T>(ball.mesh.points[t[0]]), rounded<T>(ball.mesh.points[t[1]]),
                                 rounded<T>(ball.mesh.points[t[2]]), rounded<T>(ray.origin),
                                 rounded<T>(ray.direction));
      tally.failures += hits < 2;  // leaks: hits of both triangles at an edge are no fault of it
    }
    return tally;
  };
}

template <class MakeBall>
std::vector<Method> methods(MakeBall make_ball) {
  return {{"Moeller-Trumbore", "double", textbook<double>(make_ball), {}},
          {"Moeller-Trumbore", "float", textbook<float>(make_ball), {}},
          {"ours", "double", ours(make_ball), 0.0}};
}

}  // namespace

std::vector<Case> triangle_cases() {
  const CellSize size{20'000, 100'000'000, 2'000};
  return {{"S11 offset",
           "edges and corners of a mesh: leaks",
           "offset / radius",
           {0, 1, 1e2, 1e4, 1e6},
           methods(moved_ball),
           size},
          {"S11 needles",
           "edges of needle triangles: leaks",
           "length / width",
           {1, 1e2, 1e4, 1e6, 1e8},
           methods(flat_ball),
           size}};
}

}  // namespace rayfarm::stability
