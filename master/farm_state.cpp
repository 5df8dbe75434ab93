#include "master/farm_state.h"

#include <algorithm>
#include <utility>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

constexpr std::size_t most_names = 10'000;  // a worker may come under a new one each time

}  // namespace

Job* Farm::State::living_job(JobId id) {
  const auto job = jobs.find(id);
  return job == jobs.end() || has_ended(job->second) ? nullptr : &job->second;
}

Worker* Farm::State::worker_named(std::string_view name) {
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
  if (names.size() > most_names) return NameId{};
  const NameId id{static_cast<std::uint32_t>(names.size())};
  names.push_back(name);
  name_ids[name] = id;
  return id;
}

void Farm::State::take_in_scene(JobSpec& spec) {
  if (jobs.size() - ended_jobs.size() >= limits.unfinished_jobs)
    throw SettingsError("the farm holds " + std::to_string(limits.unfinished_jobs) +
                        " unfinished jobs, and takes no more: wait for some to end, or cancel them");
  std::erase_if(scenes, [](const auto& scene) { return scene.second.bytes.expired(); });
  const auto known = scenes.find(spec.scene_hash);
  if (known != scenes.end()) spec.scene_bytes = known->second.bytes.lock();

  std::uint64_t bytes = spec.scene_bytes->size();
  for (const auto& [hash, scene] : scenes)
    if (scene.unfinished_jobs > 0 && hash != spec.scene_hash) bytes += scene.bytes.lock()->size();
  const bool is_new = known == scenes.end() || known->second.unfinished_jobs == 0;
  if (is_new && bytes > limits.scene_bytes)
    throw SettingsError("the scenes of unfinished jobs would take " + std::to_string(bytes) + " bytes, of " +
                        std::to_string(limits.scene_bytes) + ": wait for some to end, or cancel them");
  SharedScene& scene = scenes[spec.scene_hash];
  scene.bytes = spec.scene_bytes;
  ++scene.unfinished_jobs;
}

void Farm::State::drop_old_jobs() {
  for (; ended_jobs.size() > limits.jobs; ended_jobs.pop_front()) {
    const auto oldest = jobs.find(ended_jobs.front());
    job_by_key.erase(oldest->second.spec.key);
    jobs.erase(oldest);
  }
}

void Farm::State::drop_old_films() {
  std::uint64_t kept = 0;
  std::set<std::string_view> scenes_kept;  // hashes
  for (auto id = ended_jobs.rbegin(); id != ended_jobs.rend(); ++id) {
    Job& job = jobs.at(*id);
    if (!job.canvas) continue;
    const bool is_newest = kept == 0;
    kept += film_bytes(job);
    if (job.spec.scene_bytes && scenes_kept.insert(job.spec.scene_hash).second)
      kept += job.spec.scene_bytes->size();
    if (is_newest || kept <= limits.film_bytes) continue;
    job.canvas.reset();
    job.spec.scene_bytes.reset();
    job_by_key.erase(std::exchange(job.spec.key, {}));
    job.message += (job.message.empty() ? "" : "; ") + std::string("its picture is no longer kept");
    ++revision;
  }
}

}  // namespace rayfarm
