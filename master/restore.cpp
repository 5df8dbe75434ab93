// A farm built again from what it recorded.
#include <algorithm>
#include <bit>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

constexpr auto damaged_words =
    "part of its picture was damaged on the disk; resume it, and that is rendered again";
constexpr auto no_scene_words = "its scene was damaged on the disk; submit it again";

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;

void set_done(const Job& job, JobFrame& frame, const TileCommitted& commit) {
  const Work work{commit.tile, commit.passes};
  frame.canvas->schedule.set_done(work);
  frame.pixels_done += pixels_in(work, job.spec.settings);
  frame.counters += commit.counters;
  frame.thread_time += commit.taken;
  if (is_complete(job, frame)) frame.ended = commit.at;
}

void put_name(Canvas& canvas, const TileCommitted& commit, NameId name) {
  const auto known = std::ranges::find(canvas.deliverers, name);
  const auto place = static_cast<std::uint32_t>(known - canvas.deliverers.begin());
  if (known == canvas.deliverers.end()) canvas.deliverers.push_back(name);
  Canvas::TileDeliveries& tile = canvas.deliveries[commit.tile];
  for (int pass = 0; pass < pass_count; ++pass)
    if (commit.passes >> pass & 1) tile.by[pass] = place;
  const int first = std::countr_zero(commit.passes);
  tile.taken[first] = commit.taken, tile.counters[first] = commit.counters;
}

/// The sums over its frames.
void add_up(Job& job) {
  for (const JobFrame& frame : job.frames) {
    if (is_complete(job, frame)) {
      ++job.frames_done;
      job.last_done = std::max(job.last_done, frame.ended.value_or(FarmTime{}));
    }
    if (!frame.canvas && frame.started) ++job.frames_dropped;
    job.pixels_done += frame.pixels_done;
    job.counters += frame.counters;
    job.thread_time += frame.thread_time;
  }
  while (job.first_unfinished < job.frames.size() && is_complete(job, job.frames[job.first_unfinished]))
    ++job.first_unfinished;
}

FarmTime last_end(const Job& job) {
  FarmTime last = job.submitted;
  for (const JobFrame& frame : job.frames)
    last = std::max({last, frame.started.value_or(last), frame.ended.value_or(last)});
  return last;
}

/// What follows from its state for its frames: which of them have ended, and which have work waiting.
void settle_ends(Job& job) {
  job.open.clear();
  if (has_ended(job) && !job.ended) job.ended = last_end(job);
  for (std::uint32_t place = 0; place < job.frames.size(); ++place) {
    JobFrame& frame = job.frames[place];
    if (is_complete(job, frame)) continue;
    frame.ended = job.ended;
    if (has_ended(job))
      drop_data(frame);
    else
      job.open.insert(place);
  }
}

bool is_waiting(const JobFrame& frame, std::uint32_t tile, PassSet passes) {
  return frame.canvas && tile < frame.canvas->deliveries.size() && passes != 0 &&
         (frame.canvas->schedule.waiting(tile) & passes) == passes;
}

void set_in(std::set<std::string, std::less<>>& names, const std::string& name, bool is_in) {
  if (is_in)
    names.insert(name);
  else
    names.erase(name);
}

}  // namespace

Farm::Farm(FarmLimits limits, FarmPast past, FarmTime now) : Farm(limits) {
  state_->read_pixels = std::move(past.read_pixels);
  state_->last_lease = std::uint64_t{past.life} << 32;
  for (FarmRecord& record : past.records) state_->restore(std::move(record));
  state_->records.clear();
  // Another than any of the last life, which somebody may still wait to see the end of.
  state_->revision =
      static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::milliseconds>(now).count());
  state_->settle(now);
}

