// Workers that come back with what they held: after the network was cut, or after the master died.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "tests/master/farm/fake_worker.h"
#include "tests/master/farm/rebuilt_farm.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size ten_tiles{10 * 64, 64};

WorkerInfo remote(std::string name, std::uint32_t threads = 2) {
  return {.name = std::move(name), .threads = threads};
}

std::vector<LeaseId> unneeded_in(const std::vector<ToWorker>& messages) {
  std::vector<LeaseId> leases;
  for (const ToWorker& message : messages)
    if (const auto* unneeded = std::get_if<Unneeded>(&message))
      std::ranges::copy(unneeded->leases, std::back_inserter(leases));
  return leases;
}

bool holds_tile(const FakeWorker& worker, std::uint32_t tile) {
  return std::ranges::count(worker.held(), tile, &Assignment::tile) == 1;
}

/// A farm that died while a worker held tiles, and was built again from its records.
struct DeadMaster {
  std::vector<FarmRecord> records;
  std::vector<HeldAssignment> held;
  JobId job{};
  Farm farm = after_death();

  Farm after_death() {
    Farm first;
    FakeWorker worker(first, remote("pc"));
    job = first.submit(job_of(ten_tiles), 0s);
    worker.finish_one(1s);
    held = worker.held();
    records = first.take_records();
    return Farm({}, past_of(records), 2s);
  }
};

TEST(Reattach, AWorkerIsAskedForWhatItHeldWhenTheMasterDied) {
  DeadMaster dead;
  FakeWorker worker(dead.farm, remote("pc", 1), 2s);
  ASSERT_EQ(dead.held.size(), 4u);
  const Assignment far = dead.held.back();
  ASSERT_FALSE(holds_tile(worker, far.tile)) << "else there is nothing to be seen";
  dead.farm.receive(worker.id(), Holds{{{far, true}}}, 2s);
  EXPECT_TRUE(holds_tile(worker, far.tile));
  EXPECT_TRUE(unneeded_in(worker.take_messages()).empty());
  while (!worker.held().empty()) worker.finish_one(3s);
  EXPECT_EQ(dead.farm.job(dead.job, 3s)->counters, made_up_counters(ten_tiles));
  EXPECT_EQ(dead.farm.film(dead.job)->rgb(), made_up_picture(dead.job, ten_tiles));
}

TEST(Reattach, WhatIsFinishedIsAskedForThoughAnotherHoldsItButWhatIsNotIsLeftToTheOther) {
  for (const bool is_finished : {true, false}) {
    DeadMaster dead;
    FakeWorker other(dead.farm, remote("other", 8), 2s), worker(dead.farm, remote("pc", 1), 2s);
    ASSERT_TRUE(holds_tile(other, dead.held[0].tile));
    dead.farm.receive(worker.id(), Holds{{{dead.held[0], is_finished}}}, 2s);
    EXPECT_EQ(holds_tile(worker, dead.held[0].tile), is_finished);
    EXPECT_EQ(unneeded_in(worker.take_messages()).size(), is_finished ? 0u : 1u);
    while (!worker.held().empty()) worker.finish_one(3s);
    EXPECT_EQ(holds_tile(other, dead.held[0].tile), !is_finished);
    while (!other.held().empty()) other.finish_one(3s);
    EXPECT_EQ(dead.farm.job(dead.job, 3s)->counters, made_up_counters(ten_tiles));
  }
}

