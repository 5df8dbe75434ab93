// A job inside the farm: what was asked for, what is there of it, what is still to do.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "master/farm.h"
#include "master/pace.h"
#include "master/schedule.h"

namespace rayfarm {

struct PassesLost;

/// A worker's name by its number in the farm's list: whom a pass came from, also when the worker is gone.
enum class NameId : std::uint32_t {};

/// The big part of a frame, made at its first assignment.
struct Canvas {
  explicit Canvas(Size of_film) : size(of_film), schedule(size), deliveries(tile_count(size)) {}

  /// A tile's passes that are there: whom they came from, and what they took.
  struct TileDeliveries {
    std::array<std::uint32_t, pass_count> by{};  // places in `deliverers`
    std::array<FarmTime, pass_count> taken{};    // of a commit, with its first pass
    std::array<RayCounters, pass_count>
        counters{};  // after a restart all of a commit stand with its first pass
  };

  Size size;
  std::shared_ptr<Film> film;  // null: the pixels that the schedule says are done are still to be read
  Schedule schedule;
  std::vector<TileDeliveries> deliveries;  // by tile
  std::vector<NameId> deliverers;          // in the order of their first deliveries
  /// A worker that was lost and has not come back alive.
  struct Victim {
    NameId name{};
    std::uint64_t process = 0;  // WorkerInfo::process
    FarmTime lost{};
    bool was_silent = false;  // before it was lost; else its connection broke
  };
  using Victims = std::map<std::string, Victim>;  // by identity
  Victims lost_at_first;                          // before any pixel was there
  std::map<std::uint32_t, Victims> lost_over;     // later, by the tile that they held longest
  /// Who rendered pieces of passes that another brought to their end.
  struct Part {
    PassSet passes = 0;
    NameId by{};
  };
  std::map<std::uint32_t, std::vector<Part>> parts;  // by tile
};

/// Whose scene has come.
struct JobFrame {
  std::uint32_t number = 0;
  std::string scene_hash;
  SharedBytes scene_bytes;        // null when it is no longer needed
  std::vector<AssetData> assets;  // of the scene
  std::optional<Canvas> canvas;
  std::uint64_t pixels_done = 0;
  RayCounters counters;
  FarmTime thread_time{};
  std::optional<FarmTime> started, ended;
  std::uint32_t losses = 0;  // of passes that were there
};

struct Job {
  JobId id{};
  JobSpec spec;  // without its scene; its frames are there
  JobState state = JobState::waiting;
  std::string message;
  std::vector<JobFrame> frames;  // in the order of spec.frames
  std::set<std::uint32_t> open;  // places in `frames`: exactly those that have work waiting
  std::uint32_t frames_done = 0, frames_dropped = 0;
  std::uint32_t first_unfinished = 0;  // place in `frames`, or after them
  std::uint64_t pixels_done = 0;       // these three: sums over the frames
  RayCounters counters;
  FarmTime thread_time{};
  Pace pace;
  FarmTime submitted{};
  std::optional<FarmTime> started, ended;
  FarmTime last_done{};  // of a frame
  std::uint64_t tiles_given_back = 0, tiles_doubled = 0, tiles_shared = 0, tiles_checked = 0;
  FarmTime time_wasted{};
  std::uint64_t rays_wasted = 0;
};

/// Calls visit(hash, bytes) for the frame's scene and assets, when it has them.
template <class Frame, class Visit>
void for_each_data(Frame& frame, Visit&& visit) {
  if (!frame.scene_bytes) return;
  visit(frame.scene_hash, frame.scene_bytes);
  for (auto& asset : frame.assets) visit(asset.hash, asset.bytes);
}
/// Nobody will look into it any more.
void drop_data(JobFrame& frame);

Size size_of(const RenderSettings& settings);
/// What its film takes, once all pixels are there.
std::uint64_t film_bytes(const JobFrame& frame);
bool has_ended(const Job& job);
/// All of its pixels were committed; its film may be gone.
bool is_complete(const Job& job, const JobFrame& frame);
/// May be worked on, and some of it is waiting.
bool wants_workers(const Job& job);
/// The first frame when none is named; null when its scene has not come, or there is none.
const JobFrame* frame_of(const Job& job, std::optional<std::uint32_t> number);
JobFrame& frame_at(Job& job, std::uint32_t number);
RenderSettings settings_of(const Job& job, const JobFrame& frame);
/// As people know it: job 7 (sphere_flake).
std::string title_of(const Job& job);
/// Of an animation: frame 12 of job 7 (sphere_flake).
std::string title_of(const Job& job, const JobFrame& frame);
/// 1 tile, 2 tiles.
std::string count_of_tiles(std::size_t count);
JobView view_of(const Job& job, FarmTime now);
/// Of the frame in this place, also of one whose scene has not come.
FrameView view_of(const Job& job, std::uint32_t place, FarmTime now);

/// Why the images are not those passes of a tile, or of a piece of one; nothing when they are.
std::optional<std::string> fault_of(const std::vector<PassImage>& images, const Tile& area, PassSet passes);
/// What a lease's work gave, without fault: by whom, and in how much thread time.
struct Delivery {
  const Work& work;
  const std::vector<PassImage>& images;
  NameId by{};
  FarmTime taken{};
  const std::vector<NameId>& helpers;  // the others who rendered pieces of it, each once
};
/// Takes it into the frame's film.
void commit(Job& job, JobFrame& frame, const Delivery& delivery, FarmTime now);
/// All that the worker delivered of it.
PassesLost delivered_by(JobId job, const JobFrame& frame, NameId worker);
/// They are to be rendered again; the sums over the job's frames stay to be made.
void lose(const Job& job, JobFrame& frame, const PassesLost& damage);
/// The rays that it will take, as far as its own tile's coarser passes and the tiles around it tell; else the frame, else
/// the job's other frames. 0: nothing tells.
double expected_rays(const Job& job, const JobFrame& frame, const Work& work);
/// The pixels that one work brings.
std::uint64_t pixels_in(const Work& work, const RenderSettings& settings);
/// Who delivered other pixels of this area of the tile than these, if anybody did. Passes not there yet are not compared.
std::optional<NameId> contradicted(const Canvas& canvas, std::uint32_t tile, const Tile& area,
                                   const std::vector<PassImage>& images);

}  // namespace rayfarm
