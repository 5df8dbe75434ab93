// Charts of lines over two axes, as SVG text. The same chart always gives the same bytes.
#pragma once
#include <span>
#include <string>
#include <vector>

namespace rayfarm {

/// On a logarithmic axis values are > 0; a 0 is drawn at the low end, which is then labelled so.
enum class AxisScale { linear, logarithmic };

struct ChartAxis {
  std::string label;
  AxisScale scale = AxisScale::logarithmic;
};

struct ChartPoint {
  double x = 0, y = 0;
  bool is_bound = false;  // y is only known to be at most this: an open mark
};

struct ChartLine {
  std::string name;                // in the legend
  std::vector<ChartPoint> points;  // ascending x
  bool is_ours = false;            // drawn thick, on top
};

struct Chart {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartLine> lines;
};

/// Logarithmic when the values are >= 0 and reach over more than a decade and a half.
AxisScale scale_for(std::span<const double> values);

/// One under another, `columns` beside each other; each with its legend.
std::string svg_of(std::span<const Chart> charts, int columns = 1);

}  // namespace rayfarm
