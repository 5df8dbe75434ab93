// Tiles that idle workers share.
#include <gtest/gtest.h>

#include <algorithm>

#include "master/farm_record.h"
#include "tests/master/farm/liar.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

constexpr Size one_tile{64, 64};

WorkerInfo sharing(std::string name, std::uint32_t threads) {
  return {.name = std::move(name), .threads = threads, .takes_pieces = true};
}

/// One tile, and many threads.
struct OneTile {
  Farm farm;
  FakeWorker a{farm, sharing("a", 4)}, b{farm, sharing("b", 4)};
  JobId job = farm.submit(job_of(one_tile), 0s);

  JobView view(FarmTime now) const { return *farm.job(job, now); }
  void expect_done(FarmTime now) {
    EXPECT_EQ(view(now).state, JobState::done);
    EXPECT_EQ(view(now).counters, made_up_counters(one_tile));
    EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, one_tile));
    EXPECT_TRUE(a.held().empty() && b.held().empty());
  }
  void finish(FarmTime now) {
    while (!a.held().empty() || !b.held().empty()) (a.held().empty() ? b : a).finish_one(now);
  }
};

TEST(SharedTiles, AreRenderedByAllWhoHaveNothingElseToDo) {
  OneTile shared;
  EXPECT_EQ(shared.a.held().size(), 4u);
  EXPECT_EQ(shared.b.held().size(), 4u);
  for (const HeldAssignment& held : shared.b.held()) EXPECT_EQ(held.piece->x1 - held.piece->x0, 16u);
  shared.finish(1s);
  shared.expect_done(1s);
  EXPECT_EQ(shared.view(1s).tiles_shared, 1u);
  EXPECT_EQ(shared.view(1s).time_wasted, 0s);
  EXPECT_EQ(shared.view(1s).thread_time, 8 * 1s) << "of the first eight; the others took none";
}

TEST(SharedTiles, AreCommittedOnce) {
  OneTile shared;
  shared.farm.take_records();
  shared.finish(1s);
  const std::vector<FarmRecord> records = shared.farm.take_records();
  EXPECT_EQ(std::ranges::count_if(
                records, [](const auto& r) { return std::holds_alternative<TileCommitted>(r.fact); }),
            1);
}

TEST(SharedTiles, OfALostWorkerOnlyItsPiecesAreDoneAgain) {
  OneTile shared;
  for (int i = 0; i < 2; ++i) shared.b.finish_one(1s);
  shared.farm.remove_worker(shared.a.id(), "gone", 2s);
  int pieces = 2;
  while (!shared.b.held().empty()) shared.b.finish_one(3s), ++pieces;
  EXPECT_EQ(pieces, 16);
  EXPECT_EQ(shared.view(3s).counters, made_up_counters(one_tile));
}

TEST(SharedTiles, GoWholeToAWorkerThatTakesNoPiecesWhenNobodyElseIsThere) {
  OneTile shared;
  shared.a.finish_one(1s);
  shared.farm.remove_worker(shared.a.id(), "gone", 2s);
  shared.farm.remove_worker(shared.b.id(), "gone", 2s);
  FakeWorker old(shared.farm, {.name = "old"}, 3s);
  ASSERT_EQ(old.held().size(), 1u);
  EXPECT_FALSE(old.held()[0].piece);
  old.finish_one(4s);
  EXPECT_EQ(shared.view(4s).state, JobState::done);
  EXPECT_EQ(shared.view(4s).counters, made_up_counters(one_tile));
  EXPECT_GT(shared.view(4s).rays_wasted, 0u) << "of the piece that was there";
}

// Pieces that were late were doubled by whoever was idle. Who speaks no pieces ends the conversation.
TEST(SharedTiles, GoWholeToAWorkerThatTakesNoPiecesWhenThosePiecesNeverComeThatOthersHold) {
  OneTile shared;
  FakeWorker old(shared.farm, {.name = "old", .threads = 4}, 100ms);
  EXPECT_TRUE(old.held().empty()) << "none is late";
  for (FarmTime now = 200ms; now < 20s; now += 100ms) shared.farm.tick(now);
  ASSERT_EQ(old.held().size(), 1u);
  EXPECT_FALSE(old.held()[0].piece);
  old.finish_one(20s);
  shared.expect_done(20s);
}

