// A job inside the farm: what was asked for, what is there of it, what is still to do.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "master/farm.h"
#include "master/pace.h"
#include "master/schedule.h"

namespace rayfarm {

/// A worker's name by its number in the farm's list: whom a pass came from, also when the worker is gone.
enum class NameId : std::uint32_t {};

/// The big part of a job, made at its first assignment.
struct Canvas {
  explicit Canvas(Size size)
      : film(std::make_shared<Film>(size)), schedule(size), deliveries(tile_count(size)) {}

  /// A tile's passes that are there: whom they came from, and the thread time of all of them.
  struct TileDeliveries {
    std::array<std::uint32_t, pass_count> by{};  // places in `deliverers`
    FarmTime taken{};
  };

  std::shared_ptr<Film> film;
  Schedule schedule;
  std::vector<TileDeliveries> deliveries;  // by tile
  std::vector<NameId> deliverers;          // in the order of their first deliveries
};

struct Job {
  JobId id{};
  JobSpec spec;
  JobState state = JobState::waiting;
  std::string message;
  std::optional<Canvas> canvas;
  std::uint64_t pixels_done = 0;  // as the film says while there is one
  RayCounters counters;
  FarmTime thread_time{};
  Pace pace;
  FarmTime submitted{};
  std::optional<FarmTime> started, ended;
  std::uint64_t tiles_given_back = 0;
};

Size size_of(const RenderSettings& settings);
bool has_ended(const Job& job);
/// What its film takes, once all pixels are there.
std::uint64_t film_bytes(const Job& job);
/// May be worked on, and some of it is waiting.
bool wants_workers(const Job& job);
/// As people know it: job 7 (sphere_flake).
std::string title_of(const Job& job);
/// 1 tile, 2 tiles.
std::string count_of_tiles(std::size_t count);
JobView view_of(const Job& job, FarmTime now);

/// Why the images are not those that the work asks for; nothing when they are.
std::optional<std::string> fault_of(const std::vector<PassImage>& images, Size film, const Work& work);
/// What a lease's work gave, without fault: by whom, and in how much thread time.
struct Delivery {
  const Work& work;
  const std::vector<PassImage>& images;
  NameId by{};
  FarmTime taken{};
};
/// Takes it into the film.
void commit(Job& job, const Delivery& delivery, FarmTime now);
/// Who delivered other pixels than these, if anybody did. Passes not there yet are not compared.
std::optional<NameId> contradicted(const Job& job, std::uint32_t tile, const std::vector<PassImage>& images);

}  // namespace rayfarm
