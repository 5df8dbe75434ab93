#include "master/pace.h"

#include <algorithm>
#include <cmath>

namespace rayfarm {
namespace {

constexpr double memory = 0.9;        // of a delivery when the next one comes: half is forgotten after seven
constexpr double most_surprise = 10;  // times faster or slower than known: a PC that slept is not slow
constexpr std::chrono::microseconds shortest_delivery{1};  // so that nobody is infinitely fast
constexpr std::chrono::seconds between_marks{1};
constexpr std::size_t window_marks = 10;

}  // namespace

void Speed::add(std::uint64_t added, FarmTime taken) {
  const double amount = static_cast<double>(added);
  double seconds = seconds_of(std::max<FarmTime>(taken, shortest_delivery));
  if (const double known = per_second(); known > 0)
    seconds = std::clamp(seconds, amount / known / most_surprise, amount / known * most_surprise);
  amount_ = memory * amount_ + amount;
  seconds_ = memory * seconds_ + seconds;
}

void Pace::restart(FarmTime now, std::uint64_t pixels_done) {
  marks_.assign(1, {now, pixels_done});
  pixels_done_ = pixels_done;
}

void Pace::advance(FarmTime now, std::uint64_t pixels_done) {
  pixels_done_ = pixels_done;
  if (marks_.empty() || now - marks_.back().at < between_marks) return;
  marks_.push_back({now, pixels_done});
  if (marks_.size() > window_marks + 1) marks_.pop_front();
}

std::optional<FarmTime> Pace::time_for(std::uint64_t pixels, FarmTime now) const {
  if (marks_.empty() || pixels_done_ == marks_.front().pixels_done || now <= marks_.front().at)
    return std::nullopt;
  const double per_pixel =
      seconds_of(now - marks_.front().at) / static_cast<double>(pixels_done_ - marks_.front().pixels_done);
  const double nanoseconds = std::ceil(per_pixel * static_cast<double>(pixels) * 1e9);
  return FarmTime(static_cast<FarmTime::rep>(std::min(nanoseconds, 9e18)));
}

}  // namespace rayfarm
