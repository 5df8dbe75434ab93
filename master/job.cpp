#include "master/job.h"

#include <algorithm>
#include <cstring>

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

bool has_ended(const Job& job) {
  return job.state == JobState::done || job.state == JobState::cancelled || job.state == JobState::failed;
}

std::uint64_t film_bytes(const Job& job) {
  return std::uint64_t{job.spec.settings.width} * job.spec.settings.height * 3 * sizeof(float);
}

bool wants_workers(const Job& job) {
  if (job.state != JobState::waiting && job.state != JobState::running) return false;
  return !job.canvas || job.canvas->schedule.has_waiting();
}

std::string title_of(const Job& job) {
  const std::string number = "job " + std::to_string(static_cast<std::uint64_t>(job.id));
  return job.spec.name.empty() ? number : number + " (" + job.spec.name + ")";
}

std::string count_of_tiles(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " tile" : " tiles");
}

JobView view_of(const Job& job, FarmTime now) {
  const JobSpec& spec = job.spec;
  JobView view;
  view.id = job.id;
  view.name = spec.name, view.output = spec.output, view.scene_hash = spec.scene_hash;
  view.message = job.message;
  view.state = job.state;
  view.priority = spec.priority;
  view.settings = spec.settings, view.parameters = spec.parameters;
  view.pixels_done = job.pixels_done;
  view.pixels_total = std::uint64_t{spec.settings.width} * spec.settings.height;
  view.counters = job.counters;
  view.submitted = job.submitted;
  view.waited = job.started.value_or(job.ended.value_or(now)) - job.submitted;
  view.thread_time = job.thread_time;
  if (job.started) view.elapsed = job.ended.value_or(now) - *job.started;
  if (job.state == JobState::running) view.eta = job.pace.time_for(view.pixels_total - view.pixels_done, now);
  view.tiles_given_back = job.tiles_given_back;
  return view;
}

std::optional<std::string> fault_of(const std::vector<PassImage>& images, Size film, const Work& work) {
  PassSet delivered = 0;
  for (const PassImage& image : images) {
    if (image.pass < 0 || image.pass >= pass_count)
      return "pass " + std::to_string(image.pass) + " does not exist";
    const auto bit = static_cast<PassSet>(1u << image.pass);
    if (delivered & bit) return "pass " + std::to_string(image.pass) + " came twice";
    delivered |= bit;
    const std::size_t floats = 3 * std::size_t{pixel_count(tile_at(film, work.tile), image.pass)};
    if (image.rgb.size() != floats)
      return "pass " + std::to_string(image.pass) + " has " + std::to_string(image.rgb.size()) +
             " floats, not " + std::to_string(floats);
  }
  if (delivered != work.passes)
    return "passes " + std::to_string(delivered) + " came, not " + std::to_string(work.passes);
  return std::nullopt;
}

void commit(Job& job, const Delivery& delivery, FarmTime now) {
  Canvas& canvas = *job.canvas;
  Canvas::TileDeliveries& tile = canvas.deliveries[delivery.work.tile];
  const std::uint32_t by = place_of(delivery.by, canvas.deliverers);
  for (const PassImage& image : delivery.images) {
    canvas.film->put(delivery.work.tile, image);
    tile.by[image.pass] = by;
    job.counters += image.counters;
  }
  tile.taken += delivery.taken;
  job.thread_time += delivery.taken;
  job.pixels_done = canvas.film->pixels_done();
  canvas.schedule.finish(delivery.work);
  job.pace.advance(now, job.pixels_done);
}

std::optional<NameId> contradicted(const Job& job, std::uint32_t tile, const std::vector<PassImage>& images) {
  const Canvas& canvas = *job.canvas;
  for (const PassImage& image : images) {
    if (!(canvas.schedule.done(tile) & 1u << image.pass)) continue;
    const std::vector<float> committed = canvas.film->pass_pixels(tile, image.pass);
    // Bytes, not numbers: -0 and 0 differ, a NaN equals itself.
    if (std::memcmp(committed.data(), image.rgb.data(), committed.size() * sizeof(float)) != 0)
      return canvas.deliverers[canvas.deliveries[tile].by[image.pass]];
  }
  return std::nullopt;
}

}  // namespace rayfarm
