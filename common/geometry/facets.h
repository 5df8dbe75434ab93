// Surfaces of many parts (triangles, patches): all that is asked of them, whichever kind they are.
//
// A closed one is a solid. Inside is where a line has come in more often than it has left. Any other is a sheet: it
// has no inside, and both its sides show.
#pragma once
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "common/geometry/bezier_facets.h"
#include "common/geometry/mesh_facets.h"

namespace rayfarm {

using Facets = std::variant<MeshFacets, BezierFacets>;

/// They must outlive the facets.
std::unique_ptr<const Facets> make_facets(const TriangleMesh& mesh);
std::unique_ptr<const Facets> make_facets(const BezierGrid& grid);

const Box& box_of(const Facets& facets);
bool is_closed(const Facets& facets);

/// What is known of a ray's start: the part it leaves, and to which side; or nothing.
struct Departure {
  std::uint32_t part = no_part;
  bool inward = false;
};

/// Where a ray meets a closed surface, in and out in turn.
struct FacetPath {
  bool starts_inside = false;
  std::vector<FacetCrossing> crossings;  // ahead, ascending
};

/// All crossings ahead of a closed surface. Of one that is left, the side is known: where the others contradict it,
/// the nearest of them belongs to the place that is left.
void find_path(const Facets& facets, const LocalRay<double>& ray, const Departure& from, FacetPath& path);

/// The nearest crossing ahead at t <= t_max. None also where that is no closed surface's boundary for sure: then
/// is_sure is false, and find_path() tells.
struct Nearest {
  std::optional<FacetCrossing> crossing;
  bool is_sure = true;
};
Nearest nearest_crossing(const Facets& facets, const LocalRay<double>& ray, const Departure& from,
                         double t_max);

/// False only if the ray's start is outside for sure, or there is no inside.
bool may_start_inside(const Facets& facets, const LocalRay<double>& ray, const Departure& from);

FacetPoint point_at(const Facets& facets, const LocalRay<double>& ray, const FacetCrossing& crossing,
                    bool smooth);

}  // namespace rayfarm
