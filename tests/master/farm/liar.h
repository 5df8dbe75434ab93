// What the tests of verification share: workers that lie, and what must be true in the end.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>

#include "tests/master/farm/fake_worker.h"

namespace rayfarm {

constexpr Size forty_tiles{10 * 64, 4 * 64};

inline WorkerInfo remote(std::string name, std::uint32_t threads = 2) {
  return {.name = std::move(name), .threads = threads};
}
inline WorkerInfo masters_own() { return {.name = "master", .threads = 1, .kind = WorkerKind::local}; }

inline JobSpec verified(const Verification& verification, Size film = forty_tiles) {
  JobSpec spec = job_of(film);
  spec.verification = verification;
  return spec;
}

using Lie = std::function<void(Result&)>;
inline void nothing(Result&) {}
inline void one_ulp(Result& result) {
  float& value = result.images.back().rgb.back();
  value = std::nextafter(value, 2 * value + 1);
}
inline void one_percent(Result& result) {
  for (PassImage& image : result.images)
    for (std::size_t i = 0; i < image.rgb.size(); i += 300) image.rgb[i] += 1;
}
/// Of the same shape.
inline void anothers_tile(Result& result) {
  PassSet passes = 0;
  for (const PassImage& image : result.images) passes |= static_cast<PassSet>(1 << image.pass);
  const Assignment other{result.lease, JobId{9}, 3, 7, passes};
  result.images = rendered(other, forty_tiles).images;
}

/// Hands in the first that it holds; nothing when it holds nothing.
inline void deliver_one(Farm& farm, FakeWorker& worker, FarmTime now, const Lie& lie = nothing) {
  if (worker.held().empty()) return;
  const HeldAssignment first = worker.held()[0];
  worker.drop(first.lease);
  if (first.piece) return farm.receive(worker.id(), rendered_piece(first), now);
  Result result = rendered(first, forty_tiles);
  lie(result);
  farm.receive(worker.id(), result, now);
}

inline bool is_banned(const Farm& farm, const std::string& name) {
  return std::ranges::count(farm.banned(), name) != 0;
}

inline void expect_right_picture(const Farm& farm, JobId job, FarmTime now) {
  EXPECT_EQ(farm.job(job, now)->state, JobState::done);
  EXPECT_EQ(farm.film(job)->rgb(), made_up_picture(job, forty_tiles));
  EXPECT_EQ(farm.job(job, now)->counters, made_up_counters(forty_tiles));
}

}  // namespace rayfarm
