#include "common/geometry/facets.h"

#include <algorithm>

#include "common/math/overload.h"

namespace rayfarm {
namespace {

/// Calls found() for the crossings ahead: one that may be at or behind the origin has been passed, as has the part
/// that the ray leaves (a patch is curved and can be met again: what is left of it lies at the origin).
template <class Found>
void visit_ahead(const Facets& facets, const LocalRay<double>& ray, const Departure& from,
                 const double& t_max, Found&& found) {
  const auto ahead = [&](const FacetCrossing& c) {
    if (c.lo() > 0) found(c);
  };
  std::visit(Overload{[&](const MeshFacets& mesh) {
                        mesh.visit(ray, t_max, [&](const FacetCrossing& c) {
                          if (c.part != from.part) ahead(c);
                        });
                      },
                      [&](const BezierFacets& bezier) { bezier.visit(ray, t_max, ahead); }},
             facets);
}

bool overlap(const FacetCrossing& a, const FacetCrossing& b) { return a.lo() <= b.hi() && b.lo() <= a.hi(); }

/// A crossing of a border that was found in both pieces is one.
void remove_twins(std::vector<FacetCrossing>& crossings) {
  const auto is_twin = [](const FacetCrossing& a, const FacetCrossing& b) {
    return a.entering == b.entering && a.part != b.part && overlap(a, b);
  };
  crossings.erase(std::unique(crossings.begin(), crossings.end(), is_twin), crossings.end());
}

/// How often the ray is inside at its start: it ends outside.
int winding_of(const std::vector<FacetCrossing>& crossings) {
  int winding = 0;
  for (const FacetCrossing& c : crossings) winding += c.entering ? -1 : 1;
  return winding;
}

/// Takes away crossings, the nearest first, that contradict what is known of the start. A ray that was sent inside, by a
/// shading normal that leans over, but never gets there leaves where it came in.
void mend(std::vector<FacetCrossing>& crossings, int& winding, const Departure& from) {
  const int known = from.inward ? 1 : 0;
  while (winding != known) {
    const bool entering = winding < known;  // there is one too many of these
    const auto wrong = std::ranges::find(crossings, entering, &FacetCrossing::entering);
    if (wrong == crossings.end()) break;
    crossings.erase(wrong);
    winding += entering ? 1 : -1;
  }
  if (winding < known) crossings.insert(crossings.begin(), {0, 0, from.part, false}), ++winding;
}

/// Keeps the crossings where the winding begins or ends to be positive.
void keep_boundaries(std::vector<FacetCrossing>& crossings, int winding) {
  std::erase_if(crossings, [&](const FacetCrossing& c) {
    const bool before = winding > 0;
    winding += c.entering ? 1 : -1;
    return (winding > 0) == before;
  });
}

}  // namespace

std::unique_ptr<const Facets> make_facets(const TriangleMesh& mesh) {
  return std::make_unique<const Facets>(std::in_place_type<MeshFacets>, mesh);
}
std::unique_ptr<const Facets> make_facets(const BezierGrid& grid) {
  return std::make_unique<const Facets>(std::in_place_type<BezierFacets>, grid);
}

const Box& box_of(const Facets& facets) {
  return std::visit([](const auto& f) -> const Box& { return f.box(); }, facets);
}
bool is_closed(const Facets& facets) {
  return std::visit([](const auto& f) { return f.is_closed(); }, facets);
}

void find_path(const Facets& facets, const LocalRay<double>& ray, const Departure& from, FacetPath& path) {
  std::vector<FacetCrossing>& crossings = path.crossings;
  crossings.clear();
  visit_ahead(facets, ray, from, infinity, [&](const FacetCrossing& c) { crossings.push_back(c); });
  std::ranges::sort(crossings, [](const FacetCrossing& a, const FacetCrossing& b) {
    return a.t != b.t ? a.t < b.t : a.part < b.part;
  });
  if (std::holds_alternative<BezierFacets>(facets)) remove_twins(crossings);
  int winding = winding_of(crossings);
  if (from.part != no_part) mend(crossings, winding, from);
  path.starts_inside = winding > 0;
  keep_boundaries(crossings, winding);
}

Nearest nearest_crossing(const Facets& facets, const LocalRay<double>& ray, const Departure& from,
                         double t_max) {
  std::optional<FacetCrossing> best;
  double second = infinity;  // the least lo of the others that were found
  visit_ahead(facets, ray, from, t_max, [&](const FacetCrossing& c) {
    if (best && c.t >= best->t) {
      second = least(second, c.lo());
      return;
    }
    if (best) second = least(second, best->lo());
    best = c;
    t_max = least(t_max, c.hi());
  });
  const bool is_solid = is_closed(facets);
  if (!best || best->t > t_max) return {std::nullopt, !(is_solid && from.part != no_part && from.inward)};
  if (!is_solid) return {best, true};
  const bool is_alone = second > best->hi();
  const bool is_expected = from.part == no_part ? best->entering : best->entering != from.inward;
  return {best, is_alone && is_expected};
}

bool may_start_inside(const Facets& facets, const LocalRay<double>& ray, const Departure& from) {
  if (!is_closed(facets)) return false;
  if (from.part != no_part) return from.inward;
  const Box& box = box_of(facets);
  for (int axis = 0; axis < 3; ++axis) {
    const double at = ray.origin[axis];
    if (at + ray.origin_error < box.low[axis] || at - ray.origin_error > box.high[axis]) return false;
  }
  return true;
}

FacetPoint point_at(const Facets& facets, const LocalRay<double>& ray, const FacetCrossing& crossing,
                    bool smooth) {
  return std::visit(Overload{[&](const MeshFacets& mesh) { return mesh.point_at(ray, crossing, smooth); },
                             [&](const BezierFacets& bezier) { return bezier.point_at(ray, crossing); }},
                    facets);
}

}  // namespace rayfarm
