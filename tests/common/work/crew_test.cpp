#include "common/work/crew.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/support/answers.h"
#include "tests/support/simple_job.h"

namespace rayfarm {
namespace {

/// A crew that was told of job 1: a simple scene at 640x480, 80 tiles.
struct CrewAtWork {
  Answers answers;
  Crew crew;

  CrewAtWork(unsigned threads, PrepareScene prepare) : crew(threads, std::move(prepare)) {
    crew.begin([this](ToMaster message) { answers.add(std::move(message)); });
    start_job(1);
  }
  void start_job(std::uint64_t job) {
    const SceneData scene = scene_data(simple_scene());
    crew.take(scene);
    crew.take(FrameStart{JobId{job}, scene.hash, {}});
  }
  void assign(std::uint64_t lease, std::uint32_t tile) {
    crew.take(Assignment{LeaseId{lease}, JobId{1}, 0, tile, all_passes});
  }
};

TEST(Crew, RendersWhatItIsAssigned) {
  CrewAtWork at_work(2, prepare_positions);
  for (std::uint32_t tile = 0; tile < 80; ++tile) at_work.assign(100 + tile, tile);
  std::set<std::uint32_t> tiles;
  for (int i = 0; i < 80; ++i) {
    const auto result = std::get<Result>(at_work.answers.next());
    EXPECT_EQ(result.lease, LeaseId{100 + result.tile});
    EXPECT_EQ(result.job, JobId{1});
    EXPECT_EQ(result.images, position_tile({}, result.tile, all_passes, [] { return false; }));
    tiles.insert(result.tile);
  }
  EXPECT_EQ(tiles.size(), 80u);
}

TEST(Crew, RendersAPieceOfATile) {
  CrewAtWork at_work(1, prepare_positions);
  const PieceAssignment piece{{LeaseId{1}, JobId{1}, 0, 11, 0b1010}, {80, 96, 96, 112}};
  at_work.crew.take(piece);
  const auto answer = std::get<PieceResult>(at_work.answers.next());
  EXPECT_EQ(answer.area, piece.area);
  EXPECT_EQ(answer.result.lease, LeaseId{1});
  EXPECT_EQ(answer.result.images, position_area({}, piece.area, 0b1010, [] { return false; }));
}

TEST(Crew, GivesBackWhatIsNoPieceOfItsTile) {
  CrewAtWork at_work(1, prepare_positions);
  for (const Tile& area : {Tile{0, 64, 16, 80}, Tile{68, 64, 84, 80}, Tile{112, 64, 130, 80}}) {
    at_work.crew.take(PieceAssignment{{LeaseId{1}, JobId{1}, 0, 11, all_passes}, area});
    EXPECT_EQ(at_work.answers.next(), ToMaster(GiveBack{{LeaseId{1}}, "the piece is none of the tile's"}));
  }
}

TEST(Crew, PreparesASceneOnceForAllThreadsAndJobs) {
  std::atomic<int> prepared{0};
  CrewAtWork at_work(4, [&](Scene scene) {
    ++prepared;
    EXPECT_EQ(scene, simple_scene());
    return prepare_positions(std::move(scene));
  });
  at_work.start_job(2);
  for (std::uint32_t tile = 0; tile < 40; ++tile) {
    at_work.assign(tile, tile);
    at_work.crew.take(Assignment{LeaseId{100 + tile}, JobId{2}, 0, tile, 1});
  }
  for (int i = 0; i < 80; ++i) EXPECT_TRUE(std::holds_alternative<Result>(at_work.answers.next()));
  EXPECT_EQ(prepared, 1);
}

TEST(Crew, StopsARevokedTileInTheMiddleAndAnswersNothing) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 0);
  at_work.assign(2, 1);
  gate.wait_for_begun(1);
  at_work.crew.take(Revoke{{LeaseId{1}}});
  gate.wait_for_begun(2);  // the only thread is free again
  EXPECT_EQ(gate.stopped(), 1);
  at_work.assign(3, 2);
  at_work.crew.take(Revoke{{LeaseId{3}}});
  gate.open();
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).lease, LeaseId{2});
  EXPECT_TRUE(at_work.answers.empty());
}

TEST(Crew, StopsTheTilesOfAJobThatEnds) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.start_job(2);
  at_work.assign(1, 0);
  at_work.assign(2, 1);
  gate.wait_for_begun(1);
  at_work.crew.take(FrameEnd{JobId{1}});
  at_work.crew.take(Revoke{{LeaseId{1}, LeaseId{2}}});
  at_work.crew.take(Assignment{LeaseId{3}, JobId{2}, 0, 2, 1});  // its scene is still there
  gate.open();
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).lease, LeaseId{3});
}

