// Work on trial: that it comes to an end, and what a lie that was seen brings with it.
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <vector>

#include "tests/master/farm/liar.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

TEST(Trials, OnceALieIsSeenNothingStaysThatItsWorkerDeliveredUnchecked) {
  int seen = 0, seen_at_the_end = 0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    Farm farm({.secret = seed});
    FakeWorker liar(farm, remote("liar"));
    const JobId job = farm.submit(verified(Audit{0.1}), 0s);
    FakeWorker master(farm, masters_own());
    const bool learns = seed % 2 == 0;
    FarmTime now = 0s;
    while (farm.job(job, now)->state != JobState::done) {
      now += 10ms;
      const Trust before = farm.trust_in("liar");
      const JobView was = *farm.job(job, now);
      const bool lies = learns ? before.good_in_a_row >= 10 && before.mismatches == 0
                               : before.good_in_a_row >= 10 || before.mismatches > 0;
      if (random() % 2)
        deliver_one(farm, master, now);
      else
        deliver_one(farm, liar, now, lies ? one_percent : nothing);
      const bool is_last = was.pixels_done + tile_side * tile_side >= was.pixels_total;
      seen_at_the_end += is_last && farm.trust_in("liar").mismatches > before.mismatches;
    }
    if (farm.trust_in("liar").mismatches == 0) continue;
    ++seen;
    expect_right_picture(farm, job, now);
  }
  EXPECT_GT(seen, 50);
  EXPECT_GT(seen_at_the_end, 0) << "else the law was not tried where it is hard";
}

TEST(Trials, OneWorkerThatNeverAnswersStopsNoJob) {
  const std::vector<Verification> all{Audit{1}, Audit{0.1}, Quorum{2}, Quorum{3}};
  for (const Verification& verification : all)
    for (const std::size_t silent : {0u, 1u, 2u, 3u})
      for (const bool has_own_threads : {false, true}) {
        SCOPED_TRACE(text_of(verification) + ", silent " + std::to_string(silent));
        Farm farm;
        std::vector<FakeWorker> workers;
        for (const char* name : {"a", "b", "c", "d"}) workers.emplace_back(farm, remote(name));
        if (has_own_threads) workers.emplace_back(farm, masters_own());
        const JobId job = farm.submit(verified(verification), 0s);
        FarmTime now = 0s;
        for (int i = 0; i < 1000 && farm.job(job, now)->state != JobState::done; ++i) {
          farm.tick(now += 100ms);
          for (std::size_t w = 0; w < workers.size(); ++w)
            if (w != silent) deliver_one(farm, workers[w], now);
        }
        expect_right_picture(farm, job, now);
      }
}

// Two that are alive and never answer had stopped a job: one more than wanted was asked, and nobody else.
TEST(Trials, JudgesThatNeverAnswerAreNotWaitedFor) {
  constexpr Size one_tile{64, 64};
  Farm farm;
  FakeWorker a(farm, remote("a", 1)), silent(farm, remote("silent", 1)), mute(farm, remote("mute", 1)),
      b(farm, remote("b", 1));
  const JobId job = farm.submit(verified(Quorum{3}, one_tile), 0s);
  a.finish_one(1s);
  b.finish_one(2s);
  FakeWorker c(farm, remote("c", 1), 3s);
  EXPECT_TRUE(c.held().empty()) << "enough are asked";
  for (const auto now : {4s, 9s}) farm.tick(now);
  EXPECT_TRUE(c.held().empty());
  farm.tick(60s);
  c.finish_one(61s);
  EXPECT_EQ(farm.job(job, 61s)->state, JobState::done);
  EXPECT_EQ(farm.job(job, 61s)->counters, made_up_counters(one_tile));
  EXPECT_TRUE(silent.held().empty() && mute.held().empty()) << "revoked";
}

