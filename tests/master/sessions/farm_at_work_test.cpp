// The farm with real workers over real sockets, and threads of its own: whatever happens, the film is the one
// that a renderer makes alone.
#include <gtest/gtest.h>

#include "master/local_threads.h"
#include "tests/support/farm_jobs.h"
#include "tests/support/farm_keys.h"
#include "tests/support/lying_renderer.h"
#include "tests/support/master_thread.h"
#include "tests/support/worker_thread.h"

namespace rayfarm {
namespace {

constexpr RenderSettings settings{.width = 500, .height = 300, .spp = 1};

struct RunningJob {
  MasterThread& master;
  JobId id;

  explicit RunningJob(MasterThread& m, RenderSettings s = settings)
      : master(m), id(m.ask([&](Farm& farm, FarmTime now) { return farm.submit(simple_job(s), now); })) {}

  JobView view() {
    return *master.ask([&](Farm& farm, FarmTime now) { return farm.job(id, now); });
  }
  Film finished_film() {
    master.wait_until([&](Farm& farm) { return farm.job(id, {})->state == JobState::done; });
    return *master.ask([&](Farm& farm, FarmTime) { return farm.film(id); });
  }
};

TEST(FarmAtWork, MakesTheFilmWithOneTwoAndThreeWorkers) {
  const Film expected = rendered(position_area, settings);
  for (int count = 1; count <= 3; ++count) {
    MasterThread master;
    std::deque<WorkerThread> workers;
    for (int i = 0; i < count; ++i)
      workers.emplace_back(worker_for(master.address(), "lab" + std::to_string(i)), prepare_positions);
    EXPECT_EQ(RunningJob(master).finished_film().rgb(), expected.rgb());
  }
}

TEST(FarmAtWork, MakesTheFilmOverEncryptedConnectionsWhoeverDials) {
  const FarmKeys keys;
  MasterThread master(patient_door(), {"127.0.0.1", 0}, keys.of_master());
  WorkerOptions dials = worker_for(master.address(), "dials"), listens = patient_worker("listens");
  dials.security = keys.of_worker("dials"), listens.security = keys.of_worker("listens");
  listens.way = AwaitMaster{{"127.0.0.1", 0}};
  WorkerThread one(dials, prepare_positions), two(listens, prepare_positions);
  master.dial({"dialled", two.listening_at()});
  master.wait_for_workers(2);
  EXPECT_EQ(RunningJob(master).finished_film().rgb(), rendered(position_area, settings).rgb());
}

TEST(FarmAtWork, KnowsAWorkerByItsCertificateWhateverItsName) {
  const FarmKeys keys;
  MasterThread master(patient_door(), {"127.0.0.1", 0}, keys.of_master());
  const Identity own = keys.identity(PeerRole::worker, "lab");
  WorkerOptions one = worker_for(master.address(), "one"), two = worker_for(master.address(), "two"),
                other = worker_for(master.address(), "other");
  one.security = keys.of_worker(own), two.security = keys.of_worker(own);
  other.security = keys.of_worker("lab");
  WorkerThread first(one, prepare_positions), second(two, prepare_positions), third(other, prepare_positions);
  master.wait_for_workers(3);
  std::map<std::string, std::string> certificates;
  for (const WorkerView& worker : master.ask([](Farm&farm, FarmTime) { return farm.workers(); }))
    certificates[worker.info.name] = worker.info.certificate;
  EXPECT_EQ(certificates.at("one"), certificates.at("two"));
  EXPECT_NE(certificates.at("one"), certificates.at("other"));
}

TEST(FarmAtWork, TakesNoPlaintextWhenItIsClosed) {
  const FarmKeys keys;
  MasterThread master(patient_door(), {"127.0.0.1", 0}, keys.of_master());
  WorkerThread stranger(worker_for(master.address(), "stranger"), prepare_positions);
  const auto log = [&] { return master.ask([&](Farm&, FarmTime) { return master.door().log(0); }); };
  while (log().empty()) std::this_thread::yield();
  EXPECT_EQ(log()[0].event.text, "no worker at 127.0.0.1: it does not encrypt what it says");
}

TEST(FarmAtWork, MakesTheFilmWithItsOwnThreads) {
  MasterThread master;
  auto local = master.make<LocalThreads>(2u, PrepareScene(prepare_positions));
  EXPECT_EQ(RunningJob(master).finished_film().rgb(), rendered(position_area, settings).rgb());
  master.end(local);
}

TEST(FarmAtWork, TracesTheSamePictureAsOneThread) {
  const RenderSettings small{.width = 100, .height = 80, .spp = 4};
  MasterThread master;
  auto local = master.make<LocalThreads>(1u, PrepareScene(prepare_scene));
  WorkerThread worker(worker_for(master.address(), "lab7"), prepare_scene);
  EXPECT_EQ(RunningJob(master, small).finished_film().rgb(),
            rendered(prepare_scene(simple_scene()), small).rgb());
  master.end(local);
}

TEST(FarmAtWork, BansAWorkerThatLiesByOneUlpAndMakesTheFilmWithoutIt) {
  MasterThread master;
  WorkerThread liar(worker_for(master.address(), "liar"), lying(prepare_positions, lie_by_one_ulp));
  WorkerThread one(worker_for(master.address(), "one"), prepare_positions);
  WorkerThread two(worker_for(master.address(), "two"), prepare_positions);
  master.wait_for_workers(3);
  for (const Verification& verification : {Verification(Audit{1}), Verification(Quorum{2})}) {
    const JobId id = master.ask([&](Farm& farm, FarmTime now) {
      JobSpec spec = simple_job({.width = 1280, .height = 640, .spp = 1});
      spec.verification = verification;
      return farm.submit(spec, now);
    });
    master.wait_until([&](Farm& farm) { return farm.job(id, {})->state == JobState::done; });
    const auto film = master.ask([&](Farm& farm, FarmTime) { return farm.film(id); });
    EXPECT_EQ(film->rgb(), rendered(position_area, {.width = 1280, .height = 640, .spp = 1}).rgb());
  }
  EXPECT_EQ(master.ask([](Farm& farm, FarmTime) { return farm.banned(); }), std::vector<std::string>{"liar"});
}

TEST(FarmAtWork, MakesTheFilmAlthoughAWorkerIsKilledInTheMiddleOfATile) {
  MasterThread master;
  Gate gate;
  {
    WorkerThread doomed(worker_for(master.address(), "doomed"), gate.prepare());
    RunningJob job(master);
    gate.wait_for_begun(1);
    EXPECT_EQ(job.view().pixels_done, 0u);
  }
  WorkerThread next(worker_for(master.address(), "next"), prepare_positions);
  RunningJob second(master);
  EXPECT_EQ(second.finished_film().rgb(), rendered(position_area, settings).rgb());
  EXPECT_EQ(master.ask([](Farm& farm, FarmTime now) { return farm.jobs(now); })[0].state, JobState::done);
}

TEST(FarmAtWork, StopsAWorkerInTheMiddleOfATileWhenTheJobIsCancelled) {
  MasterThread master;
  Gate gate;
  WorkerThread worker(worker_for(master.address(), "lab7"), gate.prepare());
  RunningJob slow(master);
  gate.wait_for_begun(1);
  EXPECT_TRUE(master.ask([&](Farm& farm, FarmTime now) { return farm.cancel(slow.id, now); }));
  gate.wait_for_stopped(1);
  gate.open();
  EXPECT_EQ(RunningJob(master).finished_film().rgb(), rendered(position_area, settings).rgb());
}

TEST(FarmAtWork, StopsItsOwnThreadsInTheMiddleOfATileWhenTheJobIsPaused) {
  MasterThread master;
  Gate gate;
  auto local = master.make<LocalThreads>(2u, gate.prepare());
  RunningJob job(master);
  gate.wait_for_begun(2);
  EXPECT_TRUE(master.ask([&](Farm& farm, FarmTime now) { return farm.pause(job.id, now); }));
  gate.wait_for_stopped(2);
  gate.open();
  EXPECT_TRUE(master.ask([&](Farm& farm, FarmTime now) { return farm.resume(job.id, now); }));
  EXPECT_EQ(job.finished_film().rgb(), rendered(position_area, settings).rgb());
  master.end(local);
}

TEST(FarmAtWork, LosesNothingWhenAWorkerStopsCleanly) {
  MasterThread master;
  Gate gate;
  WorkerThread leaving(worker_for(master.address(), "leaving"), gate.prepare());
  RunningJob job(master);
  gate.wait_for_begun(1);
  leaving.stop();
  gate.open();
  leaving.wait_for_end();
  master.wait_for_workers(0);
  EXPECT_GT(job.view().pixels_done, 0u);  // what was begun was delivered
  WorkerThread next(worker_for(master.address(), "next"), prepare_positions);
  EXPECT_EQ(job.finished_film().rgb(), rendered(position_area, settings).rgb());
}

TEST(FarmAtWork, FailsAJobThatNoWorkerCanRenderAndSaysWhy) {
  MasterThread master;
  WorkerThread worker(worker_for(master.address(), "lab7"),
                      [](Scene) -> TileRenderer { throw SceneError("too large for this PC"); });
  RunningJob job(master);
  master.wait_until([&](Farm& farm) { return farm.job(job.id, {})->state == JobState::failed; });
  EXPECT_NE(job.view().message.find("too large for this PC"), std::string::npos);
}

TEST(FarmAtWork, DialsWorkersThatListenAndNamesThem) {
  WorkerOptions options = patient_worker("its own name");
  options.way = AwaitMaster{{"127.0.0.1", 0}};
  WorkerThread worker(options, prepare_positions);
  MasterThread master;
  master.dial({"nowhere", {"no.such.host.invalid", 5411}});
  master.dial({"lab7", worker.listening_at()});
  master.wait_for_workers(1);
  EXPECT_EQ(master.ask([](Farm& farm, FarmTime) { return farm.workers(); })[0].info.name, "lab7");
  EXPECT_EQ(RunningJob(master).finished_film().rgb(), rendered(position_area, settings).rgb());
}

TEST(FarmAtWork, GoesOnWhenTheMasterComesBackAtTheSameAddress) {
  auto master = std::make_unique<MasterThread>();
  const Address address = master->address();
  WorkerThread worker(worker_for(address, "lab7"), prepare_positions);
  master->wait_for_workers(1);
  master->stop();
  master->wait_for_end();
  master.reset();
  MasterThread next(patient_door(), address);
  next.wait_for_workers(1);
  EXPECT_EQ(RunningJob(next).finished_film().rgb(), rendered(position_area, settings).rgb());
}

}  // namespace
}  // namespace rayfarm
