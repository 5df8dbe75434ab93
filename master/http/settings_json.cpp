#include "master/http/settings_json.h"

#include <limits>
#include <nlohmann/json.hpp>

namespace rayfarm {
namespace {

using nlohmann::json;

template <class Unsigned>
void read(const std::string& name, const json& value, Unsigned& into) {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() > std::numeric_limits<Unsigned>::max())
    throw SettingsError("settings." + name + " must be a whole number, 0 or more, is " + value.dump());
  into = value.get<Unsigned>();
}
void read(const std::string& name, const json& value, double& into) {
  if (!value.is_number()) throw SettingsError("settings." + name + " must be a number, is " + value.dump());
  into = value.get<double>();
}
void read(const std::string& name, const json& value, bool& into) {
  if (!value.is_boolean())
    throw SettingsError("settings." + name + " must be true or false, is " + value.dump());
  into = value.get<bool>();
}
void read(const std::string& name, const json& value, SamplerKind& into) {
  const auto sampler = value.is_string() ? sampler_named(value.get<std::string>()) : std::nullopt;
  if (!sampler)
    throw SettingsError("settings." + name + " must be " + sampler_names() + ", is " + value.dump());
  into = *sampler;
}

/// Calls visit(name, member) for each member: the one list of them.
template <class Settings, class Visit>
void for_each_member(Settings& s, Visit&& visit) {
  visit("width", s.width);
  visit("height", s.height);
  visit("spp", s.spp);
  visit("sampler", s.sampler);
  visit("seed", s.seed);
  visit("frame", s.frame);
  visit("max_depth", s.max_depth);
  visit("min_importance", s.min_importance);
  visit("shadows", s.shadows);
  visit("reflections", s.reflections);
  visit("refractions", s.refractions);
}

json shown(SamplerKind sampler) { return name_of(sampler); }
template <class Plain>
json shown(Plain value) {
  return value;
}

}  // namespace

json to_json(const RenderSettings& settings) {
  json object = json::object();
  for_each_member(settings, [&](const char* name, const auto& value) { object[name] = shown(value); });
  return object;
}

RenderSettings settings_from_json(const json& value) {
  if (!value.is_object()) throw SettingsError("settings must be an object");
  RenderSettings settings;
  std::size_t known = 0;
  for_each_member(settings, [&](const char* name, auto& member) {
    const auto found = value.find(name);
    if (found == value.end()) return;
    read(name, *found, member);
    ++known;
  });
  if (known != value.size()) {
    const json all = to_json(settings);
    for (const auto& [name, ignored] : value.items())
      if (!all.contains(name)) throw SettingsError("settings." + name + " is unknown");
  }
  check(settings);
  return settings;
}

json to_json(const RayCounters& c) {
  return {{"primary", c.primary}, {"reflected", c.reflected},       {"refracted", c.refracted},
          {"shadow", c.shadow},   {"primary_hits", c.primary_hits}, {"secondary_hits", c.secondary_hits},
          {"rays", c.rays()},     {"misses", c.misses()},           {"bad_samples", c.bad_samples},
          {"lost", c.lost}};
}

}  // namespace rayfarm
