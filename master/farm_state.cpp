#include "master/farm_state.h"

#include <algorithm>
#include <utility>

namespace rayfarm {

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
  const auto [known, is_new] = name_ids.try_emplace(name, NameId{static_cast<std::uint32_t>(names.size())});
  if (is_new) names.push_back(name);
  return known->second;
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
  for (auto id = ended_jobs.rbegin(); id != ended_jobs.rend(); ++id) {
    Job& job = jobs.at(*id);
    if (!job.canvas) continue;
    const bool is_newest = kept == 0;
    kept += film_bytes(job);
    if (is_newest || kept <= limits.film_bytes) continue;
    job.canvas.reset();
    job_by_key.erase(std::exchange(job.spec.key, {}));
    job.message += (job.message.empty() ? "" : "; ") + std::string("its picture is no longer kept");
    ++revision;
  }
}

}  // namespace rayfarm
