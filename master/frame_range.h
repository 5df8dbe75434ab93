// Which frames of an animation are made: every step-th from the first to the last.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rayfarm {

/// Made by frame_range() or parse_frame_range(): first <= last, step >= 1, and the last is one of them.
struct FrameRange {
  std::uint32_t first = 0, last = 0, step = 1;

  std::uint32_t count() const { return (last - first) / step + 1; }
  std::uint32_t at(std::uint32_t index) const { return first + index * step; }
  /// The place of a frame among them, from 0; nothing when it is none of them.
  std::optional<std::uint32_t> index_of(std::uint32_t frame) const {
    if (frame < first || frame > last || (frame - first) % step != 0) return std::nullopt;
    return (frame - first) / step;
  }
  bool operator==(const FrameRange&) const = default;
};

constexpr std::uint32_t max_frames = 10'000;  // of one range

/// Throws SettingsError for a range that is empty, or too long.
FrameRange frame_range(std::uint32_t first, std::uint32_t last, std::uint32_t step);
/// "7", "0-499" or "0-499:5". Throws SettingsError.
FrameRange parse_frame_range(std::string_view text);
std::string text_of(const FrameRange& range);

}  // namespace rayfarm
