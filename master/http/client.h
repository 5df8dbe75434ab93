// A small HTTP client for the command: one request, one reply, blocking.
#pragma once
#include <chrono>
#include <functional>
#include <stdexcept>
#include <string>

namespace rayfarm {

/// Nobody answers there, or the answer is no HTTP. The message names the address.
struct MasterUnreachable : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Who answers is not the master that the token is for, nor one that this PC's authorities know. Nothing was asked.
struct MasterUntrusted : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Nothing came or went for too long.
struct RequestTimedOut : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct RequestCancelled : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpRequest {
  std::string method = "GET";
  std::string url;                    // of the master: http://HOST[:PORT] or https://HOST[:PORT]
  std::string target;                 // "/api/v1/jobs"
  std::string body;                   // JSON; empty: none
  std::chrono::seconds patience{60};  // while no byte comes or goes
  std::function<bool()> cancelled = [] { return false; };  // asked about 20 times a second
  std::string token{};                                     // empty: comes without
};
struct HttpReply {
  unsigned status = 0;
  std::string body;
};

/// Throws one of the errors above, and std::invalid_argument for a URL of another form, or a token that would leave this
/// PC in plaintext.
HttpReply send(const HttpRequest& request);

}  // namespace rayfarm
