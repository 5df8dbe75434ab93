#include "master/live_farm.h"

#include <spdlog/spdlog.h>

namespace rayfarm {

FarmTime LiveFarm::now() { return std::chrono::steady_clock::now().time_since_epoch(); }

LiveFarm::LogAtEnd::~LogAtEnd() {
  for (const FarmEvent& event : farm.take_events())
    spdlog::log(event.warning ? spdlog::level::warn : spdlog::level::info, "{}", event.text);
}

}  // namespace rayfarm
