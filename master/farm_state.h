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
#include "master/farm_record.h"
#include "master/job.h"
#include "master/split.h"
#include "master/tail.h"
#include "master/trial.h"
#include "master/worker.h"

namespace rayfarm {

/// A tile whose passes are rendered in pieces.
struct Split {
  FrameId frame;
  Work work;
  struct Piece {
    Tile area;
    bool is_waiting = true;
    std::vector<PassImage> images{};  // once it is there
    NameId by{};
    WorkerId worker{};
    FarmTime taken{};
  };
  std::vector<Piece> pieces;
  std::size_t missing = 0;  // pieces that are not there
  /// Who renders the whole, too; whoever is first ends the other.
  std::optional<Lease::Twin> original{};
  FarmTime expected{};  // when that one is expected to be done, or was when it was taken away
};

struct Farm::State {
  FarmLimits limits;
  std::map<JobId, Job> jobs;
  std::deque<JobId> ended_jobs;  // all of them, in the order of their ends
  // In the order of their ends; all that are kept, and some that no longer are.
  std::deque<FrameId> ended_frames;
  std::uint64_t bytes_kept = 0;  // of ended frames
  std::map<std::string, JobId> job_by_key;
  /// The bytes of a scene or asset, that frames share.
  struct SharedData {
    SharedBytes::weak_type bytes;
    std::size_t unfinished = 0, kept = 0;  // frames
  };
  std::map<std::string, SharedData> shared;  // by hash: exactly those that frames have
  std::uint64_t unfinished_bytes = 0;        // of those, each counted once
  std::map<WorkerId, Worker> workers;
  /// What is known of a worker by what it is, not by how it calls itself.
  struct KnownWorker {
    std::vector<NameId> names;  // under which it came, the last at the end
    bool is_banned = false;
    Trust trust;
  };
  std::map<std::string, KnownWorker> known_workers;  // by identity
  // Work on trial is leased in its frame's schedule; it is committed when it is settled.
  std::map<TrialId, Trial> trials;
  using Place =
      std::pair<int, JobId>;  // of a job in a queue, the next to be served first: minus priority, id
  using TrialQueue = std::map<Place, std::set<TrialId>>;
  TrialQueue open_trials;   // exactly those that want more opinions
  TrialQueue asked_trials;  // exactly those that want none, but bear one more
  // A tile that is shared is leased in its frame's schedule; it is committed when all pieces are there.
  std::map<SplitId, Split> splits;
  std::set<SplitId> splits_to_share;  // all of those whose pieces wait, and some that no longer are
  std::uint64_t last_split = 0;
  std::set<std::string, std::less<>> drained_names, banned_names;
  // By NameId: of all workers that there were, as films outlive them; the first stands for those that were not kept.
  std::vector<std::string> names{"(one of many)"};
  std::map<std::string, NameId> name_ids;
  std::set<Place> queue;  // exactly the jobs that want workers
  std::uint64_t last_job = 0, last_worker = 0, last_lease = 0;
  FarmTime next_look = FarmTime::min();   // for work that is worth doubling
  std::set<FrameId> frames_with_victims;  // of those that are there
  std::uint64_t revision = 0;
  std::vector<FarmEvent> events;
  std::vector<FarmRecord> records;  // those of changed_jobs are still to come
  std::set<JobId> changed_jobs;
  decltype(FarmPast::read_pixels) read_pixels;  // of films that are not there yet

  void tell(std::string text, std::string worker = "") {
    events.push_back({false, std::move(text), std::move(worker)});
  }
  void warn(std::string text, std::string worker = "") {
    events.push_back({true, std::move(text), std::move(worker)});
  }

  void record(auto fact) { records.push_back({std::move(fact)}); }
  /// After a change of what JobChanged tells.
  void touch(const Job& job) {
    ++revision;
    changed_jobs.insert(job.id);
  }

  static Place place_of(const Job& job) { return {-job.spec.priority, job.id}; }
  JobView view(const Job& job, FarmTime now) const;
  Job* living_job(JobId id);
  const JobFrame* frame(JobId id, std::optional<std::uint32_t> number) const;
  Worker* worker_named(std::string_view name);
  const Worker* worker_named(std::string_view name) const;
  std::string unique_name(const std::string& wanted) const;
  NameId id_of_name(const std::string& name);

  /// The frame shares its scene and assets with others that have the same; they count as those of an unfinished one.
  /// Throws FarmFull.
  void take_in_data(JobFrame& frame);
  void release_unfinished(JobFrame& frame);
  /// Its scene counts as unfinished from now on.
  void add_frame(Job& job, JobFrame frame);
  /// Lets workers forget the assets that no job has that goes on.
  void drop_unneeded_assets();

  // Giving work out.
  Job* next_job_for(const Worker& worker);
  /// False when the worker has enough or there is nothing for it; else ask again.
  bool give_one(Worker& worker, FarmTime now);
  /// Work that was just taken from the frame's schedule.
  void give(Worker& worker, Job& job, JobFrame& frame, const Work& work, FarmTime now);
  void fill(Worker& worker, FarmTime now);
  void fill_all(FarmTime now);
  bool start(Job& job, JobFrame& frame, FarmTime now);

