#include "master/diagnostics/csg_story.h"

#include "common/render/hit.h"
#include "master/diagnostics/leaf_names.h"

namespace rayfarm {
namespace {

constexpr int most_boundaries = 10'000;

/// Sides alternate at each crossing.
class Walk {
 public:
  explicit Walk(bool starts_inside) {
    if (starts_inside) stretches_.push_back({});
    inside_ = starts_inside;
  }
  void cross(double t) {
    if (inside_)
      stretches_.back().out = t;
    else
      stretches_.push_back({t, infinity});
    inside_ = !inside_;
  }
  std::vector<Stretch> stretches() && { return std::move(stretches_); }

 private:
  std::vector<Stretch> stretches_;
  bool inside_ = false;
};

bool starts_in_material(const World::Parts& world, const RayQuery& query, WorldWorkspace& workspace) {
  for (const WorldObject& object : world.objects)
    if (gather(world.items_of(object), world.leaves, query, infinity, workspace.csg)) return true;
  return false;
}

/// Goes through each boundary straight on, as a refracted ray would with index 1.
std::vector<Stretch> material_along(const World::Parts& world, Ray ray) {
  WorldWorkspace workspace;
  Walk walk(starts_in_material(world, RayQuery(ray), workspace));
  double t = 0;
  for (int i = 0; i < most_boundaries; ++i) {
    const RayQuery query(ray);
    const std::optional<Boundary> boundary = first_boundary(world, query, workspace);
    if (!boundary) break;
    const Hit hit = hit_at(world, query, *boundary);
    t += boundary->t;
    if (!hit.is_sheet) walk.cross(t);
    ray = ray_from(hit, ray.direction, !hit.entering);
  }
  return std::move(walk).stretches();
}

}  // namespace

namespace {

/// Where a leaf's surface is ahead; both sides alternate.
struct LeafPath {
  bool starts_inside = false;
  std::vector<double> crossings;
};

LeafPath path_of(const Leaf& leaf, const RayQuery& query) {
  LeafPath path;
  if (leaf.facets) {
    FacetPath found;
    find_path_ahead(leaf, query, found);
    path.starts_inside = found.starts_inside;
    for (const FacetCrossing& c : found.crossings) path.crossings.push_back(c.t);
  } else {
    const Crossings found = crossings_ahead(leaf, query);
    path.starts_inside = found.starts_inside;
    for (int i = 0; i < found.count; ++i) path.crossings.push_back(found.at[static_cast<std::size_t>(i)].t);
  }
  return path;
}

}  // namespace

CsgStory csg_story(const World& world, const Ray& ray) {
  const std::vector<bool> subtracted = subtracted_leaves(world.scene());
  const World::Parts& parts = world.parts();
  const RayQuery query(ray);
  CsgStory story;
  for (std::uint32_t leaf = 0; leaf < parts.leaves.size(); ++leaf) {
    const LeafPath path = path_of(parts.leaves[leaf], query);
    if (!path.starts_inside && path.crossings.empty()) continue;
    Walk walk(path.starts_inside);
    for (const double t : path.crossings) walk.cross(t);
    story.leaves.push_back({leaf, subtracted[leaf], std::move(walk).stretches()});
  }
  story.material = material_along(parts, ray);
  return story;
}

}  // namespace rayfarm
