#include "master/diagnostics/surfaces.h"

#include <algorithm>

#include "common/math/number.h"

namespace rayfarm {
namespace {

FlatFaces flat_faces_of(const Solid& solid) {
  return std::visit([](const auto& s) { return s.flat_faces; }, solid);
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

PixelSurfaces::Sums& PixelSurfaces::Sums::operator+=(const Sums& o) {
  weight += o.weight, distance += o.distance;
  point += o.point, normal += o.normal;
  return *this;
}

Surface PixelSurfaces::Sums::mean(const Glimpse& any) const {
  const auto all = static_cast<double>(weight);
  // Opposite normals cancel out; then one of them stands for all.
  const bool cancelled = normal == Vec3d{};
  return {any.leaf, weight, distance / all, point * (1 / all), cancelled ? any.normal : normalized(normal)};
}

void PixelSurfaces::clear() {
  count_ = last_ = 0;
  rest_ = {};
  closest_.t = infinity;
  samples_.clear();
}

void PixelSurfaces::keep(const Hit& sample, std::uint32_t weight) {
  if (sample.t < closest_.t) closest_ = sample;
  if (reduction_ == Reduction::median) samples_.push_back({sample, weight});
}

void PixelSurfaces::find_and_add(const Hit& sample, std::uint32_t weight) {
  const auto add_to = [&](std::size_t i) {
    ranks_[i].sums.add(sample, weight);
    last_ = i;
  };
  if (last_ < count_ && shows(ranks_[last_], sample)) return add_to(last_);
  for (std::size_t i = 0; i < count_; ++i)
    if (i != last_ && shows(ranks_[i], sample)) return add_to(i);
  add_new(sample, weight);
}

bool PixelSurfaces::shows(const Rank& rank, const Hit& sample) const {
  if (plainly_shows(rank, sample)) return true;
  return rank.flat_faces == FlatFaces::caps && is_of_leaf(rank, sample) && !rank.is_cap && !is_cap(sample) &&
         on_one_sheet(rank.first, sample);
}

void PixelSurfaces::add_new(const Hit& sample, std::uint32_t weight) {
  std::uint64_t set_off = 0;
  if (count_ < most) {
    last_ = count_++;
  } else {
    const auto weakest = std::min_element(ranks_.begin(), ranks_.end(), [](const Rank& a, const Rank& b) {
      return a.lead() != b.lead() ? a.lead() < b.lead() : a.sums.weight < b.sums.weight;
    });
    set_off = std::min<std::uint64_t>(weight, weakest->lead());
    for (Rank& rank : ranks_) rank.set_off += set_off;
    if (set_off == weight) return rest_.add(sample, weight);
    rest_ += weakest->sums;
    last_ = static_cast<std::size_t>(weakest - ranks_.begin());
  }
  Rank& rank = ranks_[last_];
  rank.first = Glimpse(sample);
  rank.flat_faces = flat_faces_of(world_->leaves[sample.leaf].solid);
  rank.is_cap = rank.flat_faces == FlatFaces::caps && is_cap(sample);
  rank.sums = {};
  rank.sums.add(sample, weight);
  rank.set_off = set_off;
}

bool PixelSurfaces::is_cap(const Hit& sample) const {
  const Vec3d& axis =
      world_->leaves[sample.leaf].row[2];  // normals of the caps lie along it, those of the side never
  const double along = dot(sample.normal, axis);
  return along * along > (1 - 1e-12) * dot(axis, axis);
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
    case Reduction::second:
    case Reduction::third:
    case Reduction::fourth: {
      const std::vector<Surface> surfaces = ranked();
      const auto rank = static_cast<std::size_t>(reduction_);
      return rank < surfaces.size() ? std::optional(surfaces[rank]) : std::nullopt;
    }
    case Reduction::mean:
      return all_sums().mean(ranks_[0].first);
    case Reduction::closest:
      return Surface{closest_.leaf, 1, closest_.t, closest_.point, closest_.normal};
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
            [](const Weighed& a, const Weighed& b) { return a.sample.t < b.sample.t; });
  std::uint64_t before = 0;
  for (const auto& [s, weight] : sorted) {
    before += weight;
    if (2 * before >= all) return Surface{s.leaf, weight, s.t, s.point, s.normal};
  }
  return std::nullopt;
}

}  // namespace rayfarm
