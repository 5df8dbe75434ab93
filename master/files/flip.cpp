#include "master/files/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "common/math/vec.h"

namespace rayfarm {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double pixels_per_degree = 0.7 * 3840 / 0.7 * pi / 180;  // distance * pixels / width, small angle

/// Row-major; beyond the edge the nearest pixel is repeated.
template <class T>
struct Plane2 {
  int width = 0, height = 0;
  std::vector<T> at;
  const T& clamped(int x, int y) const {
    return at[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) * static_cast<std::size_t>(width) +
              static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
  }
};

/// Square, (2 radius + 1)^2 weights, of one number or of one a channel.
template <class W>
struct Kernel {
  int radius = 0;
  std::vector<W> weights;
};

template <class W>
Kernel<W> kernel_of(int radius, const std::function<W(double, double)>& weight) {
  Kernel<W> kernel{radius, {}};
  for (int y = -radius; y <= radius; ++y)
    for (int x = -radius; x <= radius; ++x) kernel.weights.push_back(weight(x, y));
  return kernel;
}

template <class T, class W>
Plane2<T> convolved(const Plane2<T>& in, const Kernel<W>& kernel) {
  Plane2<T> out{in.width, in.height, std::vector<T>(in.at.size())};
  for (int y = 0; y < in.height; ++y)
    for (int x = 0; x < in.width; ++x) {
      T sum{};
      const W* weight = kernel.weights.data();
      for (int dy = -kernel.radius; dy <= kernel.radius; ++dy)
        for (int dx = -kernel.radius; dx <= kernel.radius; ++dx)
          sum = sum + in.clamped(x + dx, y + dy) * *weight++;
      out.at[static_cast<std::size_t>(y) * static_cast<std::size_t>(in.width) + static_cast<std::size_t>(x)] =
          sum;
    }
  return out;
}

// Colour spaces, all relative to the white of linear Rec. 709.
// --------------------------------------------------

constexpr std::array<Vec3d, 3> xyz_from_rgb{
    {{10135552 / 24577794.0, 8788810 / 24577794.0, 4435075 / 24577794.0},
     {2613072 / 12288897.0, 8788810 / 12288897.0, 887015 / 12288897.0},
     {1425312 / 73733382.0, 8788810 / 73733382.0, 70074185 / 73733382.0}}};
constexpr std::array<Vec3d, 3> rgb_from_xyz{{{3.241003275, -1.537398934, -0.498615861},
                                             {-0.969224334, 1.875930071, 0.041554224},
                                             {0.055639423, -0.204011202, 1.057148933}}};

Vec3d product(const std::array<Vec3d, 3>& m, const Vec3d& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

const Vec3d white = product(xyz_from_rgb, {1, 1, 1});

Vec3d ycxcz_of(const Vec3d& rgb) {
  const Vec3d xyz = product(xyz_from_rgb, rgb);
  const double x = xyz.x / white.x, y = xyz.y / white.y, z = xyz.z / white.z;
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

Vec3d rgb_of_ycxcz(const Vec3d& c) {
  const double y = (c.x + 16) / 116, x = c.y / 500 + y, z = y - c.z / 200;
  const Vec3d rgb = product(rgb_from_xyz, {x * white.x, y * white.y, z * white.z});
  return {std::clamp(rgb.x, 0.0, 1.0), std::clamp(rgb.y, 0.0, 1.0), std::clamp(rgb.z, 0.0, 1.0)};
}

/// L*a*b* with Hunt's effect: dark colours look less chromatic.
Vec3d hunt_lab_of(const Vec3d& rgb) {
  const auto f = [](double t) {
    constexpr double delta = 6.0 / 29;
    return t > delta * delta * delta ? std::cbrt(t) : t / (3 * delta * delta) + 4.0 / 29;
  };
  const Vec3d xyz = product(xyz_from_rgb, rgb);
  const double x = f(xyz.x / white.x), y = f(xyz.y / white.y), z = f(xyz.z / white.z);
  const double lightness = 116 * y - 16;
  return {lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)};
}

double hyab(const Vec3d& a, const Vec3d& b) {
  return std::fabs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

// The two halves: colours seen through the eye's blur, and edges and points.
// -------------------------------------

/// Contrast sensitivity of the three opponent channels, each a sum of two Gaussians (a1, b1, a2, b2).
Kernel<Vec3d> sensitivity() {
  constexpr std::array<std::array<double, 4>, 3> terms{
      {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * pixels_per_degree));
  Kernel<Vec3d> kernel = kernel_of<Vec3d>(radius, [&](double x, double y) {
    const double z = (x * x + y * y) / (pixels_per_degree * pixels_per_degree);
    const auto weight = [&](const std::array<double, 4>& t) {
      return t[0] * std::sqrt(pi / t[1]) * std::exp(-pi * pi * z / t[1]) +
             t[2] * std::sqrt(pi / t[3]) * std::exp(-pi * pi * z / t[3]);
    };
    return Vec3d{weight(terms[0]), weight(terms[1]), weight(terms[2])};
  });
  Vec3d sum{};
  for (const Vec3d& w : kernel.weights) sum += w;
  for (Vec3d& w : kernel.weights) w = {w.x / sum.x, w.y / sum.y, w.z / sum.z};
  return kernel;
}

double redistributed(double error) {
  static const double largest = std::pow(hyab(hunt_lab_of({0, 1, 0}), hunt_lab_of({0, 0, 1})), 0.7);
  const double knee = 0.4 * largest;
  const double powered = std::pow(error, 0.7);
  return powered < knee ? 0.95 / knee * powered : 0.95 + (powered - knee) / (largest - knee) * 0.05;
}

/// First or second derivative of a Gaussian along x; negative and positive weights each sum to one.
Kernel<double> feature_kernel(bool second_derivative) {
  const double deviation = 0.5 * 0.082 * pixels_per_degree;
  Kernel<double> kernel =
      kernel_of<double>(static_cast<int>(std::ceil(3 * deviation)), [&](double x, double y) {
        const double gauss = std::exp(-(x * x + y * y) / (2 * deviation * deviation));
        return second_derivative ? (x * x / (deviation * deviation) - 1) * gauss : -x * gauss;
      });
  double negative = 0, positive = 0;
  for (const double w : kernel.weights) (w < 0 ? negative : positive) += w;
  for (double& w : kernel.weights) w /= w < 0 ? -negative : positive;
  return kernel;
}

Kernel<double> transposed(const Kernel<double>& kernel) {
  const int side = 2 * kernel.radius + 1;
  Kernel<double> result = kernel;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      result.weights[static_cast<std::size_t>(y * side + x)] =
          kernel.weights[static_cast<std::size_t>(x * side + y)];
  return result;
}

std::vector<double> feature_strength(const Plane2<double>& lightness, const Kernel<double>& along_x) {
  const Plane2<double> x = convolved(lightness, along_x), y = convolved(lightness, transposed(along_x));
  std::vector<double> strength(x.at.size());
  for (std::size_t i = 0; i < strength.size(); ++i) strength[i] = std::hypot(x.at[i], y.at[i]);
  return strength;
}

/// What the comparison needs of one picture.
struct Seen {
  std::vector<Vec3d> colors;  // Hunt-adjusted L*a*b* after the eye's blur
  std::vector<double> edges, points;
};

Seen seen(const Picture& picture) {
  const int width = static_cast<int>(picture.size.width), height = static_cast<int>(picture.size.height);
  Plane2<Vec3d> opponent{width, height, {}};
  Plane2<double> lightness{width, height, {}};
  const auto shown = [](float v) { return v > 0 ? std::min(double{v}, 1.0) : 0.0; };
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) {
    opponent.at.push_back(
        ycxcz_of({shown(picture.rgb[i]), shown(picture.rgb[i + 1]), shown(picture.rgb[i + 2])}));
    lightness.at.push_back((opponent.at.back().x + 16) / 116);
  }
  Seen result{convolved(opponent, sensitivity()).at, feature_strength(lightness, feature_kernel(false)),
              feature_strength(lightness, feature_kernel(true))};
  for (Vec3d& c : result.colors) c = hunt_lab_of(rgb_of_ycxcz(c));
  return result;
}

}  // namespace

std::vector<float> flip_error(const Picture& reference, const Picture& test) {
  const Seen a = seen(reference), b = seen(test);
  std::vector<float> error;
  error.reserve(reference.rgb.size());
  for (std::size_t i = 0; i < a.colors.size(); ++i) {
    const double color = redistributed(hyab(a.colors[i], b.colors[i]));
    const double feature = std::max(std::fabs(a.edges[i] - b.edges[i]), std::fabs(a.points[i] - b.points[i]));
    const double both = std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2));
    error.insert(error.end(), 3, static_cast<float>(both));
  }
  return error;
}

}  // namespace rayfarm
