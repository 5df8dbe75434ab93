#include "master/files/picture_facts.h"

#include <charconv>

namespace rayfarm {
namespace {

/// The shortest text that reads back as the same number, in any locale.
std::string text_of(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string text_of(bool on) { return on ? "yes" : "no"; }

}  // namespace

std::map<std::string, std::string> facts_of(const std::string& scene_hash, const RenderSettings& s) {
  return {
      {"Software", "rayfarm " RAYFARM_VERSION},
      {"rayfarm:scene_hash", scene_hash},
      {"rayfarm:samples_per_pixel", std::to_string(s.spp)},
      {"rayfarm:sampler", std::string(name_of(s.sampler))},
      {"rayfarm:seed", std::to_string(s.seed)},  // as text: 64 bits fit no number of a header
      {"rayfarm:frame", std::to_string(s.frame)},
      {"rayfarm:max_depth", std::to_string(s.max_depth)},
      {"rayfarm:min_importance", text_of(s.min_importance)},
      {"rayfarm:shadows", text_of(s.shadows)},
      {"rayfarm:reflections", text_of(s.reflections)},
      {"rayfarm:refractions", text_of(s.refractions)},
  };
}

}  // namespace rayfarm
