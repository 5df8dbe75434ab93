// All workers as people see them: those that are here, those that are dialled and not reached, and those that
// are banned.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include "master/http/doors.h"

namespace rayfarm {

struct WorkerList {
  std::vector<WorkerView> here;
  std::vector<Dialling> dialled;
  std::vector<std::string> banned;
};

/// On the farm's thread.
WorkerList worker_list(const Farm& farm, const MasterDoor& master);
nlohmann::json to_json(const WorkerList& list, FarmTime now);

}  // namespace rayfarm
