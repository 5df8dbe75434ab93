#include "tests/support/farm_thread.h"

#include <future>
#include <map>
#include <memory>

#include "common/net/codec.h"
#include "common/render/render.h"

namespace rayfarm {
namespace {

FarmTime now() { return std::chrono::steady_clock::now().time_since_epoch(); }

/// What a worker knows: its scenes and frames.
struct Renderer {
  WorkerId id{};
  int tiles_left = 0;
  std::map<std::string, std::shared_ptr<const World>> worlds;
  std::map<FrameId, FrameStart> frames;

  Result render(const Assignment& a) const {
    const FrameStart& frame = frames.at({a.job, a.frame});
    auto images =
        render_tile(*worlds.at(frame.scene_hash), frame.settings, a.tile, a.passes, [] { return false; });
    return {a.lease, a.job, a.frame, a.tile, std::move(*images), 0.001};
  }
};

}  // namespace

FarmThread::FarmThread(FarmLimits limits) : farm_(limits), thread_([this] { work(); }) {}

FarmThread::~FarmThread() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    tasks_.clear();
  }
  news_.notify_one();
}

void FarmThread::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    news_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
    if (ended_) return;
    const Task task = std::move(tasks_.front());
    tasks_.pop_front();
    lock.unlock();
    task(farm_, now());
    lock.lock();
  }
}

void FarmThread::post(Task task) {
  const std::lock_guard lock(mutex_);
  if (ended_) return;
  tasks_.push_back(std::move(task));
  news_.notify_one();
}

void FarmThread::run(const Task& task) {
  std::promise<void> done;
  post([&](Farm& farm, FarmTime time) {
    task(farm, time);
    done.set_value();
  });
  done.get_future().wait();
}

void FarmThread::add_renderer(const std::string& name, int tiles) {
  const auto renderer = std::make_shared<Renderer>();
  renderer->tiles_left = tiles;
  const auto send = [this, renderer](ToWorker message) {
    if (const auto* scene = std::get_if<SceneData>(&message))
      renderer->worlds[scene->hash] = std::make_shared<const World>(decode_scene(*scene->bytes));
    if (const auto* start = std::get_if<FrameStart>(&message))
      renderer->frames[{start->job, start->settings.frame}] = *start;
    if (const auto* assignment = std::get_if<Assignment>(&message))
      post([renderer, a = *assignment](Farm& farm, FarmTime time) {
        if (renderer->tiles_left-- > 0) farm.receive(renderer->id, renderer->render(a), time);
      });
  };
  run([&](Farm& farm, FarmTime time) {
    renderer->id = farm.add_worker({.name = name, .address = {}, .cpu = {}, .version = {}}, send, time);
  });
}

void FarmThread::add_idler(const std::string& name) {
  run([&](Farm& farm, FarmTime time) {
    farm.add_worker(
        {.name = name, .address = {}, .cpu = {}, .version = {}}, [](const ToWorker&) {}, time);
  });
}

}  // namespace rayfarm
