#include "master/cli/local_render.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "common/render/render.h"

namespace rayfarm {
namespace {

constexpr auto progress_interval = std::chrono::milliseconds(100);

/// What the threads share. `next` alone is touched without the mutex.
struct Work {
  std::vector<std::uint32_t> tiles;
  std::atomic<std::size_t> next{0};

  std::mutex mutex;
  std::condition_variable thread_ended;
  LocalRender result;
  unsigned threads_left = 0;
  bool stopped = false;
  std::exception_ptr failure;
};

void render_tiles(Work& work, const World& world, const RenderSettings& settings,
                  const std::function<bool()>& stop) {
  for (std::size_t i = work.next++; i < work.tiles.size(); i = work.next++) {
    const auto images = render_tile(world, settings, work.tiles[i], all_passes, stop);
    const std::lock_guard lock(work.mutex);
    if (!images) work.stopped = true;
    if (work.stopped || work.failure) return;
    for (const PassImage& image : *images) {
      work.result.film.put(work.tiles[i], image);
      work.result.counters += image.counters;
    }
  }
}

void run_thread(Work& work, const World& world, const RenderSettings& settings,
                const std::function<bool()>& stop) {
  std::exception_ptr failure;
  try {
    render_tiles(work, world, settings, stop);
  } catch (...) {
    failure = std::current_exception();
  }
  const std::lock_guard lock(work.mutex);
  if (failure) work.failure = failure;
  --work.threads_left;
  work.thread_ended.notify_one();
}

}  // namespace

std::optional<LocalRender> render_locally(const World& world, const RenderSettings& settings,
                                          unsigned threads, const std::function<bool()>& stop,
                                          const std::function<void(const Film&)>& progress) {
  const Size size{settings.width, settings.height};
  Work work;
  work.tiles = centre_first(size);
  work.result.film = Film(size);
  work.threads_left = threads;
  {
    std::vector<std::jthread> pool;
    for (unsigned i = 0; i < threads; ++i)
      pool.emplace_back([&] { run_thread(work, world, settings, stop); });

    std::unique_lock lock(work.mutex);
    while (work.threads_left > 0) {
      work.thread_ended.wait_for(lock, progress_interval);
      progress(work.result.film);
    }
  }
  if (work.failure) std::rethrow_exception(work.failure);
  if (work.stopped) return std::nullopt;
  return std::move(work.result);
}

}  // namespace rayfarm
