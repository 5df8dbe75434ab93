// The scenes of the frames that a command makes, evaluated one ahead: while one is rendered or sent, the script is
// evaluated for the next.
#pragma once
#include <atomic>
#include <future>
#include <optional>

#include "master/cli/picture_options.h"
#include "master/frame_range.h"

namespace rayfarm {

class SceneFrames {
 public:
  /// Evaluates the script for the first frame: of --frames, or the one that --frame says. Throws SceneError,
  /// SettingsError: also when the animation has not all of the frames, or there is none; CommandError when interrupted.
  explicit SceneFrames(const PictureOptions& options);
  /// Does not wait for an evaluation under way.
  ~SceneFrames();
  SceneFrames(const SceneFrames&) = delete;
  SceneFrames& operator=(const SceneFrames&) = delete;

  const FrameRange& range() const { return range_; }
  /// Frames a second of a video of these frames.
  double frames_per_second() const;
  /// The next one; each once. All have the size and settings of the first. Throws as the constructor.
  PreparedScene take();
  /// Passes over frames that need not be made.
  void skip_to(std::uint32_t place);

 private:
  ScriptResult evaluated(std::uint32_t frame) const;
  PreparedScene made(std::uint32_t frame) const;

  ScriptRequest script_;
  FrameRange range_;
  RenderSettings settings_;
  std::atomic<bool> stopped_{false};
  std::uint32_t place_ = 0;  // of the next frame to be taken
  std::optional<PreparedScene> first_;
  std::future<PreparedScene> next_;
};

}  // namespace rayfarm
