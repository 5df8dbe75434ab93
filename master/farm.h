// The farm: jobs, workers, leases. It decides who renders what, without I/O: no socket, no clock, no file.
// Time is passed in; messages leave through the function that a worker was added with; what an admin should
// know comes out of take_events(), and what changed out of take_records(): from these the same farm can be built again.
// All calls are made from one thread.
//
// A job has one frame, or those of an animation, whose scenes come one after the other.
//
// Invariants: each (job, frame, tile, pass) is waiting, leased to one worker or, near the end, to two or in pieces, or done; it is
// committed exactly once, under a live lease. A pass that comes again is compared with what was committed, never
// written.
//
// Who gets what: of the jobs that have work waiting the one of highest priority, then the one submitted
// first; of its frames the first that has work waiting, so that the last tiles of one and the first of the next
// are rendered side by side; of its tiles those given back, then the one nearest the centre. A worker holds a
// lease for each thread until it has delivered something, then two more, and beyond that as many as keep it
// busy for 250 ms by its learned speed. It is sent the scene of the coming frame, too. Near the
// end of a job, what is expected to end after all that still waits is done a second time by a worker that would be sooner
// (tail.h): the first result counts, the other lease is revoked. Where more threads idle than there are such tiles, a tile
// is shared by several in pieces (split.h), which the farm puts together: it is committed once, as a whole. Work that is
// verified is not shared.
//
// What is to be verified (verification.h) is on trial first: its tile counts as leased until enough others, or the
// master's own threads, say the same pixels; only then it is committed. Who has nothing else to do is asked although
// enough are asked already: one that never answers stops no job. What a worker that was wrong delivered for unfinished
// jobs is rendered again, and who was wrong twice is banned. After a restart what was on trial waits.
//
// Memory: a frame costs its scene, which frames of the same hash share; from its first assignment also 12 bytes
// a pixel for the film (3.7 MB for 640x480, 6 GB for 500 megapixels) and 300 bytes a tile. A frame that is done,
// or whose job has ended, keeps its film, which is fetched later, and one that is done also its scene, which
// says how the picture came about, as long as FarmLimits say. Of all workers that there were the names are kept, to say
// whose pixels they are, and whether they lied; whoever would be one too many is not let in.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/net/messages.h"
#include "common/render/film.h"
#include "master/farm_time.h"
#include "master/frame_range.h"
#include "master/verification.h"