// It was forgotten, and rendered to its end by the others.
TEST(Reattach, WhatIsFinishedIsAskedForThoughOthersShareOrDoubleItAndIsNotSharedAgain) {
  for (const bool is_shared : {true, false}) {
    Farm farm;
    FakeWorker slow(farm, remote("slow", 1));
    const JobId job = farm.submit(job_of({64, 64}), 0s);
    FakeWorker other(farm, {.name = "other", .threads = 4, .takes_pieces = is_shared}, 100ms);
    FarmTime now = 100ms;
    while (other.held().empty() && now < 10s) farm.tick(now += 1s);
    ASSERT_EQ(other.held().at(0).piece.has_value(), is_shared);
    FakeWorker back(farm, remote("back", 1), now);
    farm.receive(back.id(), Holds{{{{LeaseId{7}, job, 0, 0, all_passes}, true}}}, now);
    farm.tick(now += 10ms);
    ASSERT_EQ(back.held().size(), 1u);
    EXPECT_FALSE(back.held()[0].piece);
    EXPECT_TRUE(other.held().empty()) << "two are enough";
    back.finish_one(now);
    EXPECT_TRUE(slow.held().empty());
    EXPECT_EQ(farm.job(job, now)->state, JobState::done);
    EXPECT_EQ(farm.job(job, now)->counters, made_up_counters({64, 64}));
  }
}

TEST(Reattach, WhatIsThereAlreadyIsUnneeded) {
  DeadMaster dead;
  FakeWorker other(dead.farm, remote("other"), 2s);
  while (!other.held().empty()) other.finish_one(3s);
  FakeWorker worker(dead.farm, remote("pc"), 3s);
  dead.farm.receive(worker.id(), Holds{{{dead.held[0], true}}}, 3s);
  EXPECT_TRUE(worker.held().empty());
  EXPECT_EQ(unneeded_in(worker.take_messages()), std::vector{dead.held[0].lease});
}

TEST(Reattach, OnlyThePassesThatAreMissingAreAskedFor) {
  DeadMaster dead;
  FakeWorker threads(dead.farm, {.name = "master", .threads = 1, .kind = WorkerKind::local}, 2s);
  const std::uint32_t tile = dead.held[3].tile;
  FarmTime now = 2s;
  for (bool is_it = false; !is_it; threads.finish_one(now += 1s)) is_it = threads.held().at(0).tile == tile;
  FakeWorker worker(dead.farm, remote("pc", 1), now);
  dead.farm.receive(worker.id(), Holds{{{dead.held[3], true}}}, now);
  const auto given = std::ranges::find(worker.held(), tile, &Assignment::tile);
  ASSERT_NE(given, worker.held().end());
  EXPECT_EQ(given->passes, all_passes & ~1);
}

TEST(Reattach, WhatIsNoWorkOfThisFarmIsUnneeded) {
  DeadMaster dead;
  FakeWorker worker(dead.farm, remote("pc"), 2s);
  const std::size_t held = worker.held().size();
  const std::vector<Assignment> strange{{LeaseId{1}, JobId{77}, 0, 0, all_passes},
                                        {LeaseId{2}, dead.job, 5, 0, all_passes},
                                        {LeaseId{3}, dead.job, 0, 1000, all_passes}};
  Holds holds;
  for (const Assignment& work : strange) holds.tiles.push_back({work, true});
  dead.farm.receive(worker.id(), holds, 2s);
  EXPECT_EQ(worker.held().size(), held);
  EXPECT_EQ(unneeded_in(worker.take_messages()), (std::vector{LeaseId{1}, LeaseId{2}, LeaseId{3}}));
}

TEST(Reattach, NobodyIsAskedWhenItIsDrainedOrToGoOnWithAJobThatIsPaused) {
  for (const bool is_paused : {true, false}) {
    DeadMaster dead;
    FakeWorker worker(dead.farm, remote("pc"), 2s);
    is_paused ? dead.farm.pause(dead.job, 2s) : dead.farm.drain("pc", 2s);
    dead.farm.receive(worker.id(), Holds{{{dead.held[0], !is_paused}}}, 2s);
    EXPECT_TRUE(worker.held().empty());
  }
}

