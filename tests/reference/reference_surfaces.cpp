#include "tests/reference/reference_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/overload.h"

namespace rayfarm::reference {
namespace {

Vec vec_of(const Vec3d& v) { return {v.x, v.y, v.z}; }
Vec unit_or_zero(const Vec& v) { return v == Vec(0) ? v : glm::normalize(v); }

// Meshes. Source: T. Moeller, B. Trumbore, Fast, Minimum Storage Ray/Triangle Intersection, JGT 2(1), 1997. -----------

struct TriangleHit {
  Real t = 0;
  std::array<Real, 3> weight{};  // of the corners
};

std::optional<TriangleHit> hit_of(const std::array<Vec, 3>& corner, const Ray& ray) {
  const Vec to_b = corner[1] - corner[0], to_c = corner[2] - corner[0], p = glm::cross(ray.direction, to_c);
  const Real det = glm::dot(to_b, p);
  if (det == 0) return std::nullopt;
  const Vec from = ray.origin - corner[0], q = glm::cross(from, to_b);
  const Real b = glm::dot(from, p) / det, c = glm::dot(ray.direction, q) / det;
  if (b < 0 || c < 0 || b + c > 1) return std::nullopt;
  return TriangleHit{glm::dot(to_c, q) / det, {1 - b - c, b, c}};
}

Vec face_normal(const TriangleMesh& mesh, std::size_t triangle) {
  const IndexTriple& t = mesh.triangles[triangle];
  const Vec a = vec_of(mesh.points[t[0]]);
  return glm::cross(vec_of(mesh.points[t[1]]) - a, vec_of(mesh.points[t[2]]) - a);
}

/// Given, or the mean of the faces around the point by their areas.
Vec corner_normal(const TriangleMesh& mesh, std::size_t triangle, std::size_t corner) {
  if (!mesh.normals_at.empty()) return vec_of(mesh.normals[mesh.normals_at[triangle][corner]]);
  const std::uint32_t point = mesh.triangles[triangle][corner];
  Vec sum(0);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (std::ranges::count(mesh.triangles[i], point) > 0) sum += face_normal(mesh, i);
  return sum;
}

Crossing crossing_of(const TriangleMesh& mesh, std::size_t triangle, bool smooth, const TriangleHit& hit) {
  Crossing c{.t = hit.t};
  for (std::size_t i = 0; i < 3; ++i) {
    if (smooth) c.gradient += hit.weight[i] * unit_or_zero(corner_normal(mesh, triangle, i));
    if (mesh.texture_at.empty()) continue;
    const std::size_t at = 2 * std::size_t{mesh.texture_at[triangle][i]};
    c.uv += hit.weight[i] * Uv(mesh.texture[at], mesh.texture[at + 1]);
  }
  if (c.gradient == Vec(0)) c.gradient = face_normal(mesh, triangle);
  return c;
}

std::vector<Crossing> crossings_of(const TriangleMesh& mesh, bool smooth, const Ray& ray) {
  std::vector<Crossing> found;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const IndexTriple& t = mesh.triangles[i];
    const auto hit =
        hit_of({vec_of(mesh.points[t[0]]), vec_of(mesh.points[t[1]]), vec_of(mesh.points[t[2]])}, ray);
    if (hit) found.push_back(crossing_of(mesh, i, smooth, *hit));
  }
  return found;
}

// Bezier patches: quartered while their control points lie around the line, then Newton's method on the whole patch. --

using Net = std::array<Vec, 16>;  // row by row, u along a row

/// Both halves of four points by de Casteljau; `step` apart.
void halve(const Net& net, std::size_t first, std::size_t step, Net& low, Net& high) {
  std::array<Vec, 4> p;
  for (std::size_t i = 0; i < 4; ++i) p[i] = net[first + i * step];
  for (std::size_t i = 0; i < 4; ++i) {
    low[first + i * step] = p[0], high[first + (3 - i) * step] = p[3 - i];
    for (std::size_t k = 0; k + i < 3; ++k) p[k] = (p[k] + p[k + 1]) / Real(2);
  }
}
std::array<Net, 2> halves(const Net& net, std::size_t step) {
  std::array<Net, 2> half;
  for (std::size_t line = 0; line < 4; ++line) halve(net, line * (step == 1 ? 4 : 1), step, half[0], half[1]);
  return half;
}

struct Place {
  Vec point{0}, by_u{0}, by_v{0};
};
Place place_at(const Net& net, const Uv& at) {
  const auto weights = [](Real x) {
    const Real y = 1 - x;
    return std::array<Real, 4>{y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
  };
  const auto slopes = [](Real x) {
    const Real y = 1 - x;
    return std::array<Real, 4>{-3 * y * y, 3 * y * y - 6 * x * y, 6 * x * y - 3 * x * x, 3 * x * x};
  };
  const auto u = weights(at.x), v = weights(at.y), du = slopes(at.x), dv = slopes(at.y);
  Place place;
  for (std::size_t i = 0; i < 16; ++i) {
    place.point += v[i / 4] * u[i % 4] * net[i];
    place.by_u += v[i / 4] * du[i % 4] * net[i];
    place.by_v += dv[i / 4] * u[i % 4] * net[i];
  }
  return place;
}

/// All places where a patch meets the line; the patch is given by coordinates across the line (x, y) and along it (z).
class PatchSearch {
 public:
  explicit PatchSearch(const Net& patch) : patch_(patch) {
    for (const Vec& p : patch) size_ = std::max({size_, std::abs(p.x), std::abs(p.y)});
    search(patch, Uv(0), 1);
  }
  std::vector<Uv> found;

 private:
  static constexpr Real smallest = 0x1p-10L;  // side of the pieces where Newton's method begins

  void search(const Net& piece, const Uv& corner, Real side) {
    for (int axis = 0; axis < 2; ++axis) {
      const auto [low, high] = std::ranges::minmax(piece, {}, [&](const Vec& p) { return p[axis]; });
      const Real slack = 1e-16L * size_;
      if (low[axis] > slack || high[axis] < -slack) return;
    }
    if (side <= smallest) return finish(corner + side / 2, side);
    const auto by_v = halves(piece, 4);
    for (int v = 0; v < 2; ++v) {
      const auto by_u = halves(by_v[static_cast<std::size_t>(v)], 1);
      for (int u = 0; u < 2; ++u)
        search(by_u[static_cast<std::size_t>(u)], corner + Uv(u, v) * (side / 2), side / 2);
    }
  }

  void finish(Uv at, Real side) {
    const Uv begin = at;
    for (int step = 0; step < 12; ++step) {
      const Place p = place_at(patch_, at);
      const Real det = p.by_u.x * p.by_v.y - p.by_u.y * p.by_v.x;
      if (det == 0) return;
      at -=
          Uv(p.point.x * p.by_v.y - p.point.y * p.by_v.x, p.point.y * p.by_u.x - p.point.x * p.by_u.y) / det;
      if (!(apart(at, begin) <= 8 * side)) return;
    }
    const Vec rest = place_at(patch_, at).point;
    const Real border = 1e-15L;
    const bool on_patch = std::min(at.x, at.y) >= -border && std::max(at.x, at.y) <= 1 + border;
    if (!on_patch || std::abs(rest.x) + std::abs(rest.y) > 1e-16L * size_) return;
    if (std::ranges::none_of(found, [&](const Uv& other) { return apart(at, other) < 1e-9L; }))
      found.push_back(at);
  }
  static Real apart(const Uv& a, const Uv& b) { return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)); }

