// A master with a thousand workers over TLS: what each costs in memory, and how many tiles a second go out to them and
// come back when nobody renders (black tiles, which zstd makes into nothing: assignment, encryption, checks, film).
// The workers are one other process, which shares the PC's processors with the master.
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/daemon/system.h"
#include "common/net/connection.h"
#include "common/net/until_first_ends.h"
#include "common/work/engine.h"
#include "tests/support/farm_jobs.h"
#include "tests/support/farm_keys.h"
#include "tests/support/master_thread.h"

namespace rayfarm {
namespace {

using Clock = std::chrono::steady_clock;

constexpr RenderSettings settings{.width = 100 * tile_side, .height = 50 * tile_side, .spp = 1};
constexpr int repetitions = 5;

std::vector<PassImage> black_tile() {
  std::vector<PassImage> images;
  for (int pass = 0; pass < pass_count; ++pass)
    images.push_back({pass, std::vector<float>(3 * pixel_count({0, 0, tile_side, tile_side}, pass)), {}});
  return images;
}

// The workers. ---------------------------------------------------------------------------------------------

asio::awaitable<void> deliver(MasterConnection& connection, const std::vector<PassImage>& images) {
  for (;;) {
    const ToWorker message = co_await connection.receive();
    const auto* a = std::get_if<Assignment>(&message);
    if (a) connection.post(Result{a->lease, a->job, a->frame, a->tile, images, 0.001});
  }
}

asio::awaitable<void> work_once(Address master, Security security, std::string name,
                                const std::vector<PassImage>& images) {
  auto dialling = dial(master, std::move(security), std::chrono::seconds(60));
  Channel channel = co_await std::move(dialling);
  MasterConnection connection(std::move(channel), {});
  connection.post(Hello{
      {protocol_version, oldest_protocol_version, 0}, RAYFARM_VERSION, name, "", 1, engine_fingerprint()});
  auto loops = until_first_ends(connection.tend(), deliver(connection, images));
  co_await std::move(loops);
}

/// Comes back when it is lost, as workers do.
asio::awaitable<void> work(Address master, Security security, std::string name,
                           const std::vector<PassImage>& images) {
  asio::steady_timer pause(co_await asio::this_coro::executor);
  Backoff backoff({}, std::hash<std::string>{}(name));
  for (;;) {
    try {
      auto working = work_once(master, security, name, images);
      co_await std::move(working);
    } catch (const ConnectionLost&) {}
    pause.expires_after(backoff.next());
    co_await pause.async_wait(asio::use_awaitable);
  }
}

/// Never returns: it is killed with its parent.
[[noreturn]] void be_the_crowd(int addresses, int count, const FarmKeys& keys) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::uint16_t port = 0;
  if (::read(addresses, &port, sizeof port) != sizeof port) std::_Exit(1);
  const std::vector<PassImage> images = black_tile();
  const Security security = keys.of_worker("crowd");
  asio::io_context io;
  const auto keep = asio::make_work_guard(io);
  for (int i = 0; i < count; ++i)
    asio::co_spawn(io, work({"127.0.0.1", port}, security, "pc" + std::to_string(i), images), asio::detached);
  io.run();
  std::_Exit(0);
}

// The master. ----------------------------------------------------------------------------------------------

/// Bytes that are in memory.
double resident() {
  std::size_t total = 0, pages = 0;
  std::ifstream("/proc/self/statm") >> total >> pages;
  return static_cast<double>(pages) * static_cast<double>(::sysconf(_SC_PAGESIZE));
}

double processor_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Run {
  double seconds, master_seconds;  // wall; processor time of the master alone
};

Run run_a_job(MasterThread& master) {
  const auto begin = Clock::now();
  const double used = processor_seconds();
  const JobId job =
      master.ask([](Farm& farm, FarmTime now) { return farm.submit(simple_job(settings), now); });
  while (master.ask([&](Farm& farm, FarmTime now) { return farm.job(job, now); })->state != JobState::done)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return {std::chrono::duration<double>(Clock::now() - begin).count(), processor_seconds() - used};
}

void measure(int count, const FarmKeys& keys, int addresses) {
  const double before = resident();
  MasterThread master(DoorLimits{}, {"127.0.0.1", 0}, keys.of_master());
  const std::uint16_t port = master.address().port;
  const auto begin = Clock::now();
  if (::write(addresses, &port, sizeof port) != sizeof port) throw std::runtime_error("the crowd is gone");
  const auto present = [&] { return master.ask([](Farm& farm, FarmTime) { return farm.workers().size(); }); };
  while (present() < static_cast<std::size_t>(count))
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  const double connected = std::chrono::duration<double>(Clock::now() - begin).count();
  std::printf("%d workers over TLS: all in after %.2f s, %.1f kB of the master's memory each\n", count,
              connected, (resident() - before) / count / 1e3);

  std::vector<Run> runs;
  for (int i = 0; i < repetitions; ++i) runs.push_back(run_a_job(master));
  std::ranges::sort(runs, {}, &Run::seconds);
  const Run median = runs[repetitions / 2];
  const int tiles = tile_count({settings.width, settings.height});
  std::printf(
      "%d black tiles, median of %d runs (least to most: %.2f to %.2f s): %.0f tiles/s, "
      "%.0f us of the master's processor time each\n",
      tiles, repetitions, runs.front().seconds, runs.back().seconds, tiles / median.seconds,
      1e6 * median.master_seconds / tiles);
  std::printf("%zu workers are still there\n", present());
}

}  // namespace
}  // namespace rayfarm

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 1000;
  spdlog::set_level(spdlog::level::off);
  rayfarm::allow_many_descriptors();
  const rayfarm::FarmKeys keys;
  int addresses[2];
  if (::pipe(addresses) != 0) return 1;
  if (::fork() == 0) rayfarm::be_the_crowd(addresses[0], count, keys);
  rayfarm::measure(count, keys, addresses[1]);
}
