#include "master/http/api.h"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "common/net/codec.h"
#include "master/files/image_file.h"
#include "master/http/assets.h"
#include "master/http/farm_json.h"
#include "master/http/film_snapshot.h"
#include "master/http/request_target.h"
#include "master/http/settings_json.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;

struct Call {
  const ApiRequest& request;
  const FarmDoor& farm;
  std::vector<std::string> arguments;  // what stands for {id} and {name}
};

constexpr std::uint64_t command_limit = 64 * 1024;

ApiResponse shown(const json& value) {
  return {200, "application/json", value.dump(-1, ' ', false, json::error_handler_t::replace)};
}

JobId job_id(const Call& call) {
  const std::string& text = call.arguments.at(0);
  std::uint64_t id = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc{} || end != text.data() + text.size())
    throw ApiError(400, "a job's id is a whole number, is " + text);
  return JobId{id};
}

/// The members of a command's body; an empty body has none.
json body_of(const Call& call) {
  if (call.request.body.empty()) return json::object();
  return parse_json(call.request.body);
}

// Jobs.
// --------------------------------------------------------------------------------------------------------

ApiResponse list_jobs(const Call& call) {
  return shown(call.farm.ask([](Farm& farm, FarmTime now) {
    json jobs = json::array();
    for (const JobView& job : farm.jobs(now)) jobs.push_back(to_json(job, now));
    return json{{"revision", farm.revision()}, {"jobs", std::move(jobs)}};
  }));
}

/// The job as it is on the farm's thread.
json job_now(Farm& farm, JobId id, FarmTime now) {
  const std::optional<JobView> job = farm.job(id, now);
  if (!job) throw no_such_job(id);
  json object = to_json(*job, now);
  object["revision"] = farm.revision();
  return object;
}

ApiResponse show_job(const Call& call) {
  return shown(
      call.farm.ask([id = job_id(call)](Farm& farm, FarmTime now) { return job_now(farm, id, now); }));
}

ApiResponse submit_job(const Call& call) {
  JobSpec spec = job_spec(parse_json(call.request.body));
  ApiResponse response = shown(call.farm.ask([spec = std::move(spec)](Farm& farm, FarmTime now) mutable {
    const JobId id = farm.submit(std::move(spec), now);
    return job_now(farm, id, now);
  }));
  response.status = 201;
  return response;
}

/// Runs change(farm, id, now), which says false when there is no such job or it has ended.
template <class Change>
ApiResponse change_job(const Call& call, Change change) {
  return shown(call.farm.ask([id = job_id(call), change = std::move(change)](Farm& farm, FarmTime now) {
    const bool changed = change(farm, id, now);
    json job = job_now(farm, id, now);
    if (!changed) throw ApiError(409, text_of(id) + " has ended (" + job["state"].get<std::string>() + ")");
    return job;
  }));
}

ApiResponse pause_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.pause(id, now); });
}
ApiResponse resume_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.resume(id, now); });
}
ApiResponse cancel_job(const Call& call) {
  return change_job(call, [](Farm& farm, JobId id, FarmTime now) { return farm.cancel(id, now); });
}
ApiResponse prioritise_job(const Call& call) {
  const int priority = priority_from_json(body_of(call).value("priority", json()));
  return change_job(call,
                    [=](Farm& farm, JobId id, FarmTime now) { return farm.set_priority(id, priority, now); });
}

ApiResponse show_film(const Call& call) {
  const Bytes bytes = encode_film(*film_snapshot(call.farm, job_id(call)));
  return {200, "application/octet-stream", {bytes.begin(), bytes.end()}};
}

ApiResponse show_picture(const Call& call) {
  const std::vector<std::uint8_t> bytes = png_bytes(preview(*film_snapshot(call.farm, job_id(call))));
  return {200, "image/png", {bytes.begin(), bytes.end()}};
}

// Workers and the rest.
// ----------------------------------------------------------------------------------------

ApiResponse list_workers(const Call& call) {
  return shown(call.farm.ask([](Farm& farm, FarmTime now) {
    json workers = json::array();
    for (const WorkerView& worker : farm.workers()) workers.push_back(to_json(worker, now));
    return json{{"workers", std::move(workers)}};
  }));
}

