#include "common/render/settings.h"

#include <array>
#include <cmath>

namespace rayfarm {
namespace {

constexpr std::array<std::string_view, 5> names{"sobol", "jitter", "regular", "random", "adapt1"};
static_assert(names.size() == static_cast<std::size_t>(last_sampler) + 1);

bool wants_a_square(SamplerKind kind) {
  return kind == SamplerKind::jitter || kind == SamplerKind::regular || kind == SamplerKind::adapt1;
}

bool is_square(std::uint32_t n) {
  std::uint32_t root = 0;
  while (root * root < n) ++root;
  return root * root == n;
}

}  // namespace

std::string_view name_of(SamplerKind kind) { return names[static_cast<std::size_t>(kind)]; }

std::optional<SamplerKind> sampler_named(std::string_view name) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<SamplerKind>(i);
  return std::nullopt;
}

std::string sampler_names() {
  std::string list(names.front());
  for (std::size_t i = 1; i < names.size(); ++i)
    list.append(i + 1 < names.size() ? ", " : " or ").append(names[i]);
  return list;
}

void leave_out(RenderSettings& s, const ImageDefaults& scene) {
  s.shadows = s.shadows && scene.shadows;
  s.reflections = s.reflections && scene.reflections;
  s.refractions = s.refractions && scene.refractions;
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
  if (s.sampler > last_sampler) throw SettingsError("--sampler must be " + sampler_names());
  if (wants_a_square(s.sampler) && !is_square(s.spp)) {
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
