// How fast samplers approach the picture: error against time.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "master/charts/chart.h"

namespace rayfarm {

/// One render.
struct ConvergencePoint {
  std::string sampler;
  std::uint32_t spp = 0;
  double cpu_seconds = 0;  // of all threads
  double rmse = 0;         // to the reference, linear, over pixels and channels
};

/// The exponent p of the power law rmse ~ seconds^p, fitted by least squares of the logarithms; 0 for fewer
/// than two points with an error.
double fitted_slope(const std::vector<ConvergencePoint>& points);

std::string convergence_csv(const std::vector<ConvergencePoint>& points);
/// A line each sampler, its slope in the legend.
Chart convergence_chart(const std::string& title, const std::vector<ConvergencePoint>& points);

}  // namespace rayfarm
