#include "master/cli/scene_frames.h"

#include "master/cli/exit_code.h"
#include "master/cli/interrupt.h"
#include "master/script/animation.h"

namespace rayfarm {
namespace {

FrameRange range_of(const PictureOptions& options) {
  if (options.frames) return parse_frame_range(*options.frames);
  const std::uint32_t frame = options.frame.value_or(0);
  return {frame, frame, 1};
}

}  // namespace

SceneFrames::SceneFrames(const PictureOptions& options) : range_(range_of(options)) {
  PictureOptions first = options;
  first.frame = range_.first;
  settings_of(first, {});  // a mistake in the options is told before the script runs
  script_ = script_of(options);
  ScriptResult result = evaluated(range_.first);
  if (options.frames) expect_frames(script_.name, result.scene, range_);
  script_.animation = result.scene.animation;
  settings_ = settings_of(first, result.scene.image);
  first_ = prepared(std::move(result), settings_);
}

SceneFrames::~SceneFrames() { stopped_ = true; }

double SceneFrames::frames_per_second() const {
  return script_.animation ? script_.animation->fps / range_.step : Animation{}.fps;
}

ScriptResult SceneFrames::evaluated(std::uint32_t frame) const {
  ScriptRequest script = script_;
  script.frame = frame;
  try {
    return evaluate(script, {}, [this] { return stopped_ || interrupted(); });
  } catch (const SceneError& error) {
    if (interrupted()) throw CommandError(ExitCode::interrupted, "interrupted; nothing was written");
    if (frame == range_.first) throw;
    throw SceneError("frame " + std::to_string(frame) + ": " + error.what());
  }
}

PreparedScene SceneFrames::made(std::uint32_t frame) const {
  RenderSettings settings = settings_;
  settings.frame = frame;
  return prepared(evaluated(frame), settings);
}

PreparedScene SceneFrames::take() {
  PreparedScene scene = place_ == 0     ? std::move(first_).value()
                        : next_.valid() ? next_.get()
                                        : made(range_.at(place_));
  if (++place_ < range_.count())
    next_ = std::async(std::launch::async, [this, frame = range_.at(place_)] { return made(frame); });
  return scene;
}

void SceneFrames::skip_to(std::uint32_t place) {
  if (place <= place_) return;
  place_ = place;
  next_ = {};
}

}  // namespace rayfarm
