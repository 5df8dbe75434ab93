// Work that no picture waits for: on threads of the lowest priority, as long as somebody asks for it.
//
// A task is made of parts. Nobody has asked for it for 30 s: its parts in work are stopped, and it rests until
// somebody asks again. Of several tasks the one that was asked for last is served first.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "master/diagnostics/layer.h"

namespace rayfarm {

/// A time since any fixed instant.
using Clock = std::function<std::chrono::nanoseconds()>;
std::chrono::nanoseconds steady_now();

constexpr auto interest_lasts = std::chrono::seconds(30);

/// How far a task is.
struct Standing {
  LayerProgress state = LayerProgress::making;
  double share_done = 0;  // of the parts, 0 to 1
  std::string message;    // why it failed
};

class Background {
 public:
  using Stop = std::function<bool()>;
  struct Work {
    std::uint32_t parts = 0;
    /// Called by several threads, for each part once until it has said true. False: stop() said so. What it
    /// throws ends the task, until it is asked for again after nobody has for a while.
    std::function<bool(std::uint32_t part, const Stop& stop)> do_part;
  };
  class Task;
  using TaskRef = std::shared_ptr<Task>;

  explicit Background(unsigned threads, Clock now = steady_now);
  ~Background();
  Background(const Background&) = delete;

  /// Parts in work are told, and no other is begun.
  void stop();

  /// Ends when the last one lets go of it. Nobody has asked for it yet.
  TaskRef add(Work work);
  /// Keeps it going.
  Standing ask(const TaskRef& task);

  /// One part of what is next, on the calling thread: how tests work without threads. False: there is nothing.
  bool work_once();

 private:
  struct Part {
    TaskRef task;
    std::uint32_t number = 0;
  };
  using Lock = std::unique_lock<std::mutex>;

  void work();
  std::optional<Part> next_part();
  void do_part(Lock& lock, Part part);
  bool is_wanted(const Task& task) const;

  const Clock now_;
  std::atomic<bool> ending_{false};

  std::mutex mutex_;  // guards what follows, and all tasks but what is atomic in them
  std::condition_variable news_;
  std::vector<std::weak_ptr<Task>> tasks_;
  std::uint64_t questions_ = 0;

  std::vector<std::jthread> threads_;  // last: they end before what they use
};

}  // namespace rayfarm