  // The tail.
  /// A lease, as it was looked at.
  struct Held {
    LeaseId id{};
    const Lease* lease = nullptr;
    Straggler straggler;
  };
  /// Who may help with what others hold, on so many threads.
  struct Helper {
    Worker* worker = nullptr;
    std::uint32_t threads = 0;
    bool is_idle = false;  // has nothing else to do
  };
  /// So little of it is unfinished that it can be seen who will be late.
  bool is_ending(const Job& job) const;
  std::vector<Helper> helpers();
  double seconds_of_queue(const Job& job, std::uint64_t pixels_leased) const;
  /// Gives threads that have nothing to do a share of what others hold, or what is worth doing a second time; looks for
  /// it every few milliseconds only.
  void relieve_stragglers(FarmTime now);
  double note_held(const Worker& holder, FarmTime now, std::map<JobId, std::vector<Held>>& by_job);
  double expected_cost(const Lease& lease) const;
  void copy_stragglers(const Job& job, std::vector<Held> held, const std::vector<Helper>& helpers,
                       const std::map<WorkerId, double>& busy, FarmTime now);
  void give_copy(Worker& holder, LeaseId original, Worker& worker, FarmTime now);
  /// Somebody else's result was taken.
  void end_twin(const Lease::Twin& twin, FarmTime now);
  /// The lease ended, and what was rendered for it is of no use.
  void waste(Job& job, const Worker& worker, const Lease& lease, FarmTime now);

  // Tiles that are shared.
  /// False: nothing is worth it.
  bool share_stragglers(const Job& job, const std::vector<Held>& held, const std::vector<Helper>& helpers,
                        FarmTime now);
  void split(const Held& straggler, std::uint32_t pieces, FarmTime now);
  /// To a thread without anything to do; nothing of less priority than what else it might do.
  bool give_share(Worker& worker, const Job* other, FarmTime now);
  bool may_share(const Worker& worker, const Split& split, const Job* other) const;
  bool give_some_piece(Worker& worker, const Job* other, FarmTime now);
  void give_piece(Worker& worker, SplitId id, std::size_t place, FarmTime now);
  bool is_doubled(SplitId id) const;  // somebody does a piece of it a second time
  /// To one that takes no pieces: when nobody is at one, or those who are do not come to an end.
  bool may_go_whole(SplitId id, FarmTime now) const;
  void give_whole(Worker& worker, SplitId id, FarmTime now);
  void hear_piece(Worker& worker, const Lease& lease, Result result, FarmTime now);
  void put_together(SplitId id, Worker& last, FarmTime now);
  /// The pieces are no longer wanted.
  void end_split(SplitId id, FarmTime now);
  void drop_splits(FrameId frame, FarmTime now);
  /// Its pieces of tiles that are not committed yet are to be rendered again.
  void lose_pieces_of(const KnownWorker& worker);

  // Trials.
  std::uint32_t opinions_wanted_on(const Worker& worker, LeaseId id, const Lease& lease) const;
  /// Some of the work's passes are on trial, and the worker has not said yet what they are.
  std::optional<TrialId> unheard_trial(const Worker& worker, const Lease& lease) const;
  /// Of the job of highest priority, then the one submitted first.
  std::optional<TrialId> first_for(const Worker& worker, const TrialQueue& queue) const;
  /// Others are asked already, who may never answer.
  std::optional<TrialId> asked_trial_for(const Worker& worker) const;
  void put_in(TrialQueue& queue, const TrialId& id, bool is_in);
  /// So many of its tiles want opinions that no more shall: they take memory.
  bool waits_for_judges(Place job) const;
  /// What people should know about it; empty: nothing.
  std::string words_for_trials(const Job& job) const;
  /// Some were asked too long ago: others are asked.
  void note_overdue(FarmTime now);
  void give_trial(Worker& worker, const TrialId& id, FarmTime now);
  /// To a worker without anything else to do. False: it has something, or there is none for it.
  bool give_asked_trial(Worker& worker, FarmTime now);
  void update_trial(const TrialId& id);
  /// The worker will not say what it was asked for.
  void withdraw(const Worker& worker, const Lease& lease);
  /// An opinion on new work, of which so many are wanted, or on work that is on trial.
  void hear(Worker& worker, const Lease& lease, std::uint32_t wanted, Result result, FarmTime now);
  void settle_trial(const TrialId& id, std::size_t right, FarmTime now);
  /// Nobody is asked any more.
  void end_trial(const TrialId& id, FarmTime now);
  void end_check(const Trial::Asked& asked, FarmTime now);
  void drop_trials(FrameId frame, FarmTime now);
  /// It was wrong once more: nothing stays that it delivered, and the second time it is banned.
  void disbelieve(const std::string& identity, NameId name, FarmTime now);
  /// It broke the rules of the conversation, which is as bad as wrong pixels. Throws WorkerError.
  [[noreturn]] void denounce(Worker& worker, const std::string& lie, FarmTime now);
  /// What it delivered for unfinished jobs waits again; how many tiles.
  std::size_t lose_all_of(const KnownWorker& worker, FarmTime now);
  /// Trials go on without what it said.
  void strike_opinions(const std::string& identity, FarmTime now);
  void wait_again(Job& job, std::uint32_t frame, const Work& work);

