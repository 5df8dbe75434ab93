// The HTTP server: a thread of its own with Boost.Beast, which no other room sees.
//
// Bounds on every peer: header 8 KB, body as the API says, a deadline on each step, 128 connections.
#pragma once
#include <memory>
#include <stdexcept>
#include <string>

#include "master/http/farm_door.h"

namespace rayfarm {

constexpr std::uint16_t default_http_port = 5412;

/// The server cannot listen; the message names the address and the fix.
struct HttpError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpSettings {
  std::string listen = "127.0.0.1:5412";  // ADDRESS:PORT; port 0: any free one
  bool insecure = false;                  // without it only loopback is listened to
};

class HttpServer {
 public:
  /// Listens from now on. Throws HttpError.
  HttpServer(const HttpSettings& settings, OnFarm on_farm);
  /// Ends all connections; may run on the farm's thread.
  ~HttpServer();

  /// With the port that is really listened to.
  std::string url() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace rayfarm