TEST(SharedTiles, ArePausedResumedAndCancelledAsOthersAre) {
  for (const bool is_cancelled : {false, true}) {
    OneTile shared;
    shared.a.finish_one(1s);
    shared.farm.pause(shared.job, 2s);
    EXPECT_TRUE(shared.a.held().empty() && shared.b.held().empty());
    if (is_cancelled) {
      shared.farm.cancel(shared.job, 3s);
      EXPECT_EQ(shared.view(3s).state, JobState::cancelled);
      continue;
    }
    shared.farm.resume(shared.job, 3s);
    EXPECT_EQ(shared.a.held().size() + shared.b.held().size(), 8u);
    shared.finish(4s);
    shared.expect_done(4s);
  }
}

/// A slow worker has begun the only tile when others come.
struct Begun {
  Farm farm;
  FakeWorker slow{farm, sharing("slow", 1)};
  JobId job = farm.submit(job_of(one_tile), 0s);
  FakeWorker fast{farm, sharing("fast", 8), 100ms};

  JobView view(FarmTime now) const { return *farm.job(job, now); }
};

TEST(SharedTiles, ThatWereBegunAreGoneOnWith) {
  Begun begun;
  EXPECT_EQ(begun.slow.held().size(), 1u);
  EXPECT_EQ(begun.fast.held().size(), 8u);
}

TEST(SharedTiles, AreTakenFromWhoIsFirst) {
  for (const bool pieces_are_first : {false, true}) {
    Begun begun;
    begun.fast.finish_one(200ms);
    if (pieces_are_first)
      begun.fast.finish_all(300ms);
    else
      begun.slow.finish_one(300ms);
    EXPECT_TRUE(begun.slow.held().empty());
    EXPECT_TRUE(begun.fast.held().empty());
    EXPECT_EQ(begun.view(1s).state, JobState::done);
    EXPECT_EQ(begun.view(1s).counters, made_up_counters(one_tile));
    EXPECT_EQ(begun.farm.film(begun.job)->rgb(), made_up_picture(begun.job, one_tile));
    EXPECT_GT(begun.view(1s).time_wasted, 0s);
  }
}

// The whole tile and all pieces of it were with one worker, which was doubled by nobody.
TEST(SharedTiles, ThatOneWorkerHoldsAloneAreDoneByAnotherWhenItNeverAnswers) {
  Farm farm;
  FakeWorker stuck(farm, sharing("stuck", 8));
  const JobId job = farm.submit(job_of({8 * 64, 64}), 0s);
  for (int i = 0; i < 6; ++i) stuck.finish_one(1s);
  FarmTime now = 1s;
  while (stuck.held().size() <= 2 && now < 10s) farm.tick(now += 100ms);
  ASSERT_FALSE(stuck.held()[0].piece) << "it was begun long ago";
  ASSERT_TRUE(stuck.held().back().piece) << "six threads are free for it";
  FakeWorker other(farm, sharing("other", 2), now);
  while (farm.job(job, now)->state != JobState::done && now < 60s) {
    farm.tick(now += 100ms);
    other.finish_all(now);
  }
  EXPECT_EQ(farm.job(job, now)->state, JobState::done);
  EXPECT_EQ(farm.job(job, now)->counters, made_up_counters({8 * 64, 64}));
}

TEST(SharedTiles, LosersThatComeLateAreComparedAndNoMismatch) {
  Begun begun;
  const HeldAssignment piece = begun.fast.held().at(3), whole = begun.slow.held().at(0);
  begun.farm.take_events();
  begun.slow.finish_one(300ms);
  begun.farm.receive(begun.fast.id(), rendered_piece(piece), 400ms);
  Begun other;
  other.farm.take_events();
  other.fast.finish_all(300ms);
  other.farm.receive(other.slow.id(), rendered(whole, one_tile), 400ms);
  for (Farm* farm : {&begun.farm, &other.farm})
    for (const FarmEvent& event : farm->take_events()) EXPECT_FALSE(event.warning) << event.text;
}

