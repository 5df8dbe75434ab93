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
  const auto is_here = [&](const std::string& name) {
    return std::ranges::any_of(list.here, [&](const WorkerView& w) { return w.info.name == name; });
  };
  for (const WorkerView& worker : list.here) {
    if (is_banned(worker.info.name)) continue;  // it is about to go
    json& shown = workers.emplace_back(to_json(worker, now));
    if (worker.trust.mismatches > 0) shown["message"] = "it was wrong once; the second time it is banned";
    const auto dialled = std::ranges::find(list.dialled, worker.info.name, &Dialling::name);
    if (dialled != list.dialled.end())  // it came by itself meanwhile: still one row a name
      shown["message"] = "also dialled, at " + dialled->address + ": " + dialled->message;
  }
  for (const std::string& name : list.banned) workers.push_back(absent(name, "banned", "", ""));
  for (const Dialling& dialled : list.dialled)
    if (!is_banned(dialled.name) && !is_here(dialled.name))
      workers.push_back(absent(dialled.name, "dialling", dialled.address, dialled.message));
  return workers;
}

}  // namespace rayfarm
