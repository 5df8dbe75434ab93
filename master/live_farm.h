// The farm at work: with a clock, which it does not have itself, and its events in the log.
#pragma once
#include <type_traits>

#include "master/event_log.h"
#include "master/farm.h"

namespace rayfarm {

/// All calls are made from one thread.
class LiveFarm {
 public:
  /// What call(farm, now) gives. What happened in the farm goes to the log.
  template <class Call>
  std::invoke_result_t<Call, Farm&, FarmTime> apply(Call&& call) {
    const LogAtEnd log{*this};
    return call(farm_, now());
  }

  /// What happened beside the farm.
  void note(FarmEvent event);
  const EventLog& log() const { return log_; }

 private:
  struct LogAtEnd {
    LiveFarm& live;
    ~LogAtEnd();
  };
  static FarmTime now();

  Farm farm_;
  EventLog log_;
};

}  // namespace rayfarm
