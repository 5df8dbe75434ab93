// Lies that need no second opinion: what breaks the rules of the conversation.
#include <gtest/gtest.h>

#include <limits>
#include <map>

#include "tests/master/farm/liar.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

const std::map<std::string, Lie> lies{
    {"a NaN", [](Result& r) { r.images[1].rgb[7] = std::numeric_limits<float>::quiet_NaN(); }},
    {"infinity", [](Result& r) { r.images[0].rgb[0] = -std::numeric_limits<float>::infinity(); }},
    {"another tile", [](Result& r) { r.tile ^= 1; }},
    {"another job's", [](Result& r) { r.job = JobId{77}; }},
    {"too few pixels", [](Result& r) { r.images[3].rgb.pop_back(); }},
    {"a pass less", [](Result& r) { r.images.pop_back(); }},
    {"a lease never given", [](Result& r) { r.lease = LeaseId{1'000'000}; }},
};

const std::vector<Verification> all_verifications{{}, Audit{1}, Audit{0.01}, Quorum{2}};

/// A worker that was caught comes again, as the real one does.
struct Liar {
  Farm& farm;
  Lie lie;
  std::optional<FakeWorker> here{};

  /// Whether a lie was told.
  bool act(FarmTime now) {
    if (!here && farm.objection_to("liar")) return false;
    if (!here) here.emplace(farm, remote("liar"), now);
    if (here->held().empty()) return false;
    Result result = rendered(here->held()[0], forty_tiles);
    lie(result);
    EXPECT_THROW(farm.receive(here->id(), result, now), WorkerError);
    farm.remove_worker(here->id(), "it lied", now);
    here.reset();
    return true;
  }
};

TEST(Lies, AreRefusedToldCountedAndTheSecondBansWhateverTheVerification) {
  for (const Verification& verification : all_verifications)
    for (const auto& [what, lie] : lies) {
      SCOPED_TRACE(text_of(verification) + ", " + what);
      Farm farm;
      const JobId job = farm.submit(verified(verification), 0s);
      Liar liar{farm, lie};
      EXPECT_TRUE(liar.act(1s));
      EXPECT_EQ(farm.trust_in("liar").mismatches, 1u);
      EXPECT_FALSE(is_banned(farm, "liar"));
      EXPECT_TRUE(liar.act(2s));
      EXPECT_TRUE(is_banned(farm, "liar"));
      EXPECT_FALSE(liar.act(3s)) << "it is not let in";
      const std::vector<FarmEvent> events = farm.take_events();
      EXPECT_GE(
          std::ranges::count_if(events, [](const FarmEvent& e) { return e.warning && e.worker == "liar"; }),
          3);
      FakeWorker a(farm, remote("a"), 4s), b(farm, remote("b"), 4s);
      while (!a.held().empty() || !b.held().empty()) deliver_one(farm, a, 5s), deliver_one(farm, b, 5s);
      expect_right_picture(farm, job, 5s);
    }
}

TEST(Lies, OnceSeenNothingStaysThatTheirWorkerDelivered) {
  Farm farm;
  FakeWorker liar(farm, remote("liar"));
  const JobId job = farm.submit(job_of(forty_tiles), 0s);
  for (int i = 0; i < 10; ++i) deliver_one(farm, liar, 1s, one_ulp);
  EXPECT_THROW(deliver_one(farm, liar, 1s, lies.at("a NaN")), WorkerError);
  farm.remove_worker(liar.id(), "it lied", 1s);
  FakeWorker honest(farm, remote("honest"), 2s);
  while (!honest.held().empty()) deliver_one(farm, honest, 3s);
  expect_right_picture(farm, job, 3s);
}

// One that reconnects as a new program each time had failed its job as one over which five workers are lost.
TEST(Lies, FailNoJob) {
  Farm farm;
  FakeWorker honest(farm, remote("honest"));
  const JobId job = farm.submit(job_of(forty_tiles), 0s);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    WorkerInfo info = remote("pc" + std::to_string(i));
    info.process = i, info.certificate = "c" + std::to_string(i);
    FakeWorker liar(farm, info, 1s);
    ASSERT_FALSE(liar.held().empty());
    EXPECT_THROW(deliver_one(farm, liar, 1s, lies.at("another tile")), WorkerError);
    farm.remove_worker(liar.id(), "it lied", 1s);
  }
  while (!honest.held().empty()) deliver_one(farm, honest, 2s);
  expect_right_picture(farm, job, 2s);
}

TEST(Lies, OfTwoConnectionsAboutOneLeaseAreSeen) {
  Farm farm;
  FakeWorker holder(farm, remote("holder")), thief(farm, remote("thief"));
  farm.submit(job_of(forty_tiles), 0s);
  EXPECT_THROW(farm.receive(thief.id(), rendered(holder.held().at(0), forty_tiles), 1s), WorkerError);
  EXPECT_EQ(farm.trust_in("thief").mismatches, 1u);
  EXPECT_EQ(farm.trust_in("holder"), Trust{});
}

