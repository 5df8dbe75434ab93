// The live connection with real sockets, a real master and real workers.
#include <gtest/gtest.h>

#include <list>
#include <nlohmann/json.hpp>
#include <thread>

#include "master/diagnostics/map.h"
#include "tests/support/farm_jobs.h"
#include "tests/support/layer_view.h"
#include "tests/support/live_viewer.h"
#include "tests/support/master_thread.h"
#include "tests/support/test_server.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

json watching(JobId job, const char* layer = "picture") {
  return {{"watch", {{{"job", static_cast<std::uint64_t>(job)}, {"layer", layer}}}}};
}

/// The next text of this type; what comes before it is passed over.
json next_text(LiveViewer& viewer, const std::string& type) {
  for (;;) {
    const LiveViewer::Message message = viewer.next();
    if (!message.is_text) continue;
    json text = json::parse(message.bytes);
    if (text["type"] == type) return text;
  }
}

class Live : public testing::Test {
 protected:
  JobId submit(std::uint32_t width, std::uint32_t height) {
    RenderSettings settings;
    settings.width = width, settings.height = height, settings.spp = 1;
    return master.ask([&](Farm& farm, FarmTime now) { return farm.submit(simple_job(settings), now); });
  }
  std::shared_ptr<const Film> film(JobId job) {
    return master.ask([&](Farm& farm, FarmTime) { return farm.film(job); });
  }
  /// All tiles until the layer is done and complete.
  LayerView watched_whole(LiveViewer& viewer) {
    const json layer = next_text(viewer, "layer");
    LayerView view({layer["width"], layer["height"]}, layer["channels"]);
    bool is_done = layer["state"] == "done";
    while (!is_done || !view.is_complete()) {
      const LiveViewer::Message message = viewer.next();
      if (!message.is_text) view.put(received_tile(message.bytes));
      if (!message.is_text) continue;
      const json text = json::parse(message.bytes);
      if (text["type"] == "layer") is_done = text["state"] == "done";
    }
    return view;
  }

  MasterThread master;
  WorkerThread worker{worker_for(master.address(), "pc1"), prepare_scene};
  TestServer server{master.on_farm(), {.listen = "127.0.0.1:0", .viewer_patience = 60s}, master.door()};
};

TEST_F(Live, TheStateComesAtOnceAndWhenItChanges) {
  master.wait_for_workers(1);
  LiveViewer viewer(server.port());
  const json first = next_text(viewer, "state");
  EXPECT_TRUE(first["jobs"].empty());
  EXPECT_EQ(first["workers"][0]["name"], "pc1");
  EXPECT_NE(next_text(viewer, "log")["lines"][0]["text"].get<std::string>().find("pc1 joined"),
            std::string::npos);
  submit(64, 64);
  json state;
  do state = next_text(viewer, "state");
  while (state["jobs"].empty() || state["jobs"][0]["state"] != "done");
  EXPECT_GT(state["revision"], first["revision"]);
}

TEST_F(Live, ARunningPictureArrivesBitForBit) {
  const JobId job = submit(500, 300);
  LiveViewer viewer(server.port());
  viewer.say(watching(job).dump());
  const LayerView view = watched_whole(viewer);
  EXPECT_TRUE(std::ranges::equal(view.values(), film(job)->rgb()));
}

TEST_F(Live, AMapArrivesAsItIsMade) {
  const JobId job = submit(130, 70);
  LiveViewer viewer(server.port());
  viewer.say(watching(job, "depth").dump());
  const LayerView view = watched_whole(viewer);
  RenderSettings settings;
  settings.width = 130, settings.height = 70, settings.spp = 1;
  const auto map = map_of(
      World(simple_scene()), settings, {}, 1, [] { return false; }, [](auto, auto) {});
  EXPECT_EQ(view.values(), map->values);
}

TEST_F(Live, WhatIsNotThereFailsInWords) {
  LiveViewer viewer(server.port());
  viewer.say(watching(JobId{7}).dump());
  json layer = next_text(viewer, "layer");
  EXPECT_EQ(layer["state"], "failed");
  EXPECT_EQ(layer["message"], "there is no job 7");
  viewer.say(watching(submit(64, 64), "nonsense").dump());
  do layer = next_text(viewer, "layer");
  while (layer["job"] == 7);
  EXPECT_EQ(layer["message"], "there is no map nonsense");
}

// Hostile ones. -------------------------------------------------------------------------------------------

std::string refusal_of(std::uint16_t port, const std::map<std::string, std::string>& header) {
  try {
    LiveViewer viewer(port, header);
  } catch (const ViewerEnded& ended) {
    return ended.what();
  }
  return "";
}

