// What comes back from workers: results in time and too late, and work they will not do.
#include <algorithm>
#include <cstdio>
#include <set>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

std::string words_for(const Result& result, const std::string& fault) {
  return "wrong result for tile " + std::to_string(result.tile) + " of job " +
         std::to_string(static_cast<std::uint64_t>(result.job)) + ": " + fault;
}

std::optional<std::string> lease_fault_of(const Result& result, std::optional<Tile> area, const Lease& lease,
                                          const Job& job) {
  if (result.job != lease.job || result.frame != lease.frame || result.tile != lease.work.tile)
    return "its lease is for tile " + std::to_string(lease.work.tile) + " of " +
           title_of(job, *frame_of(job, lease.frame));
  const Tile tile = tile_at(size_of(job.spec.settings), lease.work.tile);
  const Tile wanted = lease.piece ? lease.piece->area : tile;
  if (area.value_or(tile) != wanted) return "it is not of the area that its lease is for";
  return fault_of(result.images, wanted, lease.work.passes);
}

RayCounters counters_of(const std::vector<PassImage>& images) {
  RayCounters sum;
  for (const PassImage& image : images) sum += image.counters;
  return sum;
}

std::string seconds(FarmTime time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", std::chrono::duration<double>(time).count());
  return text;
}

}  // namespace

void Farm::receive(WorkerId id, Result result, FarmTime now) {
  state_->take_result(id, std::move(result), std::nullopt, now);
}

void Farm::receive(WorkerId id, PieceResult piece, FarmTime now) {
  state_->take_result(id, std::move(piece.result), piece.area, now);
}

void Farm::State::take_result(WorkerId id, Result result, std::optional<Tile> area, FarmTime now) {
  Worker* const here = worker_here(id);
  if (!here) return;
  Worker& worker = *here;
  worker.has_spoken = true;
  if (!worker.leases.contains(result.lease)) return receive_late(worker, std::move(result), area, now);

  const Lease lease = worker.leases.at(result.lease);
  if (const auto fault = lease_fault_of(result, area, lease, jobs.at(lease.job))) {
    end_lease(worker, result.lease, now);
    denounce(worker, words_for(result, *fault), now);
  }
  const LeaseId leased_as = result.lease;
  take_lease(worker, leased_as, now);
  if (lease.twin) end_twin(*lease.twin, now);
  if (lease.split) end_split(*lease.split, now);
  const std::uint32_t wanted = opinions_wanted_on(worker, leased_as, lease);
  if (lease.is_check || wanted > 1) {
    hear(worker, lease, wanted, std::move(result), now);
    return fill_all(now);
  }
  if (lease.piece)
    hear_piece(worker, lease, std::move(result), now);
  else
    deliver(worker, lease, std::move(result), now);
  if (lease.split || lease.piece) return fill_all(now);
  fill(worker, now);
  if (lease.twin) fill(workers.at(lease.twin->worker), now);
}

void Farm::State::deliver(Worker& worker, const Lease& lease, Result result, FarmTime now) {
  Job& job = jobs.at(lease.job);
  const FarmTime taken = book(worker, lease, result, now);
  credit(worker, lease.samples / job.spec.settings.spp);
  accept(job, frame_at(job, lease.frame), lease.work, std::move(result.images), worker.name, taken, now);
}

FarmTime Farm::State::book(Worker& worker, const Lease& lease, const Result& result, FarmTime now) {
  const FarmTime taken = believed_time(lease, result.seconds, now);
  if (!lease.is_reattached) learn_speed(worker, lease, counters_of(result.images).rays(), taken);
  return taken;
}

void Farm::State::credit(Worker& worker, std::uint64_t pixels) {
  ++worker.tiles;
  worker.pixels += pixels;
}

void Farm::State::accept(Job& job, JobFrame& frame, const Work& work, std::vector<PassImage> images,
                         NameId by, FarmTime taken, FarmTime now, const std::vector<NameId>& helpers) {
  commit(job, frame, {work, images, by, taken, helpers}, now);
  const RayCounters counters = counters_of(images);
  std::vector<std::string> helpers_names;
  for (const NameId helper : helpers) helpers_names.push_back(names[static_cast<std::size_t>(helper)]);
  record(TileCommitted{{job.id, frame.number},
                       work.tile,
                       work.passes,
                       names[static_cast<std::size_t>(by)],
                       taken,
                       now,
                       counters,
                       std::move(images),
                       std::move(helpers_names)});
  ++revision;
  if (is_complete(job, frame)) finish(job, frame, now);
}

