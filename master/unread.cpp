// Films of a farm that was built again: their pixels are read when they are first needed, and may be damaged.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

PassSet passes_with_pixels(Size film, std::uint32_t tile) {
  PassSet passes = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (pixel_count(tile_at(film, tile), pass) > 0) passes |= static_cast<PassSet>(1u << pass);
  return passes;
}

}  // namespace

void Farm::State::pause(Job& job, std::string why) {
  job.state = JobState::paused;
  tell(title_of(job) + " paused" + (why.empty() ? "" : ": " + why));
  if (!why.empty()) job.message = std::move(why);
  touch(job);
  update_queue(job);
}

const JobFrame* Farm::State::picture(JobId id, std::optional<std::uint32_t> number) {
  const JobFrame* found = frame(id, number);
  if (!found || !found->canvas) return nullptr;
  Job& job = jobs.at(id);
  return read_film(job, frame_at(job, found->number)) ? found : nullptr;
}

bool Farm::State::read_film(Job& job, JobFrame& frame) {
  Canvas& canvas = *frame.canvas;
  if (canvas.film) return true;
  const Size size = size_of(job.spec.settings);
  const auto film = std::make_shared<Film>(size);
  RayCounters counters;
  try {
    read_pixels({job.id, frame.number}, [&](const TileCommitted& commit) {
      if (commit.tile >= canvas.deliveries.size() ||
          (canvas.schedule.done(commit.tile) & ~film->passes_of(commit.tile) & commit.passes) !=
              commit.passes ||
          fault_of(commit.images, tile_at(size, commit.tile), commit.passes))
        return;
      for (const PassImage& image : commit.images) film->put(commit.tile, image);
      counters += commit.counters;
    });
  } catch (const std::exception& error) {
    const std::string why = "its picture cannot be read: " + std::string(error.what());
    if (job.message == why) return false;  // said already
    warn(title_of(job, frame) + ": " + why);
    if (has_ended(job))
      job.message = why;
    else
      pause(job, why);
    return false;
  }
  canvas.film = film;
  if (film->pixels_done() != frame.pixels_done) lose_unread(job, frame, frame.counters - counters);
  return true;
}

void Farm::State::lose_unread(Job& job, JobFrame& frame, const RayCounters& counters) {
  PassesLost damage{{job.id, frame.number}, {}, counters};
  for (std::uint32_t tile = 0; tile < frame.canvas->deliveries.size(); ++tile) {
    const PassSet lost = frame.canvas->schedule.done(tile) & ~frame.canvas->film->passes_of(tile) &
                         passes_with_pixels(size_of(job.spec.settings), tile);
    if (lost != 0) damage.lost.push_back({tile, lost});
  }
  const std::size_t tiles = damage.lost.size();
  const std::string what = count_of_tiles(tiles) + " of its picture " +
                           (tiles == 1 ? "was damaged on the disk" : "were damaged on the disk");
  warn(title_of(job, frame) + ": " + what);
  lose_passes(job, frame, damage);
  if (job.state == JobState::cancelled || job.state == JobState::failed) return;
  pause(job, what + "; resume it, and that is rendered again");
}

void Farm::State::lose_passes(Job& job, JobFrame& frame, const PassesLost& lost) {
  record(lost);
  const bool was_complete = is_complete(job, frame);
  const FarmTime taken = frame.thread_time;
  job.pixels_done -= frame.pixels_done;
  lose(job, frame, lost);
  job.pixels_done += frame.pixels_done;
  const FarmTime wasted = taken - frame.thread_time;
  job.thread_time -= wasted, job.time_wasted += wasted;
  job.rays_wasted += lost.counters.rays();
  touch(job);
  job.counters = job.counters - lost.counters;
  if (frame.canvas->film && frame.canvas->film->pixels_done() != frame.pixels_done) {
    std::shared_ptr<Film>& film = frame.canvas->film;
    // Somebody may look at the old one; at a complete one also on another thread, whose last look has no date here.
    if (was_complete || film.use_count() > 1) film = std::make_shared<Film>(*film);
    for (const Work& work : lost.lost) film->take_out(work.tile, work.passes);
  }
  const std::uint32_t place = job.spec.frames->index_of(frame.number).value();
  if (was_complete) --job.frames_done;
  job.first_unfinished = std::min(job.first_unfinished, place);
  if (job.state == JobState::cancelled || job.state == JobState::failed) return;
  if (was_complete) reopen(job, frame);
  job.open.insert(place);
}

void Farm::State::reopen(Job& job, JobFrame& frame) {
  unkeep(frame);
  std::erase(ended_frames, FrameId{job.id, frame.number});
  frame.ended.reset();
  for_each_data(frame, [&](const std::string& hash, const SharedBytes& bytes) {
    SharedData& data = shared[hash];
    data.bytes = bytes;
    if (data.unfinished++ == 0) unfinished_bytes += bytes->size();
  });
  if (job.state != JobState::done) return;
  std::erase(ended_jobs, job.id);
  job.ended.reset();
  job.state = JobState::paused;
}

}  // namespace rayfarm
