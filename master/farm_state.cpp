#include "master/farm_state.h"

#include <algorithm>

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

}  // namespace rayfarm
