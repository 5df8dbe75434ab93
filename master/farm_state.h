// What a farm is made of, and the steps that its calls share. Only farm's own files include this.
#pragma once
#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "master/farm.h"
#include "master/job.h"
#include "master/worker.h"

namespace rayfarm {

struct Farm::State {
  FarmLimits limits;
  std::map<JobId, Job> jobs;
  std::deque<JobId> ended_jobs;  // all of them, in the order of their ends
  std::map<std::string, JobId> job_by_key;
  /// One that jobs share.
  struct SharedScene {
    SharedBytes::weak_type bytes;
    std::size_t unfinished_jobs = 0;
  };
  std::map<std::string, SharedScene> scenes;  // by hash
  std::map<WorkerId, Worker> workers;
  std::set<std::string, std::less<>> drained_names, banned_names;
  // By NameId: of all workers that there were, as films outlive them; the first stands for those too many.
  std::vector<std::string> names{"(one of many)"};
  std::map<std::string, NameId> name_ids;
  // Exactly the jobs that want workers, the next to be served first.
  std::set<std::pair<int, JobId>> queue;  // minus priority, id
  std::uint64_t last_job = 0, last_worker = 0, last_lease = 0;
  std::uint64_t revision = 0;
  std::vector<FarmEvent> events;

  void tell(std::string text, std::string worker = "") {
    events.push_back({false, std::move(text), std::move(worker)});
  }
  void warn(std::string text, std::string worker = "") {
    events.push_back({true, std::move(text), std::move(worker)});
  }

  Job* living_job(JobId id);
  Worker* worker_named(std::string_view name);
  std::string unique_name(const std::string& wanted) const;
  NameId id_of_name(const std::string& name);

  /// Makes the job share its scene with others of the same hash; throws SettingsError when the farm is full.
  void take_in_scene(JobSpec& spec);

  // Giving work out.
  Job* next_job_for(const Worker& worker);
  /// False when the worker has enough or there is nothing for it; else ask again.
  bool give_one(Worker& worker, FarmTime now);
  void fill(Worker& worker, FarmTime now);
  void fill_all(FarmTime now);
  bool start(Job& job, FarmTime now);

  // Taking it back; none of them gives it out again.
  void end_lease(Worker& worker, LeaseId id);
  /// Ends all leases of a worker, returning their ids.
  std::vector<LeaseId> end_leases(Worker& worker);
  void revoke(Worker& worker, JobId job);
  void revoke_everywhere(JobId job);

  // Results.
  void deliver(Worker& worker, const Lease& lease, const Result& result, FarmTime now);
  void compare_late(Worker& worker, const Result& result);
  void refuse(Worker& worker, Job& job, const std::string& reason, FarmTime now);

  /// After a change of the job's state, priority or waiting work.
  void update_queue(const Job& job);
  /// Other jobs that ended may be dropped.
  void end(Job& job, JobState state, FarmTime now);
  void drop_old_jobs();
  void drop_old_films();
};

}  // namespace rayfarm
