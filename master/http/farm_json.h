// Jobs and workers as the HTTP API shows them.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "master/farm.h"

namespace rayfarm {

/// Times are seconds, counted from `now` or between two events; what is not known yet is null.
nlohmann::json to_json(const JobView& job, FarmTime now);
nlohmann::json to_json(const FrameView& frame);
nlohmann::json to_json(const WorkerView& worker, FarmTime now);

}  // namespace rayfarm
