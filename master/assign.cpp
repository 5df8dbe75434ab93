// Who gets what: giving work out and taking it back.
#include <algorithm>
#include <new>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

constexpr std::size_t most_victims = 5;  // workers that one tile may cost

}  // namespace

void Farm::State::update_queue(const Job& job) {
  if (wants_workers(job))
    queue.insert(place_of(job));
  else
    queue.erase(place_of(job));
}

Job* Farm::State::next_job_for(const Worker& worker) {
  if (!may_work(worker)) return nullptr;
  const bool is_believed = worker.info.kind == WorkerKind::local;
  const auto place = std::ranges::find_if(queue, [&](const Place& p) {
    return !refuses(worker, p.second) && (is_believed || !waits_for_judges(p));
  });
  return place == queue.end() ? nullptr : &jobs.at(place->second);
}

bool Farm::State::give_one(Worker& worker, FarmTime now) {
  Job* job = next_job_for(worker);
  if (give_share(worker, job, now)) return true;
  if (const auto trial = first_for(worker, open_trials)) {
    const Job& tried = jobs.at(trial->frame.job);
    const bool is_next = job == nullptr || tried.spec.priority >= job->spec.priority;
    if (is_next && has_room_for(worker, tried.id)) return give_trial(worker, *trial, now), true;
    if (is_next) return false;
  }
  if (job == nullptr) return give_asked_trial(worker, now);
  if (!has_room_for(worker, job->id)) return false;
  const std::uint32_t place = *job->open.begin();
  JobFrame& frame = job->frames[place];
  const bool can_start = frame.canvas ? read_film(*job, frame) : start(*job, frame, now);
  if (!can_start) return true;  // it failed, or waits now; ask for the next

  Schedule& schedule = frame.canvas->schedule;
  const std::optional<Work> work =
      worker.info.kind == WorkerKind::local ? schedule.take_pass() : schedule.take_tile();
  give(worker, *job, frame, work.value(), now);
  // The coming frame's scene travels while this one is rendered.
  if (place + 1 < job->frames.size() && !job->frames[place + 1].ended)
    introduce(worker, *job, job->frames[place + 1]);
  return true;
}

void Farm::State::give(Worker& worker, Job& job, JobFrame& frame, const Work& work, FarmTime now) {
  if (!frame.canvas->schedule.has_waiting()) {
    job.open.erase(job.spec.frames->index_of(frame.number).value());
    update_queue(job);
  }
  introduce(worker, job, frame);
  const std::uint64_t samples = pixels_in(work, job.spec.settings) * job.spec.settings.spp;
  assign(worker, LeaseId{++last_lease}, {job.id, frame.number, work, samples, now});
}

void Farm::State::fill(Worker& worker, FarmTime now) {
  while (give_one(worker, now)) {}
  relieve_stragglers(now);
}

void Farm::State::fill_all(FarmTime now) {
  // In rounds of one lease each, so that the few tiles of a small picture are spread over all workers.
  bool anybody_took = !queue.empty() || !trials.empty() || !splits.empty();
  while (anybody_took) {
    anybody_took = false;
    for (auto& [id, worker] : workers) anybody_took |= give_one(worker, now);
  }
  relieve_stragglers(now);
}

bool Farm::State::start(Job& job, JobFrame& frame, FarmTime now) {
  const Size size = size_of(job.spec.settings);
  try {
    auto film = std::make_shared<Film>(size);
    frame.canvas.emplace(size).film = std::move(film);
  } catch (const std::bad_alloc&) {
    fail(job,
         "the master has no memory for a picture of " + std::to_string(size.width) + "x" +
             std::to_string(size.height) + " pixels; ask for a smaller --size",
         now);
    return false;
  }
  frame.started = now;
  touch(job);
  record(FrameStarted{{job.id, frame.number}, now});
  if (job.started) return true;
  job.state = JobState::running;
  job.started = now;
  job.pace.restart(now, 0);
  tell(title_of(job) + " started");
  return true;
}

void Farm::State::end_lease(Worker& worker, LeaseId id, FarmTime now) {
  const Lease lease = call_off(worker, id, now);
  Job& job = jobs.at(lease.job);
  waste(job, worker, lease, now);
  ++job.tiles_given_back;
  touch(job);
  if (lease.twin) {
    workers.at(lease.twin->worker).leases.at(lease.twin->lease).twin.reset();
    return;
  }
  if (lease.is_check) return withdraw(worker, lease);
  if (lease.split) return splits.at(*lease.split).original.reset();
  if (lease.piece) {
    splits.at(lease.piece->split).pieces[lease.piece->place].is_waiting = true;
    splits_to_share.insert(lease.piece->split);
    return;
  }
  wait_again(job, lease.frame, lease.work);
}

