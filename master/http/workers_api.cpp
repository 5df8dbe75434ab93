// Workers: listing and steering, and what happened to them.
#include <nlohmann/json.hpp>

#include "common/net/text.h"
#include "master/http/live/json.h"
#include "master/http/route.h"
#include "master/http/worker_list.h"

namespace rayfarm {
namespace {

using nlohmann::json;

ApiResponse list_workers(const Call& call) {
  return shown(call.doors.farm.ask([&master = call.doors.master](Farm& farm, FarmTime now) {
    return json{{"workers", to_json(worker_list(farm, master), now)}};
  }));
}

template <class Change>
ApiResponse change_worker(const Call& call, Change change) {
  return shown(call.doors.farm.order([name = call.arguments.at(0), change](Farm& farm, FarmTime now) {
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

ApiResponse ban_worker(const Call& call) {
  return change_worker(call, [](Farm& farm, const std::string& name, FarmTime now) {
    for (const WorkerView& worker : farm.workers())
      if (worker.info.name == name && worker.info.kind == WorkerKind::local)
        throw ApiError(409, "the master's own threads cannot be banned; drain them");
    return farm.ban(name, now);
  });
}
ApiResponse unban_worker(const Call& call) {
  return change_worker(
      call, [](Farm& farm, const std::string& name, FarmTime now) { return farm.unban(name, now); });
}

ApiResponse dial_worker(const Call& call) {
  const json body = body_of(call);
  if (body.size() != 1 || !body.contains("dial") || !body["dial"].is_string())
    throw ApiError(400, R"(say {"dial": "NAME=HOST"} or {"dial": "NAME=HOST:PORT"})");
  const std::string target = body["dial"];
  if (!is_plain_text(target)) throw ApiError(422, "dial must be one line of text without control characters");
  call.doors.farm.ask([&master = call.doors.master, target](Farm&, FarmTime) {
    master.dial(target);
    return true;
  });
  return {201, "application/json", json{{"dial", target}}.dump()};
}

ApiResponse stop_dialling(const Call& call) {
  const std::string& name = call.arguments.at(0);
  const bool stopped = call.doors.farm.ask(
      [&master = call.doors.master, name](Farm&, FarmTime) { return master.stop_dialling(name); });
  if (!stopped)
    throw ApiError(404, "no worker \"" + name + "\" is dialled; GET /api/v1/workers lists those that are");
  return shown({{"name", name}});
}

ApiResponse show_log(const Call& call) {
  const std::uint64_t after = number_in(call.query, "after");
  return shown(call.doors.farm.ask([&master = call.doors.master, after](Farm&, FarmTime now) {
    json lines = json::array();
    std::uint64_t last = after;
    for (const LogLine& line : master.log(after)) {
      lines.push_back(to_json(line, now));
      last = line.number;
    }
    return json{{"last", last}, {"lines", std::move(lines)}};
  }));
}

constexpr Route routes[]{
    {"GET", "/api/v1/workers", list_workers},
    {"POST", "/api/v1/workers/{name}/drain", drain_worker, Work::order, command_limit, Needs::admin},
    {"POST", "/api/v1/workers/{name}/undrain", undrain_worker, Work::order, command_limit, Needs::admin},
    {"POST", "/api/v1/workers/{name}/ban", ban_worker, Work::order, command_limit, Needs::admin},
    {"POST", "/api/v1/workers/{name}/unban", unban_worker, Work::order, command_limit, Needs::admin},
    {"POST", "/api/v1/workers", dial_worker, Work::command, command_limit, Needs::admin},
    {"DELETE", "/api/v1/workers/dial/{name}", stop_dialling, Work::command, command_limit, Needs::admin},
    {"GET", "/api/v1/log?after", show_log},
};

}  // namespace

std::span<const Route> worker_routes() { return routes; }

}  // namespace rayfarm