TEST(Lies, AResultThatWasOnItsWayIsNone) {
  Farm farm;
  FakeWorker late(farm, remote("late"));
  const JobId job = farm.submit(job_of(forty_tiles), 0s);
  const std::vector<HeldAssignment> held = late.held();
  farm.pause(job, 1s);
  for (const Assignment& work : held)
    EXPECT_NO_THROW(farm.receive(late.id(), rendered(work, forty_tiles), 1s));
  for (const Assignment& work : held)
    EXPECT_THROW(farm.receive(late.id(), rendered(work, forty_tiles), 1s), WorkerError) << "twice";
}

TEST(Lies, HoweverMuchIsRevokedNoHonestAnswerIsOne) {
  Farm farm;
  FakeWorker late(farm, remote("late", 64));
  const JobId job = farm.submit(job_of({64 * 64, 64}), 0s);
  std::vector<HeldAssignment> held;
  for (int i = 0; i < 40; ++i) {
    std::ranges::copy(late.held(), std::back_inserter(held));
    farm.pause(job, 1s);
    farm.resume(job, 1s);
  }
  for (const Assignment& work : held)
    EXPECT_NO_THROW(farm.receive(late.id(), rendered(work, {64 * 64, 64}), 2s));
}

TEST(Lies, CostTimeThatWasWasted) {
  Farm farm;
  FakeWorker liar(farm, remote("liar"));
  const JobId job = farm.submit(job_of(forty_tiles), 0s);
  for (int i = 1; i <= 4; ++i) deliver_one(farm, liar, i * 1s, one_ulp);
  EXPECT_EQ(farm.job(job, 4s)->thread_time, 4s);
  EXPECT_THROW(deliver_one(farm, liar, 5s, lies.at("a NaN")), WorkerError);
  farm.remove_worker(liar.id(), "it lied", 5s);
  EXPECT_EQ(farm.job(job, 5s)->thread_time, 0s);
  EXPECT_GE(farm.job(job, 5s)->time_wasted, 4s);

  const JobId checked = farm.submit(verified(Quorum{2}, {64, 64}), 5s);
  farm.cancel(job, 5s);
  FakeWorker wrong(farm, remote("wrong", 1), 5s), a(farm, remote("a", 1), 5s), b(farm, remote("b", 1), 5s);
  const auto say = [&](FakeWorker& worker, FarmTime now, const Lie& lie) {
    if (worker.held().empty()) return;
    Result result = rendered(worker.held()[0], {64, 64});
    worker.drop(result.lease);
    lie(result);
    farm.receive(worker.id(), result, now);
  };
  say(wrong, 7s, one_ulp), say(a, 9s, nothing), say(b, 11s, nothing);
  EXPECT_EQ(farm.job(checked, 11s)->state, JobState::done);
  EXPECT_EQ(farm.job(checked, 11s)->thread_time, 1s) << "of the pixels that were taken";
  EXPECT_EQ(farm.job(checked, 11s)->time_wasted, 1s) << "of those that were wrong";
}

TEST(Lies, ALateResultIsAnOpinionWhileItsTileIsOnTrial) {
  for (const Lie& lie : {Lie(nothing), Lie(one_ulp)}) {
    Farm farm;
    FakeWorker late(farm, remote("late"));
    const JobId job = farm.submit(verified(Quorum{2}, {64, 64}), 0s);
    const Assignment revoked = late.held().at(0);
    farm.drain("late", 1s);
    FakeWorker other(farm, remote("other"), 1s);
    farm.receive(other.id(), rendered(other.held().at(0), {64, 64}), 2s);
    Result result = rendered(revoked, {64, 64});
    lie(result);
    farm.receive(late.id(), result, 3s);
    const bool is_honest = result == rendered(revoked, {64, 64});
    EXPECT_EQ(farm.job(job, 3s)->state, is_honest ? JobState::done : JobState::running);
    FakeWorker third(farm, remote("third"), 4s);
    for (const Assignment& work : std::vector(third.held()))
      farm.receive(third.id(), rendered(work, {64, 64}), 5s);
    EXPECT_EQ(farm.job(job, 5s)->state, JobState::done);
    EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, {64, 64}));
    EXPECT_EQ(farm.trust_in("late").mismatches, is_honest ? 0u : 1u);
  }
}

TEST(Lies, OfABannedWorkerAreNotHeard) {
  Farm farm;
  FakeWorker banned(farm, remote("banned"));
  const JobId job = farm.submit(verified(Quorum{2}, {64, 64}), 0s);
  const Assignment revoked = banned.held().at(0);
  farm.ban("banned", 1s);
  FakeWorker other(farm, remote("other"), 1s);
  farm.receive(other.id(), rendered(other.held().at(0), {64, 64}), 2s);
  farm.receive(banned.id(), rendered(revoked, {64, 64}), 3s);
  EXPECT_EQ(farm.job(job, 3s)->pixels_done, 0u);
}

}  // namespace
}  // namespace rayfarm
