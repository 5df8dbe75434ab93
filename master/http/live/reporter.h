// Looks up what viewers wish to see: the farm is asked once for all of them.
#pragma once
#include <map>
#include <string>

#include "master/http/doors.h"
#include "master/http/live/hub.h"

namespace rayfarm {

/// All calls are made from one thread at a time; not from the I/O thread, for they wait for the farm.
class LiveReporter {
 public:
  explicit LiveReporter(const Doors& doors) : doors_(doors) {}

  /// What cannot be had just now is left out.
  LiveNews look_up(const LiveWish& wish);

 private:
  void look_at_farm(const LiveWish& wish, LiveNews& news);
  FeedNews poll(const LiveWish::Layer& layer);

  const Doors doors_;
  std::uint64_t revision_ = 0;
  std::string workers_;                           // as they were shown last, without their ages
  FarmTime next_state_{};                         // not before: a long list is not told ten times a second
  std::map<std::uint32_t, LayerPoller> pollers_;  // by the feed's id
};

}  // namespace rayfarm
