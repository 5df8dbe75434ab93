// How a picture is made. Together with the scene these decide every bit of it.
#pragma once
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "common/scene/scene.h"

namespace rayfarm {

enum class SamplerKind : std::uint8_t { sobol, jitter, regular, random, adapt1 };
constexpr SamplerKind last_sampler = SamplerKind::adapt1;

std::string_view name_of(SamplerKind kind);
std::optional<SamplerKind> sampler_named(std::string_view name);
/// "sobol, jitter, ... or adapt1", for messages.
std::string sampler_names();

struct RenderSettings {
  std::uint32_t width = 640, height = 480;  // pixels
  std::uint32_t spp = 16;                   // primary samples per pixel; adapt1: see adapt1.h
  SamplerKind sampler = SamplerKind::sobol;
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  std::uint32_t max_depth = 12;  // a primary ray has depth 0
  double min_importance = 0.05;  // a secondary ray of less importance is not traced
  bool shadows = true, reflections = true, refractions = true;
  bool operator==(const RenderSettings&) const = default;
};

/// Switches off the effects that the scene does without.
void leave_out(RenderSettings& settings, const ImageDefaults& scene);

/// Settings that cannot be used; the message names the option and the fix.
struct SettingsError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr std::uint32_t max_side = 60'000;  // pixels
constexpr std::uint64_t max_pixels = 500'000'000;
constexpr std::uint32_t max_spp = 1u << 20;
constexpr std::uint32_t max_recursion_depth = 100;

/// Throws SettingsError unless the settings can be rendered.
void check(const RenderSettings& settings);

}  // namespace rayfarm
