// Pixels that are believed only when several workers agree on them, and what befalls those who do not.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

constexpr auto no_judge_words = "tiles wait for another worker to check them";

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

/// The worker has said nothing about it yet, and is not about to.
bool is_unheard(const Worker& worker, const Trial& trial) {
  const std::uint64_t process = worker.info.process;
  const auto is_its = [&](const Opinion& o) {
    return o.identity == worker.identity || (process != 0 && o.process == process);
  };
  return std::ranges::none_of(trial.opinions, is_its) && std::ranges::count(trial.asked, worker.id) == 0;
}

bool may_judge(const Worker& worker, const TrialId& id, const Trial& trial) {
  return may_work(worker) && !refuses(worker, id.frame.job) && is_unheard(worker, trial);
}

}  // namespace

std::uint32_t Farm::State::opinions_wanted_on(const Worker& worker, LeaseId id, const Lease& lease) const {
  if (worker.info.kind == WorkerKind::local) return 1;
  const auto known = known_workers.find(worker.identity);
  return opinions_wanted(jobs.at(lease.job).spec.verification,
                         known == known_workers.end() ? Trust{} : known->second.trust,
                         mixed(limits.secret ^ mixed(static_cast<std::uint64_t>(id))));
}

bool Farm::State::may_judge_now(const Worker& worker, const TrialId& id) const {
  return jobs.at(id.frame.job).state == JobState::running && may_judge(worker, id, trials.at(id));
}

std::optional<TrialId> Farm::State::unheard_trial(const Worker& worker, const Lease& lease) const {
  const FrameId frame{lease.job, lease.frame};
  for (auto trial = trials.lower_bound({frame, lease.work.tile, 0});
       trial != trials.end() && trial->first.frame == frame && trial->first.tile == lease.work.tile; ++trial)
    if ((trial->first.passes & ~lease.work.passes) == 0 && is_unheard(worker, trial->second))
      return trial->first;
  return std::nullopt;
}

int Farm::State::priority_of(const TrialId& id) const { return jobs.at(id.frame.job).spec.priority; }

std::optional<TrialId> Farm::State::next_trial_for(const Worker& worker) const {
  std::optional<TrialId> next;
  for (const TrialId& id : open_trials)
    if ((!next || priority_of(id) > priority_of(*next)) && may_judge_now(worker, id)) next = id;
  return next;
}

std::optional<TrialId> Farm::State::asked_trial_for(const Worker& worker) const {
  const bool is_final = worker.info.kind == WorkerKind::local;
  std::optional<TrialId> next;
  for (const auto& [id, trial] : trials)
    if ((is_final || bears_another_opinion(trial)) && (!next || priority_of(id) > priority_of(*next)) &&
        may_judge_now(worker, id))
      next = id;
  return next;
}

void Farm::State::give_trial(Worker& worker, const TrialId& id, FarmTime now) {
  Job& job = jobs.at(id.frame.job);
  const Work work{id.tile, id.passes};
  trials.at(id).asked.push_back(worker.id);
  update_trial(id);
  introduce(worker, job, frame_at(job, id.frame.frame));
  Lease lease{job.id, id.frame.frame, work, pixels_in(work, job.spec.settings) * job.spec.settings.spp, now};
  lease.is_check = true;
  assign(worker, LeaseId{++last_lease}, std::move(lease));
}

bool Farm::State::give_asked_trial(Worker& worker, FarmTime now) {
  if (worker.leases.size() >= worker.info.threads) return false;
  const std::optional<TrialId> trial = asked_trial_for(worker);
  if (trial) give_trial(worker, *trial, now);
  return trial.has_value();
}

void Farm::State::update_trial(const TrialId& id) {
  if (wants_opinions(trials.at(id)))
    open_trials.insert(id);
  else
    open_trials.erase(id);
}

void Farm::State::withdraw(const Worker& worker, const Lease& lease) {
  const auto trial = trials.find(trial_of(lease));
  if (trial == trials.end()) return;
  std::erase(trial->second.asked, worker.id);
  update_trial(trial->first);
}

void Farm::State::hear(Worker& worker, const Lease& lease, std::uint32_t wanted, Result result,
                       FarmTime now) {
  const TrialId id = trial_of(lease);
  const auto [place, is_new] = trials.try_emplace(id);
  Trial& trial = place->second;
  if (is_new) trial.wanted = wanted;
  std::erase(trial.asked, worker.id);
  const FarmTime taken = book(worker, lease, result, now);
  const bool is_final = worker.info.kind == WorkerKind::local;
  trial.opinions.push_back(
      {worker.name, worker.identity, worker.info.process, is_final, std::move(result.images), taken});
  if (const auto right = verdict(trial)) return settle_trial(id, *right, now);
  update_trial(id);
  const auto can_judge = [&](const auto& w) { return may_judge(w.second, id, trial); };
  Job& job = jobs.at(lease.job);
  if (!trial.asked.empty() || std::ranges::any_of(workers, can_judge) || !job.message.empty()) return;
  job.message = no_judge_words;
  touch(job);
}

void Farm::State::end_trial(const TrialId& id, FarmTime now) {
  const Trial trial = std::move(trials.extract(id).mapped());
  open_trials.erase(id);
  for (const WorkerId asked : trial.asked) {
    Worker& worker = workers.at(asked);
    const auto lease = std::ranges::find_if(
        worker.leases, [&](const auto& held) { return held.second.is_check && trial_of(held.second) == id; });
    const LeaseId revoked = lease->first;
    call_off(worker, revoked, now);
    worker.send(Revoke{{revoked}});
  }
}

void Farm::State::settle_trial(const TrialId& id, std::size_t right, FarmTime now) {
  std::vector<Opinion> opinions = std::move(trials.at(id).opinions);
  end_trial(id, now);
  Job& job = jobs.at(id.frame.job);
  JobFrame& frame = frame_at(job, id.frame.frame);
  if (job.message == no_judge_words) job.message.clear();
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
    tell(count_of_tiles(tiles) + " that worker " + name +
             " delivered for unfinished jobs are rendered again, as it was wrong elsewhere",
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
    if (std::erase_if(trial.opinions, [&](const Opinion& o) { return o.identity == identity; }) == 0)
      continue;
    if (!trial.opinions.empty()) {
      update_trial(id);
      continue;
    }
    end_trial(id, now);
    wait_again(jobs.at(id.frame.job), id.frame.frame, {id.tile, id.passes});
  }
}

std::size_t Farm::State::lose_all_of(const KnownWorker& worker, FarmTime now) {
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
        touch(job);
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
