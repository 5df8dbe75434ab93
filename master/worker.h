// A worker as the farm sees it: what it can, what it knows, what it holds.
#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "master/farm.h"
#include "master/job.h"
#include "master/pace.h"
#include "master/schedule.h"

namespace rayfarm {

/// A tile that several share.
enum class SplitId : std::uint64_t {};

/// Work that one worker was asked to do; good for one result.
struct Lease {
  JobId job{};
  std::uint32_t frame = 0;
  Work work;
  std::uint64_t samples = 0;
  FarmTime given{};
  std::optional<FarmTime> begun{};  // as far as can be known from outside: it has had a thread since then
  /// Who does the same work; the first result ends both.
  struct Twin {
    WorkerId worker{};
    LeaseId lease{};
  };
  std::optional<Twin> twin{};
  /// A piece of a tile that is shared.
  struct Piece {
    SplitId split{};
    std::size_t place = 0;
    Tile area{};
  };
  std::optional<Piece> piece{};    // none: the whole tile
  std::optional<SplitId> split{};  // which others render in pieces meanwhile
  bool is_check = false;           // an opinion on a trial is asked for
  bool is_reattached = false;      // the work was begun before the lease: its age tells nothing of the speed
};

struct Worker {
  WorkerId id{};
  WorkerInfo info;
  std::string identity;  // who it is, under whatever name
  NameId name{};
  Farm::Send send;
  FarmTime joined{};
  bool is_drained = false;
  bool is_stopping = false;  // said so itself
  bool was_contradicted = false;
  bool was_caught = false;  // it lied: what is lost with it is not its work's fault
  bool has_spoken = false;  // work was handed in, or held work was told of

  /// What is known of the worker and a job that it had work of.
  struct KnownJob {
    Speed speed, tracing;     // of samples, and of rays
    bool is_refused = false;  // the worker cannot render it
  };
  std::map<JobId, KnownJob> jobs;
  std::map<FrameId, std::string>
      frames;                    // that it was told of and not yet told the end of: their scenes' hashes
  std::set<std::string> assets;  // hashes of those that it was sent and not told to forget

  std::map<LeaseId, Lease> leases;      // held now
  std::uint64_t samples_held = 0;       // sum over leases
  std::map<LeaseId, Lease> called_off;  // the last that ended without an answer: one may be on its way
  LeaseId forgotten{};                  // of its leases up to this one nothing more is known

  Speed speed, tracing;  // over all jobs
  std::uint64_t tiles = 0, pixels = 0;
};

/// Who shows this certificate; without one, who asks for this name.
std::string identity_of(const std::string& wanted_name, const std::string& certificate);
bool may_work(const Worker& worker);
bool refuses(const Worker& worker, JobId job);
/// Also when it has no room.
bool may_be_given(const Worker& worker, JobId job);
/// How many it may have begun, or has at hand for when one ends.
std::size_t leases_at_hand(const Worker& worker);
/// Whether a lease of this job would keep it busier, not just make its queue longer.
bool has_room_for(const Worker& worker, JobId job);
WorkerView view_of(const Worker& worker);

/// Makes the frame known, sending what of it the worker has not got.
void introduce(Worker& worker, const Job& job, const JobFrame& frame);
/// Lets the frame be forgotten, if it is known.
void forget(Worker& worker, FrameId frame);
/// Lets the assets be forgotten that are none of these.
void forget_assets(Worker& worker, const std::set<std::string>& needed);
void assign(Worker& worker, LeaseId id, Lease lease);
/// Takes a lease that the worker holds away from it, silently: it has answered.
Lease take_lease(Worker& worker, LeaseId id, FarmTime now);
/// The same, without an answer.
Lease call_off(Worker& worker, LeaseId id, FarmTime now);
/// Of the seconds that a worker says its thread took: no thread works longer than its lease is old.
FarmTime believed_time(const Lease& lease, double seconds, FarmTime now);
/// What a delivery says about the worker's speed.
void learn_speed(Worker& worker, const Lease& lease, std::uint64_t rays, FarmTime taken);
/// Rays a second of one of its threads, with this job if that is known; 0: not known.
double tracing_speed(const Worker& worker, JobId job);
/// The same, or the job's mean while nothing is known of the worker.
double expected_speed(const Worker& worker, const Job& job);
/// How long a thread was busy with a lease that ended without being of use.
FarmTime time_wasted(const Lease& lease, FarmTime now);

}  // namespace rayfarm
