// Second copies of work that others are slow with.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"
#include "master/tail.h"

namespace rayfarm {
namespace {

constexpr std::chrono::milliseconds between_looks{5};  // a look goes through all that is leased

double seconds_of(FarmTime time) { return std::chrono::duration<double>(time).count(); }

/// Of one of the worker's threads: its own, or the job's mean while nothing is known of it. 0: nothing is known at all.
double speed_with(const Job& job, const Worker& worker) {
  if (const double own = tracing_speed(worker, job.id); own > 0) return own;
  const double seconds = seconds_of(job.thread_time);
  return seconds > 0 ? static_cast<double>(job.counters.rays()) / seconds : 0;
}

}  // namespace

/// Of one job.
struct Farm::State::Candidates {
  std::vector<Straggler> stragglers;
  std::vector<LeaseId> leases;  // theirs
};

void Farm::tick(FarmTime now) { state_->double_stragglers(now); }

void Farm::State::double_stragglers(FarmTime now) {
  if (now < next_look) return;
  std::vector<Worker*> idle;
  for (auto& [id, worker] : workers)
    if (worker.leases.size() < worker.info.threads && may_work(worker) && !next_job_for(worker))
      idle.push_back(&worker);
  if (idle.empty()) return;
  std::map<JobId, Candidates> by_job;
  for (const auto& [id, worker] : workers) add_candidates(worker, now, by_job);
  if (!by_job.empty()) next_look = now + between_looks;

  for (const auto& [id, candidates] : by_job) {
    std::vector<IdleWorker> helpers;
    for (const Worker* worker : idle) {
      const std::size_t free_threads =
          worker->info.threads - std::min<std::size_t>(worker->leases.size(), worker->info.threads);
      const bool may_help = !refuses(*worker, id);
      helpers.push_back({static_cast<std::uint64_t>(worker->id), speed_with(jobs.at(id), *worker),
                         may_help ? static_cast<std::uint32_t>(free_threads) : 0});
    }
    for (const Copy& copy : copies_of(candidates.stragglers, helpers))
      give_copy(workers.at(WorkerId{candidates.stragglers[copy.straggler].holder}),
                candidates.leases[copy.straggler], *idle[copy.worker], now);
  }
}

void Farm::State::add_candidates(const Worker& holder, FarmTime now, std::map<JobId, Candidates>& by_job) {
  std::vector<HeldWork> held;
  std::vector<double> costs;
  for (const auto& [id, lease] : holder.leases) {
    const Job& job = jobs.at(lease.job);
    costs.push_back(expected_rays(job, *frame_of(job, lease.frame), lease.work));
    held.push_back({expected_seconds(costs.back(), speed_with(job, holder))});
    if (lease.begun) held.back().spent = seconds_of(now - *lease.begun);
  }
  const std::vector<double> left = times_left(held, holder.info.threads);
  std::size_t place = 0;
  for (const auto& [id, lease] : holder.leases) {
    const std::size_t i = place++;
    if (lease.twin || lease.is_check) continue;
    Candidates& candidates = by_job[lease.job];
    candidates.stragglers.push_back({static_cast<std::uint64_t>(holder.id), left[i], costs[i]});
    candidates.leases.push_back(id);
  }
}

void Farm::State::give_copy(Worker& holder, LeaseId original, Worker& worker, FarmTime now) {
  Lease& lease = holder.leases.at(original);
  Job& job = jobs.at(lease.job);
  const LeaseId id{++last_lease};
  Lease copy{lease.job, lease.frame, lease.work, lease.samples, now};
  copy.twin = {holder.id, original};
  lease.twin = {worker.id, id};
  introduce(worker, job, frame_at(job, lease.frame));
  assign(worker, id, std::move(copy));
  ++job.tiles_doubled;
  touch(job);
}

void Farm::State::end_twin(const Lease::Twin& twin, FarmTime now) {
  Worker& worker = workers.at(twin.worker);
  const Lease lease = take_lease(worker, twin.lease, now);
  Job& job = jobs.at(lease.job);
  job.time_wasted += time_wasted(lease, now);
  touch(job);
  worker.send(Revoke{{twin.lease}});
}

}  // namespace rayfarm
