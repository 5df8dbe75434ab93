// The tables of what can be asked: each *_api.cpp has one, the router looks into all of them.
#pragma once
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/net/messages.h"
#include "master/http/api_error.h"
#include "master/http/doors.h"
#include "master/http/message.h"

namespace rayfarm {

/// Each kind has threads of its own, so that it never waits behind another one.
enum class Work : std::uint8_t {
  command,  // asks the farm something small
  order,    // changes something, and waits until that is on the disk: more of them wait together
  trace,    // milliseconds of processor time
  picture,  // seconds: pictures, maps, clouds and films are made into files
  look,     // up to 5 s: scripts are evaluated for a form
  script,   // up to 20 s: scenes are evaluated and checked to be rendered
};

/// It is not done for who has left.
constexpr bool is_evaluation(Work work) { return work == Work::look || work == Work::script; }

/// Who may ask.
enum class Needs : std::uint8_t {
  usual,    // to look: a viewer; to do something: an artist
  nothing,  // not even to be somebody
  admin,
};

/// A request at its handler.
struct Call {
  const ApiRequest& request;
  const Doors& doors;
  std::vector<std::string> arguments;        // what stands for {id} and {name}
  std::map<std::string, std::string> query;  // decoded
};

constexpr std::uint64_t command_limit = 64 * 1024;  // bytes of a body

/// A handler runs on a thread of its kind of work. It may throw ApiError and what the rooms that it calls
/// throw; a picture that is still being made is no reason to wait: it answers 202.
struct Route {
  std::string_view method, path;  // "/api/v1/jobs/{id}?after&wait": with all that may stand in the query
  ApiResponse (*handle)(const Call&);
  Work work = Work::command;
  std::uint64_t body_limit = command_limit;
  Needs needs = Needs::usual;
};

std::span<const Route> job_routes();
std::span<const Route> picture_routes();
std::span<const Route> script_routes();
std::span<const Route> asset_routes();
std::span<const Route> map_routes();
std::span<const Route> diagnostics_routes();
std::span<const Route> worker_routes();
std::span<const Route> token_routes();
std::span<const Route> page_routes();

// What handlers share.

ApiResponse shown(const nlohmann::json& value);
/// The job in the path, or another one there. Throws ApiError.
JobId job_id(const Call& call, std::size_t argument = 0);
/// A whole number in the query; 0 when it is not there or none.
std::uint64_t number_in(const std::map<std::string, std::string>& query, const std::string& name);
/// The members of a command's body; an empty body has none. Throws ApiError.
nlohmann::json body_of(const Call& call);

}  // namespace rayfarm
