// Workers that come back with work of an earlier conversation: with this master, or with the one that died.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

constexpr std::size_t most_held =
    2048 + 64;  // a worker keeps 2048 (crew.cpp); each costs a look at all leases

}  // namespace

void Farm::receive(WorkerId id, const Holds& holds, FarmTime now) {
  Worker* const here = state_->worker_here(id);
  if (!here) return;
  Worker& worker = *here;
  if (std::exchange(worker.has_spoken, true))
    state_->denounce(worker,
                     "it told again, or too late, what it holds; it may do so once, before any result", now);
  if (holds.tiles.size() > most_held)
    state_->denounce(worker,
                     "it says that it holds " + std::to_string(holds.tiles.size()) + " tiles; at most " +
                         std::to_string(most_held) + " can be",
                     now);
  Unneeded unneeded;
  std::size_t unfinished = 0;
  for (const HeldTile& held : holds.tiles) {
    const bool is_too_many = !held.is_finished && unfinished == leases_at_hand(worker);
    if (is_too_many || !state_->reattach(worker, held, now))
      unneeded.leases.push_back(held.work.lease);
    else if (!held.is_finished)
      ++unfinished;
  }
  const std::size_t kept = holds.tiles.size() - unneeded.leases.size();
  if (kept > 0)
    state_->tell("worker " + worker.info.name + " goes on with " + count_of_tiles(kept) + " that it held",
                 worker.info.name);
  if (!unneeded.leases.empty()) worker.send(std::move(unneeded));
  state_->fill_all(now);
}

bool Farm::State::reattach(Worker& worker, const HeldTile& held, FarmTime now) {
  const Assignment& work = held.work;
  Job* job = living_job(work.job);
  // Of a job that is paused, what is rendered already: it costs nobody anything.
  const auto is_taken = [&] {
    return job->state == JobState::running || (job->state == JobState::paused && held.is_finished);
  };
  if (job == nullptr || !is_taken() || !may_be_given(worker, job->id)) return false;
  const auto place = job->spec.frames->index_of(work.frame);
  if (!place || *place >= job->frames.size()) return false;
  JobFrame& frame = job->frames[*place];
  if (!frame.canvas || frame.ended || work.tile >= frame.canvas->deliveries.size()) return false;
  if (!read_film(*job, frame) || !is_taken()) return false;

  Schedule& schedule = frame.canvas->schedule;
  const Work waiting{work.tile, static_cast<PassSet>(schedule.waiting(work.tile) & work.passes)};
  if (waiting.passes != 0) {
    schedule.take(waiting);
    give(worker, *job, frame, waiting, now);
  } else if (!held.is_finished ||
             !(reattach_as_check(worker, work, now) || reattach_as_copy(worker, work, now) ||
               reattach_as_whole(worker, work, now))) {
    return false;
  }
  worker.leases.at(LeaseId{last_lease}).is_reattached = true;
  return true;
}

bool Farm::State::reattach_as_check(Worker& worker, const Assignment& work, FarmTime now) {
  const auto trial = unheard_trial(worker, {work.job, work.frame, {work.tile, work.passes}});
  if (trial) give_trial(worker, *trial, now);
  return trial.has_value();
}

bool Farm::State::reattach_as_copy(Worker& worker, const Assignment& work, FarmTime now) {
  for (auto& [id, holder] : workers)
    for (auto& [lease_id, lease] : holder.leases) {
      const bool is_it = lease.job == work.job && lease.frame == work.frame && lease.work.tile == work.tile &&
                         (lease.work.passes & ~work.passes) == 0;
      if (!is_it || lease.is_check || lease.piece || lease.split || holder.id == worker.id) continue;
      if (lease.twin && (lease.twin->worker == worker.id || lease.twin->lease < lease_id)) continue;
      if (lease.twin)
        end_twin(*std::exchange(lease.twin, {}), now);  // the younger of two: nearly for nothing
      give_copy(holder, lease_id, worker, now);
      return true;
    }
  return false;
}

bool Farm::State::reattach_as_whole(Worker& worker, const Assignment& work, FarmTime now) {
  for (const auto& [id, split] : splits) {
    const bool is_it = split.frame == FrameId{work.job, work.frame} && split.work.tile == work.tile &&
                       (split.work.passes & ~work.passes) == 0;
    if (!is_it || (!split.original && is_doubled(id))) continue;
    if (!split.original) return give_whole(worker, id, now), true;
    const Lease::Twin original = *split.original;
    if (original.worker == worker.id) return false;
    end_split(id, now);
    workers.at(original.worker).leases.at(original.lease).split.reset();
    give_copy(workers.at(original.worker), original.lease, worker, now);
    return true;
  }
  return false;
}

}  // namespace rayfarm
