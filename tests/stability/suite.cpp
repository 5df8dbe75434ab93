#include "tests/stability/suite.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <exception>
#include <mutex>
#include <thread>

#include "common/math/hash.h"

namespace rayfarm::stability {
namespace {

std::uint64_t seed_of(const Case& c, double driver) {
  std::uint64_t key = keyed(0, std::bit_cast<std::uint64_t>(driver));
  for (const char letter : c.name) key = keyed(key, static_cast<unsigned char>(letter));
  return key;
}

Tally run_cell(const Case& c, const Method& method, double driver, std::uint64_t rays, unsigned threads) {
  const std::uint64_t seed = seed_of(c, driver), batches = (rays + c.size.batch - 1) / c.size.batch;
  std::atomic<std::uint64_t> next = 0;
  std::mutex mutex;  // guards total and fault
  Tally total;
  std::exception_ptr fault;
  const auto work = [&] {
    Tally tally;
    try {
      for (std::uint64_t b = next++; b < batches; b = next++) {
        const std::uint64_t first = b * c.size.batch;
        tally += method.run({driver, b, std::min(c.size.batch, rays - first), keyed(seed, b)});
      }
    } catch (...) {
      next = batches;
      const std::lock_guard lock(mutex);
      fault = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    total += tally;
  };
  {
    std::vector<std::jthread> crew;
    for (unsigned i = 1; i < threads; ++i) crew.emplace_back(work);
    work();
  }
  if (fault) std::rethrow_exception(fault);
  return total;
}

}  // namespace

std::vector<StabilityRow> run_suite(const std::vector<Case>& cases, const SuiteOptions& options,
                                    const std::function<void(const StabilityRow&)>& finished) {
  std::vector<StabilityRow> rows;
  for (const Case& c : cases) {
    if (!c.name.starts_with(options.only)) continue;
    for (const Method& method : c.methods)
      for (const double driver : c.sweep) {
        // A rate far from zero needs no more rays to be seen.
        const std::uint64_t long_rays = method.allowed ? c.size.long_rays : c.size.long_rays / 100;
        const std::uint64_t rays = options.is_long ? std::max(c.size.rays, long_rays) : c.size.rays;
        const Tally tally = run_cell(c, method, driver, rays, options.threads);
        rows.push_back({c.name, c.title, c.driver_name, method.name, method.number, driver, tally.rays,
                        tally.failures, method.allowed});
        finished(rows.back());
      }
  }
  return rows;
}

}  // namespace rayfarm::stability
