#include "master/diagnostics/surfaces.h"

#include <algorithm>

#include "common/math/number.h"

namespace rayfarm {
namespace {

FlatFaces flat_faces_of(const Solid& solid) {
  return std::visit([](const auto& s) { return s.flat_faces; }, solid);
}

/// Whether two points of a face lie on one sheet of it, as seen from about the same place.
///
/// Of a sheet that bends one way, the chord between two points rises from the tangent plane at one of them and
/// comes down to that at the other. Of two sheets, one behind the other and both facing the viewer, it comes
/// down to both. Points side by side may have a relief between them.
bool on_one_sheet(const SurfaceSample& a, const SurfaceSample& b) {
  constexpr double flat = 0.05, steepest = 0.8;  // sines of the angles between chord and tangent planes
  const Vec3d chord = b.point - a.point;
  const double length_2 = dot(chord, chord);
  const double rise_a = dot(a.normal, chord), rise_b = dot(b.normal, chord);
  const double most_2 = greatest(rise_a * rise_a, rise_b * rise_b);
  if (most_2 <= flat * flat * length_2) return true;
  if (most_2 > steepest * steepest * length_2) return false;
  const double behind = b.distance - a.distance;
  const bool side_by_side = behind * behind <= 0.75 * length_2;  // at 60 degrees to the view at most
  return side_by_side || rise_a * rise_b <= 0;
}

constexpr std::array<std::string_view, 4> reduction_names{"majority", "mean", "closest", "median"};

}  // namespace

std::optional<Reduction> reduction_named(std::string_view name) {
  for (std::size_t i = 0; i < reduction_names.size(); ++i)
    if (reduction_names[i] == name) return static_cast<Reduction>(i);
  return std::nullopt;
}

std::string_view name_of(Reduction reduction) { return reduction_names[static_cast<std::size_t>(reduction)]; }

void PixelSurfaces::Sums::add(const SurfaceSample& s, std::uint32_t times) {
  const double factor = times;
  weight += times;
  distance += factor * s.distance;
  point += factor * s.point;
  normal += factor * s.normal;
}

PixelSurfaces::Sums& PixelSurfaces::Sums::operator+=(const Sums& o) {
  weight += o.weight, distance += o.distance;
  point += o.point, normal += o.normal;
  return *this;
}

Surface PixelSurfaces::Sums::mean(const SurfaceSample& any) const {
  const auto all = static_cast<double>(weight);
  // Opposite normals cancel out; then one of them stands for all.
  const bool cancelled = normal == Vec3d{};
  return {any.leaf, weight, distance / all, point * (1 / all), cancelled ? any.normal : normalized(normal)};
}

void PixelSurfaces::clear() {
  count_ = last_ = 0;
  rest_ = {};
  closest_.distance = infinity;
  samples_.clear();
}

void PixelSurfaces::add(const SurfaceSample& sample, std::uint32_t weight) {
  if (sample.distance < closest_.distance) closest_ = sample;
  if (reduction_ == Reduction::median) samples_.push_back({sample, weight});
  const auto add_to = [&](std::size_t i) {
    ranks_[i].sums.add(sample, weight);
    ranks_[i].lead += weight;
    last_ = i;
  };
  if (last_ < count_ && shows(ranks_[last_], sample)) return add_to(last_);
  for (std::size_t i = 0; i < count_; ++i)
    if (i != last_ && shows(ranks_[i], sample)) return add_to(i);
  add_new(sample, weight);
}

void PixelSurfaces::add_new(const SurfaceSample& sample, std::uint32_t weight) {
  std::uint64_t lead = weight;
  if (count_ < most) {
    last_ = count_++;
  } else {
    const auto weakest = std::min_element(ranks_.begin(), ranks_.end(), [](const Rank& a, const Rank& b) {
      return a.lead != b.lead ? a.lead < b.lead : a.sums.weight < b.sums.weight;
    });
    const std::uint64_t set_off = std::min<std::uint64_t>(weight, weakest->lead);
    for (Rank& rank : ranks_) rank.lead -= set_off;
    lead -= set_off;
    if (lead == 0) return rest_.add(sample, weight);
    rest_ += weakest->sums;
    last_ = static_cast<std::size_t>(weakest - ranks_.begin());
  }
  ranks_[last_] = {sample, is_cap(sample), {}, lead};
  ranks_[last_].sums.add(sample, weight);
}

bool PixelSurfaces::is_cap(const SurfaceSample& sample) const {
  const Leaf& leaf = world_->leaves[sample.leaf];
  if (flat_faces_of(leaf.solid) != FlatFaces::caps) return false;
  const Vec3d& axis = leaf.row[2];  // normals of the caps lie along it, those of the side never
  const double along = dot(sample.normal, axis);
  return along * along > (1 - 1e-12) * dot(axis, axis);
}

/// Whether the sample lies on the rank's face, and on the same sheet of it.
bool PixelSurfaces::shows(const Rank& rank, const SurfaceSample& sample) const {
  if (sample.leaf != rank.first.leaf || sample.into_leaf != rank.first.into_leaf) return false;
  if (sample.normal != rank.first.normal) {
    const Leaf& leaf = world_->leaves[sample.leaf];
    if (flat_faces_of(leaf.solid) == FlatFaces::all) return false;
    if (rank.is_cap || is_cap(sample)) return false;
  }
  return on_one_sheet(rank.first, sample);
}

std::vector<Surface> PixelSurfaces::ranked() const {
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < count_; ++i) surfaces.push_back(ranks_[i].sums.mean(ranks_[i].first));
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface& a, const Surface& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.distance < b.distance;
  });
  return surfaces;
}

