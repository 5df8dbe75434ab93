// The surface points that a render's rays met, as a cloud: where they are, which way they face, their colour.
#pragma once
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <optional>

#include "common/render/settings.h"
#include "common/render/trace.h"
#include "master/diagnostics/voxels.h"
#include "master/files/atomic_write.h"
#include "master/files/ply.h"

namespace rayfarm {

struct CloudOptions {
  PlyForm form = PlyForm::binary;
  double voxel = 0;           // at most one point in each cube of this size; 0: all points
  bool visible_only = false;  // where primary rays ended, not reflected and refracted ones
  bool operator==(const CloudOptions&) const = default;
};

/// The surface's colour without light, as the original renderer has it, but rounded.
PlyPoint cloud_point(const Hit& hit);

/// A cloud's file. Many threads give it the points of parts of the picture, ranks 0, 1, 2 ... to the last; the
/// file has them in the order of ranks whoever came first. Memory is bounded: what comes too early waits, up to
/// `most_waiting` points, and then its thread does. So ranks must be begun in their order.
class CloudFile {
 public:
  static constexpr std::size_t most_waiting = 2'000'000;
  static constexpr std::size_t part_size = 200'000;  // points that a thread should keep at most

  CloudFile(const std::filesystem::path& file, const CloudOptions& options);

  /// Some of a rank's points, when it is its turn; `points` is empty afterwards.
  void add(std::uint32_t rank, std::vector<PlyPoint>& points);
  /// The last of a rank's points.
  void end(std::uint32_t rank, std::vector<PlyPoint> points);
  /// There will be no file: nobody waits any more.
  void give_up();
  /// All ranks have ended: the file takes its place. Returns its number of points.
  std::uint64_t commit();

  const CloudOptions& options() const { return options_; }

 private:
  using Lock = std::unique_lock<std::mutex>;
  void write(std::vector<PlyPoint>& points);
  void write_unlocked(Lock& lock, std::vector<PlyPoint>& points);

  const CloudOptions options_;
  AtomicFile file_;
  std::optional<OccupiedVoxels> voxels_;
  std::uint64_t count_ = 0;  // points written

  std::mutex mutex_;  // guards what follows; what stands above belongs to the thread that writes
  std::condition_variable turn_;
  std::uint32_t next_ = 0;  // the rank whose points are written now
  bool is_writing_ = false, gave_up_ = false;
  std::map<std::uint32_t, std::vector<PlyPoint>> ended_;  // ranks that wait for their turn
  std::size_t waiting_ = 0;                               // their points
};

/// One rank's points as they come.
class CloudPart {
 public:
  CloudPart(CloudFile& file, std::uint32_t rank) : file_(&file), rank_(rank) {}
  /// Out of line, so that the tracer's code stays as it is for who watches nothing.
  void add(RayKind kind, const Hit& hit);
  void end() { file_->end(rank_, std::move(points_)); }

 private:
  CloudFile* file_;
  std::uint32_t rank_;
  std::vector<PlyPoint> points_;
};

/// An observer that also notes all hits.
template <class Observer>
struct WithCloud : Observer {
  CloudPart* part = nullptr;

  void traced(RayKind kind, const Ray& ray, std::uint32_t depth, double importance,
              const std::optional<Hit>& hit) {
    Observer::traced(kind, ray, depth, importance, hit);
    if (hit) part->add(kind, *hit);
  }
};

/// A whole PLY file of at most so many points, by rays spread evenly over the picture (not those of its
/// samples); fewer where there is too little to meet. Nothing when stop() said so; progress hears 0 to 1.
std::optional<std::vector<std::uint8_t>> small_cloud(const World& world, RenderSettings settings,
                                                     const CloudOptions& options, std::uint32_t most_points,
                                                     const std::function<bool()>& stop,
                                                     const std::function<void(double)>& progress);

}  // namespace rayfarm
