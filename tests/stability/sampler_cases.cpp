// S22: how fast the mean of n samples approaches the integral: the slope of the RMSE over n, log-log. Independent
// samples reach -1/2; stratified ones -3/4 on an edge; Owen-scrambled nets -1.43 on a smooth function
// (measured; near the -3/2 of the theory).
//
// What counts as failure is a slope that is off by more than 0.05.
#include <cmath>
#include <numbers>

#include "common/math/hash.h"
#include "common/render/sampler.h"
#include "tests/stability/cases.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {
namespace {

/// A function on the pixel, with random parameters, and its mean there.
struct Integrand {
  std::function<double(const Sample2D&)> value;
  double mean = 0;
};

/// The half-plane below a line of random direction through a random point of the pixel.
Integrand edge(RandomRays& random) {
  const double angle = random.uniform(0, 2 * std::numbers::pi), c = std::cos(angle), s = std::sin(angle);
  const double offset = c * random.uniform(0, 1) + s * random.uniform(0, 1);
  // Area of c u + s v < offset in the unit square: two ramps' integral, |c| and |s| wide.
  const double reach = offset - std::fmin(c, 0) - std::fmin(s, 0), wide = std::fabs(c), high = std::fabs(s);
  const auto square = [](double x) { return x > 0 ? x * x : 0; };
  const double area =
      (square(reach) - square(reach - wide) - square(reach - high) + square(reach - wide - high)) /
      (2 * wide * high);
  return {[=](const Sample2D& at) { return c * at.u + s * at.v < offset ? 1.0 : 0.0; }, area};
}

Integrand disc(RandomRays& random) {
  const double r = random.uniform(0.1, 0.4), x = random.uniform(r, 1 - r), y = random.uniform(r, 1 - r);
  return {[=](const Sample2D& at) {
            return (at.u - x) * (at.u - x) + (at.v - y) * (at.v - y) < r * r ? 1.0 : 0.0;
          },
          std::numbers::pi * r * r};
}

/// exp(a u + b v): the same everywhere but for its slopes.
Integrand smooth(RandomRays& random) {
  const double a = random.uniform(0.5, 1.5), b = random.uniform(0.5, 1.5);
  return {[=](const Sample2D& at) { return std::exp(a * at.u + b * at.v); },
          (std::exp(a) - 1) * (std::exp(b) - 1) / (a * b)};
}

using MakeIntegrand = Integrand (*)(RandomRays&);

double error_of_mean(MakeIntegrand make, SamplerKind kind, std::uint32_t spp, const Batch& batch) {
  RenderSettings settings;
  settings.sampler = kind, settings.spp = spp, settings.seed = batch.seed;
  constexpr std::uint32_t trials = 1'500;
  double squares = 0;
  for (std::uint32_t x = 0; x < trials; ++x) {
    RandomRays random(keyed(batch.seed, x));
    const Integrand integrand = make(random);
    const PixelSampler sampler(settings, {x, 0});
    double sum = 0;
    for (std::uint32_t i = 0; i < spp; ++i) sum += integrand.value(sampler.sample(i, 0));
    squares += (sum / spp - integrand.mean) * (sum / spp - integrand.mean);
  }
  return std::sqrt(squares / trials);
}

/// One slope, fitted over 16 to the driver's number of samples.
RunBatch slope(MakeIntegrand make, SamplerKind kind, double expected) {
  return [=](const Batch& batch) {
    double n = 0, sum_x = 0, sum_y = 0, sum_xx = 0, sum_xy = 0;
    for (std::uint32_t spp = 16; spp <= batch.driver; spp *= 4) {
      const double x = std::log(double(spp)), y = std::log(error_of_mean(make, kind, spp, batch));
      ++n, sum_x += x, sum_y += y, sum_xx += x * x, sum_xy += x * y;
    }
    const double found = (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x);
    return Tally{1, std::fabs(found - expected) > 0.05};
  };
}

Case slope_case(const std::string& name, MakeIntegrand make, double jittered, double scrambled) {
  return {"S22 " + name,
          "slopes of RMSE off by more than 0.05",
          "samples up to",
          {1024},
          {{"random", "", slope(make, SamplerKind::random, -0.5), 0.0},
           {"jitter", "", slope(make, SamplerKind::jitter, jittered), 0.0},
           {"sobol", "", slope(make, SamplerKind::sobol, scrambled), 0.0}},
          {1, 5, 1}};
}

}  // namespace

std::vector<Case> sampler_cases() {
  return {slope_case("edge", edge, -0.75, -0.75), slope_case("disc", disc, -0.75, -0.75),
          slope_case("smooth", smooth, -1.0, -1.43)};
}

}  // namespace rayfarm::stability