TEST(Trials, WithoutAJudgeWorkIsGivenOutOnlyUntilSomeHundredTilesWait) {
  constexpr Size large{40 * 64, 20 * 64};
  Farm farm;
  FakeWorker a(farm, remote("a", 8)), b(farm, remote("b", 8));
  JobSpec spec = verified(Quorum{3}, large);
  spec.priority = 90;
  const JobId job = farm.submit(spec, 0s), other = farm.submit(job_of(forty_tiles), 0s);
  FarmTime now = 1s;
  const auto work = [&](FakeWorker& worker, JobId of) {
    now += 1s;
    const auto next = std::ranges::find(worker.held(), of, &Assignment::job);
    if (next == worker.held().end()) return false;
    const Result result = rendered(*next, of == job ? large : forty_tiles);
    worker.drop(result.lease);
    farm.receive(worker.id(), result, now);
    return true;
  };
  int tiles = 0;
  for (bool is_any = true; is_any; ++tiles) is_any = work(a, job) | work(b, job);
  EXPECT_GT(tiles, 200);
  EXPECT_LT(tiles, 400);
  EXPECT_NE(farm.job(job, 1s)->message.find("wait for another worker to check them; until one comes"),
            std::string::npos);
  while (work(a, other) || work(b, other)) {}
  EXPECT_EQ(farm.job(other, 1s)->state, JobState::done) << "of less priority";

  const std::uint64_t before = farm.revision();
  std::optional<FakeWorker> c(std::in_place, farm, remote("c", 8), 2s);
  EXPECT_EQ(farm.job(job, 2s)->message, "");
  EXPECT_NE(farm.revision(), before);
  farm.remove_worker(c->id(), "gone", 3s);
  EXPECT_NE(farm.job(job, 3s)->message, "") << "the last judge has left";
  c.emplace(farm, remote("c", 8), 4s);
  for (bool is_any = true; is_any;) is_any = work(a, job) | work(b, job) | work(*c, job);
  EXPECT_EQ(farm.job(job, 4s)->state, JobState::done);
  EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, large));
}

TEST(Trials, APriorityThatChangesGoesForTilesThatWaitToBeJudgedToo) {
  constexpr Size one_tile{64, 64};
  Farm farm;
  FakeWorker a(farm, remote("a", 1));
  const JobId first = farm.submit(verified(Quorum{2}, one_tile), 0s);
  a.finish_one(1s);
  const JobId second = farm.submit(verified(Quorum{2}, one_tile), 0s);
  a.finish_one(1s);
  farm.set_priority(second, 90, 1s);
  FakeWorker judge(farm, remote("judge", 1), 2s);
  EXPECT_EQ(judge.held().at(0).job, second);
  judge.finish_one(3s);
  EXPECT_EQ(judge.held().at(0).job, first);
  judge.finish_one(3s);
  EXPECT_EQ(farm.job(first, 3s)->state, JobState::done);
}

TEST(Trials, OneWorkerOnTwoConnectionsIsNoQuorum) {
  for (const std::string certificate : {"", "c0"}) {
    Farm farm;
    WorkerInfo info = remote("pc"), again = remote(certificate.empty() ? "pc" : "other");
    info.certificate = again.certificate = certificate;
    FakeWorker first(farm, info), second(farm, again);
    const JobId job = farm.submit(verified(Quorum{2}), 0s);
    while (!first.held().empty() || !second.held().empty())
      deliver_one(farm, first, 1s), deliver_one(farm, second, 1s);
    EXPECT_EQ(farm.job(job, 1s)->pixels_done, 0u);
    FakeWorker other(farm, remote("third"), 2s);
    while (!other.held().empty()) deliver_one(farm, other, 2s);
    expect_right_picture(farm, job, 2s);
  }
}

TEST(Trials, WhoTakesTheNameOfATrustedWorkerIsNotTrusted) {
  Farm farm;
  WorkerInfo trusted = remote("pc"), judge = remote("judge"), heir = remote("pc");
  trusted.certificate = "c0", judge.certificate = "c1", heir.certificate = "c2";
  FakeWorker pc(farm, trusted), other(farm, judge);
  farm.submit(verified(Audit{1}), 0s);
  while (!pc.held().empty() || !other.held().empty()) deliver_one(farm, pc, 1s), deliver_one(farm, other, 1s);
  EXPECT_GT(farm.trust_in("pc").good_in_a_row, 0u);
  farm.remove_worker(pc.id(), "gone", 2s);
  FakeWorker impostor(farm, heir, 2s);
  EXPECT_EQ(impostor.name(), "pc");
  EXPECT_EQ(farm.trust_in("pc"), Trust{});
}

