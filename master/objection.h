// What keeps a peer from becoming a worker, in words that say what to do.
#pragma once
#include <string>

#include "common/net/messages.h"

namespace rayfarm {

/// Why a worker that opens with this is not taken in; empty when it is. It must speak a protocol that we do, and render
/// the same bits.
std::string objection_to(const ToMaster& first);
/// Why there is no protocol to be spoken; empty when there is.
std::string objection_to(const Versions& theirs, const std::string& software);

}  // namespace rayfarm
