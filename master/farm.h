// The farm: jobs, workers, leases. It decides who renders what, without I/O: no socket, no clock, no file.
// Time is passed in; messages leave through the function that a worker was added with; what an admin should know
// comes out of take_events(). All calls are made from one thread.
//
// Invariants: each (job, tile, pass) is waiting, leased to exactly one worker, or done; it is committed exactly once.
// A pass that comes again is compared with what was committed, never written.
#pragma once
#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/net/messages.h"
#include "common/render/film.h"

namespace rayfarm {

/// The farm's time: since any fixed instant, never going back.
using FarmTime = std::chrono::nanoseconds;

enum class WorkerId : std::uint64_t {};

enum class WorkerKind : std::uint8_t {
  local,   // the master's own threads: one pass of a tile at a time, coarse passes first
  remote,  // whole tiles at stride 1, just the passes not there yet
};
struct WorkerInfo {
  std::string name, address, cpu, version;
  std::uint32_t threads = 1;
  WorkerKind kind = WorkerKind::remote;
};

enum class JobState : std::uint8_t { waiting, running, paused, done, cancelled, failed };
std::string_view name_of(JobState state);

struct JobSpec {
  std::string name;
  std::string output;          // fetch's default file, on the submitter's PC
  std::string scene_hash;
  SharedBytes scene_bytes;     // encode_scene()
  RenderSettings settings;
  int priority = 50;           // 0..99, higher first; equals in order of submission
  bool hold = false;           // starts paused
  std::string key;             // submit --id: the same key gives the same job again; empty: none
};

/// A job as people see it.
struct JobView {
  JobId id{};
  std::string name, output, scene_hash, message;   // message: why it failed
  JobState state = JobState::waiting;
  int priority = 0;
  RenderSettings settings;
  std::uint64_t pixels_done = 0, pixels_total = 0;
  RayCounters counters;                   // of committed passes
  FarmTime submitted{}, elapsed{};        // elapsed: wall time since the first assignment, until it ended
  std::optional<FarmTime> eta;            // remaining; none before there is something to learn from
  std::uint64_t tiles_given_back = 0;     // leases that ended without a result
};

enum class WorkerState : std::uint8_t { idle, busy, draining, drained };
std::string_view name_of(WorkerState state);

struct WorkerView {
  WorkerId id{};
  WorkerInfo info;
  WorkerState state = WorkerState::idle;
  std::uint32_t leases = 0;               // held now
  std::uint64_t tiles = 0, pixels = 0;    // delivered
  double samples_per_second = 0;          // learned, all its threads; 0: not known yet
  FarmTime joined{};
};

/// One line for the log. Warnings are what an admin should look at.
struct FarmEvent {
  bool warning = false;
  std::string text;
};

class Farm {
 public:
  using Send = std::function<void(ToWorker)>;

  Farm();
  ~Farm();

  WorkerId add_worker(WorkerInfo info, Send send, FarmTime now);     // the name is made unique
  void remove_worker(WorkerId worker, std::string reason, FarmTime now);
  void receive(WorkerId worker, Result result, FarmTime now);
  void receive(WorkerId worker, GiveBack given, FarmTime now);

  JobId submit(JobSpec spec, FarmTime now);
  // These answer false when there is no such job, or it has ended.
  bool pause(JobId job, FarmTime now);
  bool resume(JobId job, FarmTime now);
  bool cancel(JobId job, FarmTime now);
  bool set_priority(JobId job, int priority, FarmTime now);
  // Draining revokes what the worker holds at once and gives it nothing more. False: no such worker.
  bool drain(std::string_view name, FarmTime now);
  bool undrain(std::string_view name, FarmTime now);

  std::vector<JobView> jobs(FarmTime now) const;                     // in order of submission
  std::optional<JobView> job(JobId id, FarmTime now) const;
  std::vector<WorkerView> workers() const;
  std::string name_of_worker(WorkerId id) const;
  /// The film of a job; null when there is no such job. Grows while the job runs.
  std::shared_ptr<const Film> film(JobId id) const;
  /// Grows with every change of a job: to wait for news.
  std::uint64_t revision() const;

  std::vector<FarmEvent> take_events();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rayfarm
