// An HTTP server before a test's farm.
#pragma once
#include "master/diagnostics/diagnostics.h"
#include "master/http/server.h"
#include "tests/support/farm_thread.h"

namespace rayfarm {

inline OnFarm door_to(FarmThread& farm) {
  return [&farm](FarmThread::Task task) { farm.post(std::move(task)); };
}

/// A master that dials nobody and has no log.
inline MasterDoor lone_master() {
  return {[](const std::string&) {},
          [] { return std::vector<Dialling>{}; },
          [](std::uint64_t) { return std::vector<LogLine>{}; },
          [](const std::string&) { return false; },
          [](const std::set<std::string>&) {},
          [](const std::string&) {}};
}

class TestServer {
 public:
  explicit TestServer(
      OnFarm on_farm, HttpSettings settings = {.listen = "127.0.0.1:0"}, MasterDoor master = lone_master(),
      Access* access = nullptr, UntilSynced until_synced = [] { return std::nullopt; })
      : door_(
            std::move(on_farm), [](const Told& told) { told({}); }, std::move(until_synced)),
        master_(std::move(master)),
        server_(std::move(settings), {.farm = door_,
                                      .feeder = feeder_,
                                      .diagnostics = diagnostics_,
                                      .master = master_,
                                      .app = app_,
                                      .scenes = scenes_,
                                      .assets = assets_,
                                      .access = access}) {}

  std::string url() const { return server_.url(); }
  std::uint16_t port() const {
    return static_cast<std::uint16_t>(std::stoi(url().substr(url().rfind(':') + 1)));
  }

 private:
  FarmDoor door_;
  const MasterDoor master_;
  FrameFeeder feeder_{door_};
  Diagnostics diagnostics_{1};
  const AppFiles app_;
  const SceneLibrary scenes_;
  AssetStore assets_;
  HttpServer server_;
};

}  // namespace rayfarm
