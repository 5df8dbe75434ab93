#include <gtest/gtest.h>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {
namespace {

using namespace std::chrono_literals;

WorkerInfo remote(std::string name) {
  WorkerInfo info;
  info.name = std::move(name), info.threads = 4;
  return info;
}

std::string refusal_in(const std::vector<ToWorker>& messages) {
  for (const ToWorker& message : messages)
    if (const auto* refused = std::get_if<Refused>(&message)) return refused->reason;
  return "";
}

TEST(Farm, ABannedWorkerIsToldAndItsTilesGoToTheOthersAtOnce) {
  Farm farm;
  FakeWorker bad(farm, remote("bad"));
  farm.submit(job_of({128, 128}), 0s);
  FakeWorker good(farm, remote("good"));
  EXPECT_TRUE(farm.ban("bad", 1s));
  EXPECT_NE(refusal_in(bad.take_messages()).find("rayfarm unban bad"), std::string::npos);
  EXPECT_EQ(good.held().size(), 4u);
  good.finish_all(2s);
  EXPECT_EQ(farm.jobs(2s).at(0).state, JobState::done);
}

TEST(Farm, ABannedNameIsNotTakenInUntilItIsUnbanned) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  EXPECT_EQ(farm.objection_to("pc-2"), std::nullopt);
  EXPECT_TRUE(farm.ban("pc", 1s));
  farm.remove_worker(worker.id(), "banned", 2s);
  EXPECT_EQ(farm.banned(), std::vector<std::string>{"pc"});
  EXPECT_NE(farm.objection_to("pc"), std::nullopt);
  EXPECT_EQ(farm.objection_to("other"), std::nullopt);
  EXPECT_TRUE(farm.unban("pc", 3s));
  EXPECT_EQ(farm.objection_to("pc"), std::nullopt);
  EXPECT_TRUE(farm.banned().empty());
}

TEST(Farm, ABannedWorkerDoesNotReturnUnderAnotherName) {
  Farm farm;
  WorkerInfo info = remote("pc");
  info.certificate = "c0";
  FakeWorker first(farm, info), second(farm, info);
  EXPECT_EQ(second.name(), "pc-2");
  EXPECT_TRUE(farm.ban("pc-2", 1s));
  EXPECT_NE(refusal_in(first.take_messages()), "") << "it is the same worker";
  EXPECT_TRUE(farm.objection_to("innocent", "c0"));
  EXPECT_FALSE(farm.objection_to("innocent", "c1"));
  EXPECT_TRUE(farm.unban("pc-2", 2s));
  EXPECT_FALSE(farm.objection_to("innocent", "c0"));
}

TEST(Farm, ABannedWorkerDoesNotReturnWhileItsOldConnectionIsThere) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  EXPECT_TRUE(farm.ban("pc", 1s));
  EXPECT_TRUE(farm.objection_to("pc"));
}

TEST(Farm, OneCertificateDoesNotUseUpTheNamesOfAll) {
  Farm farm({.names_of_one = 3});
  WorkerInfo info = remote("a");
  info.certificate = "c0";
  for (const char* name : {"a", "b", "c"}) {
    info.name = name;
    EXPECT_FALSE(farm.objection_to(name, "c0"));
    FakeWorker worker(farm, info);
    farm.remove_worker(worker.id(), "gone", 1s);
  }
  EXPECT_NE(farm.objection_to("d", "c0").value_or("").find("--name"), std::string::npos);
  EXPECT_FALSE(farm.objection_to("b", "c0"));
  EXPECT_FALSE(farm.objection_to("d", "c1"));
}

TEST(Farm, AWorkerThatWouldBeOneTooManyIsNotLetIn) {
  Farm farm({.worker_names = 2});
  WorkerInfo info = remote("a");
  info.certificate = "c0";
  FakeWorker a(farm, info), b(farm, remote("b"));
  EXPECT_NE(farm.objection_to("c").value_or("").find("--name"), std::string::npos);
  EXPECT_TRUE(farm.objection_to("c", "c0"));
  EXPECT_TRUE(farm.objection_to("a", "c0")) << "it would be a-2";
  farm.remove_worker(a.id(), "gone", 1s);
  EXPECT_FALSE(farm.objection_to("a", "c0"));
}

TEST(Farm, NobodyBansWhoNeverWasThereNorTheMastersOwnThreads) {
  Farm farm;
  WorkerInfo own = remote("master");
  own.kind = WorkerKind::local;
  FakeWorker threads(farm, own);
  EXPECT_FALSE(farm.ban("nobody", 0s));
  EXPECT_FALSE(farm.ban("master", 0s));
  EXPECT_FALSE(farm.unban("nobody", 0s));
  EXPECT_TRUE(farm.banned().empty());
}

TEST(Farm, EventsNameTheWorkerThatTheyAreAbout) {
  Farm farm;
  FakeWorker worker(farm, remote("pc"));
  farm.submit(job_of({10, 10}), 0s);
  farm.drain("pc", 0s);
  farm.undrain("pc", 0s);
  farm.ban("pc", 0s);
  farm.unban("pc", 0s);
  farm.remove_worker(worker.id(), "gone", 1s);
  int of_the_worker = 0;
  for (const FarmEvent& event : farm.take_events()) {
    const bool names_it = event.text.find("worker pc") != std::string::npos;
    EXPECT_EQ(event.worker, names_it ? "pc" : "") << event.text;
    of_the_worker += names_it;
  }
  EXPECT_EQ(of_the_worker, 6);
}

}  // namespace
}  // namespace rayfarm
