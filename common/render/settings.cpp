#include "common/render/settings.h"

#include <array>
#include <cmath>

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 4> sampler_names{"sobol", "jitter", "regular", "random"};

bool is_square(std::uint32_t n) {
  std::uint32_t root = 0;
  while (root * root < n) ++root;
  return root * root == n;
}

}  // namespace

std::string_view name_of(SamplerKind kind) { return sampler_names[static_cast<std::size_t>(kind)]; }

std::optional<SamplerKind> sampler_named(std::string_view name) {
  for (std::size_t i = 0; i < sampler_names.size(); ++i)
    if (sampler_names[i] == name) return static_cast<SamplerKind>(i);
  return std::nullopt;
}

void check(const RenderSettings& s) {
  const auto number = [](auto n) { return std::to_string(n); };
  if (s.width < 1 || s.height < 1 || s.width > max_side || s.height > max_side)
    throw SettingsError("--size must be 1x1 to " + number(max_side) + "x" + number(max_side) + ", is " +
                        number(s.width) + "x" + number(s.height));
  if (std::uint64_t{s.width} * s.height > max_pixels)
    throw SettingsError("--size must have at most " + number(max_pixels / 1'000'000) + " megapixels, is " +
                        number(s.width) + "x" + number(s.height));
  if (s.spp < 1 || s.spp > max_spp)
    throw SettingsError("--spp must be 1 to " + number(max_spp) + ", is " + number(s.spp));
  if (static_cast<std::size_t>(s.sampler) >= sampler_names.size())
    throw SettingsError("--sampler must be sobol, jitter, regular or random");
  if ((s.sampler == SamplerKind::jitter || s.sampler == SamplerKind::regular) && !is_square(s.spp)) {
    const auto below = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(s.spp)));
    throw SettingsError("--sampler " + std::string(name_of(s.sampler)) +
                        " wants a square number of samples; --spp " + number(s.spp) + " is none, " +
                        number(below * below) + " and " + number((below + 1) * (below + 1)) + " are");
  }
  if (s.max_depth > max_recursion_depth)
    throw SettingsError("--depth must be 0 to " + number(max_recursion_depth) + ", is " +
                        number(s.max_depth));
  if (!(s.min_importance >= 0 && s.min_importance <= 1))
    throw SettingsError("--min-importance must be 0 to 1, is " + number(s.min_importance));
}

}  // namespace rayfarm
