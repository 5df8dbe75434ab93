#include "master/http/worker_list.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "master/http/farm_json.h"

namespace rayfarm {
namespace {

using nlohmann::json;

json absent(const std::string& name, const char* state, const std::string& address,
            const std::string& message) {
  WorkerView view;
  view.info.name = name, view.info.address = address, view.info.threads = 0;
  json worker = to_json(view, FarmTime{});
  worker["state"] = state, worker["message"] = message;
  return worker;
}

}  // namespace

WorkerList worker_list(const Farm& farm, const MasterDoor& master) {
  return {farm.workers(), master.dialling(), farm.banned()};
}

json to_json(const WorkerList& list, FarmTime now) {
  json workers = json::array();
  const auto is_banned = [&](const std::string& name) { return std::ranges::count(list.banned, name) != 0; };
  for (const WorkerView& worker : list.here)
    if (!is_banned(worker.info.name)) workers.push_back(to_json(worker, now));  // else it is about to go
  for (const std::string& name : list.banned) workers.push_back(absent(name, "banned", "", ""));
  for (const Dialling& dialled : list.dialled)
    if (!is_banned(dialled.name))
      workers.push_back(absent(dialled.name, "dialling", dialled.address, dialled.message));
  return workers;
}

}  // namespace rayfarm
