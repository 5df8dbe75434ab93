// Second copies of work that others are slow with.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"
#include "master/tail.h"

namespace rayfarm {
namespace {

constexpr std::chrono::milliseconds between_looks{5};  // a look goes through all that is leased

constexpr std::uint64_t tiles_of_the_end = 8;  // a thread: so near the end it is known what will be late

/// Of frames that have come.
std::uint64_t unfinished_pixels(const Job& job) {
  const Size size = size_of(job.spec.settings);
  return std::uint64_t{size.width} * size.height * job.frames.size() - job.pixels_done;
}

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
  std::uint64_t pixels = 0;     // leased
};

/// Who may do something twice, on so many threads.
struct Farm::State::Helper {
  Worker* worker;
  std::uint32_t threads;
};

void Farm::tick(FarmTime now) {
  state_->note_overdue(now);
  state_->double_stragglers(now);
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
    if (!next && held < threads) all.push_back({&worker, static_cast<std::uint32_t>(threads - held)});
    if (!next) continue;
    const auto [known, is_new] = ending.try_emplace(next->id);
    if (is_new) known->second = is_ending(*next);
    if (known->second) all.push_back({&worker, 1});
  }
  return all;
}

/// Until nothing of the job waits any more; 0: nothing does.
double Farm::State::seconds_of_queue(const Job& job, std::uint64_t pixels_leased) const {
  const std::uint64_t unfinished = unfinished_pixels(job);
  if (unfinished <= pixels_leased || job.pixels_done == 0) return 0;
  double speed = 0;
  for (const auto& [id, worker] : workers)
    if (may_work(worker)) speed += worker.info.threads * speed_with(job, worker);
  const double rays_a_pixel = static_cast<double>(job.counters.rays()) / static_cast<double>(job.pixels_done);
  return speed > 0 ? static_cast<double>(unfinished - pixels_leased) * rays_a_pixel / speed : 0;
}

void Farm::State::double_stragglers(FarmTime now) {
  if (now < next_look) return;
  const std::vector<Helper> all = helpers();
  if (all.empty()) return;
  std::map<JobId, Candidates> by_job;
  std::map<WorkerId, double> busy;
  for (const auto& [id, worker] : workers) busy[id] = add_candidates(worker, now, by_job);
  if (!by_job.empty()) next_look = now + between_looks;

  for (auto& [id, candidates] : by_job) {
    const Job& job = jobs.at(id);
    // While something waits, only what would end after all of that.
    const double queue = seconds_of_queue(job, candidates.pixels);
    for (Straggler& straggler : candidates.stragglers)
      if (straggler.time_left <= queue) straggler.time_left = 0;
    std::vector<IdleWorker> idle;
    for (const auto& [worker, threads] : all)
      idle.push_back({static_cast<std::uint64_t>(worker->id), speed_with(job, *worker),
                      refuses(*worker, id) ? 0 : threads, busy.at(worker->id)});
    for (const Copy& copy : copies_of(candidates.stragglers, idle))
      give_copy(workers.at(WorkerId{candidates.stragglers[copy.straggler].holder}),
                candidates.leases[copy.straggler], *all[copy.worker].worker, now);
  }
}

/// When the holder has a thread for something else.
double Farm::State::add_candidates(const Worker& holder, FarmTime now, std::map<JobId, Candidates>& by_job) {
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
    by_job[lease.job].pixels += pixels_in(lease.work, jobs.at(lease.job).spec.settings);
    if (lease.twin || lease.is_check) continue;
    Candidates& candidates = by_job[lease.job];
    candidates.stragglers.push_back({static_cast<std::uint64_t>(holder.id), left[i], costs[i]});
    candidates.leases.push_back(id);
  }
  return time_until_free(left, holder.info.threads);
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
  const Lease lease = call_off(worker, twin.lease, now);
  Job& job = jobs.at(lease.job);
  job.time_wasted += time_wasted(lease, now);
  touch(job);
  worker.send(Revoke{{twin.lease}});
}

}  // namespace rayfarm
