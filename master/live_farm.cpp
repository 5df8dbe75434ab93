#include "master/live_farm.h"

#include <spdlog/spdlog.h>

#include "master/farm_record.h"

namespace rayfarm {

FarmTime LiveFarm::now() { return std::chrono::steady_clock::now().time_since_epoch(); }

void LiveFarm::note(FarmEvent event) {
  spdlog::log(event.warning ? spdlog::level::warn : spdlog::level::info, "{}", event.text);
  log_.add(std::move(event), now());
}

LiveFarm::LogAtEnd::~LogAtEnd() {
  for (FarmEvent& event : live.farm_.take_events()) live.note(std::move(event));
  live.farm_.take_records();  // nobody keeps them
}

}  // namespace rayfarm
