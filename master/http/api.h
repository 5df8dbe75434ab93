// The HTTP API without sockets: what a request asks of the farm, and the answer. openapi.json describes it.
#pragma once
#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "master/access/credentials.h"
#include "master/http/route.h"

namespace rayfarm {

struct ApiRoute {
  std::string method, path;     // "/api/v1/jobs/{id}"
  std::set<std::string> query;  // what may stand in it
};
std::vector<ApiRoute> api_routes();

/// The largest body, in bytes, that this request may bring.
std::uint64_t body_limit(const ApiRequest& request);

/// What it takes to be answered; none: nothing.
std::optional<Role> role_needed(const ApiRequest& request);

/// On whose threads the request is answered.
Work work_of(const ApiRequest& request);

/// `?after=REVISION&wait=SECONDS` on jobs and on a job: the answer may wait until the farm's revision is
/// another one, or the job is no longer there.
struct NewsWait {
  std::uint64_t after = 0;
  std::chrono::seconds longest{0};
  std::optional<JobId> job;
};
std::optional<NewsWait> news_wait(const ApiRequest& request);

/// `?wait=SECONDS`: how long an answer that is not there yet (202) may be waited for; at most 30 s.
std::chrono::seconds patience_of(const ApiRequest& request);

/// Never throws for what a request can bring: errors are answers. Waits for the farm: not for the I/O thread.
ApiResponse answer(const ApiRequest& request, const Doors& doors);

}  // namespace rayfarm
