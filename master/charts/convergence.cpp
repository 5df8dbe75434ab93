#include "master/charts/convergence.h"

#include <cmath>
#include <cstdio>

#include "master/charts/csv.h"

namespace rayfarm {
namespace {

std::string formatted(const char* pattern, double value) {
  char text[32];
  std::snprintf(text, sizeof text, pattern, value);
  return text;
}

/// The points of each sampler, in the order in which they first appear.
std::vector<std::vector<ConvergencePoint>> by_sampler(const std::vector<ConvergencePoint>& points) {
  std::vector<std::vector<ConvergencePoint>> groups;
  for (const ConvergencePoint& p : points) {
    std::size_t group = 0;
    while (group < groups.size() && groups[group][0].sampler != p.sampler) ++group;
    if (group == groups.size()) groups.emplace_back();
    groups[group].push_back(p);
  }
  return groups;
}

}  // namespace

double fitted_slope(const std::vector<ConvergencePoint>& points) {
  double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
  for (const ConvergencePoint& p : points) {
    if (!(p.rmse > 0 && p.cpu_seconds > 0)) continue;
    const double x = std::log(p.cpu_seconds), y = std::log(p.rmse);
    ++n, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  return n < 2 || spread == 0 ? 0 : (n * sum_xy - sum_x * sum_y) / spread;
}

std::string convergence_csv(const std::vector<ConvergencePoint>& points) {
  std::string csv = csv_line({"sampler", "spp", "cpu_seconds", "rmse"});
  for (const ConvergencePoint& p : points)
    csv += csv_line(
        {p.sampler, std::to_string(p.spp), formatted("%.6g", p.cpu_seconds), formatted("%.6g", p.rmse)});
  return csv;
}

Chart convergence_chart(const std::string& title, const std::vector<ConvergencePoint>& points) {
  Chart chart{title, {"CPU seconds"}, {"RMSE"}, {}};
  for (const auto& group : by_sampler(points)) {
    ChartLine line{
        group[0].sampler + formatted(", slope %.2f", fitted_slope(group)), {}, group[0].sampler == "sobol"};
    for (const ConvergencePoint& p : group) line.points.push_back({p.cpu_seconds, p.rmse});
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

}  // namespace rayfarm