template <class Change>
ApiResponse change_worker(const Call& call, Change change) {
  return shown(call.farm.ask([name = call.arguments.at(0), change](Farm& farm, FarmTime now) {
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

ApiResponse show_version(const Call&) {
  return shown({{"version", RAYFARM_VERSION}, {"api", 1}, {"protocol", protocol_version}});
}

ApiResponse show_openapi(const Call&) { return {200, "application/json", std::string(openapi_json)}; }
ApiResponse show_page(const Call&) { return {200, "text/html; charset=utf-8", std::string(index_html)}; }
ApiResponse show_script(const Call&) { return {200, "text/javascript; charset=utf-8", std::string(app_js)}; }
ApiResponse show_style(const Call&) { return {200, "text/css; charset=utf-8", std::string(style_css)}; }

struct Route {
  std::string_view method, path;
  ApiResponse (*handle)(const Call&);
  bool takes_long = false;
};
constexpr Route routes[]{
    {"GET", "/api/v1/jobs", list_jobs},
    {"POST", "/api/v1/jobs", submit_job, true},
    {"GET", "/api/v1/jobs/{id}", show_job},
    {"POST", "/api/v1/jobs/{id}/pause", pause_job},
    {"POST", "/api/v1/jobs/{id}/resume", resume_job},
    {"POST", "/api/v1/jobs/{id}/cancel", cancel_job},
    {"POST", "/api/v1/jobs/{id}/priority", prioritise_job},
    {"GET", "/api/v1/jobs/{id}/film", show_film, true},
    {"GET", "/api/v1/jobs/{id}/picture.png", show_picture, true},
    {"GET", "/api/v1/workers", list_workers},
    {"POST", "/api/v1/workers/{name}/drain", drain_worker},
    {"POST", "/api/v1/workers/{name}/undrain", undrain_worker},
    {"GET", "/api/v1/version", show_version},
    {"GET", "/api/v1/openapi.json", show_openapi},
    {"GET", "/", show_page},
    {"GET", "/app.js", show_script},
    {"GET", "/style.css", show_style},
};

/// What stands for the {} of the pattern, if the path has its form.
std::optional<std::vector<std::string>> arguments_of(std::string_view pattern,
                                                     const std::vector<std::string>& path) {
  const std::vector<std::string> parts = parse_target(pattern).path;
  if (parts.size() != path.size()) return std::nullopt;
  std::vector<std::string> arguments;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (parts[i].starts_with('{'))
      arguments.push_back(path[i]);
    else if (parts[i] != path[i])
      return std::nullopt;
  return arguments;
}

ApiResponse routed(const ApiRequest& request, const FarmDoor& farm) {
  const RequestTarget target = parse_target(request.target);
  bool path_is_known = false;
  for (const Route& route : routes) {
    auto arguments = arguments_of(route.path, target.path);
    if (!arguments) continue;
    path_is_known = true;
    if (route.method == request.method) return route.handle({request, farm, std::move(*arguments)});
  }
  if (path_is_known) throw ApiError(405, request.method + " is not possible here");
  throw ApiError(404, "there is nothing at " + request.target);
}

std::uint64_t number_in(const RequestTarget& target, const std::string& name) {
  const auto found = target.query.find(name);
  std::uint64_t number = 0;
  if (found == target.query.end()) return number;
  std::from_chars(found->second.data(), found->second.data() + found->second.size(), number);
  return number;
}

}  // namespace

bool takes_long(const ApiRequest& request) {
  try {
    const RequestTarget target = parse_target(request.target);
    return std::ranges::any_of(routes, [&](const Route& route) {
      return route.takes_long && route.method == request.method && arguments_of(route.path, target.path);
    });
  } catch (const std::invalid_argument&) {
    return false;  // answer() will say what is wrong
  }
}

std::vector<ApiRoute> api_routes() {
  std::vector<ApiRoute> all;
  for (const Route& route : routes) all.push_back({std::string(route.method), std::string(route.path)});
  return all;
}

std::uint64_t body_limit(const ApiRequest& request) {
  return request.method == "POST" && request.target == "/api/v1/jobs" ? submission_limit : command_limit;
}

std::optional<NewsWait> news_wait(const ApiRequest& request) {
  constexpr std::uint64_t longest = 30;  // seconds; proxies and browsers lose patience at 60
  if (request.method != "GET" || !request.target.starts_with("/api/v1/jobs")) return std::nullopt;
  try {
    const RequestTarget target = parse_target(request.target);
    const std::uint64_t seconds = std::min(number_in(target, "wait"), longest);
    if (seconds == 0 || target.path.size() > 4) return std::nullopt;
    return NewsWait{number_in(target, "after"), std::chrono::seconds(seconds)};
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // answer() will say what is wrong
  }
}

ApiResponse answer(const ApiRequest& request, const FarmDoor& farm) {
  try {
    return routed(request, farm);
  } catch (const ApiError& error) {
    return error_response(error.status, error.what());
  } catch (const FarmUnavailable& error) {
    return error_response(503, error.what());
  } catch (const std::invalid_argument& error) {
    return error_response(400, error.what());
  } catch (const KeyTaken& error) {
    return error_response(409, error.what());
  } catch (const SettingsError& error) {
    return error_response(422, error.what());
  } catch (const SceneError& error) {
    return error_response(422, error.what());
  } catch (const CodecError& error) {
    return error_response(422, error.what());
  } catch (const std::exception& error) {
    return error_response(500, error.what());
  }
}

}  // namespace rayfarm
