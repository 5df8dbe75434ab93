#include "master/schedule.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace rayfarm {
namespace {

constexpr PassSet bit(int pass) { return static_cast<PassSet>(1u << pass); }

}  // namespace

Schedule::Schedule(Size film)
    : order_(centre_first(film)), rank_(order_.size()), waiting_(order_.size()), done_(order_.size()) {
  for (Rank rank = 0; rank < order_.size(); ++rank) {
    const std::uint32_t tile = order_[rank];
    rank_[tile] = rank;
    for (int pass = 0; pass < pass_count; ++pass)
      (pixel_count(tile_at(film, tile), pass) > 0 ? waiting_ : done_)[tile] |= bit(pass);
    waiting_count_ += std::popcount(waiting_[tile]);
  }
}

std::optional<Work> Schedule::take_pass() {
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!given_back_[pass].empty()) return take_at(*given_back_[pass].begin(), bit(pass));
    Rank& first = first_with_pass_[pass];
    while (first < order_.size() && !(waiting_[order_[first]] & bit(pass))) ++first;
    if (first < order_.size()) return take_at(first, bit(pass));
  }
  return std::nullopt;
}

std::optional<Work> Schedule::take_tile() {
  std::optional<Rank> nearest;
  for (const std::set<Rank>& ranks : given_back_)
    if (!ranks.empty()) nearest = std::min(nearest.value_or(*ranks.begin()), *ranks.begin());
  if (nearest) return take_at(*nearest, waiting_[order_[*nearest]]);

  while (first_with_any_ < order_.size() && !waiting_[order_[first_with_any_]]) ++first_with_any_;
  if (first_with_any_ == order_.size()) return std::nullopt;
  return take_at(first_with_any_, waiting_[order_[first_with_any_]]);
}

void Schedule::take(const Work& work) { take_at(rank_[work.tile], work.passes); }

Work Schedule::take_at(Rank rank, PassSet passes) {
  const Work work{order_[rank], passes};
  assert((waiting_[work.tile] & passes) == passes);
  waiting_[work.tile] &= ~passes;
  waiting_count_ -= std::popcount(passes);
  for (int pass = 0; pass < pass_count; ++pass)
    if (passes & bit(pass)) given_back_[pass].erase(rank);
  return work;
}

void Schedule::give_back(const Work& work) {
  assert((leased(work.tile) & work.passes) == work.passes);
  waiting_[work.tile] |= work.passes;
  waiting_count_ += std::popcount(work.passes);
  for (int pass = 0; pass < pass_count; ++pass)
    if (work.passes & bit(pass)) given_back_[pass].insert(rank_[work.tile]);
}

void Schedule::set_done(const Work& work) {
  take(work);
  finish(work);
}

void Schedule::undo(const Work& work) {
  assert((done_[work.tile] & work.passes) == work.passes);
  done_[work.tile] &= ~work.passes;
  give_back(work);
}

void Schedule::finish(const Work& work) {
  assert((leased(work.tile) & work.passes) == work.passes);
  done_[work.tile] |= work.passes;
}

}  // namespace rayfarm
