// The frames of an animation in scene time.
#pragma once
#include <cstdint>
#include <string>

#include "common/scene/scene.h"
#include "master/frame_range.h"

namespace rayfarm {

/// Seconds.
inline double time_of(const Animation& animation, std::uint32_t frame) {
  return animation.start + frame / animation.fps;
}
/// Frames are 0 to this one.
std::uint64_t last_frame(const Animation& animation);
/// Throws SceneError, with the frames that there are, when this one comes after them.
void check_frame(const Animation& animation, std::uint32_t frame);
/// Throws SceneError when a scene without animation is to have this frame: it has 0.
void expect_still(std::uint32_t frame);
/// Throws SceneError, which begins with the script's name, unless the scene has an animation with all of these frames.
void expect_frames(const std::string& script, const Scene& scene, const FrameRange& frames);

}  // namespace rayfarm
