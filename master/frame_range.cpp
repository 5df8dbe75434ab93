#include "master/frame_range.h"

#include <charconv>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

/// Takes a whole number off the front of the text.
std::optional<std::uint32_t> take_number(std::string_view& text) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return number;
}

/// The number behind this sign; `otherwise` when the text ends before it.
std::optional<std::uint32_t> take_after(char sign, std::string_view& text, std::uint32_t otherwise) {
  if (!text.starts_with(sign)) return otherwise;
  text.remove_prefix(1);
  return take_number(text);
}

}  // namespace

FrameRange frame_range(std::uint32_t first, std::uint32_t last, std::uint32_t step) {
  if (step == 0)
    throw SettingsError("frames " + std::to_string(first) + "-" + std::to_string(last) +
                        ":0 would never end; the step must be 1 or more");
  if (last < first)
    throw SettingsError("frames " + std::to_string(first) + "-" + std::to_string(last) +
                        " are none: the first comes after the last");
  const std::uint32_t steps = (last - first) / step;
  if (steps >= max_frames)
    throw SettingsError("at most " + std::to_string(max_frames) + " frames can be made at once, these are " +
                        std::to_string(std::uint64_t{steps} + 1));
  return {first, first + steps * step, step};
}

FrameRange parse_frame_range(std::string_view text) {
  std::string_view rest = text;
  const auto first = take_number(rest);
  const auto last = first ? take_after('-', rest, *first) : std::nullopt;
  const auto step = last ? take_after(':', rest, 1) : std::nullopt;
  if (!step || !rest.empty())
    throw SettingsError("--frames wants A-B or A-B:step, as in 0-99 or 0-99:2, is " + std::string(text));
  return frame_range(*first, *last, *step);
}

std::string text_of(const FrameRange& range) {
  std::string text = std::to_string(range.first);
  if (range.last != range.first) text += "-" + std::to_string(range.last);
  if (range.last != range.first && range.step != 1) text += ":" + std::to_string(range.step);
  return text;
}

}  // namespace rayfarm
