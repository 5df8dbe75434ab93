// An HTTP server before a test's farm.
#pragma once
#include "master/http/server.h"
#include "tests/support/farm_thread.h"

namespace rayfarm {

inline OnFarm door_to(FarmThread& farm) {
  return [&farm](FarmThread::Task task) { farm.post(std::move(task)); };
}

class TestServer {
 public:
  explicit TestServer(OnFarm on_farm, HttpSettings settings = {.listen = "127.0.0.1:0"})
      : door_(std::move(on_farm)), server_(std::move(settings), {.farm = door_, .app = app_}) {}

  std::string url() const { return server_.url(); }
  std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(url().substr(url().rfind(':') + 1)));
  }

 private:
  FarmDoor door_;
  const AppFiles app_;
  HttpServer server_;
};

}  // namespace rayfarm
