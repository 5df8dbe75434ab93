#include "master/charts/chart.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "master/charts/axis_map.h"

namespace rayfarm {
namespace {

// Pixels.
constexpr double width = 460, plot_height = 240, left = 64, right = 14, top = 34, below = 44,
                 legend_line = 17;
constexpr double plot_width = width - left - right;

// Told apart also by the colour-blind. Source: M. Okabe and K. Ito, Color Universal Design, 2008.
constexpr const char* colors[] = {"#d55e00", "#0072b2", "#cc79a7", "#e69f00",
                                  "#56b4e9", "#7f6f5f", "#9467bd"};
constexpr const char* color_of_ours = "#007a5a";

std::string format(const char* pattern, ...) {
  char text[512];
  va_list values;
  va_start(values, pattern);
  std::vsnprintf(text, sizeof text, pattern, values);
  va_end(values);
  return text;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '&')
      safe += "&amp;";
    else
      safe += c;
  }
  return safe;
}

std::string words(double x, double y, const char* style, const std::string& text) {
  return format("<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style) + escaped(text) + "</text>\n";
}

std::string stroke(double x0, double y0, double x1, double y1, const char* color, double thickness) {
  return format(
      "<line x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\" stroke=\"%s\" stroke-width=\"%.1f\"/>\n", x0, y0,
      x1, y1, color, thickness);
}

std::string mark(double x, double y, const char* color, bool is_open) {
  return format(
      "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3.4\" fill=\"%s\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", x, y,
      is_open ? "#fff" : color, color);
}

/// One chart with its own axes, its upper left corner at the origin.
class Panel {
 public:
  explicit Panel(const Chart& chart) : chart_(chart), x_(axis_of(chart, true)), y_(axis_of(chart, false)) {}

  std::string svg() const {
    std::string out = words(left, 20, "font-weight=\"bold\"", chart_.title);
    out += grid();
    for (std::size_t i = 0; i < chart_.lines.size(); ++i)
      if (!chart_.lines[i].is_ours) out += line(i);
    for (std::size_t i = 0; i < chart_.lines.size(); ++i)
      if (chart_.lines[i].is_ours) out += line(i);
    return out + legend();
  }

 private:
  static AxisMap axis_of(const Chart& chart, bool is_x) {
    std::vector<double> values;
    for (const ChartLine& line : chart.lines)
      for (const ChartPoint& p : line.points) values.push_back(is_x ? p.x : p.y);
    return AxisMap(is_x ? chart.x.scale : chart.y.scale, values);
  }

  double x_at(double value) const { return left + plot_width * x_.place(value); }
  double y_at(double value) const { return top + plot_height * (1 - y_.place(value)); }

  std::string grid() const {
    const double bottom = top + plot_height;
    std::string out;
    for (const Tick& tick : x_.ticks()) {
      out += stroke(x_at(tick.value), top, x_at(tick.value), bottom, "#ddd", 1);
      out += words(x_at(tick.value), bottom + 17, "text-anchor=\"middle\"", tick.label);
    }
    for (const Tick& tick : y_.ticks()) {
      out += stroke(left, y_at(tick.value), width - right, y_at(tick.value), "#ddd", 1);
      out += words(left - 6, y_at(tick.value) + 4, "text-anchor=\"end\"", tick.label);
    }
    out +=
        format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"none\" stroke=\"#555\"/>\n",
               left, top, plot_width, plot_height);
    out += words(left + plot_width / 2, bottom + 35, "text-anchor=\"middle\"", chart_.x.label);
    const std::string turned =
        format("text-anchor=\"middle\" transform=\"rotate(-90 14 %.1f)\"", top + plot_height / 2);
    return out + words(14, top + plot_height / 2, turned.c_str(), chart_.y.label);
  }

  /// A colour belongs to a place in the list, ours aside.
  const char* color(std::size_t number) const {
    if (chart_.lines[number].is_ours) return color_of_ours;
    std::size_t others = 0;
    for (std::size_t i = 0; i < number; ++i) others += !chart_.lines[i].is_ours;
    return colors[others % std::size(colors)];
  }

  std::string line(std::size_t number) const {
    const ChartLine& line = chart_.lines[number];
    std::string path, marks;
    for (const ChartPoint& p : line.points) {
      path += format("%s%.1f,%.1f", path.empty() ? "" : " ", x_at(p.x), y_at(p.y));
      marks += mark(x_at(p.x), y_at(p.y), color(number), p.is_bound);
    }
    return "<polyline points=\"" + path +
           format("\" fill=\"none\" stroke=\"%s\" stroke-width=\"%s\"/>\n", color(number),
                  line.is_ours ? "2.6" : "1.4") +
           marks;
  }

  std::string legend() const {
    std::string out;
    double y = top + plot_height + below + 8;
    for (std::size_t i = 0; i < chart_.lines.size(); ++i, y += legend_line) {
      const char* c = color(i);
      out += stroke(left, y, left + 24, y, c, chart_.lines[i].is_ours ? 2.6 : 1.4) +
             mark(left + 12, y, c, false);
      out += words(left + 32, y + 4, "", chart_.lines[i].name);
    }
    return out;
  }

  const Chart& chart_;
  AxisMap x_, y_;
};

double height_of(const Chart& chart) {
  return top + plot_height + below + legend_line * static_cast<double>(chart.lines.size()) + 10;
}

}  // namespace

AxisScale scale_for(std::span<const double> values) {
  double least = 0, most = 0;
  for (const double value : values) {
    if (value < 0) return AxisScale::linear;
    if (value > 0 && (least == 0 || value < least)) least = value;
    most = std::max(most, value);
  }
  return most > 30 * least ? AxisScale::logarithmic : AxisScale::linear;
}

std::string svg_of(std::span<const Chart> charts, int columns) {
  const auto across = static_cast<std::size_t>(std::max(1, columns));
  std::string panels;
  double y = 0;
  for (std::size_t first = 0; first < charts.size(); first += across) {
    double row_height = 0;
    for (std::size_t i = first; i < std::min(first + across, charts.size()); ++i) {
      panels +=
          format("<g transform=\"translate(%.1f %.1f)\">\n", width * static_cast<double>(i - first), y) +
          Panel(charts[i]).svg() + "</g>\n";
      row_height = std::max(row_height, height_of(charts[i]));
    }
    y += row_height;
  }
  const double full_width =
      width * static_cast<double>(std::min(across, std::max<std::size_t>(1, charts.size())));
  return format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\" viewBox=\"0 0 %.0f "
             "%.0f\" "
             "font-family=\"DejaVu Sans, Verdana, sans-serif\" font-size=\"12\" fill=\"#222\">\n",
             full_width, y, full_width, y) +
         "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n" + panels + "</svg>\n";
}

}  // namespace rayfarm
