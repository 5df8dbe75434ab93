// The HTTP server: a thread of its own with Boost.Beast, which no other room sees.
//
// Bounds on every peer: header 8 KB, body as the API says, a deadline on each step. When there are too many
// connections, the one that has been idle longest is closed, or where none is, the oldest of those who have most. Of
// answers over 1 MB, 1 GB in all waits for its readers.
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "common/net/certificates.h"
#include "master/http/doors.h"
#include "master/http/people.h"

namespace rayfarm {

constexpr std::uint16_t default_http_port = 5412;

/// The server cannot listen; the message names the address and the fix.
struct HttpError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpSettings {
  std::string listen = "127.0.0.1:5412";        // ADDRESS:PORT; port 0: any free one
  Exposure exposure = Exposure::loopback_only;  // of plaintext, and of askers without a token
  std::optional<Identity> identity{};      // its certificate, and the authorities behind it; none: no TLS
  std::string outward_host = "127.0.0.1";  // in links, where any address is listened to
  std::size_t connections = 1024;          // at once, viewers among them
  std::chrono::milliseconds header_patience{30'000};  // also how long an idle connection is kept
  std::chrono::milliseconds body_patience{60'000};    // 64 MB from a slow PC of the lab
  std::chrono::milliseconds viewer_patience{60'000};  // with one who takes nothing of what it watches
};

class HttpServer {
 public:
  /// Listens from now on. Throws HttpError.
  HttpServer(const HttpSettings& settings, const Doors& doors);
  /// Ends all connections and closes the farm's door; may run on the farm's thread.
  ~HttpServer();

  /// With the port that is really listened to; https where plaintext is not spoken.
  std::string url() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace rayfarm
