// The meaning of a map's colours, drawn beside it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "common/math/deterministic.h"
#include "master/diagnostics/map_picture.h"

namespace rayfarm {
namespace {

/// Rows of five dots, the left one highest. All that a number needs.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};
constexpr Glyph glyphs[] = {
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}}, {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x02, 0x04, 0x08, 0x1f}}, {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}}, {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}}, {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}}, {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}}, {'-', {0x00, 0x00, 0x00, 0x1f, 0x00, 0x00, 0x00}},
    {'+', {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00}}, {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}},
};

std::string text_of(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 4).ptr};
}

/// A map's colours with room beside them.
class Legend {
 public:
  Legend(const Map& map, const MapKind& kind, const MapColors& colors)
      : map_(map), kind_(kind), colors_(colors) {}

  Picture picture() {
    paint_map();
    switch (kind_.scale) {
      case MapScale::depth:
      case MapScale::count:
        paint_bar();
        break;
      case MapScale::normal:
        paint_ball();
        break;
      case MapScale::label:
        paint_swatches();
    }
    return picture_;
  }

 private:
  void paint_map() {
    const Picture colors = colored(map_, kind_, colors_);
    const std::uint32_t width = map_.size.width, height = map_.size.height;
    unit_ = std::max(1u, height / 400);
    left_ = width + 6 * unit_;
    picture_.size = {width + 90 * unit_, std::max(height, 30 * unit_)};
    picture_.rgb.assign(std::size_t{3} * picture_.size.width * picture_.size.height, 0);
    for (std::size_t y = 0; y < height; ++y)
      std::copy_n(&colors.rgb[3 * y * width], 3 * std::size_t{width},
                  &picture_.rgb[3 * y * picture_.size.width]);
  }

  /// The highest value on top.
  void paint_bar() {
    MapRange range = colors_.range.value_or(usual_range(map_, kind_));
    if (range.low > range.high) return;  // all is nothing
    const std::uint32_t height = picture_.size.height;
    const std::uint32_t values = height < 100 * unit_ ? 2 : 5;
    for (std::uint32_t y = 0; y < height; ++y) {
      const double share = height > 1 ? 1 - static_cast<double>(y) / (height - 1) : 1;
      const auto value = static_cast<float>(range.low + share * (range.high - range.low));
      for (std::uint32_t x = 0; x < 12 * unit_; ++x)
        put(left_ + x, y, color_of(&value, kind_.scale, colors_.palette, range));
    }
    // The colours of depths are no linear scale: so there are values on the way, too.
    for (std::uint32_t i = 0; i < values; ++i) {
      const double share = static_cast<double>(i) / (values - 1);
      const std::uint32_t top = unit_ + static_cast<std::uint32_t>((1 - share) * (height - 9 * unit_));
      write(text_of(range.low + share * (range.high - range.low)), top);
    }
  }

  /// What a ball would look like.
  void paint_ball() {
    const double radius = std::min(40.0 * unit_, picture_.size.height / 2.0);
    for (std::uint32_t y = 0; y < 2 * radius; ++y)
      for (std::uint32_t x = 0; x < 2 * radius; ++x) {
        const double u = (x + 0.5) / radius - 1, v = 1 - (y + 0.5) / radius;
        if (u * u + v * v > 1) continue;
        const std::array<float, 3> n{static_cast<float>(u), static_cast<float>(v),
                                     static_cast<float>(-std::sqrt(1 - u * u - v * v))};
        put(left_ + x, y, color_of(n.data(), kind_.scale, colors_.palette, {}));
      }
  }

  /// As many labels as there is room for.
  void paint_swatches() {
    const MapRange range = range_of(map_);
    for (std::uint32_t label = 0; label <= range.high && (label + 1) * 10 * unit_ <= picture_.size.height;
         ++label) {
      const auto value = static_cast<float>(label);
      for (std::uint32_t y = 0; y < 9 * unit_; ++y)
        for (std::uint32_t x = 0; x < 12 * unit_; ++x)
          put(left_ + x, label * 10 * unit_ + y, color_of(&value, kind_.scale, colors_.palette, range));
      write(text_of(label), (label * 10 + 1) * unit_);
    }
  }

  void write(const std::string& text, std::uint32_t top) {
    std::uint32_t left = left_ + 16 * unit_;
    for (const char letter : text) {
      for (const Glyph& glyph : glyphs)
        if (glyph.letter == letter) write(glyph, left, top);
      left += 6 * unit_;
    }
  }

  void write(const Glyph& glyph, std::uint32_t left, std::uint32_t top) {
    for (std::uint32_t y = 0; y < 7 * unit_; ++y)
      for (std::uint32_t x = 0; x < 5 * unit_; ++x)
        if (glyph.rows[y / unit_] >> (4 - x / unit_) & 1) put(left + x, top + y, {255, 255, 255});
  }

  void put(std::uint32_t x, std::uint32_t y, const MapColor& color) {
    float* pixel = &picture_.rgb[3 * (std::size_t{y} * picture_.size.width + x)];
    for (std::size_t c = 0; c < 3; ++c)
      pixel[c] = static_cast<float>(deterministic::pow(color[c] / 255.0, 2.2));
  }

  const Map& map_;
  const MapKind& kind_;
  const MapColors& colors_;
  Picture picture_{};
  std::uint32_t unit_ = 1;  // pixels a dot of the letters is wide
  std::uint32_t left_ = 0;
};

}  // namespace

Picture colored_with_legend(const Map& map, const MapKind& kind, const MapColors& colors) {
  return Legend(map, kind, colors).picture();
}

}  // namespace rayfarm