TEST(Crew, GivesBackWithAReasonWhatCannotBeRendered) {
  CrewAtWork at_work(1, [](Scene) -> TileRenderer { throw SceneError("too large for this PC"); });
  at_work.assign(1, 0);
  EXPECT_EQ(at_work.answers.next(), ToMaster(GiveBack{{LeaseId{1}}, "too large for this PC"}));
  at_work.assign(2, 80);
  EXPECT_EQ(at_work.answers.next(),
            ToMaster(GiveBack{{LeaseId{2}}, "there is no tile 80, the picture has 80"}));
  at_work.crew.take(Assignment{LeaseId{3}, JobId{9}, 0, 0, 1});
  EXPECT_EQ(at_work.answers.next(), ToMaster(GiveBack{{LeaseId{3}}, "its job was never started"}));
  at_work.crew.take(FrameStart{JobId{4}, "another hash", {}});
  at_work.crew.take(Assignment{LeaseId{4}, JobId{4}, 0, 0, 1});
  EXPECT_EQ(at_work.answers.next(), ToMaster(GiveBack{{LeaseId{4}}, "its scene was never sent"}));
}

TEST(Crew, DoesNotRenderASceneWithAnotherHash) {
  CrewAtWork at_work(1, prepare_positions);
  SceneData scene = scene_data(simple_scene());
  scene.hash[0] = scene.hash[0] == '0' ? '1' : '0';
  at_work.crew.take(scene);
  at_work.crew.take(FrameStart{JobId{2}, scene.hash, {}});
  at_work.crew.take(Assignment{LeaseId{1}, JobId{2}, 0, 0, 1});
  EXPECT_EQ(at_work.answers.next(),
            ToMaster(GiveBack{{LeaseId{1}}, "the scene's bytes do not have the scene's hash"}));
}

TEST(Crew, FinishesWhatItHasBegunAfterItStopsTaking) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  for (std::uint64_t lease = 1; lease <= 3; ++lease) at_work.assign(lease, 0);
  gate.wait_for_begun(1);
  EXPECT_EQ(at_work.crew.stop_taking(), (std::vector{LeaseId{2}, LeaseId{3}}));
  at_work.assign(4, 0);
  EXPECT_EQ(at_work.answers.next(), ToMaster(GiveBack{{LeaseId{4}}, ""}));
  gate.open();
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).lease, LeaseId{1});
}

TEST(Crew, AbandonsEverything) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 0);
  at_work.assign(2, 0);
  gate.wait_for_begun(1);
  EXPECT_EQ(at_work.crew.abandon(), (std::vector{LeaseId{1}, LeaseId{2}}));
  EXPECT_TRUE(at_work.answers.empty());
}

TEST(Crew, AnswersNothingToAMasterThatIsGone) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 0);
  gate.wait_for_begun(1);
  Answers other;
  at_work.crew.begin([&](ToMaster message) { other.add(std::move(message)); });
  at_work.start_job(1);
  gate.open();
  at_work.assign(1, 7);  // the same number, another lease
  EXPECT_EQ(std::get<Result>(other.next()).tile, 7u);
  EXPECT_TRUE(other.empty());
  EXPECT_TRUE(at_work.answers.empty());
}

TEST(Crew, EndsInTheMiddleOfATile) {
  Gate gate;
  {
    CrewAtWork at_work(2, gate.prepare());
    for (std::uint64_t lease = 1; lease <= 9; ++lease) at_work.assign(lease, 0);
    gate.wait_for_begun(2);
  }
  EXPECT_EQ(gate.stopped(), 2);
}

// A master that is lost. -----------------------------------------------------------------------------------

/// Its master is lost, and the next one tells it of the same job.
void lose_master(CrewAtWork& at_work) {
  at_work.crew.lose_master();
  at_work.crew.begin([&](ToMaster message) { at_work.answers.add(std::move(message)); });
}