namespace rayfarm {

enum class WorkerId : std::uint64_t {};

enum class WorkerKind : std::uint8_t {
  local,   // the master's own threads: one pass of a tile at a time, coarse passes first
  remote,  // whole tiles at stride 1, just the passes not there yet
};
struct WorkerInfo {
  std::string name{}, address{}, cpu{}, version{};
  std::uint32_t threads = 1;
  WorkerKind kind = WorkerKind::remote;
  std::uint64_t process = 0;  // the same when it comes back without having ended; 0: not known
  std::string certificate{};  // its id; empty: it showed none
  bool takes_pieces = false;  // can render a piece of a tile
};

enum class JobState : std::uint8_t { waiting, running, paused, done, cancelled, failed };
std::string_view name_of(JobState state);

struct JobSpec {
  std::string name;
  std::string output;  // fetch's default file, on the submitter's PC
  std::string scene_hash;
  SharedBytes scene_bytes;        // encode_scene(); of the first frame
  std::vector<AssetData> assets;  // of that scene
  RenderSettings settings;
  std::optional<FrameRange> frames;  // none: the one of the settings. The other scenes come by add_frame()
  int priority = 50;                 // 0..99, higher first; equals in order of submission
  bool hold = false;                 // starts paused
  Verification verification;         // of what workers deliver; the master's own threads are believed
  std::string key;  // submit --id: the same key gives the same job again until that fails; empty: none
  std::map<std::string, std::string> parameters;  // that its script was given, as far as the submitter says
  std::string
      script;  // of which its door makes the scenes to come, in the door's own words; empty: others bring them
};

/// What of ended jobs and of frames that are done is kept; those that ended first go first. A frame that loses its
/// film loses its scene, too, and its job the key. And how much may be unfinished: beyond that, nothing is taken
/// in.
struct FarmLimits {
  std::uint64_t film_bytes = std::uint64_t{2}
                             << 30;    // all films, scenes, assets; the newest stay, however big
  std::size_t jobs = 1000;             // at least 1; of the others only the numbers are known
  FarmTime job_age = FarmTime::max();  // above 0, since its end; older ones go however few there are
  std::size_t unfinished_jobs = 10'000;
  std::uint64_t scene_bytes = std::uint64_t{2} << 30;  // of unfinished frames, each scene and asset once
  std::size_t worker_names = 10'000;  // that workers had; a worker may come under a new one each time
  std::size_t names_of_one = 2'500;   // of those with one certificate, which a cluster may share
  std::uint64_t secret = 0;  // that workers do not know: which of their tiles are checked follows from it
};

/// A job as people see it.
struct JobView {
  JobId id{};
  std::string name, output, scene_hash;
  std::string message;  // why it failed, why a worker gave it back, that its picture is gone
  JobState state = JobState::waiting;
  int priority = 0;
  RenderSettings settings;  // of the first frame; the others differ in their numbers
  std::map<std::string, std::string> parameters;
  FrameRange frames;
  std::uint32_t frames_sent = 0;               // whose scenes have come, the first ones
  std::uint32_t frames_done = 0;               // also those whose pictures are no longer kept
  std::optional<std::uint32_t> current_frame;  // the first that is not done
  FarmTime last_done{};                        // when a frame was done last
  std::uint64_t pixels_done = 0, pixels_total = 0;
  RayCounters counters;                // of committed passes
  FarmTime submitted{}, waited{};      // waited: from then to the first assignment, or to its end without one
  FarmTime elapsed{};                  // wall time since the first assignment, until it ended
  FarmTime thread_time{};              // that its deliveries took, each on one thread
  std::optional<FarmTime> eta;         // remaining; none before there is something to learn from
  std::uint64_t tiles_given_back = 0;  // leases that ended without a result
  std::uint64_t tiles_doubled = 0;     // given to a second worker near the end
  Verification verification;
  std::uint64_t tiles_checked = 0;  // on which several had to agree, and did
  std::uint64_t tiles_shared = 0;   // given to several in pieces near the end
  FarmTime time_wasted{};           // of threads: on leases that ended so, and on those that came second
  std::uint64_t rays_wasted = 0;    // in that time; estimated by the workers' speeds where they were cut off
};

/// One of its frames.
struct FrameView {
  std::uint32_t frame = 0;
  JobState state = JobState::waiting;  // that of the job unless it is done, or waits
  std::string scene_hash;              // empty while it has not come
  bool is_kept = false;                // there is a film
  std::uint64_t pixels_done = 0, pixels_total = 0;
  RayCounters counters;
  FarmTime waited{}, elapsed{}, thread_time{};  // as of a job
  std::optional<FarmTime> done{};               // when; another time when its pixels had to be rendered again
  bool is_final = false;                        // the job has ended: its pixels stay as they are
  std::uint32_t losses = 0;  // so often pixels that were there waited again, since the farm was built
};

/// Who delivered a picture's pixels, and what they took.
struct Deliveries {
  struct Tile {
    std::array<std::uint32_t, pass_count> by{};  // of the passes that are there: places in names
    FarmTime taken{};                            // by all of them, each on one thread
    PassSet passes = 0;                          // that are there
  };
  std::vector<Tile> tiles;         // by tile number
  std::vector<std::string> names;  // of workers; grows at its end only
  std::uint32_t losses = 0;        // as of its frame
  bool is_final = false;           // the job has ended: they stay as they are
};

enum class WorkerState : std::uint8_t { idle, busy, drained };
std::string_view name_of(WorkerState state);

struct WorkerView {
  WorkerId id{};
  WorkerInfo info;
  WorkerState state = WorkerState::idle;
  std::uint32_t leases = 0;       // held now
  std::uint64_t tiles = 0;        // delivered; each pass of a tile that a local thread did counts as one
  std::uint64_t pixels = 0;       // delivered
  double samples_per_second = 0;  // learned, all its threads; 0: not known yet
  FarmTime joined{};
  Trust trust;
};

/// One line for the log. Warnings are what an admin should look at.
struct FarmEvent {
  bool warning = false;
  std::string text;
  std::string worker;  // that it is about; empty: none, or several
};

/// A worker broke the rules of the conversation; the message says how. End its connection and pass the
/// message to remove_worker as the reason. The lease concerned has ended already, nothing was committed. It counts as
/// wrong pixels do, whatever a job's verification: what it delivered for unfinished jobs is rendered again, and the second
/// time it is banned.
struct WorkerError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The key of a submission belongs to a job with another scene or other settings, or a frame has another scene
/// already; the message names it.
struct KeyTaken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// As much is unfinished as FarmLimits allow; later there will be room again.
struct FarmFull : SettingsError {
  using SettingsError::SettingsError;
};

struct FarmPast;    // farm_record.h
struct FarmRecord;  // the same

class Farm {
 public:
  /// Must not call the farm.
  using Send = std::function<void(ToWorker)>;

  explicit Farm(FarmLimits limits = {});
  /// The farm that these records came from (farm_record.h). All that was leased waits; no worker is here. A film's pixels
  /// are read when they are first needed. Those that are damaged, or gone, are rendered again once their job, which is
  /// paused and says so, is resumed.
  Farm(FarmLimits limits, FarmPast past, FarmTime now);
  Farm(Farm&&) noexcept;
  Farm& operator=(Farm&&) noexcept;
  ~Farm();

