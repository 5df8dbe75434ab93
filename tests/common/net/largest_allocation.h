// The largest single allocation of this test program, to show that no announced length is believed.
#pragma once
#include <cstddef>

namespace rayfarm {

/// Since the last call.
std::size_t take_largest_allocation();

}  // namespace rayfarm
