#include "master/cli/master_api.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include "common/net/private_file.h"
#include "master/cli/exit_code.h"
#include "master/cli/interrupt.h"
#include "master/cli/text.h"
#include "master/http/client.h"

namespace rayfarm {
namespace {

using nlohmann::json;

using Clock = std::chrono::steady_clock;

constexpr int news_seconds = 10;                          // how long the master may hold a question for news
constexpr auto made_patience = std::chrono::minutes(10);  // a picture of 500 megapixels is compressed first
constexpr auto busy_patience = std::chrono::minutes(2);
constexpr auto away_patience = std::chrono::minutes(1);  // for a master that is started again
constexpr auto busy_pause = std::chrono::milliseconds(500);

/// The master says: try again.
struct MasterBusy : CommandError {
  explicit MasterBusy(const std::string& message) : CommandError(ExitCode::failed, message) {}
};

/// Nobody answers where it should be.
struct MasterAway : CommandError {
  explicit MasterAway(const std::string& message) : CommandError(ExitCode::master_unreachable, message) {}
};

/// What RAYFARM_TOKEN_FILE holds; empty: there is none.
const std::string& token() {
  static const std::string token = [] {
    const char* file = std::getenv("RAYFARM_TOKEN_FILE");
    if (file == nullptr || *file == '\0') return std::string();
    std::optional<std::string> text;
    try {
      text = read_private_file(file);
    } catch (const std::runtime_error& error) {
      throw CommandError(ExitCode::usage, std::string(error.what()) + " (RAYFARM_TOKEN_FILE)");
    }
    if (!text)
      throw CommandError(ExitCode::usage, std::string("there is no file ") + file + " (RAYFARM_TOKEN_FILE)");
    return text->substr(0, text->find_first_of("\r\n"));
  }();
  return token;
}

ExitCode exit_code_of(unsigned status) {
  if (status == 426) return ExitCode::version_refused;
  if (status == 403 || status == 401) return ExitCode::not_allowed;
  if (status == 400 || status == 413 || status == 415 || status == 422) return ExitCode::usage;
  return ExitCode::failed;
}

std::string error_in(const HttpReply& reply) {
  const json body = json::parse(reply.body, nullptr, false);
  if (body.is_object() && body.contains("error") && body["error"].is_string())
    return printable(body["error"].get<std::string>());
  return "the master answered with HTTP status " + std::to_string(reply.status);
}

HttpReply asked(HttpRequest request) {
  request.url = master_url();
  request.token = token();
  request.cancelled = interrupted;
  try {
    HttpReply reply = send(request);
    if (reply.status == 503) throw MasterBusy(error_in(reply));
    if (reply.status >= 300) throw CommandError(exit_code_of(reply.status), error_in(reply));
    return reply;
  } catch (const MasterUnreachable& error) {
    throw MasterAway(std::string(error.what()) +
                     "; start one with rayfarm-master, or say where it is in RAYFARM_MASTER");
  } catch (const MasterUntrusted& error) {
    throw CommandError(ExitCode::not_allowed, error.what());
  } catch (const RequestTimedOut& error) {
    throw CommandError(ExitCode::timed_out, error.what());
  } catch (const RequestCancelled& error) {
    throw CommandError(ExitCode::interrupted, error.what());
  } catch (const std::invalid_argument& error) {
    throw CommandError(ExitCode::usage, std::string(error.what()) + " (RAYFARM_MASTER)");
  }
}

/// What may be asked twice. A master that has answered before and is away now is waited for: it may be started again.
HttpReply asked_again(const HttpRequest& request) {
  static bool has_answered = false;
  const auto end = Clock::now() + away_patience;
  for (bool is_told = false;; is_told = true) {
    try {
      HttpReply reply = asked(request);
      has_answered = true;
      return reply;
    } catch (const MasterAway&) {
      if (!has_answered || Clock::now() > end) throw;
      if (!is_told) std::fputs("rayfarm: the master does not answer; waiting for it\n", stderr);
    }
    std::this_thread::sleep_for(busy_pause);
    if (interrupted()) throw CommandError(ExitCode::interrupted, "interrupted");
  }
}

json parsed(const HttpReply& reply) {
  json value = json::parse(reply.body, nullptr, false);
  if (!value.is_object())
    throw CommandError(ExitCode::failed, "what answers at " + master_url() + " is not a rayfarm master");
  return value;
}

/// Asks again while the master is busy.
json get_json_patiently(const std::string& target) {
  const auto end = Clock::now() + busy_patience;
  for (;;) {
    try {
      return get_json(target);
    } catch (const MasterBusy&) {
      if (Clock::now() > end) throw;
    }
    std::this_thread::sleep_for(busy_pause);
  }
}

}  // namespace

std::string master_url() {
  const char* url = std::getenv("RAYFARM_MASTER");
  return url != nullptr && *url != '\0' ? url : "http://127.0.0.1:5412";
}

json get_json(const std::string& target) { return parsed(asked_again({"GET", "", target, ""})); }
std::string get_bytes(const std::string& target) {
  return asked_again({"GET", "", target, "", made_patience}).body;
}

Progress made_so_far(const std::string& target) {
  const char* wait = target.find('?') == std::string::npos ? "?wait=1" : "&wait=1";  // seconds between news
  HttpReply reply = asked_again({"GET", "", target + wait, "", made_patience});
  if (reply.status != 202) return {std::move(reply.body), 1};
  const json making = parsed(reply);
  const json& part = making.contains("detail") ? making["detail"] : making;
  return {std::nullopt, part.value("progress", 0.0)};
}

std::string get_made(const std::string& target, const std::function<void(double share)>& progress) {
  for (;;) {
    Progress now = made_so_far(target);
    if (now.bytes) return std::move(*now.bytes);
    progress(now.share);
  }
}

json post_json(const std::string& target, const json& body) {
  return parsed(asked({"POST", "", target, body.dump()}));
}

json post_json_patiently(const std::string& target, const json& body,
                         const std::function<void()>& while_busy) {
  for (;;) {
    try {
      return parsed(asked_again({"POST", "", target, body.dump()}));
    } catch (const MasterBusy&) {
      std::this_thread::sleep_for(busy_pause);
      while_busy();
    }
  }
}

std::string job_target(JobNumber id) { return "/api/v1/jobs/" + std::to_string(id); }

bool has_ended(const json& job) {
  const std::string state = job.at("state");
  return state == "done" || state == "cancelled" || state == "failed";
}

json await_end(JobNumber id, const std::function<void(const json& job)>& news) {
  const std::string number = std::to_string(id);
  try {
    json job = get_json_patiently(job_target(id));
    for (news(job); !has_ended(job); news(job))
      job = get_json_patiently(job_target(id) + "?wait=" + std::to_string(news_seconds) +
                               "&after=" + std::to_string(job.at("revision").get<std::uint64_t>()));
    return job;
  } catch (const CommandError& error) {
    if (error.code != ExitCode::interrupted) throw;
    throw CommandError(ExitCode::interrupted, "interrupted; job " + number + " goes on: rayfarm watch " +
                                                  number + ", then rayfarm fetch " + number);
  }
}

void expect_done(const json& job) {
  const std::string state = job.at("state"), message = printable(job.at("message"));
  if (state != "done")
    throw CommandError(ExitCode::failed, "job " + std::to_string(job.at("id").get<JobNumber>()) + " is " +
                                             state + (message.empty() ? "" : ": " + message));
}

}  // namespace rayfarm
