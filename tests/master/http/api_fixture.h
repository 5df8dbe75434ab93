// The API before a farm, without a server between.
#pragma once
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "master/http/api.h"
#include "master/http/submission.h"
#include "tests/support/test_server.h"
#include "tests/support/test_submission.h"

namespace rayfarm {

class Api : public testing::Test {
 protected:
  ApiResponse get(const std::string& target) { return answer({"GET", target, "", "", "", "", ""}, doors()); }
  ApiResponse post(const std::string& target, const nlohmann::json& body = nlohmann::json::object()) {
    return answer({"POST", target, "", "", "", "", body.dump()}, doors());
  }
  ApiResponse remove(const std::string& target) {
    return answer({"DELETE", target, "", "", "", "", ""}, doors());
  }
  Doors doors() {
    return {.farm = door,
            .feeder = feeder,
            .diagnostics = diagnostics,
            .master = master,
            .app = app,
            .scenes = scenes,
            .assets = assets};
  }
  nlohmann::json get_json(const std::string& target) { return nlohmann::json::parse(get(target).body); }
  std::string submit(const JobSpec& spec = small_job()) {
    return nlohmann::json::parse(post("/api/v1/jobs", to_json(spec)).body)["id"].dump();
  }
  void wait_until_done(const std::string& id) {
    while (get_json("/api/v1/jobs/" + id)["state"] != "done") std::this_thread::yield();
  }

  FarmThread farm;
  UntilSynced until_synced = [] { return std::nullopt; };
  FarmDoor door{[this](FarmThread::Task task) { farm.post(std::move(task)); },
                [](const Told& told) { told({}); }, [this] { return until_synced(); }};
  FrameFeeder feeder{door};
  Diagnostics diagnostics{1};
  MasterDoor master = lone_master();
  const AppFiles app;
  const SceneLibrary scenes;
  AssetStore assets;
};

}  // namespace rayfarm
