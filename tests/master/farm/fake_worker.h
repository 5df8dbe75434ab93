// A worker without a network: it records what the farm sends, and renders a made-up picture.
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "master/farm.h"

namespace rayfarm {

/// What the fake workers "render": a different value for each frame, pixel and channel.
float made_up_value(FrameId frame, std::uint32_t x, std::uint32_t y, int channel);
/// What a worker was asked for.
struct HeldAssignment : Assignment {
  std::optional<Tile> piece{};  // none: the whole tile
};
/// What an honest worker answers to an assignment.
Result rendered(const Assignment& assignment, Size film, double seconds = 1);
PieceResult rendered_piece(const HeldAssignment& assignment, double seconds = 1);
/// The whole picture, as the farm's film must be in the end.
ZeroedVector<float> made_up_picture(JobId job, Size film, std::uint32_t frame = 0);
/// What the counters of a whole picture must sum up to.
RayCounters made_up_counters(Size film);

JobSpec job_of(Size film, std::string name = "picture", std::string scene_hash = "scene");
/// The frame's scene comes; all have the same size.
bool add_frame(Farm& farm, JobId job, std::uint32_t frame, FarmTime now = {});

class FakeWorker {
 public:
  FakeWorker(Farm& farm, WorkerInfo info, FarmTime now = {});

  WorkerId id() const { return id_; }
  /// What it was sent since the last call, but assignments and Revoke, which held() reflects.
  std::vector<ToWorker> take_messages();
  /// The assignments it holds, in the order in which they came.
  const std::vector<HeldAssignment>& held() const;
  /// Renders and hands in its first assignment. The farm believes no more seconds than went by.
  void finish_one(FarmTime now = {}, double seconds = 1);
  void finish_all(FarmTime now = {});
  /// The lease is no longer held; nothing is said to the farm.
  void drop(LeaseId lease);
  std::string name() const;

 private:
  struct Desk;  // what the farm's messages change; it outlives the worker, as the farm may still send
  Farm* farm_;
  std::shared_ptr<Desk> desk_;
  WorkerId id_{};
};

}  // namespace rayfarm