TEST_F(Live, PagesFromElsewhereAreRefusedBeforeTheUpgrade) {
  EXPECT_EQ(refusal_of(server.port(), {{"Origin", "http://evil.example"}}), "403 Forbidden");
  EXPECT_EQ(refusal_of(server.port(), {{"Host", "evil.example"}}), "403 Forbidden");
  EXPECT_EQ(refusal_of(server.port(), {{"Sec-Fetch-Site", "cross-site"}}), "403 Forbidden");
  EXPECT_EQ(refusal_of(server.port(), {{"Origin", "http://127.0.0.1:" + std::to_string(server.port())}}), "");
}

std::string farewell_to(std::uint16_t port, const std::string& text) {
  LiveViewer viewer(port);
  viewer.say(text);
  try {
    for (;;) viewer.next();
  } catch (const ViewerEnded& ended) {
    return ended.what();
  }
}

TEST_F(Live, OneWhoSaysWhatItMayNotIsToldSo) {
  EXPECT_EQ(farewell_to(server.port(), "{}"), "say {\"watch\": [...]}");
  EXPECT_EQ(farewell_to(server.port(), R"({"watch":[{"layer":"picture"}]})"),
            "what is watched has a job, a whole number");
  EXPECT_NE(farewell_to(server.port(), "nonsense"), "");
  farewell_to(server.port(), std::string(5000, ' '));  // ends
}

// Ten megabytes fit into no buffer between the two.
TEST(LiveServer, AViewerThatNeverReadsIsLeft) {
  FarmThread farm;
  farm.add_renderer("pc1");
  JobId job{};
  farm.run([&](Farm& f, FarmTime now) {
    RenderSettings settings;
    settings.width = 1600, settings.height = 1200, settings.spp = 1;
    job = f.submit(simple_job(settings), now);
  });
  const TestServer server(door_to(farm), {.listen = "127.0.0.1:0", .viewer_patience = 300ms});
  LiveViewer viewer(server.port());
  const std::size_t with_both_ends = open_descriptors();
  viewer.say(watching(job).dump());
  while (open_descriptors() == with_both_ends) std::this_thread::yield();
}

// Many. ---------------------------------------------------------------------------------------------------

/// Reads until it has the whole picture; what it was sent as finished must be the film.
bool sees_whole(LiveViewer& viewer, const Film& expected) {
  std::uint64_t pixels = 0;
  const std::uint64_t all = std::uint64_t{expected.size().width} * expected.size().height;
  while (pixels < all) {
    const LiveViewer::Message message = viewer.next();
    if (message.is_text) continue;
    const ReceivedTile tile = received_tile(message.bytes);
    if (!tile.is_float32) continue;
    pixels += std::uint64_t{tile.width} * tile.height;
    for (std::uint32_t y = 0; y < tile.height; ++y) {
      const float* row =
          expected.rgb().data() + 3 * (std::size_t{tile.y + y} * expected.size().width + tile.x);
      if (!std::equal(row, row + 3 * tile.width, tile.values.data() + std::size_t{3} * y * tile.width))
        return false;
    }
  }
  return true;
}

TEST_F(Live, TwoHundredViewersOfWhomFiftyNeverReadChangeNothing) {
  RenderSettings settings;
  settings.width = 512, settings.height = 384, settings.spp = 1;
  const Film expected = rendered(prepare_scene(simple_scene()), settings);
  const JobId job = master.ask([&](Farm& farm, FarmTime now) {
    JobSpec spec = simple_job(settings);
    spec.hold = true;
    return farm.submit(std::move(spec), now);
  });

  [[maybe_unused]] const std::uint64_t before = resident_memory();
  std::list<LiveViewer> silent, readers;
  for (int i = 0; i < 50; ++i) silent.emplace_back(server.port()).say(watching(job).dump());
  for (int i = 0; i < 150; ++i) readers.emplace_back(server.port()).say(watching(job).dump());
  master.ask([&](Farm& farm, FarmTime now) { return farm.resume(job, now); });

  std::atomic<int> satisfied = 0;
  {
    std::list<std::jthread> threads;
    for (LiveViewer& reader : readers)
      threads.emplace_back([&] { satisfied += sees_whole(reader, expected); });
  }
  EXPECT_EQ(satisfied, 150);
  EXPECT_TRUE(film(job)->is_complete());
  EXPECT_EQ(film(job)->rgb(), expected.rgb());
#ifndef RAYFARM_SANITIZED                             // whose notes take as much again
  EXPECT_LT(resident_memory() - before, 300u << 20);  // of the clients, too
#endif
}

}  // namespace
}  // namespace rayfarm
