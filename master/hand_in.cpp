#include "master/hand_in.h"

namespace rayfarm {

void hand_in(LiveFarm& live, WorkerId worker, ToMaster message) {
  live.apply([&](Farm& farm, FarmTime now) {
    if (auto* result = std::get_if<Result>(&message))
      farm.receive(worker, std::move(*result), now);
    else if (auto* piece = std::get_if<PieceResult>(&message))
      farm.receive(worker, std::move(*piece), now);
    else if (auto* given = std::get_if<GiveBack>(&message))
      farm.receive(worker, std::move(*given), now);
    else if (const auto* holds = std::get_if<Holds>(&message))
      farm.receive(worker, *holds, now);
    else
      throw WorkerError("it said something that it may not say in the middle of the conversation");
  });
}

}  // namespace rayfarm