  /// Sends Welcome with the worker's name (made unique: the second "pc" is "pc-2"; a name is free again when
  /// its worker is removed), then work. A drained name stays drained until undrain(). objection_to() it must be nothing.
  /// The same process of the same worker may be here on another connection, which is not known to be dead yet: that one
  /// is removed, and sent Goodbye.
  WorkerId add_worker(WorkerInfo info, Send send, FarmTime now);
  // The next four do nothing when the worker is no longer here.
  /// Its leases go to the others, first of all. The reason is for people. Nothing was heard of it for so long: what it was
  /// given since then is not what it was lost over.
  void remove_worker(WorkerId worker, std::string reason, FarmTime now, FarmTime silence = {});
  /// Throws WorkerError if the result is not what its lease asked for, or the worker has no such lease. One result may
  /// still come after its lease was revoked: it counts while its tile is on trial, and is compared with what others
  /// delivered: a difference is a warning that names both.
  void receive(WorkerId worker, Result result, FarmTime now);
  void receive(WorkerId worker, PieceResult piece, FarmTime now);
  /// With a reason: the worker cannot render the jobs of these leases, and is not offered them again; a job
  /// that every worker gave back so before anything of it was done has failed. Without one: the worker is
  /// stopping and gets nothing more; what it still holds it may finish.
  void receive(WorkerId worker, GiveBack given, FarmTime now);

  /// What of this is still to be done, it is asked to do; what others are asked already too, if it has finished it.
  /// The rest it is told to forget. Once, before its first result, and no more than a worker can hold; else it throws
  /// WorkerError.
  void receive(WorkerId worker, const Holds& holds, FarmTime now);

  /// Time goes by: to be called each 100 ms or so. Work that nobody ends is noticed by it, and that a job is too old to be
  /// kept.
  void tick(FarmTime now);

  /// Throws SettingsError for settings that cannot be rendered, FarmFull, KeyTaken.
  JobId submit(JobSpec spec, FarmTime now);
  /// The scene of the next frame; again the same scene of one that has come already is no fault. False: no such
  /// job, or it has ended. Throws SettingsError when another frame is next, FarmFull, KeyTaken.
  bool add_frame(FrameId id, std::string scene_hash, SharedBytes scene, FarmTime now,
                 std::vector<AssetData> assets = {});
  // These answer false when there is no such job, or it has ended. Pausing and cancelling revoke at once.
  bool pause(JobId job, FarmTime now, std::string why = {});  // for people; until it is resumed
  bool resume(JobId job, FarmTime now);
  bool cancel(JobId job, FarmTime now);
  bool fail(JobId job, std::string why, FarmTime now);  // what it still needs will not come
  bool set_priority(JobId job, int priority, FarmTime now);
  /// Nothing of it is kept any longer. False: there is no such job, or it has not ended.
  bool remove(JobId job);
  // Of workers by their unique name. Draining revokes what it holds at once and gives it nothing more. False:
  // no such worker; undrain also knows drained workers that are away.
  bool drain(std::string_view name, FarmTime now);
  bool undrain(std::string_view name, FarmTime now);
  // A banned worker is refused, its connections end and what it holds is given to others. It is known by its certificate,
  // whatever name it takes; without one by the name that it asks for. A name that never was here is none; the master's own
  // threads are not banned.
  bool ban(std::string_view name, FarmTime now);
  bool unban(std::string_view name, FarmTime now);
  /// Why a worker that wants this name must not be added; nothing when it may.
  std::optional<std::string> objection_to(const std::string& wanted_name,
                                          const std::string& certificate = {}) const;

  std::vector<JobView> jobs(FarmTime now) const;  // in order of submission
  std::optional<JobView> job(JobId id, FarmTime now) const;
  /// There was a job of this number, which is no longer kept.
  bool was_here(JobId id) const;
  std::vector<WorkerView> workers() const;  // in order of joining
  std::vector<std::string> banned() const;  // names
  Trust trust_in(std::string_view name) const;
  std::string name_of_worker(WorkerId id) const;  // empty: not here
  /// All that it will have; empty: no such job.
  std::vector<FrameView> frames(JobId id, FarmTime now) const;
  // Of a frame of a job; of the first, when none is named.
  std::optional<FrameView> frame(JobId id, std::optional<std::uint32_t> frame, FarmTime now) const;
  /// Null when there is no such frame, nothing of it was assigned yet, or it is no longer kept. Grows while the
  /// frame is rendered.
  std::shared_ptr<const Film> film(JobId id, std::optional<std::uint32_t> frame = {}) const;
  /// None when there is no film.
  std::optional<Deliveries> deliveries(JobId id, std::optional<std::uint32_t> frame = {}) const;
  /// The encoded scene of a frame that goes on or is done; null when there is no such frame, its job was
  /// cancelled or failed before it was done, or its film is no longer kept.
  SharedBytes scene(JobId id, std::optional<std::uint32_t> frame = {}) const;
  /// Those of that scene.
  std::vector<AssetData> assets(JobId id, std::optional<std::uint32_t> frame = {}) const;
  /// As it was submitted; empty once the job has ended.
  std::string script(JobId id) const;
  /// Grows with every change of a job: to wait for news.
  std::uint64_t revision() const;

  /// What happened since the last call.
  std::vector<FarmEvent> take_events();
  /// What changed since the last call. They hold the pixels of commits: to be taken often, also when nobody keeps them.
  std::vector<FarmRecord> take_records();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rayfarm
