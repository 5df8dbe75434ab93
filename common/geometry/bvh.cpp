#include "common/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace rayfarm {
namespace {

constexpr int bin_count = 16;
constexpr std::uint32_t leaf_size = 2;     // fewer boxes are never split
constexpr std::uint32_t largest_leaf = 8;  // more are split even where the heuristic would not
constexpr double step_cost = 1.0;          // of a node, in units of a box's content

Vec3d middle(const Box& b) { return b.low * 0.5 + b.high * 0.5; }

struct Split {
  double cost = infinity;
  int axis = 0, bin = 0;
};

struct Bins {
  double low, per_unit;
  int of(double x) const {
    const double bin = (x - low) * per_unit;
    return bin >= bin_count ? bin_count - 1 : bin > 0 ? static_cast<int>(bin) : 0;
  }
};

Bins bins_along(const Box& middles, int axis) {
  return {middles.low[axis], bin_count / (middles.high[axis] - middles.low[axis])};
}

Split best_split(std::span<const std::uint32_t> numbers, std::span<const Box> boxes, const Box& middles) {
  Split best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(middles.low[axis] < middles.high[axis])) continue;
    const Bins bins = bins_along(middles, axis);
    std::array<Box, bin_count> box;
    std::array<std::uint32_t, bin_count> count{};
    for (const std::uint32_t n : numbers) {
      const auto bin = static_cast<std::size_t>(bins.of(middle(boxes[n])[axis]));
      box[bin] = hull(box[bin], boxes[n]), ++count[bin];
    }
    std::array<double, bin_count> right_cost{};
    Box right;
    std::uint32_t right_count = 0;
    for (std::size_t b = bin_count - 1; b > 0; --b) {
      right = hull(right, box[b]), right_count += count[b];
      right_cost[b] = half_area(right) * right_count;
    }
    Box left;
    std::uint32_t left_count = 0;
    for (std::size_t b = 1; b < bin_count; ++b) {
      left = hull(left, box[b - 1]), left_count += count[b - 1];
      const double cost = half_area(left) * left_count + right_cost[b];
      if (cost < best.cost) best = {cost, axis, static_cast<int>(b)};
    }
  }
  return best;
}

}  // namespace

Bvh::Bvh(std::span<const Box> boxes) : order_(boxes.size()) {
  if (boxes.empty()) return;
  std::iota(order_.begin(), order_.end(), 0u);
  nodes_.reserve(boxes.size());
  root_ = build(0, static_cast<std::uint32_t>(boxes.size()), 0, boxes);
}

Bvh::Child Bvh::build(std::uint32_t first, std::uint32_t last, int depth, std::span<const Box> boxes) {
  const std::span<std::uint32_t> numbers(order_.data() + first, last - first);
  Box box, middles;
  for (const std::uint32_t n : numbers) {
    const Vec3d m = middle(boxes[n]);
    box = hull(box, boxes[n]), middles = hull(middles, {m, m});
  }

  const std::uint32_t count = last - first;
  const Split split =
      count > leaf_size && depth < max_depth / 2 ? best_split(numbers, boxes, middles) : Split{};
  const bool worth_it = split.cost + step_cost * half_area(box) < half_area(box) * count;
  const bool must_stop = depth >= max_depth - 1;
  if (count <= leaf_size || must_stop || (count <= largest_leaf && !worth_it)) return {box, first, count};

  // Boxes that no bin tells apart are halved: their order is as good as any.
  std::uint32_t half = first + count / 2;
  if (split.cost < infinity) {
    const Bins bins = bins_along(middles, split.axis);
    const auto right = std::stable_partition(numbers.begin(), numbers.end(), [&](std::uint32_t n) {
      return bins.of(middle(boxes[n])[split.axis]) < split.bin;
    });
    half = first + static_cast<std::uint32_t>(right - numbers.begin());
    if (half == first || half == last) half = first + count / 2;
  }
  const auto number = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  const Child left = build(first, half, depth + 1, boxes), right = build(half, last, depth + 1, boxes);
  nodes_[number] = {{left, right}};
  return {box, number, 0};
}

}  // namespace rayfarm
