// Workers: listing and steering.
#include <nlohmann/json.hpp>

#include "master/http/farm_json.h"
#include "master/http/route.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse list_workers(const Call& call) {
  return shown(call.doors.farm.ask([](Farm& farm, FarmTime now) {
    json workers = json::array();
    for (const WorkerView& worker : farm.workers()) workers.push_back(to_json(worker, now));
    return json{{"workers", std::move(workers)}};
  }));
}

template <class Change>
ApiResponse change_worker(const Call& call, Change change) {
  return shown(call.doors.farm.ask([name = call.arguments.at(0), change](Farm& farm, FarmTime now) {
    if (!change(farm, name, now)) throw ApiError(404, "there is no worker " + name);
    return json{{"name", name}};
  }));
}

ApiResponse drain_worker(const Call& call) {
  return change_worker(
      call, [](Farm& farm, const std::string& name, FarmTime now) { return farm.drain(name, now); });
}
ApiResponse undrain_worker(const Call& call) {
  return change_worker(
      call, [](Farm& farm, const std::string& name, FarmTime now) { return farm.undrain(name, now); });
}

constexpr Route routes[]{
    {"GET", "/api/v1/workers", list_workers},
    {"POST", "/api/v1/workers/{name}/drain", drain_worker},
    {"POST", "/api/v1/workers/{name}/undrain", undrain_worker},
};

}  // namespace

std::span<const Route> worker_routes() { return routes; }

}  // namespace rayfarm
