// Workers that come back with work of an earlier conversation: with this master, or with the one that died.
#include <algorithm>

#include "master/farm_state.h"

namespace rayfarm {

void Farm::receive(WorkerId id, const Holds& holds, FarmTime now) {
  Worker& worker = state_->workers.at(id);
  Unneeded unneeded;
  for (const HeldTile& held : holds.tiles)
    if (!state_->reattach(worker, held, now)) unneeded.leases.push_back(held.work.lease);
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
  if (job == nullptr || job->state != JobState::running || !may_be_given(worker, job->id)) return false;
  const auto place = job->spec.frames->index_of(work.frame);
  if (!place || *place >= job->frames.size()) return false;
  JobFrame& frame = job->frames[*place];
  if (!frame.canvas || frame.ended || work.tile >= frame.canvas->deliveries.size()) return false;
  if (!read_film(*job, frame) || job->state != JobState::running) return false;

  Schedule& schedule = frame.canvas->schedule;
  const Work waiting{work.tile, static_cast<PassSet>(schedule.waiting(work.tile) & work.passes)};
  if (waiting.passes != 0) {
    schedule.take(waiting);
    give(worker, *job, frame, waiting, now);
    return true;
  }
  if (!held.is_finished) return false;
  for (auto& [id, holder] : workers)
    for (auto& [lease_id, lease] : holder.leases) {
      const bool is_it = lease.job == work.job && lease.frame == work.frame && lease.work.tile == work.tile &&
                         (lease.work.passes & ~work.passes) == 0;
      if (!is_it || lease.twin || lease.is_check || holder.id == worker.id) continue;
      give_copy(holder, lease_id, worker, now);
      return true;
    }
  return false;
}

}  // namespace rayfarm
