#include "common/work/each_tile.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace rayfarm {
namespace {

constexpr auto progress_interval = std::chrono::milliseconds(100);

/// What the threads share.
struct Tiles {
  std::vector<std::uint32_t> numbers;
  std::atomic<std::size_t> next{0};
  std::atomic<bool> stopped{false};

  std::mutex mutex;  // guards what follows
  std::condition_variable thread_ended;
  unsigned threads_left = 0;
  std::exception_ptr failure;
};

void run_thread(Tiles& tiles, const std::function<bool(std::uint32_t)>& work) {
  std::exception_ptr failure;
  try {
    for (std::size_t i = tiles.next++; i < tiles.numbers.size() && !tiles.stopped; i = tiles.next++)
      if (!work(tiles.numbers[i])) tiles.stopped = true;
  } catch (...) {
    failure = std::current_exception();
    tiles.stopped = true;
  }
  const std::lock_guard lock(tiles.mutex);
  if (failure) tiles.failure = failure;
  --tiles.threads_left;
  tiles.thread_ended.notify_one();
}

}  // namespace

bool each_tile(Size film, unsigned threads, const std::function<bool(std::uint32_t)>& work,
               const std::function<void()>& progress) {
  Tiles tiles;
  tiles.numbers = centre_first(film);
  tiles.threads_left = threads;
  {
    std::vector<std::jthread> pool;
    for (unsigned i = 0; i < threads; ++i) pool.emplace_back([&] { run_thread(tiles, work); });

    std::unique_lock lock(tiles.mutex);
    while (tiles.threads_left > 0) {
      tiles.thread_ended.wait_for(lock, progress_interval);
      lock.unlock();
      progress();
      lock.lock();
    }
  }
  if (tiles.failure) std::rethrow_exception(tiles.failure);
  return !tiles.stopped;
}

}  // namespace rayfarm
