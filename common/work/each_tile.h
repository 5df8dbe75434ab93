// Work on each tile of a film, by threads that live as long as it takes.
#pragma once
#include <functional>

#include "common/render/tile.h"

namespace rayfarm {

/// Calls work(tile number) for all tiles, nearest the centre first, from so many threads at once, until one
/// call says false: then false. `progress()` is called about ten times a second by the calling thread. What
/// work throws, is thrown here.
bool each_tile(Size film, unsigned threads, const std::function<bool(std::uint32_t)>& work,
               const std::function<void()>& progress);

}  // namespace rayfarm
