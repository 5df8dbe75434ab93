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

#include "common/math/number.h"
#include "common/render/hit.h"

namespace rayfarm {

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
  second,    // that of the surface with the second most samples, if there is one; and so on
  third,
  fourth,
  mean,     // of all samples that hit, as the original renderer
  closest,  // the sample nearest to the camera
  median,   // the sample in the middle by distance, those that hit nothing behind all others
};

/// What tells surfaces apart of a hit.
struct Glimpse {
  explicit Glimpse(const Hit& hit)
      : leaf(hit.leaf), leaf_entering(hit.leaf_entering), t(hit.t), point(hit.point), normal(hit.normal) {}
  Glimpse() = default;

  std::uint32_t leaf = 0;
  bool leaf_entering = false;
  double t = 0;
  Vec3d point{}, normal{};
};

/// Whether two points of a face lie on one sheet of it, as seen from about the same place.
///
/// Of a sheet that bends one way, the chord between two points rises from the tangent plane at one of them and
/// comes down to that at the other. Of two sheets, one behind the other and both facing the viewer, it comes
/// down to both. Points side by side may have a relief between them.
inline bool on_one_sheet(const Glimpse& a, const Hit& b) {
  constexpr double flat = 0.05, steepest = 0.8;  // sines of the angles between chord and tangent planes
  const Vec3d chord = b.point - a.point;
  const double length_2 = dot(chord, chord);
  const double rise_a = dot(a.normal, chord), rise_b = dot(b.normal, chord);
  const double most_2 = greatest(rise_a * rise_a, rise_b * rise_b);
  if (most_2 <= flat * flat * length_2) return true;
  if (most_2 > steepest * steepest * length_2) return false;
  const double behind = b.t - a.t;
  const bool side_by_side = behind * behind <= 0.75 * length_2;  // at 60 degrees to the view at most
  return side_by_side || rise_a * rise_b <= 0;
}

std::span<const std::string_view> reduction_names();
std::optional<Reduction> reduction_named(std::string_view name);
std::string_view name_of(Reduction reduction);

/// The surfaces of one pixel after another, in memory of a fixed size (but for the median, which needs all
/// samples).
///
/// A surface is one face of a leaf, and one sheet of it: a face that comes into view twice (a hole's near and far
/// side, the tube of a torus before its far side) is two. Four are told apart at a time; a fifth takes the place of
/// the one that has been outweighed by others, so whatever more than a fifth of the samples that hit show is among
/// the four, and what has lost its place joins the rest, which is no surface and is never shown. Source: J. Misra
/// and D. Gries, Finding Repeated Elements, Science of Computer Programming 2, 1982.
///
/// Nearly all samples show what the one before them showed: that much is inline and copies nothing.
class PixelSurfaces {
 public:
  static constexpr std::size_t most = 4;

  PixelSurfaces(const World& world, Reduction reduction) : world_(&world.parts()), reduction_(reduction) {}

  void clear();
  /// The weight is a whole number; all of a pixel's samples have 1 unless the sampler is adaptive.
  void add(const Hit& sample, std::uint32_t weight) {
    if (reduction_ >= Reduction::closest) keep(sample, weight);
    if (last_ < count_ && plainly_shows(ranks_[last_], sample))
      ranks_[last_].sums.add(sample, weight);
    else
      find_and_add(sample, weight);
  }

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

    void add(const Hit& sample, std::uint32_t times) {
      const double factor = times;
      weight += times;
      distance += factor * sample.t;
      point += factor * sample.point;
      normal += factor * sample.normal;
    }
    Sums& operator+=(const Sums& o);
    Surface mean(const Glimpse& any) const;
  };
  struct Rank {
    Glimpse first;
    FlatFaces flat_faces = FlatFaces::none;  // of the leaf
    bool is_cap = false;                     // of a cylinder or cone
    Sums sums;
    std::uint64_t set_off = 0;  // of its weight, against that of others

    std::uint64_t lead() const { return sums.weight - set_off; }
  };

  static bool is_of_leaf(const Rank& rank, const Hit& sample) {
    return sample.leaf == rank.first.leaf && sample.leaf_entering == rank.first.leaf_entering;
  }
  /// Whether the sample lies on the rank's face, and on the same sheet of it, as far as that is seen at a glance.
  static bool plainly_shows(const Rank& rank, const Hit& sample) {
    if (!is_of_leaf(rank, sample)) return false;
    return rank.flat_faces == FlatFaces::none ? on_one_sheet(rank.first, sample)
                                              : sample.normal == rank.first.normal;
  }
  bool shows(const Rank& rank, const Hit& sample) const;
  bool is_cap(const Hit& sample) const;  // of a leaf that has caps
  void keep(const Hit& sample, std::uint32_t weight);
  void find_and_add(const Hit& sample, std::uint32_t weight);
  void add_new(const Hit& sample, std::uint32_t weight);
  std::uint64_t hit_weight() const;
  Sums all_sums() const;
  std::optional<Surface> majority(std::uint64_t missed) const;
  std::optional<Surface> median(std::uint64_t all) const;

  const World::Parts* world_;
  Reduction reduction_;
  std::array<Rank, most> ranks_;
  std::size_t count_ = 0, last_ = 0;  // last_: of the sample before
  Sums rest_;
  Hit closest_{.t = infinity};
  struct Weighed {
    Hit sample;
    std::uint32_t weight;
  };
  std::vector<Weighed> samples_;  // for the median alone
};

}  // namespace rayfarm
