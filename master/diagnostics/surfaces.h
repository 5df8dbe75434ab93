// What a pixel shows, surface by surface.
//
// At an edge the mean of two surfaces' depths is the depth of no surface. So the samples are told apart by what
// they hit. Source of the idea: J. Friedman and A. C. Jones, Fully Automatic ID Mattes with Support for Motion
// Blur and Transparency (Cryptomatte), SIGGRAPH Posters 2015.
#pragma once
#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/render/hit.h"

namespace rayfarm {

/// Where a primary ray first met a surface.
struct SurfaceSample {
  std::uint32_t leaf = 0;
  bool into_leaf = true;  // on the leaf's near side, not from within it
  double distance = 0;
  Vec3d point{}, normal{};
};

inline SurfaceSample surface_sample(const Hit& hit) {
  return {hit.leaf, hit.leaf_entering, hit.t, hit.point, hit.normal};
}

/// One surface within a pixel: its samples' means.
struct Surface {
  std::uint32_t leaf = 0;
  std::uint64_t weight = 0;  // of the samples that show it
  double distance = 0;
  Vec3d point{}, normal{};  // the normal is unit
};

/// How the samples of a pixel become one value.
enum class Reduction : std::uint8_t {
  majority,  // the mean of the surface that most samples show; nothing if more show nothing
  mean,      // of all samples that hit, as the original renderer
  closest,   // the sample nearest to the camera
  median,    // the sample in the middle by distance, those that hit nothing behind all others
};

std::optional<Reduction> reduction_named(std::string_view name);
std::string_view name_of(Reduction reduction);

/// The surfaces of one pixel after another, in memory of a fixed size (but for the median, which needs all
/// samples).
///
/// A surface is one face of a leaf, and one sheet of it: a face that comes into view twice (a hole's near and far
/// side, the tube of a torus before its far side) is two. Four are told apart at a time; a fifth takes the place of the one that has been
/// outweighed by others, so whatever more than a fifth of the samples that hit show is among the four, and what
/// has lost its place joins the rest, which is no surface and is never shown. Source: J. Misra and D. Gries,
/// Finding Repeated Elements, Science of Computer Programming 2, 1982.
class PixelSurfaces {
 public:
  static constexpr std::size_t most = 4;

  PixelSurfaces(const World& world, Reduction reduction) : world_(&world.parts()), reduction_(reduction) {}

  void clear();
  /// The weight is a whole number; all of a pixel's samples have 1 unless the sampler is adaptive.
  void add(const SurfaceSample& sample, std::uint32_t weight);

  /// The greatest weight first; of equal ones the closer surface.
  std::vector<Surface> ranked() const;
  std::uint64_t rest() const { return rest_.weight; }
  /// None when the pixel shows nothing. `all`: the weight of all its samples, those that hit nothing too.
  std::optional<Surface> reduced(std::uint64_t all) const;

 private:
  struct Sums {
    std::uint64_t weight = 0;
    double distance = 0;
    Vec3d point{}, normal{};

    void add(const SurfaceSample& sample, std::uint32_t times);
    Sums& operator+=(const Sums& o);
    Surface mean(const SurfaceSample& any) const;
  };
  struct Rank {
    SurfaceSample first;
    bool is_cap = false;  // of a cylinder
    Sums sums;
    std::uint64_t lead = 0;  // what is left of its weight when others' is set off against it
  };

  bool shows(const Rank& rank, const SurfaceSample& sample) const;
  bool is_cap(const SurfaceSample& sample) const;
  void add_new(const SurfaceSample& sample, std::uint32_t weight);
  std::uint64_t hit_weight() const;
  Sums all_sums() const;
  std::optional<Surface> majority(std::uint64_t missed) const;
  std::optional<Surface> median(std::uint64_t all) const;

  const World::Parts* world_;
  Reduction reduction_;
  std::array<Rank, most> ranks_;
  std::size_t count_ = 0, last_ = 0;  // last_: of the sample before
  Sums rest_;
  SurfaceSample closest_{.distance = infinity};
  struct Weighed {
    SurfaceSample sample;
    std::uint32_t weight;
  };
  std::vector<Weighed> samples_;  // for the median alone
};

}  // namespace rayfarm
