// One job's work: which passes of which tiles are waiting, leased or done.
//
// Invariant: each (tile, pass) is in exactly one of the three. Taking leases it, finishing and giving back
// end that. Passes without pixels (at the film's edges) are done from the start. Taking and giving back cost
// O(log n) in the number of tiles given back, and amortised O(1) in all others.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include "common/render/tile.h"

namespace rayfarm {

/// Some passes of one tile.
struct Work {
  std::uint32_t tile = 0;
  PassSet passes = 0;
  bool operator==(const Work&) const = default;
};

class Schedule {
 public:
  explicit Schedule(Size film);

  /// For a local thread: one pass, the coarsest that is waiting anywhere; of these one given back, else the
  /// one nearest the centre.
  std::optional<Work> take_pass();
  /// For a remote worker: all passes waiting in one tile; a tile given back, else the one nearest the centre.
  std::optional<Work> take_tile();

  /// Passes that are waiting, whichever would be next.
  void take(const Work& work);

  // Both want passes that are leased.
  void give_back(const Work& work);
  void finish(const Work& work);

  /// Passes that are waiting were done before.
  void set_done(const Work& work);
  /// Passes that are done wait again.
  void undo(const Work& work);

  bool has_waiting() const { return waiting_count_ != 0; }
  PassSet waiting(std::uint32_t tile) const { return waiting_[tile]; }
  PassSet done(std::uint32_t tile) const { return done_[tile]; }
  PassSet leased(std::uint32_t tile) const { return all_passes & ~(waiting_[tile] | done_[tile]); }

 private:
  using Rank = std::uint32_t;  // place in the centre-first order

  Work take_at(Rank rank, PassSet passes);

  std::vector<std::uint32_t> order_;  // tile by rank
  std::vector<Rank> rank_;            // rank by tile
  std::vector<PassSet> waiting_, done_;
  std::uint64_t waiting_count_ = 0;
  std::array<std::set<Rank>, pass_count> given_back_;  // waiting again, by pass
  // Below these ranks nothing is waiting but what was given back; they only grow.
  std::array<Rank, pass_count> first_with_pass_{};
  Rank first_with_any_ = 0;
};

}  // namespace rayfarm
