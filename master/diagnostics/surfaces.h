// What a pixel shows, surface by surface.
//
// At an edge the mean of two surfaces' depths is the depth of no surface. So the samples are told apart by what
// they hit. Source of the idea: J. Friedman and A. C. Jones, Fully Automatic ID Mattes with Support for Motion
// Blur and Transparency (Cryptomatte), SIGGRAPH Posters 2015.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "common/render/hit.h"

namespace rayfarm {

/// Where a primary ray first met a surface.
struct SurfaceSample {
  std::uint32_t leaf = 0, face = 0;  // face: of a solid with edges
  double distance = 0;
  Vec3d point{}, normal{};
};

SurfaceSample surface_sample(const World::Parts& world, const Hit& hit);

/// One surface within a pixel: its samples' means.
struct Surface {
  std::uint32_t leaf = 0, face = 0;
  std::uint32_t samples = 0;  // of the pixel's that show it
  double distance = 0;
  Vec3d point{}, normal{};  // the normal is unit
};

/// Most samples first; of equally many the closer one. A face that comes into view twice (the tube of a torus
/// before its far side) is two surfaces. The numbers of samples add up to samples.size().
std::vector<Surface> ranked_surfaces(std::vector<SurfaceSample> samples);

/// How the samples of a pixel become one value.
enum class Reduction : std::uint8_t {
  majority,  // the mean of the surface that most samples show; nothing if more show nothing
  mean,      // of all samples that hit, as the original renderer
  closest,   // the sample nearest to the camera
  median,    // the sample in the middle by distance, those that hit nothing behind all others
};

std::optional<Reduction> reduction_named(std::string_view name);
std::string_view name_of(Reduction reduction);

/// None when the pixel shows nothing. `all`: the pixel's samples, those that hit nothing too.
std::optional<Surface> reduced(const std::vector<SurfaceSample>& hits, std::uint32_t all,
                               Reduction reduction);

}  // namespace rayfarm
