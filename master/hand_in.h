// What any worker says, brought to the farm.
#pragma once
#include "common/net/messages.h"
#include "master/live_farm.h"

namespace rayfarm {

/// Throws WorkerError when the message breaks the rules of the conversation.
void hand_in(LiveFarm& farm, WorkerId worker, ToMaster message);

}  // namespace rayfarm
