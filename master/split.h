// The end of a picture in smaller pieces: a tile that one thread would be late with is shared by several that have
// nothing to do.
//
// Pieces are a matter of dispatch only: their pixels and counters are put together before anybody else sees them, and
// are those of the whole tile.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "common/render/film.h"
#include "master/tail.h"

namespace rayfarm {

/// Into how many pieces each of so many tiles of one cost should be cut, so that so many threads, at least 1, are done
/// soonest: 1, 4 or 16, and no more than help.
std::uint32_t pieces_each(std::size_t tiles, std::uint32_t threads);
/// So many squares, row by row; those at the film's edges may be smaller, or not there.
std::vector<Tile> pieces_of(const Tile& tile, std::uint32_t count);

/// The tile's passes as one thread would have made them; images[i] are of pieces[i], all of the same passes.
std::vector<PassImage> assembled(const Tile& tile, std::span<const Tile> pieces,
                                 std::span<const std::vector<PassImage>> images);

/// What is to be shared, and in how many pieces.
struct Share {
  std::size_t straggler = 0;  // its place in the list
  std::uint32_t pieces = 4;
  bool operator==(const Share&) const = default;
};
/// Whether its holder has put next to nothing into it yet: it can be taken away.
bool is_hardly_begun(const Straggler& straggler);
/// What ends last first, as long as all idle threads together would be sooner with it, and with what comes before it.
/// The holder's thread helps when the work is taken away from it. O(n log n).
std::vector<Share> shares_of(std::span<const Straggler> stragglers, std::span<const IdleWorker> idle);

}  // namespace rayfarm