TEST(Trials, AWorkersLiesGoUnderWhateverNameItDeliveredThem) {
  Farm farm;
  WorkerInfo info = remote("pc", 1);
  info.certificate = "c0";
  const JobId job = farm.submit(job_of(forty_tiles), 0s);
  FakeWorker liar(farm, info);
  for (int i = 0; i < 10; ++i) deliver_one(farm, liar, 1s, one_percent);
  farm.remove_worker(liar.id(), "gone", 2s);
  info.name = "innocent";
  JobSpec spec = verified(Quorum{2});
  spec.priority = 90;
  const JobId checked = farm.submit(spec, 2s);
  FakeWorker again(farm, info, 2s), a(farm, remote("a"), 2s), b(farm, remote("b"), 2s);
  while (!again.held().empty() || !a.held().empty() || !b.held().empty()) {
    deliver_one(farm, again, 3s, one_percent);
    deliver_one(farm, a, 3s), deliver_one(farm, b, 3s);
  }
  EXPECT_TRUE(is_banned(farm, "innocent"));
  expect_right_picture(farm, checked, 3s);
  expect_right_picture(farm, job, 3s);
}

TEST(Trials, WhatABannedWorkerSaidCountsNoMore) {
  Farm farm;
  FakeWorker liar(farm, remote("liar"));
  const JobId job = farm.submit(verified(Quorum{2}), 0s);
  while (!liar.held().empty()) deliver_one(farm, liar, 1s, one_percent);
  farm.ban("liar", 2s);
  FakeWorker a(farm, remote("a"), 2s), b(farm, remote("b"), 2s);
  while (!a.held().empty() || !b.held().empty()) deliver_one(farm, a, 3s), deliver_one(farm, b, 3s);
  expect_right_picture(farm, job, 3s);
  EXPECT_EQ(farm.trust_in("liar"), Trust{}) << "nobody asked";
}

TEST(Trials, TheJobOfTheHighestPriorityIsJudgedFirst) {
  constexpr Size one_tile{64, 64};
  Farm farm;
  FakeWorker a(farm, remote("a", 1));
  std::map<int, JobId> jobs;
  for (const int priority : {10, 90, 50}) {
    JobSpec spec = verified(Quorum{2}, one_tile);
    spec.priority = priority;
    jobs[priority] = farm.submit(spec, 0s);
    a.finish_one(1s);
  }
  FakeWorker judge(farm, remote("judge", 1), 2s);
  for (const int priority : {90, 50, 10}) {
    EXPECT_EQ(judge.held().at(0).job, jobs.at(priority));
    judge.finish_one(3s);
  }
}

TEST(Trials, AFilmThatNobodyLooksAtIsNotCopiedWhenTilesAreLost) {
  for (const bool is_looked_at : {false, true}) {
    Farm farm;
    FakeWorker liar(farm, remote("liar", 1));
    const JobId other = farm.submit(job_of(forty_tiles), 0s);
    for (int i = 0; i < 3; ++i) deliver_one(farm, liar, 1s, one_percent);
    JobSpec spec = verified(Audit{1}, {64, 64});
    spec.priority = 90;
    farm.submit(spec, 1s);
    while (!liar.held().empty() && liar.held()[0].job == other) deliver_one(farm, liar, 1s, one_percent);
    std::shared_ptr<const Film> film = farm.film(other);
    const Film* const place = film.get();
    const std::uint64_t pixels = film->pixels_done();
    if (!is_looked_at) film.reset();
    deliver_one(farm, liar, 1s, one_ulp);
    FakeWorker master(farm, masters_own(), 2s);
    const Assignment check = master.held().at(0);
    farm.receive(master.id(), rendered(check, {64, 64}), 3s);
    EXPECT_EQ(farm.trust_in("liar").mismatches, 1u);
    EXPECT_EQ(farm.film(other)->pixels_done(), 0u);
    EXPECT_EQ(farm.film(other).get() == place, !is_looked_at);
    if (film) {
      EXPECT_EQ(film->pixels_done(), pixels);
    }
  }
}

}  // namespace
}  // namespace rayfarm
