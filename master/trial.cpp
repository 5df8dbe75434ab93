#include "master/trial.h"

#include <algorithm>
#include <cstring>

namespace rayfarm {
namespace {

std::uint32_t supporters(const Trial& trial, const Opinion& of) {
  return static_cast<std::uint32_t>(
      std::ranges::count_if(trial.opinions, [&](const Opinion& other) { return agree(of, other); }));
}

std::size_t most_in_agreement(const Trial& trial) {
  std::uint32_t most = 0;
  for (const Opinion& opinion : trial.opinions) most = std::max(most, supporters(trial, opinion));
  return most;
}

}  // namespace

bool agree(const Opinion& a, const Opinion& b) {
  // Bytes, not numbers: -0 and 0 differ. Both have the passes of the same work.
  const auto has = [&](const PassImage& image) {
    return std::ranges::any_of(b.images, [&](const PassImage& other) {
      return other.pass == image.pass && other.counters == image.counters &&
             std::memcmp(other.rgb.data(), image.rgb.data(), image.rgb.size() * sizeof(float)) == 0;
    });
  };
  return std::ranges::all_of(a.images, has);
}

std::optional<std::size_t> verdict(const Trial& trial) {
  const auto is_right = [&](const Opinion& opinion) {
    return std::ranges::any_of(trial.opinions,
                               [&](const Opinion& o) { return o.is_final && agree(o, opinion); });
  };
  const bool is_decided = std::ranges::any_of(trial.opinions, &Opinion::is_final);
  for (std::size_t i = 0; i < trial.opinions.size(); ++i) {
    const Opinion& opinion = trial.opinions[i];
    if (is_decided ? is_right(opinion) : supporters(trial, opinion) >= trial.wanted) return i;
  }
  return std::nullopt;
}

bool wants_opinions(const Trial& trial) {
  return most_in_agreement(trial) + trial.asked.size() < trial.wanted;
}

bool bears_another_opinion(const Trial& trial) {
  return most_in_agreement(trial) + trial.asked.size() <= trial.wanted;
}

}  // namespace rayfarm