void Farm::State::wait_again(Job& job, std::uint32_t frame, const Work& work) {
  frame_at(job, frame).canvas->schedule.give_back(work);
  job.open.insert(job.spec.frames->index_of(frame).value());
  update_queue(job);
}

std::vector<LeaseId> Farm::State::end_leases(Worker& worker, FarmTime now) {
  std::vector<LeaseId> ids;
  for (const auto& [id, lease] : worker.leases) ids.push_back(id);
  for (const LeaseId id : ids) end_lease(worker, id, now);
  return ids;
}

void Farm::State::revoke(Worker& worker, JobId job, FarmTime now) {
  Revoke revoke;
  for (const auto& [id, lease] : worker.leases)
    if (lease.job == job) revoke.leases.push_back(id);
  for (const LeaseId lease : revoke.leases) end_lease(worker, lease, now);
  if (!revoke.leases.empty()) worker.send(std::move(revoke));
}

void Farm::State::revoke_everywhere(JobId job, FarmTime now) {
  for (auto& [id, worker] : workers) revoke(worker, job, now);
}

void Farm::State::blame(const Lease& oldest, const std::string& identity, Canvas::Victim lost, FarmTime now) {
  Job& job = jobs.at(oldest.job);
  JobFrame& frame = frame_at(job, oldest.frame);
  const bool is_first = frame.pixels_done == 0;
  const auto is_alive = [&](const auto& worker) { return worker.second.info.process == lost.process; };
  if (lost.process != 0 && std::ranges::any_of(workers, is_alive)) return;  // on another connection
  Canvas::Victims& victims =
      is_first ? frame.canvas->lost_at_first : frame.canvas->lost_over[oldest.work.tile];
  // Who was given its work before another was lost was lost with that one, not after it: by the network, when nothing was
  // heard of it. One that fell may have fallen over the scene, which all load at once, but not over one tile.
  const bool is_with_another =
      std::ranges::any_of(victims, [&](const auto& v) { return oldest.given < v.second.lost; });
  if (is_with_another && (lost.was_silent || !is_first)) return;
  victims[identity] = lost;
  frames_with_victims.insert({job.id, frame.number});
  if (victims.size() < most_victims) return;
  std::string who;
  for (const auto& [its_identity, victim] : victims)
    who += (who.empty() ? "" : ", ") + names[static_cast<std::size_t>(victim.name)];
  fail(job,
       "workers are lost again and again over " +
           (is_first ? "" : "tile " + std::to_string(oldest.work.tile) + " of ") + title_of(job, frame) +
           " (" + who + "); do they have too little memory for it?",
       now);
}

void Farm::State::exonerate(std::uint64_t process) {
  if (process == 0) return;
  const auto is_it = [process](const auto& victim) { return victim.second.process == process; };
  std::erase_if(frames_with_victims, [&](FrameId id) {
    const auto job = jobs.find(id.job);
    if (job == jobs.end()) return true;
    std::optional<Canvas>& canvas = frame_at(job->second, id.frame).canvas;
    if (!canvas) return true;
    std::erase_if(canvas->lost_at_first, is_it);
    for (auto& [tile, victims] : canvas->lost_over) std::erase_if(victims, is_it);
    std::erase_if(canvas->lost_over, [](const auto& lost) { return lost.second.empty(); });
    return canvas->lost_at_first.empty() && canvas->lost_over.empty();
  });
}

void Farm::State::fail(Job& job, std::string why, FarmTime now) {
  revoke_everywhere(job.id, now);
  job.message = std::move(why);
  warn(title_of(job) + " failed: " + job.message);
  end(job, JobState::failed, now);
}

void Farm::State::end(Job& job, JobState state, FarmTime now) {
  job.state = state;
  job.ended = now;
  job.open.clear();
  for (JobFrame& frame : job.frames)
    if (!frame.ended) end(job, frame, now);
  for (auto& [id, worker] : workers) worker.jobs.erase(job.id);
  drop_unneeded_assets();
  if (state != JobState::done) job_by_key.erase(std::exchange(job.spec.key, {}));  // it may be tried again
  job.spec.script = {};
  touch(job);
  update_queue(job);
  ended_jobs.push_back(job.id);
  drop_old_jobs(now);
  drop_old_films();
}

}  // namespace rayfarm
