// Things that were made for somebody, kept for those who ask again, within bounds.
#pragma once
#include <algorithm>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "master/diagnostics/background.h"

namespace rayfarm {

/// More is asked for at once than the master has memory for.
struct TooMuchAsked : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct ShelfLimits {
  std::uint64_t bytes = 0;   // kept, beside the newest
  std::uint64_t wanted = 0;  // asked for within interest_lasts
  std::size_t things = 0;
};

/// Things by key; what was not asked for the longest goes first. A thing is made at the first question, small,
/// and may fill up to the bytes that it is said to take.
template <class Key, class Thing>
class Shelf {
 public:
  Shelf(ShelfLimits limits, Clock now) : limits_(limits), now_(std::move(now)) {}

  /// make() gives a shared_ptr<Thing>, when there is none yet. Throws TooMuchAsked.
  template <class Make>
  std::shared_ptr<Thing> get(const Key& key, std::uint64_t bytes, Make make) {
    const std::lock_guard lock(mutex_);
    for (auto entry = entries_.begin(); entry != entries_.end(); ++entry)
      if (entry->key == key) {
        entry->asked = now_();
        entries_.splice(entries_.begin(), entries_, entry);
        return entry->thing;
      }
    make_room(bytes);
    entries_.push_front({key, make(), bytes, now_()});
    bytes_ += bytes;
    return entries_.front().thing;
  }

  /// Has the thing too, as the first to go, if nothing must go for it: nobody has asked for it.
  template <class Make>
  void offer(const Key& key, std::uint64_t bytes, Make make) {
    const std::lock_guard lock(mutex_);
    if (bytes_ + bytes > limits_.bytes || entries_.size() >= limits_.things) return;
    if (std::ranges::any_of(entries_, [&](const Entry& entry) { return entry.key == key; })) return;
    entries_.push_back({key, make(), bytes, now_() - interest_lasts});
    bytes_ += bytes;
  }
  /// Null when there is none. To look is not to ask.
  std::shared_ptr<Thing> find(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto found = std::ranges::find(entries_, key, &Entry::key);
    return found == entries_.end() ? nullptr : found->thing;
  }

 private:
  struct Entry {
    Key key;
    std::shared_ptr<Thing> thing;
    std::uint64_t bytes = 0;
    std::chrono::nanoseconds asked{};
  };

  void make_room(std::uint64_t bytes) {
    while (!entries_.empty() && (bytes_ + bytes > limits_.bytes || entries_.size() >= limits_.things)) {
      if (now_() - entries_.back().asked < interest_lasts) break;
      bytes_ -= entries_.back().bytes;
      entries_.pop_back();
    }
    if (!entries_.empty() && (bytes_ + bytes > limits_.wanted || entries_.size() >= limits_.things))
      throw TooMuchAsked("the master is asked for too much at once; look at fewer things, or wait for " +
                         std::to_string(interest_lasts.count()) + " s");
  }

  const ShelfLimits limits_;
  const Clock now_;
  std::mutex mutex_;          // guards what follows
  std::list<Entry> entries_;  // the one asked for last first
  std::uint64_t bytes_ = 0;
};

}  // namespace rayfarm
