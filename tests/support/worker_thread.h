// A whole worker on a thread of its own.
#pragma once
#include <asio/post.hpp>
#include <future>

#include "common/net/run_until_end.h"
#include "worker/worker.h"

namespace rayfarm {

/// No deadline within a test; back-off without waiting.
inline WorkerOptions patient_worker(std::string name) {
  using namespace std::chrono_literals;
  WorkerOptions options;
  options.identity = {std::move(name), "a test's CPU", 1};
  options.times = {{100ms, 60s, 60s}, 60s};
  options.backoff = {1ms, 10ms};
  return options;
}
inline WorkerOptions worker_for(const Address& master, std::string name) {
  WorkerOptions options = patient_worker(std::move(name));
  options.way = DialMaster{master};
  return options;
}

class WorkerThread {
 public:
  WorkerThread(WorkerOptions options, PrepareScene prepare)
      : worker_(io_, std::move(options), std::move(prepare)) {
    ended_ = std::async(std::launch::async, [this] { run_until_end(io_, worker_.run()); });
  }
  /// As kill -9 would: nobody is told.
  ~WorkerThread() { io_.stop(); }

  void stop() {
    asio::post(io_, [this] { worker_.stop(); });
  }
  /// Waits for the end of run(); throws what it threw.
  void wait_for_end() { ended_.get(); }
  Address listening_at() const { return *worker_.listening_at(); }

 private:
  asio::io_context io_;
  WorkerDaemon worker_;
  std::future<void> ended_;  // first to go: waits for the thread
};

}  // namespace rayfarm
