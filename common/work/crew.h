// A worker without its network: what a master says goes in, results come out.
// The worker daemon is a crew behind a connection; the master's own threads are a crew beside the farm.
#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/net/messages.h"
#include "common/work/tile_renderer.h"

namespace rayfarm {

/// Threads that render assignments in the order in which they came. A scene is checked against its hash and
/// made ready once, by one of the threads, for all frames that show it.
///
/// Each lease ends in exactly one of: a Result, a GiveBack that says why it cannot be rendered, a Revoke or
/// FrameEnd, the list that stop_taking() or abandon() returns, begin().
class Crew {
 public:
  /// Called by the crew's threads, one at a time; must return soon and not call the crew.
  using Answer = std::function<void(ToMaster)>;

  /// `prepare` is called by several threads at once.
  explicit Crew(unsigned threads, PrepareScene prepare = prepare_scene);
  /// Stops within a sample (or the preparation of a scene).
  ~Crew();
  Crew(const Crew&) = delete;

  /// A new master, before anything is taken: all jobs, scenes and leases are forgotten, nothing more is
  /// answered to the old one.
  void begin(Answer answer);

  void take(const AssetData& asset);
  void take(const AssetEnd& end);
  void take(const SceneData& scene);
  void take(const FrameStart& start);
  void take(const Assignment& assignment);
  void take(const Revoke& revoke);
  void take(const FrameEnd& end);

  /// The leases that were not begun, which now will not be, nor those that are still to come.
  std::vector<LeaseId> stop_taking();
  /// All leases; those in work are stopped within a sample.
  std::vector<LeaseId> abandon();

 private:
  /// Decoded once, by the first scene that shows it.
  struct AssetState {
    AssetData data;
    std::once_flag once;
    Asset asset;
    const Asset& decoded();
  };
  using Assets = std::vector<std::shared_ptr<AssetState>>;
  struct SceneState {
    SceneData data;
    bool preparing = false;
    TileRenderer renderer;  // once it is ready, unless
    std::string fault;      // says why it cannot be
    bool is_settled() const { return renderer || !fault.empty(); }
  };
  struct Frame {
    RenderSettings settings;
    std::shared_ptr<SceneState> scene;
    Assets assets;
  };
  using Stop = std::shared_ptr<std::atomic<bool>>;
  using Lock = std::unique_lock<std::mutex>;

  void work();
  bool work_once(Lock& lock);
  void prepare(Lock& lock, const Frame& frame);
  static TileRenderer made_ready(const SceneData& scene, const Assets& assets, const PrepareScene& prepare);
  void render(Lock& lock, const Assignment& assignment, const Frame& frame);
  void give_back(LeaseId lease, std::string reason);
  void discard(std::shared_ptr<void> scene_or_asset);
  std::vector<LeaseId> drop_waiting();
  std::vector<LeaseId> stop_running();

  const PrepareScene prepare_;

  // Guarded by mutex_. Invariant: a lease is waiting, running or not ours, and a running one not in two
  // threads.
  std::mutex mutex_;
  std::condition_variable changed_;
  Answer answer_;
  bool taking_ = true, ending_ = false;
  std::map<std::string, std::shared_ptr<SceneState>> scenes_;  // by hash
  std::map<std::string, std::shared_ptr<AssetState>> assets_;  // by hash
  std::map<FrameId, Frame> frames_;
  std::deque<Assignment> waiting_;
  std::map<LeaseId, Stop> running_;
  std::vector<std::shared_ptr<void>> discarded_;  // freed by a thread of ours: that takes long

  std::vector<std::jthread> threads_;  // last: the threads end before what they use
};

}  // namespace rayfarm
