#include "master/farm.h"

#include <utility>

#include "common/render/settings.h"
#include "master/farm_state.h"

namespace rayfarm {
namespace {

/// The job that has the key of this submission already. Throws KeyTaken if it is not what is wanted.
JobId same_job(const Job& job, const JobSpec& wanted) {
  if (job.frames.front().scene_hash != wanted.scene_hash || job.spec.settings != wanted.settings ||
      job.spec.frames != wanted.frames || job.spec.verification != wanted.verification)
    throw KeyTaken("the key " + wanted.key + " belongs to " + title_of(job) +
                   ", which has another scene, other settings or another verification; choose another key");
  return job.id;
}

}  // namespace

Farm::Farm(FarmLimits limits) : state_(std::make_unique<State>()) { state_->limits = limits; }
Farm::Farm(Farm&&) noexcept = default;
Farm& Farm::operator=(Farm&&) noexcept = default;
Farm::~Farm() = default;

// Workers. ----------------------------------------------------------------------------------

WorkerId Farm::add_worker(WorkerInfo info, Send send, FarmTime now) {
  const WorkerId id{++state_->last_worker};
  std::string identity = identity_of(info.name, info.certificate);
  std::map<LeaseId, Lease> had = state_->end_former_connection(identity, info.process, now);
  info.name = state_->unique_name(info.name);
  state_->exonerate(info.process);
  std::string joined = "worker " + info.name + " joined";
  if (!info.address.empty()) joined += " from " + info.address;
  joined += " with " + std::to_string(info.threads) + (info.threads == 1 ? " thread" : " threads");
  if (!info.cpu.empty()) joined += ", " + info.cpu;

  Worker& worker = state_->workers[id];
  worker.id = id;
  worker.name = state_->id_of_name(info.name);
  worker.is_drained = state_->drained_names.contains(info.name);
  worker.info = std::move(info);
  worker.identity = std::move(identity);
  worker.called_off = std::move(had);
  state_->meet(worker);
  worker.send = std::move(send);
  worker.joined = now;
  state_->tell(worker.is_drained ? joined + "; it is drained" : joined, worker.info.name);
  worker.send(Welcome{worker.info.name});
  ++state_->revision;         // who waits for a judge may have one
  state_->fill(worker, now);  // before the others: it may have at hand what was taken from its old connection
  state_->fill_all(now);
  return id;
}

void Farm::remove_worker(WorkerId id, std::string reason, FarmTime now, FarmTime silence) {
  Worker* const here = state_->worker_here(id);
  if (!here) return;
  Worker& worker = *here;
  auto oldest = worker.leases.empty() ? std::nullopt : std::optional(worker.leases.begin()->second);
  const std::size_t given_back = state_->end_leases(worker, now).size();
  const std::string what =
      ": " + reason + (given_back == 0 ? "" : "; " + count_of_tiles(given_back) + " given back");
  if (worker.is_stopping)
    state_->tell("worker " + worker.info.name + " left" + what, worker.info.name);
  else
    state_->warn("worker " + worker.info.name + " lost" + what, worker.info.name);
  const bool did_it_hear = oldest && oldest->given <= now - silence;
  if (worker.is_stopping || worker.was_caught || !did_it_hear) oldest.reset();
  const std::string identity = worker.identity;
  const Canvas::Victim lost{worker.name, worker.info.process, now, silence > FarmTime{}};
  state_->workers.erase(id);
  ++state_->revision;  // the last judge may be gone
  if (oldest) state_->blame(*oldest, identity, lost, now);
  state_->fill_all(now);
}

bool Farm::drain(std::string_view name, FarmTime now) {
  Worker* worker = state_->worker_named(name);
  if (worker == nullptr) return false;
  if (worker->is_drained) return true;
  worker->is_drained = true;
  state_->drained_names.insert(worker->info.name);
  state_->record(WorkerDrained{worker->info.name, true});
  std::vector<LeaseId> leases = state_->end_leases(*worker, now);
  state_->tell("worker " + worker->info.name + " drained; " + count_of_tiles(leases.size()) + " given back",
               worker->info.name);
  if (!leases.empty()) worker->send(Revoke{std::move(leases)});
  state_->fill_all(now);
  return true;
}

bool Farm::undrain(std::string_view name, FarmTime now) {
  Worker* worker = state_->worker_named(name);
  const auto drained = state_->drained_names.find(name);
  if (drained == state_->drained_names.end()) return worker != nullptr;
  state_->tell("worker " + *drained + " no longer drained", *drained);
  state_->record(WorkerDrained{*drained, false});
  state_->drained_names.erase(drained);
  if (worker == nullptr) return true;
  worker->is_drained = false;
  state_->fill(*worker, now);
  return true;
}

namespace {

JobFrame frame_with(std::string scene_hash, SharedBytes scene, std::vector<AssetData> assets) {
  JobFrame frame;
  frame.scene_hash = std::move(scene_hash), frame.scene_bytes = std::move(scene);
  frame.assets = std::move(assets);
  return frame;
}

}  // namespace

// Jobs. ----------------------------------------------------------------------------------

JobId Farm::submit(JobSpec spec, FarmTime now) {
  if (!spec.frames) spec.frames = FrameRange{spec.settings.frame, spec.settings.frame, 1};
  spec.settings.frame = spec.frames->first;
  check(spec.settings);
  if (const auto known = state_->job_by_key.find(spec.key);
      !spec.key.empty() && known != state_->job_by_key.end())
    return same_job(state_->jobs.at(known->second), spec);
  if (state_->jobs.size() - state_->ended_jobs.size() >= state_->limits.unfinished_jobs)
    throw FarmFull("the farm holds " + std::to_string(state_->limits.unfinished_jobs) +
                   " unfinished jobs, and takes no more: wait for some to end, or cancel them");

  Job job;
  job.id = JobId{state_->last_job + 1};
  job.spec = std::move(spec);
  job.state = job.spec.hold ? JobState::paused : JobState::waiting;
  job.submitted = now;
  state_->add_frame(job, frame_with(std::move(job.spec.scene_hash), std::move(job.spec.scene_bytes),
                                    std::move(job.spec.assets)));
  ++state_->last_job;
  if (!job.spec.key.empty()) state_->job_by_key[job.spec.key] = job.id;
  ++state_->revision;
  const RenderSettings& settings = job.spec.settings;
  const std::uint32_t frames = job.spec.frames->count();
  state_->tell(title_of(job) + " submitted: " + (frames == 1 ? "" : std::to_string(frames) + " frames, ") +
               std::to_string(settings.width) + "x" + std::to_string(settings.height) + ", " +
               std::to_string(settings.spp) + " spp, priority " + std::to_string(job.spec.priority) +
               (job.spec.hold ? ", on hold" : ""));
  const JobId id = job.id;
  state_->changed_jobs.insert(id);
  state_->update_queue(state_->jobs[id] = std::move(job));
  state_->fill_all(now);
  return id;
}

bool Farm::add_frame(FrameId id, std::string scene_hash, SharedBytes scene, FarmTime now,
                     std::vector<AssetData> assets) {
  const auto found = state_->jobs.find(id.job);
  if (found == state_->jobs.end()) return false;
  Job& job = found->second;
  if (const JobFrame* known = frame_of(job, id.frame)) {
    if (known->scene_hash == scene_hash) return true;
    throw KeyTaken(title_of(job, *known) + " has another scene already");
  }
  if (has_ended(job)) return false;
  const FrameRange& range = *job.spec.frames;
  const auto next = static_cast<std::uint32_t>(job.frames.size());
  if (range.index_of(id.frame) != next)
    throw SettingsError(next == range.count()
                            ? "all " + std::to_string(next) + " frames of " + title_of(job) + " have come"
                            : "the next frame of " + title_of(job) + " is " + std::to_string(range.at(next)) +
                                  ", not " + std::to_string(id.frame));
  state_->add_frame(job, frame_with(std::move(scene_hash), std::move(scene), std::move(assets)));
  ++state_->revision;
  state_->update_queue(job);
  state_->fill_all(now);
  return true;
}

bool Farm::pause(JobId id, FarmTime now, std::string why) {
  Job* job = state_->living_job(id);
  if (job == nullptr) return false;
  if (job->state == JobState::paused) return true;
  state_->revoke_everywhere(id, now);
  state_->pause(*job, std::move(why));
  state_->fill_all(now);
  return true;
}

bool Farm::resume(JobId id, FarmTime now) {
  Job* job = state_->living_job(id);
  if (job == nullptr) return false;
  if (job->state != JobState::paused) return true;
  job->state = job->started ? JobState::running : JobState::waiting;
  if (job->started) job->pace.restart(now, job->pixels_done);
  job->message.clear();
  state_->touch(*job);
  state_->tell(title_of(*job) + " resumed");
  state_->update_queue(*job);
  state_->fill_all(now);
  return true;
}

bool Farm::cancel(JobId id, FarmTime now) {
  Job* job = state_->living_job(id);
  if (job == nullptr) return false;
  state_->tell(title_of(*job) + " cancelled");
  state_->revoke_everywhere(id, now);
  state_->end(*job, JobState::cancelled, now);
  state_->fill_all(now);
  return true;
}

bool Farm::fail(JobId id, std::string why, FarmTime now) {
  Job* job = state_->living_job(id);
  if (job == nullptr) return false;
  state_->fail(*job, std::move(why), now);
  state_->fill_all(now);
  return true;
}

bool Farm::set_priority(JobId id, int priority, FarmTime) {
  Job* job = state_->living_job(id);
  if (job == nullptr) return false;
  const State::Place before = State::place_of(*job);
  state_->queue.erase(before);
  job->spec.priority = priority;
  for (State::TrialQueue* queue : {&state_->open_trials, &state_->asked_trials})
    if (auto trials = queue->extract(before)) {
      trials.key() = State::place_of(*job);
      queue->insert(std::move(trials));
    }
  state_->touch(*job);
  state_->update_queue(*job);
  return true;
}

bool Farm::remove(JobId id) {
  const auto found = state_->jobs.find(id);
  if (found == state_->jobs.end() || !has_ended(found->second)) return false;
  state_->tell(title_of(found->second) + " removed");
  std::erase(state_->ended_jobs, id);
  state_->drop_job(id);
  return true;
}

std::vector<FarmEvent> Farm::take_events() { return std::exchange(state_->events, {}); }

std::vector<FarmRecord> Farm::take_records() {
  for (const JobId id : std::exchange(state_->changed_jobs, {}))
    if (const auto found = state_->jobs.find(id); found != state_->jobs.end()) {
      const Job& job = found->second;
      state_->record(JobChanged{id, job.state, job.spec.priority, job.message, job.spec.key,
                                job.tiles_given_back, job.ended, job.tiles_doubled, job.tiles_checked,
                                job.time_wasted, job.tiles_shared, job.rays_wasted});
    }
  return std::exchange(state_->records, {});
}

}  // namespace rayfarm
