#include "master/diagnostics/cloud.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "common/render/sampler.h"

namespace rayfarm {
namespace {

std::span<const std::uint8_t> bytes_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::uint8_t code_of(double share) {
  return static_cast<std::uint8_t>(255 * std::clamp(share, 0.0, 1.0) + 0.5);
}

std::optional<OccupiedVoxels> voxels_of(const CloudOptions& options) {
  return options.voxel > 0 ? std::optional<OccupiedVoxels>(options.voxel) : std::nullopt;
}

void thin(std::vector<PlyPoint>& points, OccupiedVoxels& voxels) {
  std::erase_if(points, [&](const PlyPoint& p) { return !voxels.take(p.position); });
}

}  // namespace

PlyPoint cloud_point(const Hit& hit) {
  const auto mirrored = [](const Vec3d& v) {
    return std::array{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(-v.z)};
  };
  return {mirrored(hit.point),
          mirrored(hit.normal),
          {code_of(hit.color.x), code_of(hit.color.y), code_of(hit.color.z)}};
}

CloudFile::CloudFile(const std::filesystem::path& file, const CloudOptions& options)
    : options_(options), file_(file), voxels_(voxels_of(options)) {
  file_.append(bytes_of(ply_header(options_.form, 0)));
}

void CloudFile::write(std::vector<PlyPoint>& points) {
  if (voxels_) thin(points, *voxels_);
  constexpr std::size_t at_once = 4096;  // few enough for the cache
  std::vector<std::uint8_t> bytes;
  for (std::span<const PlyPoint> rest = points; !rest.empty();
       rest = rest.subspan(std::min(at_once, rest.size()))) {
    bytes.clear();
    append_ply(options_.form, rest.first(std::min(at_once, rest.size())), bytes);
    file_.append(bytes);
  }
  count_ += points.size();
  points.clear();
}

/// The lock is given back meanwhile; whoever comes sees that somebody writes.
void CloudFile::write_unlocked(Lock& lock, std::vector<PlyPoint>& points) {
  is_writing_ = true;
  lock.unlock();
  try {
    write(points);
  } catch (...) {
    give_up();
    throw;
  }
  lock.lock();
  is_writing_ = false;
}

void CloudFile::add(std::uint32_t rank, std::vector<PlyPoint>& points) {
  Lock lock(mutex_);
  turn_.wait(lock, [&] { return gave_up_ || (rank == next_ && !is_writing_); });
  if (gave_up_) return points.clear();
  write_unlocked(lock, points);
}

void CloudFile::end(std::uint32_t rank, std::vector<PlyPoint> points) {
  Lock lock(mutex_);
  turn_.wait(lock, [&] { return gave_up_ || rank == next_ || waiting_ + points.size() <= most_waiting; });
  if (gave_up_) return;
  waiting_ += points.size();
  ended_[rank] = std::move(points);
  if (is_writing_) return;  // that thread goes on with these
  while (!ended_.empty() && ended_.begin()->first == next_) {
    std::vector<PlyPoint> now = std::move(ended_.begin()->second);
    ended_.erase(ended_.begin());
    waiting_ -= now.size();
    write_unlocked(lock, now);
    ++next_;
    turn_.notify_all();
  }
}

void CloudFile::give_up() {
  const std::lock_guard lock(mutex_);
  gave_up_ = true;
  turn_.notify_all();
}

std::uint64_t CloudFile::commit() {
  assert(ended_.empty() && !gave_up_ && "all ranks have ended");
  file_.put_at_start(bytes_of(ply_header(options_.form, count_)));
  file_.commit();
  return count_;
}

void CloudPart::add(RayKind kind, const Hit& hit) {
  if (kind != RayKind::primary && file_->options().visible_only) return;
  points_.push_back(cloud_point(hit));
  if (points_.size() >= CloudFile::part_size) file_->add(rank_, points_);
}

namespace {

/// The points of one ray after another.
struct HitList : IdleObserver {
  bool visible_only = false;
  std::vector<PlyPoint> points;

  void traced(RayKind kind, const Ray&, std::uint32_t, double, const std::optional<Hit>& hit) {
    if (hit && (kind == RayKind::primary || !visible_only)) points.push_back(cloud_point(*hit));
  }
};

}  // namespace

std::optional<std::vector<std::uint8_t>> small_cloud(const World& world, RenderSettings settings,
                                                     const CloudOptions& options, std::uint32_t most_points,
                                                     const std::function<bool()>& stop,
                                                     const std::function<void(double)>& progress) {
  constexpr std::uint64_t rays_per_point = 16;  // in a picture of little but background, or with large voxels
  settings.shadows = false;                     // they decide no ray that goes on
  Tracer<HitList> tracer(world, settings, HitList{{}, options.visible_only, {}});
  tracer.stop_when(std::cref(stop));  // also in the middle of a ray's tree
  std::optional<OccupiedVoxels> voxels = voxels_of(options);
  RenderSettings spread = settings;
  spread.sampler = SamplerKind::sobol;
  const PixelSampler places(spread, {0, 0});
  std::vector<PlyPoint> points;
  const std::uint64_t most_rays = most_points * rays_per_point;
  for (std::uint64_t ray = 0; ray < most_rays && points.size() < most_points; ++ray) {
    const auto number = static_cast<std::uint32_t>(ray);
    const Sample2D place = places.sample(number, 0);
    tracer.observer.points.clear();
    tracer.radiance(place.u * settings.width, place.v * settings.height,
                    [&](std::uint32_t light) { return places.sample(number, 1 + light); });
    if (tracer.is_stopped()) return std::nullopt;
    if (voxels) thin(tracer.observer.points, *voxels);
    const std::size_t room = most_points - points.size();
    const auto& found = tracer.observer.points;
    points.insert(points.end(), found.begin(),
                  found.begin() + static_cast<std::ptrdiff_t>(std::min(room, found.size())));
    if (ray % 4096 == 0)
      progress(std::max(static_cast<double>(points.size()) / most_points,
                        static_cast<double>(ray) / static_cast<double>(most_rays)));
  }
  const std::string header = ply_header(options.form, points.size());
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  append_ply(options.form, points, bytes);
  return bytes;
}

}  // namespace rayfarm
