#include "master/job.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "master/farm_record.h"

namespace rayfarm {

namespace {

std::uint32_t place_of(NameId name, std::vector<NameId>& names) {
  const auto known = std::ranges::find(names, name);
  const auto place = static_cast<std::uint32_t>(known - names.begin());
  if (known == names.end()) names.push_back(name);
  return place;
}

}  // namespace

Size size_of(const RenderSettings& settings) { return {settings.width, settings.height}; }

void drop_data(JobFrame& frame) {
  frame.scene_bytes.reset();
  frame.assets.clear();
}

bool has_ended(const Job& job) {
  return job.state == JobState::done || job.state == JobState::cancelled || job.state == JobState::failed;
}

std::uint64_t film_bytes(const JobFrame& frame) {
  const Size size = frame.canvas->size;
  return std::uint64_t{size.width} * size.height * 3 * sizeof(float);
}

bool wants_workers(const Job& job) {
  return (job.state == JobState::waiting || job.state == JobState::running) && !job.open.empty();
}

const JobFrame* frame_of(const Job& job, std::optional<std::uint32_t> number) {
  const FrameRange& range = job.spec.frames.value();
  const auto place = range.index_of(number.value_or(range.first));
  return place && *place < job.frames.size() ? &job.frames[*place] : nullptr;
}

JobFrame& frame_at(Job& job, std::uint32_t number) {
  return job.frames.at(job.spec.frames->index_of(number).value());
}

RenderSettings settings_of(const Job& job, const JobFrame& frame) {
  RenderSettings settings = job.spec.settings;
  settings.frame = frame.number;
  return settings;
}

std::string title_of(const Job& job) {
  const std::string number = "job " + std::to_string(static_cast<std::uint64_t>(job.id));
  return job.spec.name.empty() ? number : number + " (" + job.spec.name + ")";
}

std::string title_of(const Job& job, const JobFrame& frame) {
  if (job.spec.frames->count() == 1) return title_of(job);
  return "frame " + std::to_string(frame.number) + " of " + title_of(job);
}

std::string count_of_tiles(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " tile" : " tiles");
}

namespace {

std::uint64_t pixels_of(const RenderSettings& settings) {
  return std::uint64_t{settings.width} * settings.height;
}

/// With what is no longer kept of it.
std::string message_of(const Job& job) {
  if (job.frames_dropped == 0) return job.message;
  const std::string lost =
      job.spec.frames->count() == 1
          ? "its picture is no longer kept"
          : "of its pictures the " + std::to_string(job.frames_dropped) + " oldest are no longer kept";
  return job.message.empty() ? lost : job.message + "; " + lost;
}

}  // namespace

bool is_complete(const Job& job, const JobFrame& frame) {
  return frame.pixels_done == pixels_of(job.spec.settings);
}

JobView view_of(const Job& job, FarmTime now) {
  const JobSpec& spec = job.spec;
  JobView view;
  view.id = job.id;
  view.name = spec.name, view.output = spec.output, view.scene_hash = job.frames.front().scene_hash;
  view.message = message_of(job);
  view.state = job.state;
  view.priority = spec.priority;
  view.settings = spec.settings, view.parameters = spec.parameters;
  view.frames = *spec.frames;
  view.frames_sent = static_cast<std::uint32_t>(job.frames.size());
  view.frames_done = job.frames_done;
  if (job.first_unfinished < spec.frames->count()) view.current_frame = spec.frames->at(job.first_unfinished);
  view.last_done = job.last_done;
  view.pixels_done = job.pixels_done;
  view.pixels_total = pixels_of(spec.settings) * spec.frames->count();
  view.counters = job.counters;
  view.submitted = job.submitted;
  view.waited = job.started.value_or(job.ended.value_or(now)) - job.submitted;
  view.thread_time = job.thread_time;
  if (job.started) view.elapsed = job.ended.value_or(now) - *job.started;
  if (job.state == JobState::running) view.eta = job.pace.time_for(view.pixels_total - view.pixels_done, now);
  view.tiles_given_back = job.tiles_given_back, view.tiles_doubled = job.tiles_doubled;
  view.verification = spec.verification, view.tiles_checked = job.tiles_checked;
  view.tiles_shared = job.tiles_shared;
  view.time_wasted = job.time_wasted, view.rays_wasted = job.rays_wasted;
  return view;
}