TEST(Reattach, WhatIsFinishedOfAPausedJobIsTakenAlthoughNothingIsRendered) {
  DeadMaster dead;
  dead.farm.pause(dead.job, 2s);
  FakeWorker worker(dead.farm, remote("pc", 1), 2s);
  Holds holds;
  for (const Assignment& work : dead.held) holds.tiles.push_back({work, true});
  const std::uint64_t before = dead.farm.job(dead.job, 2s)->pixels_done;
  dead.farm.receive(worker.id(), holds, 2s);
  EXPECT_EQ(worker.held().size(), dead.held.size());
  EXPECT_TRUE(unneeded_in(worker.take_messages()).empty());
  while (!worker.held().empty()) worker.finish_one(3s);
  EXPECT_EQ(dead.farm.job(dead.job, 3s)->state, JobState::paused);
  EXPECT_EQ(dead.farm.job(dead.job, 3s)->pixels_done, before + dead.held.size() * 64 * 64);
  dead.farm.resume(dead.job, 4s);
  while (!worker.held().empty()) worker.finish_one(5s);
  EXPECT_EQ(dead.farm.job(dead.job, 5s)->counters, made_up_counters(ten_tiles));
  EXPECT_EQ(dead.farm.film(dead.job)->rgb(), made_up_picture(dead.job, ten_tiles));
}

TEST(Reattach, AfterTheNetworkWasCutAWorkerGoesOnToo) {
  Farm farm;
  FakeWorker cut(farm, remote("pc"));
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  const std::vector<HeldAssignment> held = cut.held();
  farm.remove_worker(cut.id(), "it was silent", 2s);
  FakeWorker again(farm, remote("pc", 1), 3s);
  farm.receive(again.id(), Holds{{{held[1], false}}}, 3s);
  EXPECT_TRUE(holds_tile(again, held[1].tile));
  while (!again.held().empty()) again.finish_one(4s);
  EXPECT_EQ(farm.job(job, 4s)->counters, made_up_counters(ten_tiles));
}

// A worker notices a cut at once, the master after 2 s of silence: it had become "pc-2" meanwhile.
TEST(Reattach, AWorkerThatIsBackBeforeItsOldConnectionIsNoticedDeadIsTheSame) {
  Farm farm;
  WorkerInfo info = remote("pc");
  info.process = 7, info.certificate = "c0";
  FakeWorker cut(farm, info);
  const JobId job = farm.submit(job_of(ten_tiles), 0s);
  const std::vector<HeldAssignment> held = cut.held();
  FakeWorker again(farm, info, 1s);
  EXPECT_EQ(again.name(), "pc");
  EXPECT_EQ(farm.workers().size(), 1u);
  ASSERT_FALSE(cut.take_messages().empty());
  EXPECT_EQ(again.held().at(0).tile, held.at(0).tile) << "it is likely to have that at hand";
  farm.receive(again.id(), Holds{{{held[1], true}}}, 1s);
  const Result from_the_grave = rendered(held[0], ten_tiles);
  farm.receive(cut.id(), from_the_grave, 1s);
  farm.receive(cut.id(), GiveBack{{held[0].lease}, "out of memory"}, 1s);
  farm.remove_worker(cut.id(), "it was silent", 2s);
  EXPECT_EQ(farm.workers().size(), 1u);
  EXPECT_NO_THROW(farm.receive(again.id(), from_the_grave, 2s)) << "a network may have sent it on twice";
  EXPECT_EQ(farm.trust_in("pc"), Trust{});
  while (!again.held().empty()) again.finish_one(4s);
  EXPECT_EQ(farm.job(job, 4s)->counters, made_up_counters(ten_tiles));
  EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, ten_tiles));
}

TEST(Reattach, TwoProgramsOfOneCertificateAreTwo) {
  Farm farm;
  WorkerInfo info = remote("pc");
  info.certificate = "c0";
  for (const std::uint64_t process : {0u, 0u, 7u, 8u}) {
    info.process = process;
    const FakeWorker worker(farm, info);
  }
  EXPECT_EQ(farm.workers().size(), 4u);
}

