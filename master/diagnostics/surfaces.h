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
  std::uint32_t leaf = 0;
  bool leaf_entering = false;
  Faces faces = Faces::one;  // of the leaf
  double t = 0;
  Vec3d point{}, normal{};
};

/// One surface within a pixel: the sums of its samples. What nobody asks of it is not worked out.
struct Surface {
  Glimpse first;             // of its samples
  std::uint64_t weight = 0;  // of them all
  double distances = 0;
  Vec3d points{}, normals{};

  /// Its first sample, so many times.
  void begin(const Hit& sample, Faces faces, std::uint32_t times) {
    first.leaf = sample.leaf, first.leaf_entering = sample.leaf_entering, first.faces = faces;
    first.t = sample.t, first.point = sample.point, first.normal = sample.normal;
    const double factor = times;
    weight = times;
    distances = factor * sample.t;
    points = factor * sample.point;
    normals = factor * sample.normal;
  }
  void add(const Hit& sample, std::uint32_t times) {
    const double factor = times;
    weight += times;
    distances += factor * sample.t;
    points += factor * sample.point;
    normals += factor * sample.normal;
  }
  /// What is added to one with weight keeps the one's first sample.
  Surface& operator+=(const Surface& o);

  std::uint32_t leaf() const { return first.leaf; }
  double distance() const { return distances / static_cast<double>(weight); }  // the mean, as all of these
  Vec3d point() const { return points * (1 / static_cast<double>(weight)); }
  /// Unit. Opposite normals cancel out; then one of them stands for all.
  Vec3d normal() const { return normals == Vec3d{} ? first.normal : normalized(normals); }
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
/// side, the tube of a torus before its far side) is two. What is convex and smooth has one for rays that enter and one
/// for rays that leave. Four are told apart at a time; a fifth takes the place of
/// the one that has been outweighed by others, so whatever more than a fifth of the samples that hit show is among
/// the four, and what has lost its place joins the rest, which is no surface and is never shown. Source: J. Misra
/// and D. Gries, Finding Repeated Elements, Science of Computer Programming 2, 1982.
///
/// Nearly all samples show what the one before them showed: that much is inline and copies nothing.
class PixelSurfaces {
 public:
  static constexpr std::size_t most = 4;

  PixelSurfaces(const World& world, Reduction reduction) : world_(&world.parts()), reduction_(reduction) {}

  void clear() {
    if (count_ == most) rest_ = {}, set_off_ = {};
    count_ = last_ = 0;
    kept_.clear();
  }
  /// The weight is a whole number; all of a pixel's samples have 1 unless the sampler is adaptive.
  void add(const Hit& sample, std::uint32_t weight) {
    if (reduction_ >= Reduction::closest) keep(sample, weight);
    if (count_ == 0)
      begin(ranks_[count_++], sample, weight);
    else if (plainly_shows(ranks_[last_].first, sample))
      ranks_[last_].add(sample, weight);
    else
      find_and_add(sample, weight);
  }

  /// The greatest weight first; of equal ones the closer surface.
  std::vector<Surface> ranked() const;
  std::uint64_t rest() const { return rest_.weight; }
  /// None when the pixel shows nothing. `all`: the weight of all its samples, those that hit nothing too.
  /// Good until more is added or asked for.
  const Surface* reduced(std::uint64_t all);

 private:
  static bool is_of_leaf(const Glimpse& first, const Hit& sample) {
    return sample.leaf == first.leaf && sample.leaf_entering == first.leaf_entering;
  }
  /// Whether the sample lies on the same face, and on the same sheet of it, as far as that is seen at a glance.
  static bool plainly_shows(const Glimpse& first, const Hit& sample) {
    if (!is_of_leaf(first, sample)) return false;
    if (first.faces == Faces::one) return true;
    return first.faces == Faces::round ? on_one_sheet(first, sample) : sample.normal == first.normal;
  }
  void begin(Surface& surface, const Hit& sample, std::uint32_t weight) const {
    const Solid& solid = world_->leaves[sample.leaf].solid;
    surface.begin(sample, std::visit([](const auto& s) { return s.faces; }, solid), weight);
  }
  bool shows(const Glimpse& first, const Hit& sample) const;
  std::uint64_t lead(std::size_t rank) const { return ranks_[rank].weight - set_off_[rank]; }
  void keep(const Hit& sample, std::uint32_t weight);
  void find_and_add(const Hit& sample, std::uint32_t weight);
  void displace(const Hit& sample, std::uint32_t weight);
  std::uint64_t hit_weight() const;
  std::vector<const Surface*> in_order() const;
  const Surface* majority(std::uint64_t missed) const;
  const Surface* mean();
  const Surface* median(std::uint64_t all);

  const World::Parts* world_;
  Reduction reduction_;
  std::size_t count_ = 0, last_ = 0;  // last_: of the sample before
  std::vector<Surface> kept_;         // one sample each: all of them for the median, one for the closest
  alignas(64) std::array<Surface, most> ranks_;  // of two lines of a cache each
  std::array<std::uint64_t, most> set_off_{};    // of a rank's weight, against that of others
  Surface rest_, all_;                           // all_: for the mean
};

}  // namespace rayfarm