FrameView view_of(const Job& job, std::uint32_t place, FarmTime now) {
  FrameView view;
  view.frame = job.spec.frames->at(place);
  view.pixels_total = pixels_of(job.spec.settings);
  view.is_final = has_ended(job);
  view.state = job.state == JobState::running ? JobState::waiting : job.state;
  view.waited = job.ended.value_or(now) - job.submitted;
  if (place >= job.frames.size()) return view;

  const JobFrame& frame = job.frames[place];
  if (frame.canvas) view.state = job.state;
  if (is_complete(job, frame)) view.state = JobState::done, view.done = frame.ended;
  view.losses = frame.losses;
  view.scene_hash = frame.scene_hash;
  view.is_kept = frame.canvas.has_value();
  view.pixels_done = frame.pixels_done;
  view.counters = frame.counters, view.thread_time = frame.thread_time;
  if (!frame.started) return view;
  view.waited = *frame.started - job.submitted;
  view.elapsed = frame.ended.value_or(now) - *frame.started;
  return view;
}

std::optional<std::string> fault_of(const std::vector<PassImage>& images, const Tile& area, PassSet passes) {
  PassSet delivered = 0;
  for (const PassImage& image : images) {
    if (image.pass < 0 || image.pass >= pass_count)
      return "pass " + std::to_string(image.pass) + " does not exist";
    const auto bit = static_cast<PassSet>(1u << image.pass);
    if (delivered & bit) return "pass " + std::to_string(image.pass) + " came twice";
    delivered |= bit;
    const std::size_t floats = 3 * std::size_t{pixel_count(area, image.pass)};
    if (image.rgb.size() != floats)
      return "pass " + std::to_string(image.pass) + " has " + std::to_string(image.rgb.size()) +
             " floats, not " + std::to_string(floats);
    if (std::ranges::any_of(image.rgb, [](float value) { return !std::isfinite(value); }))
      return "pass " + std::to_string(image.pass) + " has pixels that are no numbers";
  }
  if (delivered != passes)
    return "passes " + std::to_string(delivered) + " came, not " + std::to_string(passes);
  return std::nullopt;
}

void commit(Job& job, JobFrame& frame, const Delivery& delivery, FarmTime now) {
  Canvas& canvas = *frame.canvas;
  Canvas::TileDeliveries& tile = canvas.deliveries[delivery.work.tile];
  const std::uint32_t by = place_of(delivery.by, canvas.deliverers);
  for (const PassImage& image : delivery.images) {
    canvas.film->put(delivery.work.tile, image);
    tile.by[image.pass] = by;
    tile.counters[image.pass] = image.counters;
    frame.counters += image.counters;
    job.counters += image.counters;
  }
  for (const NameId helper : delivery.helpers)
    canvas.parts[delivery.work.tile].push_back({delivery.work.passes, helper});
  tile.taken[std::countr_zero(delivery.work.passes)] = delivery.taken;
  frame.thread_time += delivery.taken;
  job.thread_time += delivery.taken;
  job.pixels_done += canvas.film->pixels_done() - frame.pixels_done;
  frame.pixels_done = canvas.film->pixels_done();
  canvas.schedule.finish(delivery.work);
  job.pace.advance(now, job.pixels_done);
}

namespace {

PassSet parts_by(const Canvas& canvas, std::uint32_t tile, NameId worker) {
  const auto parts = canvas.parts.find(tile);
  if (parts == canvas.parts.end()) return 0;
  PassSet passes = 0;
  for (const Canvas::Part& part : parts->second)
    if (part.by == worker) passes |= part.passes;
  return passes;
}

}  // namespace

