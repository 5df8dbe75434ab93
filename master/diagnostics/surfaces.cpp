#include "master/diagnostics/surfaces.h"

#include <algorithm>

#include "common/math/number.h"

namespace rayfarm {
namespace {

/// A normal of a leaf that has caps: along its axis for the caps, never for the side.
bool is_of_cap(const Leaf& leaf, const Vec3d& normal) {
  const Vec3d& axis = leaf.row[2];
  const double along = dot(normal, axis);
  return along * along > (1 - 1e-12) * dot(axis, axis);
}

constexpr std::array<std::string_view, 7> names{"majority", "second",  "third", "fourth",
                                                "mean",     "closest", "median"};

}  // namespace

std::span<const std::string_view> reduction_names() { return names; }

std::optional<Reduction> reduction_named(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Reduction>(i);
  return std::nullopt;
}

std::string_view name_of(Reduction reduction) { return names[static_cast<std::size_t>(reduction)]; }

Surface& Surface::operator+=(const Surface& o) {
  weight += o.weight, distances += o.distances;
  points += o.points, normals += o.normals;
  return *this;
}

void PixelSurfaces::keep(const Hit& sample, std::uint32_t weight) {
  const bool keeps_all = reduction_ == Reduction::median;
  if (!keeps_all && !kept_.empty() && sample.t >= kept_[0].first.t) return;
  if (keeps_all || kept_.empty()) kept_.emplace_back();
  begin(kept_.back(), sample, keeps_all ? weight : 1);
}

void PixelSurfaces::find_and_add(const Hit& sample, std::uint32_t weight) {
  for (std::size_t n = 0; n < count_; ++n) {
    const std::size_t i = (last_ + n) % count_;
    if (!shows(ranks_[i].first, sample)) continue;
    ranks_[i].add(sample, weight);
    last_ = i;
    return;
  }
  if (count_ == most) return displace(sample, weight);
  last_ = count_++;
  begin(ranks_[last_], sample, weight);
}

bool PixelSurfaces::shows(const Glimpse& first, const Hit& sample) const {
  if (plainly_shows(first, sample)) return true;
  if (first.faces != Faces::caps || !is_of_leaf(first, sample)) return false;
  const Leaf& leaf = world_->leaves[sample.leaf];
  return !is_of_cap(leaf, first.normal) && !is_of_cap(leaf, sample.normal) && on_one_sheet(first, sample);
}

void PixelSurfaces::displace(const Hit& sample, std::uint32_t weight) {
  std::size_t weakest = 0;
  for (std::size_t i = 1; i < most; ++i)
    if (lead(i) < lead(weakest) || (lead(i) == lead(weakest) && ranks_[i].weight < ranks_[weakest].weight))
      weakest = i;
  const std::uint64_t less = std::min<std::uint64_t>(weight, lead(weakest));
  for (std::uint64_t& set_off : set_off_) set_off += less;
  if (less == weight) return rest_.add(sample, weight);
  rest_ += ranks_[weakest];
  begin(ranks_[weakest], sample, weight);
  set_off_[weakest] = less;
  last_ = weakest;
}

std::vector<const Surface*> PixelSurfaces::in_order() const {
  std::vector<const Surface*> surfaces;
  for (std::size_t i = 0; i < count_; ++i) surfaces.push_back(&ranks_[i]);
  std::sort(surfaces.begin(), surfaces.end(), [](const Surface* a, const Surface* b) {
    return a->weight != b->weight ? a->weight > b->weight : a->distance() < b->distance();
  });
  return surfaces;
}

std::vector<Surface> PixelSurfaces::ranked() const {
  std::vector<Surface> surfaces;
  for (const Surface* surface : in_order()) surfaces.push_back(*surface);
  return surfaces;
}

std::uint64_t PixelSurfaces::hit_weight() const {
  std::uint64_t weight = rest_.weight;
  for (std::size_t i = 0; i < count_; ++i) weight += ranks_[i].weight;
  return weight;
}

const Surface* PixelSurfaces::reduced(std::uint64_t all) {
  if (count_ == 0) return nullptr;
  switch (reduction_) {
    case Reduction::majority:
      return majority(all - hit_weight());
    case Reduction::second:
    case Reduction::third:
    case Reduction::fourth: {
      const auto rank = static_cast<std::size_t>(reduction_);
      return rank < count_ ? in_order()[rank] : nullptr;
    }
    case Reduction::mean:
      return mean();
    case Reduction::closest:
      return &kept_[0];
    case Reduction::median:
      return median(all);
  }
  return nullptr;
}

const Surface* PixelSurfaces::majority(std::uint64_t missed) const {
  const Surface* best = &ranks_[0];
  for (std::size_t i = 1; i < count_; ++i) {
    const Surface& other = ranks_[i];
    if (other.weight > best->weight || (other.weight == best->weight && other.distance() < best->distance()))
      best = &other;
  }
  return best->weight < missed ? nullptr : best;
}

const Surface* PixelSurfaces::mean() {
  all_ = ranks_[0];
  for (std::size_t i = 1; i < count_; ++i) all_ += ranks_[i];
  all_ += rest_;
  return &all_;
}

const Surface* PixelSurfaces::median(std::uint64_t all) {
  std::sort(kept_.begin(), kept_.end(),
            [](const Surface& a, const Surface& b) { return a.first.t < b.first.t; });
  std::uint64_t before = 0;
  for (const Surface& sample : kept_) {
    before += sample.weight;
    if (2 * before >= all) return &sample;
  }
  return nullptr;
}

}  // namespace rayfarm
