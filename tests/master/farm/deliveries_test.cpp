// Whose pixels they are, and what they took.
#include <gtest/gtest.h>

#include <limits>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size six_tiles{192, 128};

/// Local threads and two remote workers take turns: each tile of theirs takes one, two or three seconds.
struct SharedPicture {
  Farm farm;
  FakeWorker local{farm, {.name = "master", .threads = 1, .kind = WorkerKind::local}};
  FakeWorker lab1{farm, {.name = "lab1"}}, lab2{farm, {.name = "lab2"}};
  JobId job = farm.submit(job_of(six_tiles), 0s);
  FarmTime now{};

  bool step(FakeWorker& worker, FarmTime taken) {
    if (worker.held().empty()) return false;
    now += 10s;
    worker.finish_one(now, std::chrono::duration<double>(taken).count());
    return true;
  }
  /// False when nothing is left to be done.
  bool steps() {
    const bool by_local = step(local, 1s), by_lab1 = step(lab1, 2s), by_lab2 = step(lab2, 3s);
    return by_local || by_lab1 || by_lab2;
  }
  FarmTime total() const {
    const Deliveries deliveries = farm.deliveries(job).value();
    FarmTime sum{};
    for (const Deliveries::Tile& tile : deliveries.tiles) sum += tile.taken;
    return sum;
  }
};

TEST(Deliveries, SayAtAnyTimeWhatTheFilmSaysAndAddUpToTheJobsThreadTime) {
  SharedPicture picture;
  do {
    const auto film = picture.farm.film(picture.job);
    const Deliveries deliveries = picture.farm.deliveries(picture.job).value();
    ASSERT_EQ(deliveries.tiles.size(), tile_count(six_tiles));
    for (std::uint32_t tile = 0; tile < tile_count(six_tiles); ++tile) {
      EXPECT_EQ(deliveries.tiles[tile].passes, film->passes_of(tile));
      EXPECT_EQ(deliveries.tiles[tile].taken > 0s, film->passes_of(tile) != 0);
    }
    EXPECT_EQ(picture.total(), picture.farm.job(picture.job, 0s)->thread_time);
  } while (picture.steps());
  EXPECT_TRUE(picture.farm.film(picture.job)->is_complete());
}

TEST(Deliveries, NameWhoDeliveredEachPassAsManyAsTheWorkersCount) {
  SharedPicture picture;
  std::vector<std::string> names_before;
  while (picture.steps()) {
    const std::vector<std::string> names = picture.farm.deliveries(picture.job)->names;
    ASSERT_LE(names_before.size(), names.size());
    EXPECT_TRUE(std::equal(names_before.begin(), names_before.end(), names.begin())) << "grows at its end";
    names_before = names;
  }
  const Deliveries deliveries = picture.farm.deliveries(picture.job).value();
  std::map<std::string, std::uint64_t> pixels;
  for (std::uint32_t tile = 0; tile < tile_count(six_tiles); ++tile)
    for (int pass = 0; pass < pass_count; ++pass)
      pixels[deliveries.names.at(deliveries.tiles[tile].by[pass])] +=
          pixel_count(tile_at(six_tiles, tile), pass);
  for (const WorkerView& worker : picture.farm.workers())
    EXPECT_EQ(pixels[worker.info.name], worker.pixels) << worker.info.name;
  EXPECT_EQ(pixels.size(), 3u);
}

TEST(Deliveries, OutliveTheirWorkers) {
  Farm farm;
  FakeWorker first(farm, {.name = "first"});
  const JobId job = farm.submit(job_of(six_tiles), 0s);
  first.finish_one(1s);
  farm.remove_worker(first.id(), "gone", 1s);
  FakeWorker second(farm, {.name = "second"}, 1s);
  second.finish_all(2s);
  EXPECT_EQ(farm.deliveries(job)->names, (std::vector<std::string>{"first", "second"}));
}

TEST(Deliveries, TakeNoLongerThanTheirLeases) {
  for (const double lie :
       {1e9, -1e9, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Farm farm;
    FakeWorker worker(farm, {.name = "pc"});
    const JobId job = farm.submit(job_of({64, 64}), 0s);
    worker.finish_one(5s, lie);
    EXPECT_EQ(farm.job(job, 5s)->thread_time, lie > 0 ? 5s : 0s) << lie;
  }
}

TEST(Deliveries, AreThereAsLongAsTheFilm) {
  Farm farm({.film_bytes = 0});
  const JobId job = farm.submit(job_of({64, 64}), 0s);
  EXPECT_FALSE(farm.deliveries(job));
  FakeWorker worker(farm, {.name = "pc"});
  EXPECT_TRUE(farm.deliveries(job));
  worker.finish_all(3s);
  EXPECT_TRUE(farm.deliveries(job));
  farm.submit(job_of({64, 64}), 4s);
  worker.finish_all(5s);
  EXPECT_FALSE(farm.deliveries(job));
  EXPECT_EQ(farm.job(job, 5s)->thread_time, 1s);
}

TEST(Farm, AJobSaysHowLongItWaited) {
  Farm farm;
  const JobId job = farm.submit(job_of({64, 64}), 5s), never = farm.submit(job_of({64, 64}), 5s);
  EXPECT_EQ(farm.job(job, 7s)->waited, 2s);
  farm.cancel(never, 8s);
  FakeWorker worker(farm, {.name = "pc"}, 9s);
  worker.finish_all(15s);
  EXPECT_EQ(farm.job(job, 20s)->waited, 4s);
  EXPECT_EQ(farm.job(never, 20s)->waited, 3s);
}

}  // namespace
}  // namespace rayfarm
