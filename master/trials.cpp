// Pixels that are believed only when several workers agree on them, and what befalls those who do not.
#include <algorithm>
#include <functional>
#include <utility>

#include "master/farm_state.h"
#include "master/tail.h"

namespace rayfarm {
namespace {

constexpr std::size_t most_open = 256;  // trials of a job: 49 kB each for each opinion

/// S. Vigna's SplitMix64: neighbouring numbers give unrelated ones.
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

TrialId trial_of(const Lease& lease) {
  return {{lease.job, lease.frame}, lease.work.tile, lease.work.passes};
}

void forget_asked(Trial& trial, WorkerId worker) {
  for (auto* asked : {&trial.asked, &trial.overdue})
    std::erase_if(*asked, [&](const Trial::Asked& a) { return a.worker == worker; });
}

/// The worker has said nothing about it yet, and is not about to.
bool is_unheard(const Worker& worker, const Trial& trial) {
  const std::uint64_t process = worker.info.process;
  const auto is_its = [&](const Opinion& o) {
    return o.identity == worker.identity || (process != 0 && o.process == process);
  };
  return std::ranges::none_of(trial.opinions, is_its) &&
         std::ranges::count(trial.asked, worker.id, &Trial::Asked::worker) == 0 &&
         std::ranges::count(trial.overdue, worker.id, &Trial::Asked::worker) == 0;
}

bool may_judge(const Worker& worker, const TrialId& id, const Trial& trial) {
  return may_work(worker) && !refuses(worker, id.frame.job) && is_unheard(worker, trial);
}

/// It is not believed.
void waste(Job& job, const Opinion& opinion) {
  job.time_wasted += opinion.taken;
  for (const PassImage& image : opinion.images) job.rays_wasted += image.counters.rays();
}

}  // namespace

std::uint32_t Farm::State::opinions_wanted_on(const Worker& worker, LeaseId id, const Lease& lease) const {
  if (worker.info.kind == WorkerKind::local) return 1;
  const auto known = known_workers.find(worker.identity);
  return opinions_wanted(jobs.at(lease.job).spec.verification,
                         known == known_workers.end() ? Trust{} : known->second.trust,
                         mixed(limits.secret ^ mixed(static_cast<std::uint64_t>(id))));
}

std::optional<TrialId> Farm::State::unheard_trial(const Worker& worker, const Lease& lease) const {
  const FrameId frame{lease.job, lease.frame};
  for (auto trial = trials.lower_bound({frame, lease.work.tile, 0});
       trial != trials.end() && trial->first.frame == frame && trial->first.tile == lease.work.tile; ++trial)
    if ((trial->first.passes & ~lease.work.passes) == 0 && is_unheard(worker, trial->second))
      return trial->first;
  return std::nullopt;
}

std::optional<TrialId> Farm::State::first_for(const Worker& worker, const TrialQueue& queue) const {
  if (!may_work(worker)) return std::nullopt;
  for (const auto& [place, ids] : queue) {
    if (jobs.at(place.second).state != JobState::running || refuses(worker, place.second)) continue;
    const auto id =
        std::ranges::find_if(ids, [&](const TrialId& i) { return is_unheard(worker, trials.at(i)); });
    if (id != ids.end()) return *id;
  }
  return std::nullopt;
}

std::optional<TrialId> Farm::State::asked_trial_for(const Worker& worker) const {
  if (worker.info.kind == WorkerKind::remote) return first_for(worker, asked_trials);
  // The master's own word is the last, however many are asked.
  std::optional<std::pair<Place, TrialId>> next;
  for (const auto& [id, trial] : trials) {
    const Job& job = jobs.at(id.frame.job);
    const std::pair found{place_of(job), id};
    if (job.state == JobState::running && may_judge(worker, id, trial) && (!next || found < *next))
      next = found;
  }
  return next ? std::optional(next->second) : std::nullopt;
}

bool Farm::State::waits_for_judges(Place job) const {
  const auto open = open_trials.find(job);
  return open != open_trials.end() && open->second.size() >= most_open;
}

std::string Farm::State::words_for_trials(const Job& job) const {
  const auto open = open_trials.find(place_of(job));
  if (job.state != JobState::running || open == open_trials.end()) return {};
  const auto has_no_judge = [&](const TrialId& id) {
    return std::ranges::none_of(workers,
                                [&](const auto& w) { return may_judge(w.second, id, trials.at(id)); });
  };
  if (std::ranges::none_of(open->second, has_no_judge)) return {};
  if (!waits_for_judges(open->first)) return "tiles wait for another worker to check them";
  return count_of_tiles(open->second.size()) +
         " wait for another worker to check them; until one comes, workers are given no more";
}

void Farm::State::give_trial(Worker& worker, const TrialId& id, FarmTime now) {
  Job& job = jobs.at(id.frame.job);
  const Work work{id.tile, id.passes};
  const LeaseId lease_id{++last_lease};
  trials.at(id).asked.push_back({worker.id, lease_id});
  update_trial(id);
  introduce(worker, job, frame_at(job, id.frame.frame));
  Lease lease{job.id, id.frame.frame, work, pixels_in(work, job.spec.settings) * job.spec.settings.spp, now};
  lease.is_check = true;
  assign(worker, lease_id, std::move(lease));
}

bool Farm::State::give_asked_trial(Worker& worker, FarmTime now) {
  if (worker.leases.size() >= worker.info.threads) return false;
  const std::optional<TrialId> trial = asked_trial_for(worker);
  if (trial) give_trial(worker, *trial, now);
  return trial.has_value();
}

void Farm::State::put_in(TrialQueue& queue, const TrialId& id, bool is_in) {
  const Place place = place_of(jobs.at(id.frame.job));
  if (is_in) {
    queue[place].insert(id);
  } else if (const auto of_job = queue.find(place); of_job != queue.end()) {
    of_job->second.erase(id);
    if (of_job->second.empty()) queue.erase(of_job);
  }
}

void Farm::State::update_trial(const TrialId& id) {
  const Trial& trial = trials.at(id);
  const bool is_open = wants_opinions(trial);
  put_in(open_trials, id, is_open);
  put_in(asked_trials, id, !is_open && bears_another_opinion(trial));
}

void Farm::State::withdraw(const Worker& worker, const Lease& lease) {
  const auto trial = trials.find(trial_of(lease));
  if (trial == trials.end()) return;
  forget_asked(trial->second, worker.id);
  update_trial(trial->first);
}

void Farm::State::note_overdue(FarmTime now) {
  bool is_any = false;
  for (auto& [id, trial] : trials) {
    const Job& job = jobs.at(id.frame.job);
    const double cost = expected_rays(job, *frame_of(job, id.frame.frame), {id.tile, id.passes});
    const auto is_late = [&](const Trial::Asked& asked) {
      const Worker& worker = workers.at(asked.worker);
      // All that it holds may be done before.
      const double expected =
          static_cast<double>(worker.leases.size()) * expected_seconds(cost, tracing_speed(worker, job.id));
      const std::chrono::duration<double> spent = now - worker.leases.at(asked.lease).given;
      return is_stuck({expected, spent.count()});
    };
    const auto late = std::stable_partition(trial.asked.begin(), trial.asked.end(), std::not_fn(is_late));
    if (late == trial.asked.end()) continue;
    trial.overdue.insert(trial.overdue.end(), late, trial.asked.end());
    trial.asked.erase(late, trial.asked.end());
    update_trial(id);
    is_any = true;
  }
  if (is_any) fill_all(now);
}

void Farm::State::hear(Worker& worker, const Lease& lease, std::uint32_t wanted, Result result,
                       FarmTime now) {
  const TrialId id = trial_of(lease);
  const auto [place, is_new] = trials.try_emplace(id);
  Trial& trial = place->second;
  if (is_new) trial.wanted = wanted;
  forget_asked(trial, worker.id);
  ++revision;
  const FarmTime taken = book(worker, lease, result, now);
  credit(worker, lease.samples / jobs.at(lease.job).spec.settings.spp);
  const bool is_final = worker.info.kind == WorkerKind::local;
  trial.opinions.push_back(
      {worker.name, worker.identity, worker.info.process, is_final, std::move(result.images), taken});
  if (const auto right = verdict(trial)) return settle_trial(id, *right, now);
  update_trial(id);
}

void Farm::State::end_trial(const TrialId& id, FarmTime now) {
  put_in(open_trials, id, false);
  put_in(asked_trials, id, false);
  const Trial trial = std::move(trials.extract(id).mapped());
  for (const Trial::Asked& asked : trial.asked) end_check(asked, now);
  for (const Trial::Asked& asked : trial.overdue) end_check(asked, now);
}

void Farm::State::end_check(const Trial::Asked& asked, FarmTime now) {
  Worker& worker = workers.at(asked.worker);
  const Lease lease = call_off(worker, asked.lease, now);
  waste(jobs.at(lease.job), worker, lease, now);
  worker.send(Revoke{{asked.lease}});
}

void Farm::State::settle_trial(const TrialId& id, std::size_t right, FarmTime now) {
  std::vector<Opinion> opinions = std::move(trials.at(id).opinions);
  end_trial(id, now);
  Job& job = jobs.at(id.frame.job);
  JobFrame& frame = frame_at(job, id.frame.frame);
  ++job.tiles_checked;
  touch(job);
  std::vector<const Opinion*> lies;
  for (const Opinion& opinion : opinions) {
    if (opinion.is_final) continue;
    if (agree(opinion, opinions[right])) {
      ++known_workers.at(opinion.identity).trust.good_in_a_row;
      record_known(opinion.identity);
    } else {
      const std::string& name = names[static_cast<std::size_t>(opinion.by)];
      warn("worker " + name + " delivered wrong pixels for tile " + std::to_string(id.tile) + " of " +
               title_of(job, frame) + ": " + names[static_cast<std::size_t>(opinions[right].by)] +
               " and others say otherwise",
           name);
      lies.push_back(&opinion);
      rayfarm::waste(job, opinion);
    }
  }
  for (const Opinion* lie : lies)
    disbelieve(lie->identity, lie->by, now);  // first: this commit may be the job's last
  Opinion& believed = opinions[right];
  accept(job, frame, {id.tile, id.passes}, std::move(believed.images), believed.by, believed.taken, now);
}

void Farm::State::disbelieve(const std::string& identity, NameId its_name, FarmTime now) {
  KnownWorker& liar = known_workers.at(identity);
  liar.trust.good_in_a_row = 0, ++liar.trust.mismatches;
  record_known(identity);
  const std::string& name = names[static_cast<std::size_t>(its_name)];
  if (const std::size_t tiles = lose_all_of(liar, now); tiles > 0)
    tell("to be rendered again, as worker " + name + " was wrong elsewhere: " + count_of_tiles(tiles) +
             " that it delivered for unfinished jobs",
         name);
  if (liar.trust.mismatches < most_mismatches) return;
  ban(names[static_cast<std::size_t>(liar.names.back())], now);
  warn("worker " + name + " was wrong " + std::to_string(most_mismatches) + " times and is banned", name);
}

void Farm::State::denounce(Worker& worker, const std::string& lie, FarmTime now) {
  worker.was_caught = true;
  warn("worker " + worker.info.name + " broke the rules: " + lie, worker.info.name);
  if (worker.info.kind == WorkerKind::remote) disbelieve(worker.identity, worker.name, now);
  throw WorkerError(lie);
}

void Farm::State::strike_opinions(const std::string& identity, FarmTime now) {
  std::vector<TrialId> all;
  for (const auto& [id, trial] : trials) all.push_back(id);
  for (const TrialId& id : all) {
    Trial& trial = trials.at(id);
    const auto own = std::ranges::find(trial.opinions, identity, &Opinion::identity);
    if (own == trial.opinions.end()) continue;
    Job& job = jobs.at(id.frame.job);
    rayfarm::waste(job, *own);
    touch(job);
    trial.opinions.erase(own);
    if (!trial.opinions.empty()) {
      update_trial(id);
      continue;
    }
    end_trial(id, now);
    wait_again(job, id.frame.frame, {id.tile, id.passes});
  }
}

std::size_t Farm::State::lose_all_of(const KnownWorker& worker, FarmTime now) {
  lose_pieces_of(worker);
  std::size_t tiles = 0;
  for (auto& [id, job] : jobs) {
    if (has_ended(job)) continue;
    for (JobFrame& frame : job.frames)
      for (const NameId name : worker.names) {
        if (!frame.canvas) continue;
        const PassesLost lost = delivered_by(id, frame, name);
        if (lost.lost.empty()) continue;
        tiles += lost.lost.size();
        lose_passes(job, frame, lost);
        job.pace.restart(now, job.pixels_done);
        update_queue(job);
      }
  }
  return tiles;
}

void Farm::State::drop_trials(FrameId frame, FarmTime now) {
  for (auto trial = trials.lower_bound({frame, 0, 0}); trial != trials.end() && trial->first.frame == frame;
       trial = trials.lower_bound({frame, 0, 0}))
    end_trial(trial->first, now);
}

}  // namespace rayfarm
