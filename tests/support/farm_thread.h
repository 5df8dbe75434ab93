// A farm on a thread of its own with workers that are lambdas: what stands behind an HTTP server in a test.
#pragma once
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

#include "master/farm.h"

namespace rayfarm {

class FarmThread {
 public:
  using Task = std::function<void(Farm&, FarmTime)>;

  explicit FarmThread(FarmLimits limits = {});
  ~FarmThread();  // tasks that have not begun are dropped
  FarmThread(const FarmThread&) = delete;
  FarmThread& operator=(const FarmThread&) = delete;

  /// May be called from any thread, also from a task; returns at once.
  void post(Task task);
  /// Runs the task on the farm's thread and waits for its end.
  void run(const Task& task);

  /// A worker that renders what it is given, really, on the farm's thread; so many tiles, then it is silent.
  void add_renderer(const std::string& name, int tiles = 1'000'000);
  /// A worker that takes work and never answers.
  void add_idler(const std::string& name);

 private:
  void work();

  Farm farm_;
  std::mutex mutex_;
  std::condition_variable news_;
  std::deque<Task> tasks_;
  bool ended_ = false;
  std::jthread thread_;
};

}  // namespace rayfarm