void Farm::State::restore(FarmRecord record) {
  // What speaks of a job or frame that is not there speaks of one that is damaged: there is nothing to be done to it.
  const auto frame_at = [&](FrameId id, auto&& change) {
    const auto job = jobs.find(id.job);
    if (job == jobs.end()) return;
    if (const JobFrame* frame = frame_of(job->second, id.frame))
      change(job->second, const_cast<JobFrame&>(*frame));
  };
  std::visit(
      Overloaded{
          [&](JobAdded& added) {
            Job job;
            job.id = added.id, job.spec = std::move(added.spec), job.submitted = added.submitted;
            job.state = job.spec.hold ? JobState::paused : JobState::waiting;
            last_job = std::max(last_job, static_cast<std::uint64_t>(job.id));
            jobs[added.id] = std::move(job);
          },
          [&](FrameAdded& added) {
            const auto job = jobs.find(added.id.job);
            if (job == jobs.end()) return;
            JobFrame& frame = job->second.frames.emplace_back();
            frame.number = added.id.frame, frame.scene_hash = std::move(added.scene_hash);
            frame.scene_bytes = std::move(added.scene), frame.assets = std::move(added.assets);
          },
          [&](const FrameStarted& started) {
            frame_at(started.id, [&](Job& job, JobFrame& frame) {
              frame.canvas.emplace(size_of(job.spec.settings));
              frame.started = started.at;
              if (!job.started) job.started = started.at;
            });
          },
          [&](const TileCommitted& commit) {
            frame_at(commit.frame, [&](Job& job, JobFrame& frame) {
              if (!is_waiting(frame, commit.tile, commit.passes)) return;
              set_done(job, frame, commit);
              const bool is_one_of_many = commit.worker == names.front();
              put_name(*frame.canvas, commit, is_one_of_many ? NameId{} : id_of_name(commit.worker));
              for (const std::string& helper : commit.helpers)
                if (helper != names.front())
                  frame.canvas->parts[commit.tile].push_back({commit.passes, id_of_name(helper)});
            });
          },
          [&](const PassesLost& lost) {
            frame_at(lost.frame, [&](Job& job, JobFrame& frame) {
              if (frame.canvas) lose(job, frame, lost);
            });
          },
          [&](JobChanged& changed) {
            const auto found = jobs.find(changed.id);
            if (found == jobs.end()) return;
            Job& job = found->second;
            job.state = changed.state, job.spec.priority = changed.priority;
            job.message = std::move(changed.message), job.spec.key = std::move(changed.key);
            job.tiles_given_back = changed.tiles_given_back, job.tiles_doubled = changed.tiles_doubled;
            job.tiles_checked = changed.tiles_checked;
            job.time_wasted = changed.time_wasted, job.ended = changed.ended;
            job.tiles_shared = changed.tiles_shared, job.rays_wasted = changed.rays_wasted;
          },
          [&](const SceneDropped& dropped) {
            frame_at(dropped.id, [](Job&, JobFrame& frame) { drop_data(frame); });
          },
          [&](const PictureDropped& dropped) {
            frame_at(dropped.id, [&](Job&, JobFrame& frame) {
              frame.canvas.reset();
              drop_data(frame);
              frame.pixels_done = dropped.pixels_done, frame.counters = dropped.counters;
              frame.thread_time = dropped.thread_time, frame.ended = dropped.ended;
            });
          },
          [&](const JobDropped& dropped) {
            last_job = std::max(last_job, static_cast<std::uint64_t>(dropped.id));
            jobs.erase(dropped.id);
          },
          [&](const WorkerNamed& named) { id_of_name(named.name); },
          [&](const WorkerDrained& drained) { set_in(drained_names, drained.name, drained.is_drained); },
          [&](const WorkerKnown& worker) {
            const NameId name = id_of_name(worker.name);
            KnownWorker& known = known_workers[worker.identity];
            std::erase(known.names, name);
            known.names.push_back(name);
            known.is_banned = worker.is_banned, known.trust = worker.trust;
          },
          [&](const WorkerBanned& banned) { set_in(banned_names, banned.name, banned.is_banned); },
      },
      record.fact);
}

void Farm::State::settle(FarmTime now) {
  std::erase_if(jobs, [](const auto& job) { return job.second.frames.empty(); });
  std::vector<std::pair<FarmTime, JobId>> job_ends;
  std::vector<std::pair<FarmTime, FrameId>> frame_ends;
  for (auto& [id, job] : jobs) {
    settle(job);
    if (has_ended(job)) {
      job.spec.script = {};
      job_ends.emplace_back(*job.ended, id);
    }
    for (const JobFrame& frame : job.frames)
      if (frame.ended && frame.canvas) frame_ends.emplace_back(*frame.ended, FrameId{id, frame.number});
    if (job.state == JobState::running) job.pace.restart(now, job.pixels_done);
    if (!job.spec.key.empty()) job_by_key[job.spec.key] = id;
    update_queue(job);
  }
  std::ranges::sort(job_ends);
  std::ranges::sort(frame_ends);
  for (const auto& end : job_ends) ended_jobs.push_back(end.second);
  for (const auto& end : frame_ends) ended_frames.push_back(end.second);
  drop_old_jobs(now);
  drop_old_films();
}

void Farm::State::settle(Job& job) {
  add_up(job);
  const bool is_all_there = job.frames_done == job.spec.frames->count();
  if (is_all_there && !has_ended(job)) {
    job.state = JobState::done;
    touch(job);
  }
  if (job.state == JobState::done && !is_all_there) {
    job.ended.reset();
    pause(job, damaged_words);
  }
  settle_ends(job);
  const bool is_without_scene =
      std::ranges::any_of(job.open, [&](std::uint32_t place) { return !job.frames[place].scene_bytes; });
  if (is_without_scene) {
    job.state = JobState::failed, job.message = no_scene_words;
    job.ended = last_end(job);
    settle_ends(job);
    warn(title_of(job) + " failed: " + job.message);
    touch(job);
  }
  for (JobFrame& frame : job.frames) count_data(frame);
}

void Farm::State::count_data(JobFrame& frame) {
  if (frame.ended && frame.canvas) bytes_kept += film_bytes(frame);
  for_each_data(frame, [&](const std::string& hash, SharedBytes& bytes) {
    SharedData& data = shared[hash];
    if (const auto known = data.bytes.lock()) bytes = known;
    data.bytes = bytes;
    if (frame.ended && data.kept++ == 0) bytes_kept += bytes->size();
    if (!frame.ended && data.unfinished++ == 0) unfinished_bytes += bytes->size();
  });
}

}  // namespace rayfarm