TEST(SharedTiles, ALatePieceWithOtherPixelsIsAnAlarm) {
  Begun begun;
  PieceResult lie = rendered_piece(begun.fast.held().at(3));
  lie.result.images.back().rgb.front() += 1;
  begun.farm.take_events();
  begun.slow.finish_one(300ms);
  begun.farm.receive(begun.fast.id(), lie, 400ms);
  const std::vector<FarmEvent> events = begun.farm.take_events();
  EXPECT_TRUE(std::ranges::any_of(events, &FarmEvent::warning));
}

TEST(SharedTiles, AResultOfAnotherAreaIsAFault) {
  OneTile other, whole, outside;
  PieceResult result = rendered_piece(other.a.held().at(1));
  result.result.lease = other.a.held().at(0).lease;
  EXPECT_THROW(other.farm.receive(other.a.id(), result, 1s), WorkerError);
  EXPECT_THROW(whole.farm.receive(whole.a.id(), rendered(whole.a.held().at(0), one_tile), 1s), WorkerError);
  result = rendered_piece(outside.a.held().at(0));
  result.area = {64, 0, 80, 16};
  EXPECT_THROW(outside.farm.receive(outside.a.id(), result, 1s), WorkerError);
}

TEST(SharedTiles, OfALiarNoPieceStaysAndItsTimeWasWasted) {
  OneTile shared;
  for (int i = 0; i < 3; ++i) shared.b.finish_one(1s);
  shared.a.finish_one(1s);
  PieceResult lie = rendered_piece(shared.b.held().at(0));
  lie.result.images.pop_back();
  EXPECT_THROW(shared.farm.receive(shared.b.id(), lie, 1s), WorkerError);
  shared.farm.remove_worker(shared.b.id(), "it lied", 1s);
  EXPECT_EQ(shared.view(1s).time_wasted, 4s) << "on three pieces, and the one it was caught with";
  EXPECT_GT(shared.view(1s).rays_wasted, 0u);
  int pieces = 1;
  while (!shared.a.held().empty()) shared.a.finish_one(2s), ++pieces;
  EXPECT_EQ(pieces, 16);
  EXPECT_EQ(shared.view(2s).counters, made_up_counters(one_tile));
  EXPECT_EQ(shared.farm.film(shared.job)->rgb(), made_up_picture(shared.job, one_tile));
}

TEST(SharedTiles, AreNoneOfAJobThatIsVerified) {
  Farm farm;
  FakeWorker a(farm, sharing("a", 4)), b(farm, sharing("b", 4));
  JobSpec spec = job_of(one_tile);
  spec.verification = Quorum{2};
  farm.submit(std::move(spec), 0s);
  for (const FakeWorker* worker : {&a, &b})
    for (const HeldAssignment& held : worker->held()) EXPECT_FALSE(held.piece);
}

TEST(SharedTiles, ThatALiarHadAPieceOfAreRenderedAgain) {
  Farm farm;
  FakeWorker honest(farm, sharing("honest", 4)), liar(farm, sharing("liar", 4));
  JobSpec two_frames = job_of(one_tile);
  two_frames.frames = FrameRange{0, 1, 1};
  const JobId job = farm.submit(std::move(two_frames), 0s);  // one frame is still to come: it goes on
  deliver_one(farm, liar, 1s);
  farm.drain("liar", 1s);
  honest.finish_all(1s);
  ASSERT_EQ(farm.job(job, 1s)->tiles_shared, 1u);
  ASSERT_EQ(farm.job(job, 1s)->pixels_done, 64u * 64u);
  farm.undrain("liar", 2s);

  const JobId verified_job = farm.submit(verified(Quorum{2}), 2s);
  FakeWorker third(farm, sharing("third", 4), 2s);
  FarmTime now = 2s;
  while (farm.trust_in("liar").mismatches == 0) {
    now += 10ms;
    deliver_one(farm, liar, now, one_ulp);
    deliver_one(farm, honest, now);
    deliver_one(farm, third, now);
    ASSERT_LT(now, 10s);
  }
  EXPECT_EQ(farm.job(job, now)->pixels_done, 0u);
  EXPECT_EQ(farm.job(verified_job, now)->state, JobState::running);
}

}  // namespace
}  // namespace rayfarm
