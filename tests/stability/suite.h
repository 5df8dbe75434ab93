// The stability suite: cases where methods fail, each swept along what drives the failure, with ground truth.
//
// A cell is one method of a case at one value of its driver. Its rays come in batches, each with a seed that
// depends on case, driver and batch alone: all methods of a case see the same rays, and no thread shows in a
// number. A method counts its failures; ours must stay within what it is allowed.
//
// Adding a case: a function that returns it (or several) in a file of its own, declared in cases.h, one line
// in cases.cpp.
#pragma once
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "master/charts/stability_table.h"

namespace rayfarm::stability {

/// Some of a cell's rays.
struct Batch {
  double driver = 0;
  std::uint64_t number = 0;  // within the cell, from 0
  std::uint64_t rays = 0;
  std::uint64_t seed = 0;
};

struct Tally {
  std::uint64_t rays = 0, failures = 0;
  Tally& operator+=(const Tally& o) {
    rays += o.rays, failures += o.failures;
    return *this;
  }
};

/// Traces a batch; called by several threads at once. What it counts may be another number than batch.rays.
using RunBatch = std::function<Tally(const Batch&)>;

struct Method {
  std::string name;    // "ours", "exact equality", "absolute 1e-4" ...
  std::string number;  // "double", "float"
  RunBatch run;
  std::optional<double> allowed;  // failures a ray up to which it passes; none: shown for comparison
};

/// How many rays a cell has.
struct CellSize {
  std::uint64_t rays = 100'000, long_rays = 100'000'000;  // of the CI-sized and of the long suite
  std::uint64_t batch = 1'000;
};

struct Case {
  std::string name;         // "S13 sphere": its number in the list of cases, then which
  std::string title;        // under 45 letters, a chart's title
  std::string driver_name;  // an axis label
  std::vector<double> sweep;
  std::vector<Method> methods;
  CellSize size{};
};

/// A method that is given rays one by one: fails(driver, random) says whether the next one went wrong.
template <class Random, class Fails>
RunBatch ray_by_ray(Fails fails) {
  return [fails](const Batch& batch) {
    Random random(batch.seed);
    Tally tally;
    for (; tally.rays < batch.rays; ++tally.rays) tally.failures += fails(batch.driver, random);
    return tally;
  };
}

struct SuiteOptions {
  bool is_long = false;
  unsigned threads = 1;
  std::string only{};  // cases whose names begin so
};

/// All cells of the cases; in the long suite methods that are only compared get a hundredth of the rays.
/// `finished(row)` hears of each cell, in order.
std::vector<StabilityRow> run_suite(const std::vector<Case>& cases, const SuiteOptions& options,
                                    const std::function<void(const StabilityRow&)>& finished);

}  // namespace rayfarm::stability