  // Who workers are.
  Worker* worker_here(WorkerId id);  // null: it has been removed
  /// It has come.
  void meet(const Worker& worker);
  /// The same program is back before its old connection is known to be dead. The leases that it had there: an answer may
  /// be on its way.
  std::map<LeaseId, Lease> end_former_connection(const std::string& identity, std::uint64_t process,
                                                 FarmTime now);
  void record_known(const std::string& identity);
  /// Of the worker that has this name, or had it last; of several, when they had it one after the other.
  std::vector<std::string> identities_of(std::string_view name) const;
  void ban(const std::string& name, FarmTime now);
  /// Ends what it holds, and its conversation.
  void turn_away(Worker& worker, const std::string& name, FarmTime now);

  /// Gives the worker again what it has. False: it is not needed, or not from this worker.
  bool reattach(Worker& worker, const HeldTile& held, FarmTime now);
  // It is finished, and others have a lease of it, or it is on trial.
  bool reattach_as_check(Worker& worker, const Assignment& work, FarmTime now);
  bool reattach_as_copy(Worker& worker, const Assignment& work, FarmTime now);
  bool reattach_as_whole(Worker& worker, const Assignment& work, FarmTime now);

  // Taking it back; none of them gives it out again.
  void end_lease(Worker& worker, LeaseId id, FarmTime now);
  /// Ends all leases of a worker, returning their ids.
  std::vector<LeaseId> end_leases(Worker& worker, FarmTime now);
  void revoke(Worker& worker, JobId job, FarmTime now);
  void revoke_everywhere(JobId job, FarmTime now);

  /// A worker that was lost may have died of the lease that it held longest.
  void blame(const Lease& oldest, const std::string& identity, Canvas::Victim lost, FarmTime now);
  /// What was lost with that process was not lost for the sake of its work: it is still alive.
  void exonerate(std::uint64_t process);

  // Results.
  void deliver(Worker& worker, const Lease& lease, Result result, FarmTime now);
  /// A tile, or a piece of one, that is made use of.
  void credit(Worker& worker, std::uint64_t pixels);
  /// What a delivery tells of the worker; the time that is believed.
  FarmTime book(Worker& worker, const Lease& lease, const Result& result, FarmTime now);
  void accept(Job& job, JobFrame& frame, const Work& work, std::vector<PassImage> images, NameId by,
              FarmTime taken, FarmTime now, const std::vector<NameId>& helpers = {});
  void finish(Job& job, JobFrame& frame, FarmTime now);
  /// Of a piece when there is an area.
  void take_result(WorkerId id, Result result, std::optional<Tile> area, FarmTime now);
  /// For a lease that has ended: an opinion when its tile is on trial, else compared with what others delivered.
  void receive_late(Worker& worker, Result result, std::optional<Tile> area, FarmTime now);
  void compare_late(Worker& worker, const Lease& lease, const Result& result);
  void refuse(Worker& worker, Job& job, const std::string& reason, FarmTime now);

  /// After a change of the job's state, priority or waiting work.
  void update_queue(const Job& job);
  /// Other jobs that ended may be dropped.
  void end(Job& job, JobState state, FarmTime now);
  void fail(Job& job, std::string why, FarmTime now);
  /// Is done, or its job has ended; what of it stays is counted.
  void end(Job& job, JobFrame& frame, FarmTime now);
  void drop_old_jobs(FarmTime now);
  /// One that has ended, and is not among ended_jobs any more.
  void drop_job(JobId id);
  void drop_old_films();
  void drop_picture(Job& job, JobFrame& frame);
  void pause(Job& job, std::string why);

  // A farm built again.
  void restore(FarmRecord record);
  /// After the last record: what follows from them.
  void settle(FarmTime now);
  void settle(Job& job);
  /// Its film, scene and assets, with what all take.
  void count_data(JobFrame& frame);

  // Pixels that are read when they are needed.
  /// The frame, if it has a film, with its pixels; null also when they cannot be read.
  const JobFrame* picture(JobId id, std::optional<std::uint32_t> number);
  /// False: they cannot be read now; a job that goes on is paused.
  bool read_film(Job& job, JobFrame& frame);
  /// Those that are not in the film are to be rendered again.
  void lose_unread(Job& job, JobFrame& frame, const RayCounters& counters);
  /// Were committed, and wait again.
  void lose_passes(Job& job, JobFrame& frame, const PassesLost& lost);
  /// It was done, and is no longer.
  void reopen(Job& job, JobFrame& frame);
  void unkeep(JobFrame& frame);
};

}  // namespace rayfarm
