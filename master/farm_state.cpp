#include "master/farm_state.h"

#include <algorithm>
#include <utility>

#include "common/render/settings.h"

namespace rayfarm {

Job* Farm::State::living_job(JobId id) {
  const auto job = jobs.find(id);
  return job == jobs.end() || has_ended(job->second) ? nullptr : &job->second;
}

const JobFrame* Farm::State::frame(JobId id, std::optional<std::uint32_t> number) const {
  const auto job = jobs.find(id);
  return job == jobs.end() ? nullptr : frame_of(job->second, number);
}

Worker* Farm::State::worker_named(std::string_view name) {
  const auto found = std::ranges::find_if(workers, [&](const auto& w) { return w.second.info.name == name; });
  return found == workers.end() ? nullptr : &found->second;
}

const Worker* Farm::State::worker_named(std::string_view name) const {
  const auto found = std::ranges::find_if(workers, [&](const auto& w) { return w.second.info.name == name; });
  return found == workers.end() ? nullptr : &found->second;
}

std::string Farm::State::unique_name(const std::string& wanted) const {
  std::set<std::string_view> taken;
  for (const auto& [id, worker] : workers) taken.insert(worker.info.name);
  const std::string base = wanted.empty() ? "worker" : wanted;
  std::string name = base;
  for (int n = 2; taken.contains(name); ++n) name = base + "-" + std::to_string(n);
  return name;
}

NameId Farm::State::id_of_name(const std::string& name) {
  if (const auto known = name_ids.find(name); known != name_ids.end()) return known->second;
  const NameId id{static_cast<std::uint32_t>(names.size())};
  names.push_back(name);
  name_ids[name] = id;
  record(WorkerNamed{name});
  return id;
}

void Farm::State::take_in_data(JobFrame& frame) {
  std::uint64_t added = 0;
  for_each_data(frame, [&](const std::string& hash, SharedBytes& bytes) {
    const auto known = shared.find(hash);
    if (known != shared.end()) bytes = known->second.bytes.lock();
    if (known == shared.end() || known->second.unfinished == 0) added += bytes->size();
  });
  const std::uint64_t after = unfinished_bytes + added;
  if (added > 0 && after > limits.scene_bytes)
    throw FarmFull("the scenes of unfinished jobs would take " + std::to_string(after) + " bytes, of " +
                   std::to_string(limits.scene_bytes) + ": wait for some to end, or cancel them");
  unfinished_bytes = after;
  for_each_data(frame, [&](const std::string& hash, const SharedBytes& bytes) {
    shared[hash].bytes = bytes;
    ++shared[hash].unfinished;
  });
}

void Farm::State::release_unfinished(JobFrame& frame) {
  for_each_data(frame, [&](const std::string& hash, const SharedBytes& bytes) {
    const auto data = shared.find(hash);
    if (--data->second.unfinished > 0) return;
    unfinished_bytes -= bytes->size();
    if (data->second.kept == 0) shared.erase(data);
  });
}

void Farm::State::add_frame(Job& job, JobFrame frame) {
  take_in_data(frame);
  const auto place = static_cast<std::uint32_t>(job.frames.size());
  frame.number = job.spec.frames->at(place);
  if (place == 0) record(JobAdded{job.id, job.spec, job.submitted});
  record(FrameAdded{{job.id, frame.number}, frame.scene_hash, frame.scene_bytes, frame.assets});
  job.frames.push_back(std::move(frame));
  job.open.insert(place);
}

void Farm::State::end(Job& job, JobFrame& frame, FarmTime now) {
  frame.ended = now;
  drop_trials({job.id, frame.number}, now);
  drop_splits({job.id, frame.number}, now);
  for (auto& [id, worker] : workers) forget(worker, {job.id, frame.number});
  const bool is_done = is_complete(job, frame);
  if (is_done)
    for_each_data(frame, [&](const std::string& hash, const SharedBytes& bytes) {
      if (shared.at(hash).kept++ == 0) bytes_kept += bytes->size();
    });
  release_unfinished(frame);
  if (!is_done) {
    drop_data(frame);
    record(SceneDropped{{job.id, frame.number}});
  }
  if (!frame.canvas) return;
  bytes_kept += film_bytes(frame);
  ended_frames.push_back({job.id, frame.number});
}

void Farm::State::drop_unneeded_assets() {
  if (std::ranges::all_of(workers, [](const auto& worker) { return worker.second.assets.empty(); })) return;
  std::set<std::string> needed;
  for (const auto& [id, job] : jobs)
    if (!has_ended(job))
      for (const JobFrame& frame : job.frames)
        for (const AssetData& asset : frame.assets) needed.insert(asset.hash);
  for (auto& [id, worker] : workers) forget_assets(worker, needed);
}

void Farm::State::unkeep(JobFrame& frame) {
  bytes_kept -= film_bytes(frame);
  for_each_data(frame, [&](const std::string& hash, const SharedBytes& bytes) {
    const auto data = shared.find(hash);
    if (--data->second.kept > 0) return;
    bytes_kept -= bytes->size();
    if (data->second.unfinished == 0) shared.erase(data);
  });
}

void Farm::State::drop_picture(Job& job, JobFrame& frame) {
  unkeep(frame);
  frame.canvas.reset();
  drop_data(frame);
  ++job.frames_dropped;
  ++revision;
  record(PictureDropped{
      {job.id, frame.number}, frame.pixels_done, frame.counters, frame.thread_time, frame.ended});
}

void Farm::State::drop_job(JobId id) {
  Job& job = jobs.at(id);
  for (JobFrame& frame : job.frames)
    if (frame.canvas) drop_picture(job, frame);
  std::erase_if(ended_frames, [id](FrameId frame) { return frame.job == id; });
  job_by_key.erase(job.spec.key);
  record(JobDropped{id});
  jobs.erase(id);
  ++revision;
}

void Farm::State::drop_old_jobs(FarmTime now) {
  const auto is_old = [&](JobId id) { return now - *jobs.at(id).ended >= limits.job_age; };
  while (ended_jobs.size() > limits.jobs || (!ended_jobs.empty() && is_old(ended_jobs.front()))) {
    drop_job(ended_jobs.front());
    ended_jobs.pop_front();
  }
}

void Farm::State::drop_old_films() {
  for (; bytes_kept > limits.film_bytes && ended_frames.size() > 1; ended_frames.pop_front()) {
    const auto [id, number] = ended_frames.front();
    const auto job = jobs.find(id);
    if (job == jobs.end()) continue;
    JobFrame& frame = frame_at(job->second, number);
    if (!frame.canvas) continue;
    drop_picture(job->second, frame);
    job_by_key.erase(std::exchange(job->second.spec.key, {}));
    touch(job->second);
  }
}

}  // namespace rayfarm
