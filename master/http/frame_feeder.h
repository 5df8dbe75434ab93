// Brings the frames of animations that were submitted as scripts to the farm, evaluated one after the other on a
// thread of its own: the first are rendered long before the last are known.
#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

#include "master/frame_range.h"
#include "master/http/farm_door.h"
#include "master/script/script.h"

namespace rayfarm {

/// What a farm keeps with a job whose frames come of this script (JobSpec::script), and the reverse.
std::string kept_script(const ScriptRequest& script);
ScriptRequest script_kept_as(const std::string& kept);

/// All calls are made from any thread.
class FrameFeeder {
 public:
  /// The farm outlives it.
  explicit FrameFeeder(const FarmDoor& farm);
  /// What has not come by then will not: the farm ends, too.
  ~FrameFeeder();
  FrameFeeder(const FrameFeeder&) = delete;
  FrameFeeder& operator=(const FrameFeeder&) = delete;

  /// The frames after the first one. The request names script, parameters and animation. A script that fails in one
  /// of them fails the job. Jobs that are fed at the same time take turns.
  void feed(JobId job, ScriptRequest script, FrameRange frames);
  /// Those jobs of the farm that lack frames, after its last life. Called on the farm's thread.
  void feed_on(const Farm& farm, FarmTime now);

 private:
  struct Feed {
    JobId job{};
    ScriptRequest script;
    FrameRange frames;
    std::uint32_t place = 1;  // the next
  };

  void work();
  bool feed_one(Feed& feed);
  void give_up(const Feed& feed, const std::string& reason);

  const FarmDoor& farm_;
  std::mutex mutex_;  // guards feeds_
  std::condition_variable changed_;
  std::deque<Feed> feeds_;
  std::atomic<bool> ending_{false};
  std::jthread thread_;  // last: it ends before what it uses
};

}  // namespace rayfarm