PixelSurfaces::Sums PixelSurfaces::all_sums() const {
  Sums all = rest_;
  for (std::size_t i = 0; i < count_; ++i) all += ranks_[i].sums;
  return all;
}

std::uint64_t PixelSurfaces::hit_weight() const {
  std::uint64_t weight = rest_.weight;
  for (std::size_t i = 0; i < count_; ++i) weight += ranks_[i].sums.weight;
  return weight;
}

std::optional<Surface> PixelSurfaces::reduced(std::uint64_t all) const {
  if (count_ == 0) return std::nullopt;
  switch (reduction_) {
    case Reduction::majority:
      return majority(all - hit_weight());
    case Reduction::mean:
      return all_sums().mean(ranks_[0].first);
    case Reduction::closest:
      return Surface{closest_.leaf, 1, closest_.distance, closest_.point, closest_.normal};
    case Reduction::median:
      return median(all);
  }
  return std::nullopt;
}

std::optional<Surface> PixelSurfaces::majority(std::uint64_t missed) const {
  std::size_t best = 0;
  const auto mean_distance = [&](std::size_t i) {
    return ranks_[i].sums.distance / static_cast<double>(ranks_[i].sums.weight);
  };
  for (std::size_t i = 1; i < count_; ++i) {
    const std::uint64_t weight = ranks_[i].sums.weight, most_yet = ranks_[best].sums.weight;
    if (weight > most_yet || (weight == most_yet && mean_distance(i) < mean_distance(best))) best = i;
  }
  if (ranks_[best].sums.weight < missed) return std::nullopt;
  return ranks_[best].sums.mean(ranks_[best].first);
}

std::optional<Surface> PixelSurfaces::median(std::uint64_t all) const {
  std::vector<Weighed> sorted = samples_;
  std::sort(sorted.begin(), sorted.end(),
            [](const Weighed& a, const Weighed& b) { return a.sample.distance < b.sample.distance; });
  std::uint64_t before = 0;
  for (const auto& [s, weight] : sorted) {
    before += weight;
    if (2 * before >= all) return Surface{s.leaf, weight, s.distance, s.point, s.normal};
  }
  return std::nullopt;
}

}  // namespace rayfarm