void Farm::State::finish(Job& job, JobFrame& frame, FarmTime now) {
  end(job, frame, now);
  ++job.frames_done;
  job.last_done = now;
  while (job.first_unfinished < job.frames.size() && job.frames[job.first_unfinished].ended)
    ++job.first_unfinished;
  if (job.frames_done < job.spec.frames->count()) return drop_old_films();
  tell(title_of(job) + " done in " + seconds(now - *job.started));
  end(job, JobState::done, now);
}

void Farm::State::receive_late(Worker& worker, Result result, std::optional<Tile> area, FarmTime now) {
  if (worker.info.kind == WorkerKind::remote && known_workers.at(worker.identity).is_banned) return;
  const auto called_off = worker.called_off.extract(result.lease);
  if (called_off.empty() && result.lease <= worker.forgotten) return;
  if (called_off.empty())
    denounce(worker, words_for(result, "it has no such lease, or has answered it"), now);
  Lease& lease = called_off.mapped();
  const auto job = jobs.find(lease.job);
  if (job == jobs.end()) return;  // there is nothing left to compare it with
  if (const auto fault = lease_fault_of(result, area, lease, job->second))
    denounce(worker, words_for(result, *fault), now);
  const std::optional<TrialId> trial = lease.piece ? std::nullopt : unheard_trial(worker, lease);
  if (!trial) return compare_late(worker, lease, result);
  lease.work.passes = trial->passes;
  lease.samples = pixels_in(lease.work, job->second.spec.settings) * job->second.spec.settings.spp;
  std::erase_if(result.images, [&](const PassImage& image) { return !(trial->passes >> image.pass & 1); });
  hear(worker, lease, trials.at(*trial).wanted, std::move(result), now);
  fill_all(now);
}

void Farm::State::compare_late(Worker& worker, const Lease& lease, const Result& result) {
  const Job& job = jobs.at(lease.job);
  const JobFrame* frame = frame_of(job, lease.frame);
  if (!frame->canvas || !frame->canvas->film) return;  // it is gone, or not worth the reading
  const Tile tile = tile_at(size_of(job.spec.settings), lease.work.tile);
  const std::optional<NameId> other =
      contradicted(*frame->canvas, result.tile, lease.piece ? lease.piece->area : tile, result.images);
  if (!other || worker.was_contradicted) return;
  worker.was_contradicted = true;  // one line for each connection: a broken machine must not flood the log
  warn("workers " + worker.info.name + " and " + names[static_cast<std::size_t>(*other)] +
       " differ in the pixels of tile " + std::to_string(result.tile) + " of " + title_of(job, *frame) +
       "; one of them computes wrongly");
}

void Farm::receive(WorkerId id, GiveBack given, FarmTime now) {
  Worker* const here = state_->worker_here(id);
  if (!here) return;
  Worker& worker = *here;
  std::map<JobId, std::size_t> tiles;
  for (const LeaseId lease : given.leases) {
    const auto held = worker.leases.find(lease);
    if (held == worker.leases.end()) continue;  // revoked meanwhile
    ++tiles[held->second.job];
    state_->end_lease(worker, lease, now);
  }
  const bool is_refusal = !given.reason.empty();
  if (!is_refusal) worker.is_stopping = true;
  for (const auto& [job_id, count] : tiles) {
    Job& job = state_->jobs.at(job_id);
    state_->tell("worker " + worker.info.name + " gave back " + count_of_tiles(count) + " of " +
                     title_of(job) + ": " + (is_refusal ? given.reason : "it is stopping"),
                 worker.info.name);
    if (is_refusal) state_->refuse(worker, job, given.reason, now);
  }
  state_->fill_all(now);
}

void Farm::State::refuse(Worker& worker, Job& job, const std::string& reason, FarmTime now) {
  worker.jobs.at(job.id).is_refused = true;
  job.message = "worker " + worker.info.name + ": " + reason;
  touch(job);
  revoke(worker, job.id, now);
  const bool somebody_can = std::ranges::any_of(
      workers, [&](const auto& w) { return !w.second.is_stopping && !refuses(w.second, job.id); });
  if (somebody_can || job.pixels_done > 0) return;
  fail(job, "no worker can render it; " + job.message, now);
}

}  // namespace rayfarm
