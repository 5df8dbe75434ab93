// What changed in a farm, as values: all that must be kept so that the same farm can be built again.
//
// A record says what is now true, so a farm can be built from all of them, in the order in which they came, or from
// a shorter list with the same outcome. Leases are not among them: what was leased waits again.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "master/farm.h"
#include "master/schedule.h"

namespace rayfarm {

struct JobAdded {
  JobId id{};
  JobSpec spec;  // without scene and assets; with its frames
  FarmTime submitted{};
};
struct FrameAdded {
  FrameId id;
  std::string scene_hash;
  SharedBytes scene;  // null: nobody will look into it any more, or it is damaged
  std::vector<AssetData> assets;
};
/// Its first assignment.
struct FrameStarted {
  FrameId id;
  FarmTime at{};
};
struct TileCommitted {
  FrameId frame;
  std::uint32_t tile = 0;
  PassSet passes = 0;
  std::string worker;
  FarmTime taken{}, at{};
  RayCounters counters;                // of these passes
  std::vector<PassImage> images;       // ignored when a farm is built again: it reads them when it needs them
  std::vector<std::string> helpers{};  // the other workers that rendered pieces of it, each once
};
/// These passes were committed once, and are damaged.
struct PassesLost {
  FrameId frame;
  std::vector<Work> lost;
  RayCounters counters;  // of all of them
};
struct JobChanged {
  JobId id{};
  JobState state = JobState::waiting;
  int priority = 0;
  std::string message, key;
  std::uint64_t tiles_given_back = 0;
  std::optional<FarmTime> ended;
  std::uint64_t tiles_doubled = 0, tiles_checked = 0;
  FarmTime time_wasted{};
  std::uint64_t tiles_shared = 0, rays_wasted = 0;
};
struct SceneDropped {
  FrameId id;
};
/// And its scene. What was known of it beside its pixels stays.
struct PictureDropped {
  FrameId id;
  std::uint64_t pixels_done = 0;
  RayCounters counters;
  FarmTime thread_time{};
  std::optional<FarmTime> ended;
};
/// There was a job of this number.
struct JobDropped {
  JobId id{};
};
/// A worker of a new name was here.
struct WorkerNamed {
  std::string name;
};
struct WorkerDrained {
  std::string name;
  bool is_drained = false;
};
struct WorkerBanned {
  std::string name;
  bool is_banned = false;
};
/// Who a worker is, and what is known of it.
struct WorkerKnown {
  std::string identity;
  std::string name;  // that it had last
  bool is_banned = false;
  Trust trust;
};

struct FarmRecord {
  std::variant<JobAdded, FrameAdded, FrameStarted, TileCommitted, PassesLost, JobChanged, SceneDropped,
               PictureDropped, JobDropped, WorkerNamed, WorkerDrained, WorkerBanned, WorkerKnown>
      fact;
};

/// What a farm was: records, and a way to the pixels that it committed.
struct FarmPast {
  std::vector<FarmRecord> records;
  std::uint32_t life = 0;  // another one each time: the leases of two lives have different numbers
  /// Calls the function with each commit of the frame whose pixels are sound. Throws when nothing can be read now.
  std::function<void(FrameId, const std::function<void(const TileCommitted&)>&)> read_pixels;
};

}  // namespace rayfarm
