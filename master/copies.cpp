// Second copies of work that others are slow with.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"
#include "master/tail.h"

namespace rayfarm {
namespace {

// A look goes through all that is leased, for a microsecond or two each: with a thousand workers it is to take no more
// than a tenth of the time.
constexpr std::chrono::milliseconds between_looks{5};
constexpr std::chrono::microseconds a_lease{20};

constexpr std::uint64_t tiles_of_the_end = 8;  // a thread: so near the end it is known what will be late

/// Of frames that have come.
std::uint64_t unfinished_pixels(const Job& job) {
  const Size size = size_of(job.spec.settings);
  return std::uint64_t{size.width} * size.height * job.frames.size() - job.pixels_done;
}

}  // namespace

void Farm::tick(FarmTime now) {
  state_->drop_old_jobs(now);
  state_->note_overdue(now);
  if (!state_->splits.empty()) return state_->fill_all(now);  // who was too slow for a piece may no longer be
  state_->relieve_stragglers(now);
}

bool Farm::State::is_ending(const Job& job) const {
  std::uint64_t threads = 0;
  for (const auto& [id, worker] : workers) threads += worker.info.threads;
  return job.spec.frames->count() == job.frames.size() &&
         unfinished_pixels(job) <= tiles_of_the_end * threads * tile_side * tile_side;
}

std::vector<Farm::State::Helper> Farm::State::helpers() {
  std::vector<Helper> all;
  std::map<JobId, bool> ending;
  for (auto& [id, worker] : workers) {
    if (!may_work(worker)) continue;
    const std::size_t held = worker.leases.size(), threads = worker.info.threads;
    const Job* next = next_job_for(worker);
    if (!next && held < threads) all.push_back({&worker, static_cast<std::uint32_t>(threads - held), true});
    if (!next) continue;
    const auto [known, is_new] = ending.try_emplace(next->id);
    if (is_new) known->second = is_ending(*next);
    if (known->second) all.push_back({&worker, 1, false});
  }
  return all;
}

/// Until nothing of the job waits any more; 0: nothing does.
double Farm::State::seconds_of_queue(const Job& job, std::uint64_t pixels_leased) const {
  const std::uint64_t unfinished = unfinished_pixels(job);
  if (unfinished <= pixels_leased || job.pixels_done == 0) return 0;
  double speed = 0;
  for (const auto& [id, worker] : workers)
    if (may_work(worker)) speed += worker.info.threads * expected_speed(worker, job);
  const double rays_a_pixel = static_cast<double>(job.counters.rays()) / static_cast<double>(job.pixels_done);
  return speed > 0 ? static_cast<double>(unfinished - pixels_leased) * rays_a_pixel / speed : 0;
}

void Farm::State::relieve_stragglers(FarmTime now) {
  if (now < next_look) return;
  const std::vector<Helper> all = helpers();
  if (all.empty()) return;
  std::map<JobId, std::vector<Held>> by_job;
  std::map<WorkerId, double> busy;
  for (const auto& [id, worker] : workers) busy[id] = note_held(worker, now, by_job);
  std::size_t leases = 0;
  for (const auto& [id, held] : by_job) leases += held.size();
  if (leases > 0) next_look = now + std::max<FarmTime>(between_looks, leases * a_lease);
  for (auto& [id, held] : by_job) {
    const Job& job = jobs.at(id);
    if (!share_stragglers(job, held, all, now)) copy_stragglers(job, std::move(held), all, busy, now);
  }
}

/// When the holder has a thread for something else.
double Farm::State::note_held(const Worker& holder, FarmTime now,
                              std::map<JobId, std::vector<Held>>& by_job) {
  std::vector<HeldWork> work;
  std::vector<double> costs;
  for (const auto& [id, lease] : holder.leases) {
    costs.push_back(expected_cost(lease));
    work.push_back({expected_seconds(costs.back(), expected_speed(holder, jobs.at(lease.job)))});
    if (lease.begun) work.back().spent = seconds_of(now - *lease.begun);
  }
  const std::vector<double> left = times_left(work, holder.info.threads);
  std::size_t i = 0;
  for (const auto& [id, lease] : holder.leases) {
    by_job[lease.job].push_back(
        {id,
         &lease,
         {static_cast<std::uint64_t>(holder.id), left[i], costs[i], work[i].spent, lease.piece.has_value()}});
    ++i;
  }
  return time_until_free(left, holder.info.threads);
}

double Farm::State::expected_cost(const Lease& lease) const {
  const Job& job = jobs.at(lease.job);
  const double whole = expected_rays(job, *frame_of(job, lease.frame), lease.work);
  if (!lease.piece) return whole;
  const std::uint64_t samples = pixels_in(lease.work, job.spec.settings) * job.spec.settings.spp;
  return whole * static_cast<double>(lease.samples) / static_cast<double>(samples);
}

void Farm::State::copy_stragglers(const Job& job, std::vector<Held> held, const std::vector<Helper>& helpers,
                                  const std::map<WorkerId, double>& busy, FarmTime now) {
  std::uint64_t pixels = 0;
  for (const Held& h : held) pixels += h.lease->samples / job.spec.settings.spp;
  std::erase_if(held, [&](const Held& h) {
    const Lease& lease = *h.lease;
    // Not when the whole is with the same worker, which may be the one that is stuck.
    const auto is_whole_elsewhere = [&](const std::optional<Lease::Twin>& original) {
      return original && static_cast<std::uint64_t>(original->worker) != h.straggler.holder;
    };
    const bool is_done_twice = lease.twin || lease.split ||
                               (lease.piece && is_whole_elsewhere(splits.at(lease.piece->split).original));
    return is_done_twice || lease.is_check;
  });
  // While something waits, only what would end after all of that.
  const double queue = seconds_of_queue(job, pixels);
  std::vector<Straggler> stragglers;
  for (const Held& h : held) {
    stragglers.push_back(h.straggler);
    if (h.straggler.time_left <= queue) stragglers.back().time_left = 0;
  }
  std::vector<IdleWorker> idle;
  for (const Helper& helper : helpers)
    idle.push_back({static_cast<std::uint64_t>(helper.worker->id), expected_speed(*helper.worker, job),
                    refuses(*helper.worker, job.id) ? 0 : helper.threads, busy.at(helper.worker->id),
                    helper.worker->info.takes_pieces});
  for (const Copy& copy : copies_of(stragglers, idle))
    give_copy(workers.at(WorkerId{stragglers[copy.straggler].holder}), held[copy.straggler].id,
              *helpers[copy.worker].worker, now);
}

void Farm::State::give_copy(Worker& holder, LeaseId original, Worker& worker, FarmTime now) {
  Lease& lease = holder.leases.at(original);
  Job& job = jobs.at(lease.job);
  const LeaseId id{++last_lease};
  Lease copy{lease.job, lease.frame, lease.work, lease.samples, now};
  copy.piece = lease.piece;
  copy.twin = {holder.id, original};
  lease.twin = {worker.id, id};
  introduce(worker, job, frame_at(job, lease.frame));
  assign(worker, id, std::move(copy));
  ++job.tiles_doubled;
  touch(job);
}

void Farm::State::end_twin(const Lease::Twin& twin, FarmTime now) {
  Worker& worker = workers.at(twin.worker);
  const Lease lease = call_off(worker, twin.lease, now);
  Job& job = jobs.at(lease.job);
  waste(job, worker, lease, now);
  touch(job);
  worker.send(Revoke{{twin.lease}});
}

void Farm::State::waste(Job& job, const Worker& worker, const Lease& lease, FarmTime now) {
  const FarmTime time = time_wasted(lease, now);
  job.time_wasted += time;
  job.rays_wasted += static_cast<std::uint64_t>(seconds_of(time) * tracing_speed(worker, job.id));
}

}  // namespace rayfarm
