#include "master/script/animation.h"

#include <cmath>
#include <cstdio>
#include <string>

namespace rayfarm {
namespace {

std::string text_of(double x) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", x);
  return text;
}

}  // namespace

std::uint64_t last_frame(const Animation& a) {
  constexpr double rounding = 1e-6;  // frames: a product that should be 29 may be 28.999999999999996
  const double last = std::floor((a.stop - a.start) * a.fps + rounding);
  return last < 1e18 ? static_cast<std::uint64_t>(last) : std::uint64_t{1'000'000'000'000'000'000};
}

namespace {

constexpr auto how_to_have_one = "; scene{ animation = { stop = 20, fps = 25 } } would have some";

std::string words_for_missing(const Animation& a, std::uint32_t frame) {
  return "there is no frame " + std::to_string(frame) + ": the animation's last frame is " +
         std::to_string(last_frame(a)) + " (from " + text_of(a.start) + " s to " + text_of(a.stop) + " s, " +
         text_of(a.fps) + " frames a second)";
}

}  // namespace

void check_frame(const Animation& animation, std::uint32_t frame) {
  if (frame > last_frame(animation)) throw SceneError(words_for_missing(animation, frame));
}

void expect_still(std::uint32_t frame) {
  if (frame != 0)
    throw SceneError("there is no frame " + std::to_string(frame) + ": the scene has no animation" +
                     how_to_have_one);
}

void expect_frames(const std::string& script, const Scene& scene, const FrameRange& frames) {
  if (!scene.animation)
    throw SceneError(script + ": the scene has no animation, so it has no frames " + text_of(frames) +
                     how_to_have_one);
  if (frames.last > last_frame(*scene.animation))
    throw SceneError(script + ": " + words_for_missing(*scene.animation, frames.last));
}

}  // namespace rayfarm