TEST(Crew, FinishesWhatItHeldWhenItsMasterWasLostAndAnswersTheNextOneWithIt) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 5);
  at_work.assign(2, 6);
  gate.wait_for_begun(1);
  lose_master(at_work);
  EXPECT_EQ(at_work.crew.kept().size(), 2u);
  gate.open();
  gate.wait_for_begun(2);
  at_work.start_job(1);
  at_work.assign(101, 5);
  at_work.assign(102, 6);
  std::set<LeaseId> leases;
  for (int i = 0; i < 2; ++i) {
    const auto result = std::get<Result>(at_work.answers.next());
    EXPECT_EQ(result.images, position_tile({}, result.tile, all_passes, [] { return false; }));
    leases.insert(result.lease);
  }
  EXPECT_EQ(leases, (std::set{LeaseId{101}, LeaseId{102}}));
  EXPECT_TRUE(at_work.crew.kept().empty());
  gate.wait_for_begun(2);
  at_work.assign(103, 7);
  at_work.answers.next();
  gate.wait_for_begun(3);
  EXPECT_EQ(gate.begun(), 3) << "nothing was rendered twice";
}

TEST(Crew, KeepsNoPieceWhenItsMasterWasLost) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.crew.take(PieceAssignment{{LeaseId{1}, JobId{1}, 0, 5, all_passes}, {320, 0, 336, 16}});
  at_work.crew.take(PieceAssignment{{LeaseId{2}, JobId{1}, 0, 5, all_passes}, {336, 0, 352, 16}});
  gate.wait_for_begun(1);
  lose_master(at_work);
  EXPECT_TRUE(at_work.crew.kept().empty());
  gate.wait_for_stopped(1);
  gate.open();
  at_work.start_job(1);
  at_work.assign(3, 5);
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).images,
            position_tile({}, 5, all_passes, [] { return false; }));
}

TEST(Crew, GivesAResultAgainThatTheLostMasterMayNotHaveGot) {
  Gate gate;
  gate.open();
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 5);
  at_work.answers.next();
  lose_master(at_work);
  EXPECT_EQ(at_work.crew.kept(), (std::vector<HeldTile>{{{LeaseId{1}, JobId{1}, 0, 5, all_passes}, true}}));
  at_work.start_job(1);
  at_work.crew.take(Assignment{LeaseId{2}, JobId{1}, 0, 5, 0b1010});
  const auto result = std::get<Result>(at_work.answers.next());
  EXPECT_EQ(result.lease, LeaseId{2});
  EXPECT_EQ(result.images, position_tile({}, 5, 0b1010, [] { return false; })) << "just what is asked for";
  EXPECT_EQ(gate.begun(), 1);
}

TEST(Crew, RendersAnewWhatAnotherMasterMeansByTheSameNumbers) {
  Gate gate;
  gate.open();
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 5);
  at_work.answers.next();
  lose_master(at_work);
  const SceneData scene = scene_data(simple_scene());
  at_work.crew.take(scene);
  const RenderSettings settings{.seed = 9};
  at_work.crew.take(FrameStart{JobId{1}, scene.hash, settings});
  at_work.assign(2, 5);
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).images,
            position_tile(settings, 5, all_passes, [] { return false; }));
}

TEST(Crew, StopsWhatIsUnneeded) {
  Gate gate;
  CrewAtWork at_work(1, gate.prepare());
  at_work.assign(1, 5);
  at_work.assign(2, 6);
  gate.wait_for_begun(1);
  lose_master(at_work);
  at_work.crew.take(Unneeded{{LeaseId{1}, LeaseId{2}}});
  gate.wait_for_stopped(1);
  EXPECT_TRUE(at_work.crew.kept().empty());
  gate.open();
  at_work.start_job(1);
  at_work.assign(3, 7);
  EXPECT_EQ(std::get<Result>(at_work.answers.next()).tile, 7u);
  EXPECT_EQ(gate.begun(), 2);
}

TEST(Crew, KeepsNothingOfAFrameThatHasEnded) {
  CrewAtWork at_work(1, prepare_positions);
  at_work.assign(1, 5);
  at_work.answers.next();
  at_work.crew.take(FrameEnd{JobId{1}, 0});
  at_work.crew.lose_master();
  EXPECT_TRUE(at_work.crew.kept().empty());
}

TEST(Crew, PreparesASceneOnceThoughTwoMastersSendIt) {
  std::atomic<int> prepared{0};
  Gate gate;
  CrewAtWork at_work(1, [&](Scene scene) {
    ++prepared;
    return gate.prepare()(std::move(scene));
  });
  at_work.assign(1, 5);
  gate.wait_for_begun(1);
  lose_master(at_work);
  at_work.start_job(1);
  at_work.assign(2, 5);
  at_work.assign(3, 6);
  gate.open();
  at_work.answers.next(), at_work.answers.next();
  EXPECT_EQ(prepared, 1);
}

}  // namespace
}  // namespace rayfarm
