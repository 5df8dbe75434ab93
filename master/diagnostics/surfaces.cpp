#include "master/diagnostics/surfaces.h"

#include <algorithm>
#include <array>
#include <span>

namespace rayfarm {
namespace {

/// The axis faces of a cube and the caps of a cylinder by their normals; 0 for what is round.
std::uint32_t face_of(const Leaf& leaf, const Vec3d& normal) {
  const bool cube = std::holds_alternative<Cube>(leaf.solid);
  if (!cube && !std::holds_alternative<Cylinder>(leaf.solid)) return 0;
  for (int axis = cube ? 0 : 2; axis < 3; ++axis) {
    Vec3d local;
    local[axis] = 1;
    const Vec3d world = normal_to_world(leaf, local);
    if (normal == world) return 2 * static_cast<std::uint32_t>(axis) + 1;
    if (normal == -world) return 2 * static_cast<std::uint32_t>(axis) + 2;
  }
  return 0;
}

/// Two points of one smooth sheet see each other at a small angle to both tangent planes; two sheets, one
/// behind the other, do not: at a fold the near one is seen edge-on, the far one from the front.
bool on_one_sheet(const SurfaceSample& a, const SurfaceSample& b) {
  constexpr double steepest = 0.8;  // sine: a sheet may turn by 90 degrees (0.71) within the pixel
  const Vec3d between = b.point - a.point;
  const double most = steepest * length(between);
  return std::fabs(dot(a.normal, between)) <= most && std::fabs(dot(b.normal, between)) <= most;
}

Surface mean_of(std::span<const SurfaceSample> samples) {
  Surface surface{samples[0].leaf, samples[0].face, static_cast<std::uint32_t>(samples.size()), 0, {}, {}};
  Vec3d normals;
  for (const SurfaceSample& s : samples) {
    surface.distance += s.distance;
    surface.point += s.point;
    normals += s.normal;
  }
  const double share = 1.0 / static_cast<double>(samples.size());
  surface.distance *= share;
  surface.point = surface.point * share;
  // Opposite normals cancel out; then one of them stands for all.
  surface.normal = length(normals) > 0 ? normalized(normals) : samples[0].normal;
  return surface;
}

constexpr std::array<std::string_view, 4> reduction_names{"majority", "mean", "closest", "median"};

bool closer(const SurfaceSample& a, const SurfaceSample& b) { return a.distance < b.distance; }

}  // namespace

std::optional<Reduction> reduction_named(std::string_view name) {
  for (std::size_t i = 0; i < reduction_names.size(); ++i)
    if (reduction_names[i] == name) return static_cast<Reduction>(i);
  return std::nullopt;
}

std::string_view name_of(Reduction reduction) { return reduction_names[static_cast<std::size_t>(reduction)]; }

SurfaceSample surface_sample(const World::Parts& world, const Hit& hit) {
  return {hit.leaf, face_of(world.leaves[hit.leaf], hit.normal), hit.t, hit.point, hit.normal};
}

std::vector<Surface> ranked_surfaces(std::vector<SurfaceSample> samples) {
  std::sort(samples.begin(), samples.end(), [](const SurfaceSample& a, const SurfaceSample& b) {
    return a.leaf != b.leaf ? a.leaf < b.leaf : a.face != b.face ? a.face < b.face : closer(a, b);
  });
  std::vector<Surface> surfaces;
  for (std::size_t first = 0, next = 0; first < samples.size(); first = next) {
    for (next = first + 1; next < samples.size(); ++next)
      if (samples[next].leaf != samples[first].leaf || samples[next].face != samples[first].face ||
          !on_one_sheet(samples[next - 1], samples[next]))
        break;
    surfaces.push_back(mean_of(std::span(samples).subspan(first, next - first)));
  }
  std::stable_sort(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.distance < b.distance;
  });
  return surfaces;
}

std::optional<Surface> reduced(const std::vector<SurfaceSample>& hits, std::uint32_t all,
                               Reduction reduction) {
  if (hits.empty()) return std::nullopt;
  const auto missed = all - static_cast<std::uint32_t>(hits.size());
  switch (reduction) {
    case Reduction::majority: {
      const Surface most = ranked_surfaces(hits)[0];
      if (most.samples < missed) return std::nullopt;
      return most;
    }
    case Reduction::mean:
      return mean_of(hits);
    case Reduction::closest:
      return mean_of({&*std::min_element(hits.begin(), hits.end(), closer), 1});
    case Reduction::median: {
      const std::size_t middle = (std::size_t{all} - 1) / 2;
      if (middle >= hits.size()) return std::nullopt;
      std::vector<SurfaceSample> sorted = hits;
      std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(middle), sorted.end(),
                       closer);
      return mean_of({&sorted[middle], 1});
    }
  }
  return std::nullopt;
}

}  // namespace rayfarm