TEST(Reattach, WhatWasRenderedBeforeTeachesNoSpeed) {
  for (const bool is_copy : {false, true}) {
    DeadMaster dead;
    std::optional<FakeWorker> other;
    if (is_copy) other.emplace(dead.farm, remote("other", 8), 2s);
    FakeWorker worker(dead.farm, remote("pc", 1), 2s);
    const Assignment held = is_copy ? dead.held.front() : dead.held.back();
    dead.farm.receive(worker.id(), Holds{{{held, true}}}, 2s);
    const auto given = std::ranges::find(worker.held(), held.tile, &Assignment::tile);
    ASSERT_NE(given, worker.held().end());
    const Result result = rendered(*given, ten_tiles, 1);
    worker.drop(result.lease);
    dead.farm.receive(worker.id(), result, 2s + 1ms);
    EXPECT_EQ(dead.farm.workers().back().samples_per_second, 0);
    EXPECT_LE(worker.held().size(), 3u);
  }
}

TEST(Reattach, WhatItHoldsAWorkerTellsOnceAndBeforeItsFirstResult) {
  DeadMaster dead;
  FakeWorker once(dead.farm, remote("pc"), 2s), late(dead.farm, remote("late"), 2s);
  const Holds holds{{{dead.held[0], true}}};
  EXPECT_NO_THROW(dead.farm.receive(once.id(), holds, 2s));
  EXPECT_THROW(dead.farm.receive(once.id(), holds, 2s), WorkerError);
  late.finish_one(3s);
  EXPECT_THROW(dead.farm.receive(late.id(), holds, 3s), WorkerError);
}

TEST(Reattach, AWorkerHoldsNoMoreThanItCan) {
  DeadMaster dead;
  FakeWorker worker(dead.farm, remote("pc"), 2s);
  const Holds too_many{std::vector<HeldTile>(2113, {dead.held[0], true})};
  EXPECT_THROW(dead.farm.receive(worker.id(), too_many, 2s), WorkerError);
}

TEST(Reattach, OfWhatIsNotFinishedItGoesOnWithWhatItCanHaveBegun) {
  DeadMaster dead;
  FakeWorker worker(dead.farm, remote("pc", 1), 2s);
  Holds holds;
  for (std::uint32_t tile = 0; tile < 10; ++tile) {
    Assignment work = dead.held[0];
    work.tile = tile, work.lease = LeaseId{100 + tile};
    holds.tiles.push_back({work, false});
  }
  const std::size_t before = worker.held().size();
  dead.farm.receive(worker.id(), holds, 2s);
  EXPECT_EQ(worker.held().size(), before + 3) << "one thread, two to spare";
}

TEST(Reattach, WhatIsFinishedIsAnOpinionWhenItsTileIsOnTrial) {
  Farm farm;
  FakeWorker cut(farm, remote("pc"));
  JobSpec spec = job_of(ten_tiles);
  spec.verification = Quorum{2};
  const JobId job = farm.submit(spec, 0s);
  const std::vector<HeldAssignment> held = cut.held();
  farm.remove_worker(cut.id(), "it was silent", 1s);
  FakeWorker other(farm, remote("other", 1), 1s);
  while (!other.held().empty()) other.finish_one(2s);
  FakeWorker again(farm, remote("pc", 1), 3s);
  const auto is_held_anyway = [&](const Assignment& work) { return holds_tile(again, work.tile); };
  const auto far = std::ranges::find_if_not(held, is_held_anyway);
  ASSERT_NE(far, held.end());
  farm.receive(again.id(), Holds{{{*far, true}}}, 3s);
  EXPECT_TRUE(holds_tile(again, far->tile));
  EXPECT_TRUE(unneeded_in(again.take_messages()).empty());
  while (!again.held().empty()) again.finish_one(4s);
  EXPECT_EQ(farm.job(job, 4s)->counters, made_up_counters(ten_tiles));
}

}  // namespace
}  // namespace rayfarm
