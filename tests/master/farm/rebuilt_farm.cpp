#include "tests/master/farm/rebuilt_farm.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace rayfarm {
namespace {

void expect_same(const JobView& before, const JobView& after) {
  EXPECT_EQ(after.id, before.id);
  EXPECT_EQ(after.name, before.name);
  EXPECT_EQ(after.output, before.output);
  EXPECT_EQ(after.scene_hash, before.scene_hash);
  // What waits for a second opinion is rendered again.
  const bool waits_for_check = before.message.find("for another worker to check") != std::string::npos;
  EXPECT_EQ(after.message, waits_for_check ? "" : before.message);
  EXPECT_EQ(after.state, before.state);
  EXPECT_EQ(after.priority, before.priority);
  EXPECT_EQ(after.settings, before.settings);
  EXPECT_EQ(after.parameters, before.parameters);
  EXPECT_EQ(after.frames, before.frames);
  EXPECT_EQ(after.frames_sent, before.frames_sent);
  EXPECT_EQ(after.frames_done, before.frames_done);
  EXPECT_EQ(after.current_frame, before.current_frame);
  EXPECT_EQ(after.pixels_done, before.pixels_done);
  EXPECT_EQ(after.pixels_total, before.pixels_total);
  EXPECT_EQ(after.counters, before.counters);
  EXPECT_EQ(after.submitted, before.submitted);
  EXPECT_EQ(after.waited, before.waited);
  EXPECT_EQ(after.elapsed, before.elapsed);
  EXPECT_EQ(after.thread_time, before.thread_time);
  EXPECT_EQ(after.tiles_given_back, before.tiles_given_back);
  EXPECT_EQ(after.tiles_doubled, before.tiles_doubled);
  EXPECT_EQ(after.tiles_checked, before.tiles_checked);
  EXPECT_EQ(after.tiles_shared, before.tiles_shared);
  EXPECT_EQ(after.time_wasted, before.time_wasted);
  EXPECT_EQ(after.rays_wasted, before.rays_wasted);
  EXPECT_EQ(after.verification, before.verification);
}

void expect_same(const FrameView& before, const FrameView& after) {
  EXPECT_EQ(after.frame, before.frame);
  EXPECT_EQ(after.state, before.state);
  EXPECT_EQ(after.scene_hash, before.scene_hash);
  EXPECT_EQ(after.is_kept, before.is_kept);
  EXPECT_EQ(after.pixels_done, before.pixels_done);
  EXPECT_EQ(after.pixels_total, before.pixels_total);
  EXPECT_EQ(after.counters, before.counters);
  EXPECT_EQ(after.waited, before.waited);
  EXPECT_EQ(after.elapsed, before.elapsed);
  EXPECT_EQ(after.thread_time, before.thread_time);
}

void expect_same(const Deliveries& before, const Deliveries& after) {
  EXPECT_EQ(after.names, before.names);
  ASSERT_EQ(after.tiles.size(), before.tiles.size());
  for (std::size_t i = 0; i < before.tiles.size(); ++i) {
    EXPECT_EQ(after.tiles[i].by, before.tiles[i].by);
    EXPECT_EQ(after.tiles[i].taken, before.tiles[i].taken);
    EXPECT_EQ(after.tiles[i].passes, before.tiles[i].passes);
  }
}

void expect_same_picture(const Farm& before, const Farm& after, FrameId id) {
  const auto film = before.film(id.job, id.frame), film_after = after.film(id.job, id.frame);
  ASSERT_EQ(film_after == nullptr, film == nullptr);
  if (film) {
    EXPECT_EQ(film_after->rgb(), film->rgb());
    expect_same(before.deliveries(id.job, id.frame).value(), after.deliveries(id.job, id.frame).value());
  }
  const SharedBytes scene = before.scene(id.job, id.frame), scene_after = after.scene(id.job, id.frame);
  ASSERT_EQ(scene_after == nullptr, scene == nullptr);
  if (scene) {
    EXPECT_EQ(*scene_after, *scene);
  }
}

}  // namespace

namespace {

/// Those of the frame that were not lost later, as the journal keeps them.
std::vector<const TileCommitted*> commits_of(FrameId frame, const std::vector<FarmRecord>& records) {
  std::vector<const TileCommitted*> commits;
  for (const FarmRecord& record : records) {
    if (const auto* commit = std::get_if<TileCommitted>(&record.fact))
      if (commit->frame == frame) commits.push_back(commit);
    if (const auto* lost = std::get_if<PassesLost>(&record.fact))
      if (lost->frame == frame)
        std::erase_if(commits, [&](const TileCommitted* commit) {
          return std::ranges::any_of(lost->lost, [&](const Work& work) {
            return work.tile == commit->tile && (work.passes & commit->passes);
          });
        });
  }
  return commits;
}

}  // namespace

FarmPast past_of(const std::vector<FarmRecord>& records) {
  return {records, 1, [&records](FrameId frame, const std::function<void(const TileCommitted&)>& put) {
            for (const TileCommitted* commit : commits_of(frame, records)) put(*commit);
          }};
}

void expect_same(const Farm& before, const Farm& after, FarmTime now) {
  const std::vector<JobView> jobs = before.jobs(now), jobs_after = after.jobs(now);
  ASSERT_EQ(jobs_after.size(), jobs.size());
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    SCOPED_TRACE("job " + std::to_string(static_cast<std::uint64_t>(jobs[i].id)));
    expect_same(jobs[i], jobs_after[i]);
    const auto frames = before.frames(jobs[i].id, now), frames_after = after.frames(jobs[i].id, now);
    ASSERT_EQ(frames_after.size(), frames.size());
    for (std::size_t f = 0; f < frames.size(); ++f) {
      expect_same(frames[f], frames_after[f]);
      expect_same_picture(before, after, {jobs[i].id, frames[f].frame});
    }
  }
  EXPECT_EQ(after.banned(), before.banned());
}

}  // namespace rayfarm
