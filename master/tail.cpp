#include "master/tail.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <queue>

namespace rayfarm {
namespace {

constexpr double seconds_of_unknown = 0.5;
constexpr double shortest_patience = 2, patience = 20;  // seconds, and times what was expected

template <class Value>
std::vector<std::size_t> greatest_first(std::span<const Value> values, double Value::*key) {
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, std::greater{}, [&](std::size_t i) { return values[i].*key; });
  return order;
}

}  // namespace

std::vector<std::size_t> latest_first(std::span<const Straggler> stragglers) {
  return greatest_first(stragglers, &Straggler::time_left);
}

double expected_seconds(double cost, double speed) {
  return cost > 0 && speed > 0 ? cost / speed : seconds_of_unknown;
}

std::vector<double> times_left(std::span<const HeldWork> held, std::uint32_t threads) {
  std::priority_queue<double, std::vector<double>, std::greater<>> free_at;
  std::vector<double> left;
  for (const HeldWork& work : held) {
    if (work.spent) {
      left.push_back(std::abs(work.expected - *work.spent));
    } else {
      const bool is_thread_free = free_at.size() < threads;
      left.push_back((is_thread_free ? 0 : free_at.top()) + work.expected);
      if (!is_thread_free) free_at.pop();
    }
    free_at.push(left.back());
  }
  return left;
}

bool is_stuck(const HeldWork& work) {
  return work.spent && *work.spent > std::max(shortest_patience, patience * work.expected);
}

double time_until_free(std::vector<double> times_left, std::uint32_t threads) {
  if (times_left.size() < threads) return 0;
  const auto first_free = times_left.begin() + (threads - 1);
  std::ranges::nth_element(times_left, first_free, std::greater{});
  return *first_free;
}

std::vector<Copy> copies_of(std::span<const Straggler> stragglers, std::span<const IdleWorker> idle) {
  const std::vector<std::size_t> fastest = greatest_first(idle, &IdleWorker::speed);
  std::vector<std::uint32_t> threads;
  for (const IdleWorker& worker : idle) threads.push_back(worker.threads);
  std::size_t first = 0;  // in `fastest`: those before have no thread free
  std::vector<Copy> copies;
  for (const std::size_t s : latest_first(stragglers)) {
    while (first < fastest.size() && threads[fastest[first]] == 0) ++first;
    if (first == fastest.size()) break;
    for (std::size_t i = first; i < fastest.size(); ++i) {
      const std::size_t w = fastest[i];
      if (threads[w] == 0 || idle[w].id == stragglers[s].holder) continue;
      if (stragglers[s].is_piece && !idle[w].takes_pieces) continue;
      const double seconds = expected_seconds(stragglers[s].cost, idle[w].speed);
      if (seconds >= stragglers[s].time_left) break;  // the others are no faster
      if (idle[w].busy + seconds >= stragglers[s].time_left) continue;
      copies.push_back({s, w});
      --threads[w];
      break;
    }
  }
  return copies;
}

}  // namespace rayfarm
