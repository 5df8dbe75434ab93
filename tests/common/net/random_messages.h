// One of each message with random values, for laws that hold for all of them.
#pragma once
#include <random>

#include "common/net/codec.h"

namespace rayfarm {

/// Any scene that passes check(), with names and everything else that is optional.
Scene named_scene(std::mt19937_64& random);
std::vector<ToWorker> random_to_worker(std::mt19937_64& random);
std::vector<ToMaster> random_to_master(std::mt19937_64& random);
/// The pixels of a pass of a whole tile, any bits: also infinities and NaNs with payloads.
PassImage random_pass(std::mt19937_64& random, int pass);

}  // namespace rayfarm
