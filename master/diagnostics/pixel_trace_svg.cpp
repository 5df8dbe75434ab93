#include <array>
#include <cstdarg>
#include <cstdio>
#include <map>

#include "common/geometry/bounds.h"
#include "master/diagnostics/pixel_trace.h"

namespace rayfarm {
namespace {

constexpr double width = 960, height = 600, margin = 48;  // of the drawing, in SVG units

std::string formatted(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '<')
      result += "&lt;";
    else if (c == '&')
      result += "&amp;";
    else
      result += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  }
  return result;
}

Box around(const Vec3d& point) { return {point, point}; }

/// Of all that has a place.
Box bounds_of(const RayRecord& ray) {
  Box box = around(ray.path.origin);
  if (ray.hit) box = hull(box, around(ray.hit->point));
  for (const LightAtHit& light : ray.lights)
    if (light.fate == LightFate::reached || light.fate == LightFate::blocked)
      box = hull(box, around(light.at));
  for (const RayRecord& followed : ray.followed) box = hull(box, bounds_of(followed));
  return box;
}

/// Looks along one axis: the world axes that run to the right and upwards.
struct View {
  const char* name;
  int right, up;
};

constexpr std::array<View, 3> views{
    {{"front: x right, y up", 0, 1}, {"side: z right, y up", 2, 1}, {"top: x right, z up", 0, 2}}};

View largest_view(const Vec3d& extent) {
  View best = views[0];
  for (const View& view : views)
    if (extent[view.right] * extent[view.up] > extent[best.right] * extent[best.up]) best = view;
  return best;
}

class Drawing {
 public:
  Drawing(const Box& box, const std::vector<std::string>& leaf_names)
      : view(largest_view(box.high - box.low)), names_(leaf_names) {
    const Vec3d extent = box.high - box.low;
    reach_ = greatest(max_abs(extent), std::numeric_limits<double>::min()) / 3;
    const double across = extent[view.right] + reach_, up = extent[view.up] + reach_;
    scale_ = least((width - 2 * margin) / across, (height - 2 * margin) / up);
    middle_ = (box.low + box.high) * 0.5;
  }

  const View view;
  std::string lines, marks;  // marks lie above lines

  void add(const RayRecord& ray) {
    const Vec3d end = ray.hit ? ray.hit->point
                              : ray.path.origin + ray.path.direction * (reach_ / length(ray.path.direction));
    const double thickness = 1 + 2 * ray.importance;
    line(ray.path.origin, end,
         formatted("stroke=\"#d12f2f\" stroke-width=\"%.2f\"%s", thickness,
                   ray.hit ? "" : " stroke-dasharray=\"7 5\""));
    if (ray.kind == RayKind::primary)
      mark(ray.path.origin, "r=\"6\" fill=\"#d12f2f\" stroke=\"#fff\" stroke-width=\"2\"", "camera");
    if (!ray.hit) return;
    mark(end, "r=\"3.5\" fill=\"#333\"", names_[ray.hit->leaf]);
    line(end, end + ray.hit->normal * (reach_ / 6), "stroke=\"#6b7a8f\" stroke-width=\"1.2\"");
    for (const LightAtHit& light : ray.lights) add(light, end);
    for (const RayRecord& followed : ray.followed) add(followed);
  }

 private:
  void add(const LightAtHit& light, const Vec3d& from) {
    if (light.fate != LightFate::reached && light.fate != LightFate::blocked) return;
    const Vec3d lit_to = light.fate == LightFate::reached ? light.at
                         : light.blocker                  ? light.blocker->point
                                                          : from;
    line(from, lit_to, "stroke=\"#e3a900\" stroke-width=\"1.4\"");
    if (light.fate == LightFate::blocked) {
      line(lit_to, light.at, "stroke=\"#3a3a3a\" stroke-width=\"1\" stroke-dasharray=\"3 4\"");
      if (light.blocker) mark(lit_to, "r=\"3\" fill=\"#3a3a3a\"", names_[light.blocker->leaf]);
    }
    mark(light.at, "r=\"7\" fill=\"#ffd23f\" stroke=\"#b58500\" stroke-width=\"1.5\"",
         "light " + std::to_string(light.light));
  }

  double x(const Vec3d& p) const { return width / 2 + (p[view.right] - middle_[view.right]) * scale_; }
  double y(const Vec3d& p) const { return height / 2 - (p[view.up] - middle_[view.up]) * scale_; }

  void line(const Vec3d& a, const Vec3d& b, const std::string& style) {
    lines += formatted("<line x1=\"%.2f\" y1=\"%.2f\" x2=\"%.2f\" y2=\"%.2f\" ", x(a), y(a), x(b), y(b)) +
             style + "/>\n";
  }
  /// The first mark of a name gets a label.
  void mark(const Vec3d& p, const std::string& style, const std::string& name) {
    marks += formatted("<circle cx=\"%.2f\" cy=\"%.2f\" ", x(p), y(p)) + style + "/>\n";
    if (labels_[name]++ == 0)
      marks += formatted("<text x=\"%.2f\" y=\"%.2f\">", x(p) + 9, y(p) - 7) + escaped(name) + "</text>\n";
  }

  const std::vector<std::string>& names_;
  std::map<std::string, int> labels_;
  double reach_ = 1, scale_ = 1;  // reach: how far a missing ray is drawn
  Vec3d middle_{};
};

}  // namespace

std::string svg_of(const PixelTrace& trace) {
  Box box;
  for (const PixelTrace::Sample& sample : trace.samples) box = hull(box, bounds_of(sample.traced.ray));
  Drawing drawing(box, *trace.leaf_names);
  for (const PixelTrace::Sample& sample : trace.samples) drawing.add(sample.traced.ray);
  return formatted(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" font-family=\"sans-serif\" "
             "font-size=\"13\" fill=\"#333\">\n<rect width=\"%g\" height=\"%g\" fill=\"#fff\"/>\n",
             width, height, width, height) +
         "<g fill=\"none\" stroke-linecap=\"round\">\n" + drawing.lines + "</g>\n" + drawing.marks +
         formatted("<text x=\"16\" y=\"%g\" fill=\"#6b7a8f\">rays of pixel %u,%u, %s</text>\n</svg>\n",
                   height - 16, trace.pixel.x, trace.pixel.y, drawing.view.name);
}

}  // namespace rayfarm
