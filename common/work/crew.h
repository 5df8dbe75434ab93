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
/// FrameEnd, the list that stop_taking() or abandon() returns, lose_master().
///
/// What was held when the master was lost goes on being rendered, and is kept: an assignment of the next master that asks
/// for the same pixels, by the content of scene and settings, is answered with it. So are the last few results, which
/// the old master may not have got. Pieces of tiles are not kept: they are small.
class Crew {
 public:
  /// Called by the crew's threads, one at a time; must return soon and not call the crew.
  using Answer = std::function<void(ToMaster)>;

  /// `prepare` is called by several threads at once.
  explicit Crew(unsigned threads, PrepareScene prepare = prepare_scene);
  /// Stops within a sample (or the preparation of a scene).
  ~Crew();
  Crew(const Crew&) = delete;

  /// A new master, before anything is taken: it has told us of no job or scene; nothing more is answered to the old one,
  /// which is lost.
  void begin(Answer answer);
  void lose_master();
  /// What is kept of lost masters' work, the oldest first.
  std::vector<HeldTile> kept();
  void forget_kept();

  void take(const AssetData& asset);
  void take(const AssetEnd& end);
  void take(const SceneData& scene);
  void take(const FrameStart& start);
  void take(const Assignment& assignment);
  void take(const PieceAssignment& piece);
  void take(const Revoke& revoke);
  void take(const FrameEnd& end);
  void take(const Unneeded& unneeded);

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
  enum class Progress { waiting, running, finished };
  struct Task {
    Assignment assignment;
    std::shared_ptr<const Frame> frame;
    Tile area;              // to be rendered: the tile, or
    bool is_piece = false;  // a piece of it
    bool is_kept = false;   // its master is lost
    Progress progress = Progress::waiting;
    std::atomic<bool> stop{false};
    std::vector<PassImage> images{};  // once it is finished
    double seconds = 0;
    Task(const Assignment& a, std::shared_ptr<const Frame> of, const Tile& of_it)
        : assignment(a), frame(std::move(of)), area(of_it) {}
  };
  using TaskPtr = std::shared_ptr<Task>;
  using Lock = std::unique_lock<std::mutex>;

  void work();
  bool work_once(Lock& lock);
  void prepare(Lock& lock, const Frame& frame);
  static TileRenderer made_ready(const SceneData& scene, const Assets& assets, const PrepareScene& prepare);
  void render(Lock& lock, const TaskPtr& task);
  void finish(const TaskPtr& task);
  void fail(const TaskPtr& task, std::string reason);
  /// The frame of an assignment that is to be rendered; null when its lease was given back.
  std::shared_ptr<const Frame> frame_for(const Assignment& assignment);
  void begin(const TaskPtr& task);
  void give_back(LeaseId lease, std::string reason);
  void discard(std::shared_ptr<void> what);
  void drop(const TaskPtr& task);
  void keep_all();
  void drop_kept();
  TaskPtr take_kept(const Assignment& assignment, const Frame& frame);

  const PrepareScene prepare_;

  // Guarded by mutex_.
  std::mutex mutex_;
  std::condition_variable changed_;
  Answer answer_;
  bool taking_ = true, ending_ = false;
  std::map<std::string, std::shared_ptr<SceneState>> scenes_;  // by hash
  std::map<std::string, std::shared_ptr<AssetState>> assets_;  // by hash
  std::map<FrameId, std::shared_ptr<const Frame>> frames_;
  std::map<LeaseId, TaskPtr> tasks_;              // exactly those whose leases have not ended
  std::deque<TaskPtr> kept_;                      // of lost masters
  std::deque<TaskPtr> waiting_;                   // exactly those of both that were not begun
  std::deque<TaskPtr> answered_;                  // the last ones; their leases have ended
  std::vector<std::shared_ptr<void>> discarded_;  // freed by a thread of ours: that takes long

  std::vector<std::jthread> threads_;  // last: the threads end before what they use
};

}  // namespace rayfarm
