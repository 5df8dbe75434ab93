#include "master/diagnostics/map_kind.h"

#include <array>
#include <vector>

#include "common/math/number.h"

namespace rayfarm {
namespace {

template <std::size_t n>
using Names = std::array<std::string_view, n>;

constexpr Names<1> z{"Z"}, primary{"RayCount.primary"}, all{"RayCount.all"}, samples{"Samples"}, cost{"Cost"},
    coverage{"Coverage"}, worker{"Worker"};
constexpr Names<3> normal{"N.X", "N.Y", "N.Z"}, camera_normal{"Nc.X", "Nc.Y", "Nc.Z"};

void put_number(double value, float* into) { *into = static_cast<float>(value); }

void put_count(std::uint64_t count, float* into) {
  *into = static_cast<float>(static_cast<std::int64_t>(count));
}

void put_vector(const Vec3d& v, float* into) {
  for (int c = 0; c < 3; ++c) into[c] = static_cast<float>(v[c]);
}

constexpr Vec3d nowhere{infinity, infinity, infinity};

Vec3d camera_normal_of(const Surface& s, const MapView& view) {
  if (view.compatible) return normalized(view.eye - s.point() - s.normal());
  const Vec3d normal = s.normal();
  return {dot(normal, view.axes.right), dot(normal, view.axes.up), dot(normal, view.axes.forward)};
}

constexpr MapKind maps[] = {
    {.name = "depth",
     .title = "Depth",
     .unit = "scene units",
     .help = "distance to the first surface",
     .channels = z,
     .scale = MapScale::depth,
     .reduces = true,
     .put = [](const PixelFacts& p, const MapView&,
               float* into) { put_number(p.surface ? p.surface->distance() : infinity, into); }},
    {.name = "normal",
     .title = "Normal",
     .unit = "unit vector, world axes",
     .help = "normal of the first surface",
     .channels = normal,
     .scale = MapScale::normal,
     .reduces = true,
     .put = [](const PixelFacts& p, const MapView&,
               float* into) { put_vector(p.surface ? p.surface->normal() : nowhere, into); }},
    {.name = "normal-camera",
     .title = "Normal, camera",
     .unit = "unit vector, the camera's right, up and forward; compatible: world axes",
     .help =
         "normal of the first surface in the camera's axes; compatible: by the original renderer's formula",
     .channels = camera_normal,
     .scale = MapScale::normal,
     .reduces = true,
     .has_compatible = true,
     .put = [](const PixelFacts& p, const MapView& view,
               float* into) { put_vector(p.surface ? camera_normal_of(*p.surface, view) : nowhere, into); }},
    {.name = "coverage",
     .title = "Coverage",
     .unit = "share of the samples",
     .help = "share of the samples that show the first surface",
     .channels = coverage,
     .reduces = true,
     .put =
         [](const PixelFacts& p, const MapView&, float* into) {
           const std::uint64_t shown = p.surface ? p.surface->weight : 0;
           put_number(static_cast<double>(shown) / static_cast<double>(p.weight), into);
         }},
    {.name = "primary-rays",
     .title = "Primary rays",
     .unit = "rays",
     .help = "primary rays that hit something",
     .channels = primary,
     .put = [](const PixelFacts& p, const MapView&, float* into) { put_count(p.rays.primary_hits, into); }},
    {.name = "all-rays",
     .title = "All rays",
     .unit = "rays",
     .help = "rays of every kind that hit something, and shadow rays; compatible: without shadow rays",
     .channels = all,
     .source = MapSource::rays,
     .has_compatible = true,
     .put =
         [](const PixelFacts& p, const MapView& view, float* into) {
           const std::uint64_t hits = p.rays.primary_hits + p.rays.secondary_hits;
           put_count(view.compatible ? hits : hits + p.rays.shadow, into);
         }},
    {.name = "samples",
     .title = "Samples",
     .unit = "rays",
     .help = "primary rays",
     .channels = samples,
     .put = [](const PixelFacts& p, const MapView&, float* into) { put_count(p.rays.primary, into); }},
    {.name = "cost",
     .title = "Cost",
     .unit = "seconds",
     .help = "processor time on one thread; of a job: its tile's, over the tile's pixels",
     .channels = cost,
     .source = MapSource::time,
     .put = [](const PixelFacts& p, const MapView&, float* into) { put_number(p.seconds, into); }},
    {.name = "worker",
     .title = "Worker",
     .unit = "worker",
     .help = "who rendered the pixel; of a job alone",
     .channels = worker,
     .scale = MapScale::label,
     .source = MapSource::farm},
};

/// The compiler knows what it calls here: the maps of a pixel take a third of the time, and share what they ask of
/// its surface.
template <std::size_t i>
void put_one(const PixelFacts& pixel, const MapView& view, std::size_t place, float* into) {
  if constexpr (maps[i].source != MapSource::farm)
    if (into) maps[i].put(pixel, view, into + place * maps[i].channels.size());
}

}  // namespace

void put_all(const PixelFacts& pixel, const MapView& view, std::size_t place, std::span<float* const> into) {
  [&]<std::size_t... i>(std::index_sequence<i...>) { (put_one<i>(pixel, view, place, into[i]), ...); }
  (std::make_index_sequence<std::size(maps)>());
}

std::span<const MapKind> all_maps() { return maps; }

const MapKind* map_named(std::string_view name) {
  for (const MapKind& map : maps)
    if (map.name == name) return &map;
  return nullptr;
}

std::string listed(std::span<const std::string_view> names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += names[i];
  }
  return text;
}

std::string map_names() {
  std::vector<std::string_view> names;
  for (const MapKind& map : maps) names.push_back(map.name);
  return listed(names);
}

}  // namespace rayfarm