PassesLost delivered_by(JobId job, const JobFrame& frame, NameId worker) {
  PassesLost all{{job, frame.number}, {}, {}};
  const Canvas& canvas = *frame.canvas;
  const auto by =
      static_cast<std::uint32_t>(std::ranges::find(canvas.deliverers, worker) - canvas.deliverers.begin());
  for (std::uint32_t tile = 0; tile < canvas.deliveries.size(); ++tile) {
    PassSet passes = 0;
    const PassSet parts = parts_by(canvas, tile, worker);
    for (int pass = 0; pass < pass_count; ++pass) {
      const auto bit = static_cast<PassSet>(1u << pass);
      const bool has_pixels = pixel_count(tile_at(canvas.size, tile), pass) > 0;
      const bool is_its = canvas.deliveries[tile].by[pass] == by || (parts & bit) != 0;
      if (!has_pixels || !(canvas.schedule.done(tile) & bit) || !is_its) continue;
      passes |= bit;
      all.counters += canvas.deliveries[tile].counters[pass];
    }
    if (passes != 0) all.lost.push_back({tile, passes});
  }
  return all;
}

void lose(const Job& job, JobFrame& frame, const PassesLost& damage) {
  for (const Work& work : damage.lost) {
    Canvas::TileDeliveries& tile = frame.canvas->deliveries[work.tile];
    for (int pass = 0; pass < pass_count; ++pass) {
      if (!(work.passes >> pass & 1)) continue;
      tile.counters[pass] = {};
      frame.thread_time -= std::exchange(tile.taken[pass], FarmTime{});
    }
    if (const auto parts = frame.canvas->parts.find(work.tile); parts != frame.canvas->parts.end())
      std::erase_if(parts->second,
                    [&](const Canvas::Part& part) { return (part.passes & work.passes) != 0; });
    frame.canvas->schedule.undo(work);
    frame.pixels_done -= pixels_in(work, job.spec.settings);
  }
  frame.counters = frame.counters - damage.counters;
  ++frame.losses;
}

double expected_rays(const Job& job, const JobFrame& frame, const Work& work) {
  const RenderSettings& settings = job.spec.settings;
  const std::uint32_t columns = (settings.width + tile_side - 1) / tile_side;
  const std::uint32_t rows = (settings.height + tile_side - 1) / tile_side;
  const std::uint32_t column = work.tile % columns, row = work.tile / columns;
  std::uint64_t rays = 0, pixels = 0;
  for (std::uint32_t y = row - std::min(row, 1u); y <= std::min(row + 1, rows - 1); ++y)
    for (std::uint32_t x = column - std::min(column, 1u); x <= std::min(column + 1, columns - 1); ++x) {
      const std::uint32_t tile = y * columns + x;
      for (const RayCounters& counters : frame.canvas->deliveries[tile].counters) rays += counters.rays();
      pixels += pixels_in({tile, frame.canvas->schedule.done(tile)}, settings);
    }
  if (pixels == 0) rays = frame.counters.rays(), pixels = frame.pixels_done;
  if (pixels == 0) rays = job.counters.rays(), pixels = job.pixels_done;
  if (pixels == 0) return 0;
  return static_cast<double>(rays) / static_cast<double>(pixels) *
         static_cast<double>(pixels_in(work, settings));
}

std::uint64_t pixels_in(const Work& work, const RenderSettings& settings) {
  const Tile tile = tile_at(size_of(settings), work.tile);
  std::uint64_t pixels = 0;
  for (int pass = 0; pass < pass_count; ++pass)
    if (work.passes & 1u << pass) pixels += pixel_count(tile, pass);
  return pixels;
}

std::optional<NameId> contradicted(const Canvas& canvas, std::uint32_t tile, const Tile& area,
                                   const std::vector<PassImage>& images) {
  for (const PassImage& image : images) {
    if (!(canvas.schedule.done(tile) & 1u << image.pass)) continue;
    const std::vector<float> committed = canvas.film->pass_pixels(area, image.pass);
    // Bytes, not numbers: -0 and 0 differ, a NaN equals itself.
    if (std::memcmp(committed.data(), image.rgb.data(), committed.size() * sizeof(float)) != 0)
      return canvas.deliverers[canvas.deliveries[tile].by[image.pass]];
  }
  return std::nullopt;
}

}  // namespace rayfarm
