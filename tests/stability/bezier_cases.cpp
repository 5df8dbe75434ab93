// S10: Bezier surfaces. A line towards a point of the surface must find that point, and none sees through a closed one.
#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"
#include "tests/support/surfaces.h"

namespace rayfarm::stability {
namespace {

LocalRay<double> line_of(const Vec3d& from, const Vec3d& to) { return {from, to - from, 0, 0, {}}; }

/// A patch of 4 x 4 with random heights up to the driver: it folds over itself as seen from the side.
BezierGrid rough_patch(double height, RandomRays& random) {
  BezierGrid patch{1, 1, {}};
  for (int i = 0; i < 16; ++i)
    patch.points.push_back({i % 4 + random.uniform(-0.5, 0.5), random.uniform(-1, 1) * height,
                            i / 4 + random.uniform(-0.5, 0.5)});
  return patch;
}

double patch_size(const BezierGrid& grid) {
  double size = 0;
  for (const Vec3d& p : grid.points) size = std::max(size, max_abs(p));
  return size;
}

/// The distance of a point from a line.
double distance_from(const LocalRay<double>& ray, const Vec3d& p) {
  const Vec3d d = normalized(ray.direction);
  return length(cross(p - ray.origin, d));
}

/// One crossing must be at the target, and all of them on the surface and on the line to 1e-12 of the patch.
Tally run_ours(const Batch& batch) {
  RandomRays random(batch.seed);
  const BezierGrid patch = rough_patch(batch.driver, random);
  const double size = patch_size(patch);
  const auto facets = make_facets(patch);
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Vec3d target = bezier_point(patch, random.uniform(0, 1), random.uniform(0, 1));
    const LocalRay<double> ray = line_of(target + random.direction() * (3 * size), target);
    bool is_found = false, is_off = false;
    for (const FacetCrossing& c : crossings_of_line(*facets, ray)) {
      const FacetPoint at = point_at(*facets, ray, c, true);
      is_found = is_found || std::fabs(c.t - 1) <= c.error + 1e-12;
      const Vec3d surface = bezier_point(patch, at.texture.u, at.texture.v);
      is_off = is_off || length(surface - at.surface.point) > 1e-12 * size ||
               distance_from(ray, at.surface.point) > 1e-12 * size;
    }
    tally.failures += !is_found || is_off;
  }
  return tally;
}

/// The original's way: halve until the box's squared diagonal is small, then two triangles.
class Flattened {
 public:
  explicit Flattened(const BezierGrid& grid) : grid_(grid) {
    for (std::uint32_t v = 0; v < grid.rows; ++v)
      for (std::uint32_t u = 0; u < grid.columns; ++u) flatten(u, v, 1, 0);
  }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  void flatten(double u, double v, double side, int depth) {
    const Vec3d a = bezier_point(grid_, u, v), b = bezier_point(grid_, u + side, v),
                c = bezier_point(grid_, u + side, v + side), d = bezier_point(grid_, u, v + side);
    const Vec3d low{std::min({a.x, b.x, c.x, d.x}), std::min({a.y, b.y, c.y, d.y}),
                    std::min({a.z, b.z, c.z, d.z})};
    const Vec3d high{std::max({a.x, b.x, c.x, d.x}), std::max({a.y, b.y, c.y, d.y}),
                     std::max({a.z, b.z, c.z, d.z})};
    if (depth > 0 && (dot(high - low, high - low) < 1e-3 || depth > 7)) {
      const auto first = static_cast<std::uint32_t>(mesh_.points.size());
      for (const Vec3d& p : {a, b, c, d}) mesh_.points.push_back(p);
      mesh_.triangles.push_back({first, first + 1, first + 2}),
          mesh_.triangles.push_back({first, first + 2, first + 3});
      return;
    }
    for (const double dv : {0.0, side / 2})
      for (const double du : {0.0, side / 2}) flatten(u + du, v + dv, side / 2, depth + 1);
  }
  const BezierGrid& grid_;
  TriangleMesh mesh_;
};

Tally run_flattened(const Batch& batch) {
  RandomRays random(batch.seed);
  const BezierGrid patch = rough_patch(batch.driver, random);
  const double size = patch_size(patch);
  const Flattened flattened(patch);
  const auto facets = make_facets(flattened.mesh());
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const Vec3d target = bezier_point(patch, random.uniform(0, 1), random.uniform(0, 1));
    const LocalRay<double> ray = line_of(target + random.direction() * (3 * size), target);
    bool is_found = false;
    for (const FacetCrossing& c : crossings_of_line(*facets, ray))
      is_found = is_found || std::fabs(c.t - 1) <= 1e-12;
    tally.failures += !is_found;
  }
  return tally;
}

/// A closed ball drawn out by the driver; lines through a point inside and one of a border of patches, or any other.
Tally run_closed(const Batch& batch) {
  RandomRays random(batch.seed);
  BezierGrid ball = ball_grid();
  for (Vec3d& p : ball.points) p.z *= batch.driver;
  const auto facets = make_facets(ball);
  FacetPath path;
  Tally tally;
  for (; tally.rays < batch.rays; ++tally.rays) {
    const bool on_border = tally.rays % 2 == 0;
    const double u = random.uniform(0, 4), v = random.uniform(0, 2);
    const Vec3d inside = random.in_box(0.4) * Vec3d{1, 1, batch.driver};
    const Vec3d target =
        bezier_point(ball, on_border && u < 2 ? std::floor(u) : u, on_border && u >= 2 ? std::floor(v) : v);
    find_path(*facets, line_of(inside, target), {}, path);
    const Nearest from_outside =
        nearest_crossing(*facets, line_of(inside + (target - inside) * 5.0, inside), {}, infinity);
    tally.failures += !path.starts_inside || path.crossings.size() != 1 || !from_outside.crossing;
  }
  return tally;
}

}  // namespace

std::vector<Case> bezier_cases() {
  return {{"S10 points",
           "Bezier patch: lines that miss their point",
           "height / side of control points",
           {0.1, 0.5, 1, 2, 4},
           {{"flattened as the original", "double", run_flattened, {}}, {"ours", "double", run_ours, 0.0}},
           {4'000, 10'000'000, 500}},
          {"S10 closed",
           "closed Bezier surface: lines that see through",
           "length / width",
           {0.01, 0.1, 1, 10, 100},
           {{"ours", "double", run_closed, 0.0}},
           {20'000, 100'000'000, 2'000}}};
}

}  // namespace rayfarm::stability