  const Net& patch_;
  Real size_ = 0;
};

std::vector<Crossing> crossings_of(const BezierGrid& grid, const Ray& ray) {
  const Vec d = ray.direction, along = d / glm::dot(d, d);
  const Vec x = glm::normalize(glm::cross(d, std::abs(d.x) < std::abs(d.y) ? Vec(1, 0, 0) : Vec(0, 1, 0)));
  const Vec y = glm::normalize(glm::cross(d, x));
  std::vector<Crossing> crossings;
  for (std::size_t row = 0; row < grid.rows; ++row)
    for (std::size_t column = 0; column < grid.columns; ++column) {
      Net patch, seen;
      for (std::size_t i = 0; i < 16; ++i) {
        patch[i] = vec_of(grid.at(3 * row + i / 4, 3 * column + i % 4));
        const Vec p = patch[i] - ray.origin;
        seen[i] = {glm::dot(p, x), glm::dot(p, y), glm::dot(p, along)};
      }
      for (const Uv& at : PatchSearch(seen).found) {
        const Place place = place_at(patch, at);
        crossings.push_back({.t = place_at(seen, at).point.z,
                             .gradient = glm::cross(place.by_u, place.by_v),
                             .uv = at + Uv(column, row)});
      }
    }
  return crossings;
}

bool is_front(const Crossing& c, const Ray& ray) { return glm::dot(c.gradient, ray.direction) < 0; }

/// Patches share their borders: what both have found there is one crossing.
void remove_twins(std::vector<Crossing>& crossings, const Ray& ray) {
  const auto is_twin = [&](const Crossing& a, const Crossing& b) {
    return is_front(a, ray) == is_front(b, ray) && b.t - a.t <= 1e-14L * std::abs(b.t);
  };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), is_twin), crossings.end());
}

}  // namespace

Surface surface_of(const Mesh& mesh, const AssetContent& content) {
  return {&content, mesh.smooth, is_closed(std::get<TriangleMesh>(content))};
}
Surface surface_of(const Bezier&, const AssetContent& content) {
  return {&content, true, is_closed(std::get<BezierGrid>(content))};
}

std::vector<Crossing> crossings_of(const Surface& surface, const Ray& local) {
  auto found =
      std::visit(Overload{[&](const TriangleMesh& mesh) { return crossings_of(mesh, surface.smooth, local); },
                          [&](const BezierGrid& grid) { return crossings_of(grid, local); },
                          [](const Image&) { return std::vector<Crossing>{}; }},
                 *surface.content);
  std::ranges::sort(found, {}, &Crossing::t);
  if (std::holds_alternative<BezierGrid>(*surface.content)) remove_twins(found, local);
  return found;
}

Spans spans_of_closed(std::vector<Crossing> crossings, const Ray& local) {
  // Patches may be given inside out: the first crossing of a line leads in.
  if (!crossings.empty() && !is_front(crossings.front(), local))
    for (Crossing& c : crossings) c.gradient = -c.gradient;
  Spans spans;
  int winding = 0;
  for (const Crossing& c : crossings) {
    const bool before = winding > 0;
    winding += is_front(c, local) ? 1 : -1;
    if ((winding > 0) != before) spans.crossings.push_back(c);
  }
  return spans;
}

Spans spans_of_sheet(const std::vector<Crossing>& crossings, const Ray&) {
  Spans spans;
  for (Crossing c : crossings) {
    c.of_sheet = true;
    spans.crossings.insert(spans.crossings.end(), 2, c);
  }
  return spans;
}

}  // namespace rayfarm::reference
