#include "master/http/api.h"

#include <algorithm>
#include <array>

#include "common/net/address.h"
#include "common/net/codec.h"
#include "master/http/query.h"
#include "master/http/request_target.h"
#include "master/http/submission.h"

namespace rayfarm {
namespace {

constexpr std::uint64_t longest_wait = 30;  // seconds; proxies and browsers lose patience at 60

std::array<std::span<const Route>, 9> all_tables() {
  return {job_routes(),   picture_routes(), map_routes(),   diagnostics_routes(), script_routes(),
          asset_routes(), worker_routes(),  token_routes(), page_routes()};
}

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

struct Match {
  const Route* route = nullptr;  // null: no such path, or not with this method
  std::vector<std::string> arguments;
  bool path_is_known = false;
};

Match match_of(const std::string& method, const RequestTarget& target) {
  Match match;
  for (const std::span<const Route> table : all_tables())
    for (const Route& route : table) {
      auto arguments = arguments_of(route.path, target.path);
      if (!arguments) continue;
      match.path_is_known = true;
      if (route.method == method) return {&route, std::move(*arguments), true};
    }
  return match;
}

/// Null when answer() will say what is wrong.
const Route* route_of(const ApiRequest& request) {
  try {
    return match_of(request.method, parse_target(request.target)).route;
  } catch (const std::invalid_argument&) {
    return nullptr;
  }
}

/// Who speaks another version of the API is told so.
void expect_version(std::string_view target) {
  constexpr std::string_view versions = "/api/v", ours = "/api/v1/";
  if (target.starts_with(versions) && !target.starts_with(ours))
    throw ApiError(426, "this master (rayfarm " RAYFARM_VERSION
                        ") speaks version 1 of the API only: install the same rayfarm on both PCs");
}

ApiResponse routed(const ApiRequest& request, const Doors& doors) {
  RequestTarget target = parse_target(request.target);
  Match match = match_of(request.method, target);
  if (match.route) {
    if (is_evaluation(match.route->work) && request.has_left && request.has_left())
      throw ApiError(400, "you have left");
    if (std::optional<ApiResponse> denial = denial_now(request)) return std::move(*denial);
    expect_known(target.query, parse_target(match.route->path).query);
    return match.route->handle({request, doors, std::move(match.arguments), std::move(target.query)});
  }
  expect_version(request.target);
  if (match.path_is_known) throw ApiError(405, request.method + " is not possible here");
  if (request.method == "GET" && !request.target.starts_with("/api/"))
    return doors.app.answer(request.target.substr(0, request.target.find('?')));
  throw ApiError(404, "there is nothing at " + request.target);
}

}  // namespace

std::optional<Role> role_needed(const ApiRequest& request) {
  const Route* route = route_of(request);
  if (!route && !request.target.starts_with("/api/"))
    return std::nullopt;  // the app's files hold nothing yet
  if (route && route->needs == Needs::nothing) return std::nullopt;
  if (route && route->needs == Needs::admin) return Role::admin;
  return request.method == "GET" ? Role::viewer : Role::artist;
}

Work work_of(const ApiRequest& request) {
  const Route* route = route_of(request);
  return route ? route->work : Work::command;
}

std::uint64_t body_limit(const ApiRequest& request) {
  const Route* route = route_of(request);
  return route ? route->body_limit : command_limit;
}

std::vector<ApiRoute> api_routes() {
  std::vector<ApiRoute> all;
  for (const std::span<const Route> table : all_tables())
    for (const Route& route : table) {
      ApiRoute& one = all.emplace_back();
      one.method = route.method, one.path = route.path.substr(0, route.path.find('?'));
      for (const auto& [name, ignored] : parse_target(route.path).query) one.query.insert(name);
    }
  return all;
}

std::chrono::seconds patience_of(const ApiRequest& request) {
  try {
    return std::chrono::seconds(
        std::min(number_in(parse_target(request.target).query, "wait"), longest_wait));
  } catch (const std::invalid_argument&) {
    return std::chrono::seconds(0);  // answer() will say what is wrong
  }
}

std::optional<NewsWait> news_wait(const ApiRequest& request) {
  if (request.method != "GET" || !request.target.starts_with("/api/v1/jobs")) return std::nullopt;
  const std::chrono::seconds longest = patience_of(request);
  if (longest.count() == 0) return std::nullopt;
  const RequestTarget target = parse_target(request.target);
  if (target.path.size() > 4) return std::nullopt;
  NewsWait wait{number_in(target.query, "after"), longest, std::nullopt};
  if (target.path.size() == 4) wait.job = JobId{number_in({{"id", target.path[3]}}, "id")};
  return wait;
}

ApiResponse answer(const ApiRequest& request, const Doors& doors) {
  try {
    return routed(request, doors);
  } catch (const ApiError& error) {
    return error_response(error.status, error.what());
  } catch (const FarmUnavailable& error) {
    return error_response(503, error.what());
  } catch (const NotKept& error) {
    return error_response(507, std::string("it was done, but is lost when the master ends: ") + error.what());
  } catch (const std::invalid_argument& error) {
    return error_response(400, error.what());
  } catch (const KeyTaken& error) {
    return error_response(409, error.what());
  } catch (const NameInUse& error) {
    return error_response(409, error.what());
  } catch (const AddressError& error) {
    return error_response(422, error.what());
  } catch (const FarmFull& error) {
    return error_response(503, error.what());
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
