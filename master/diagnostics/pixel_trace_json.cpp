#include <nlohmann/json.hpp>

#include "master/diagnostics/pixel_trace.h"

namespace rayfarm {
namespace {

using nlohmann::json;

json json_of(const Vec3d& v) { return json::array({v.x, v.y, v.z}); }

json json_of(const std::vector<Stretch>& stretches) {
  json all = json::array();
  for (const Stretch& s : stretches)
    all.push_back({{"in", s.in}, {"out", s.out < infinity ? json(s.out) : json()}});
  return all;
}

const char* name_of(LightFate fate) {
  constexpr const char* names[]{"ambient", "reached", "blocked", "behind"};
  return names[static_cast<int>(fate)];
}

/// Why the ray's path goes no further here; null where it does.
json end_of(const RayRecord& ray) {
  if (!ray.hit) return "missed";
  if (ray.depth_reached) return "depth";
  if (!ray.followed.empty()) return {};
  return ray.untraced.empty() ? "light" : "importance";
}

json json_of(const LightAtHit& light, double importance, const std::vector<std::string>& names) {
  json object{{"light", light.light},
              {"fate", name_of(light.fate)},
              {"importance", importance},
              {"color", json_of(light.color)},
              {"contribution", json_of(light.color * importance)}};
  if (light.fate != LightFate::ambient) object["at"] = json_of(light.at);
  if (light.blocker)
    object["blocker"] = {{"leaf", light.blocker->leaf},
                         {"name", names[light.blocker->leaf]},
                         {"point", json_of(light.blocker->point)}};
  return object;
}

json json_of(const RayRecord& ray, const std::vector<std::string>& names) {
  json object{{"kind", name_of(ray.kind)},
              {"depth", ray.depth},
              {"weight", ray.weight},
              {"importance", ray.importance},
              {"origin", json_of(ray.path.origin)},
              {"direction", json_of(ray.path.direction)},
              {"color", json_of(ray.color)},
              {"contribution", json_of(ray.color * ray.importance)},
              {"end", end_of(ray)},
              {"hit", nullptr},
              {"lights", json::array()},
              {"glows", json::array()},
              {"rays", json::array()},
              {"not_traced", json::array()}};
  if (ray.hit)
    object["hit"] = {{"leaf", ray.hit->leaf},
                     {"name", names[ray.hit->leaf]},
                     {"distance", ray.hit->distance},
                     {"point", json_of(ray.hit->point)},
                     {"normal", json_of(ray.hit->normal)},
                     {"surface_color", json_of(ray.hit->surface_color)},
                     {"entering", ray.hit->entering}};
  for (const LightAtHit& light : ray.lights)
    object["lights"].push_back(json_of(light, ray.importance, names));
  for (const GlowOnRay& glow : ray.glows)
    object["glows"].push_back({{"glow", glow.glow},
                               {"color", json_of(glow.color)},
                               {"contribution", json_of(glow.color * ray.importance)}});
  for (const RayRecord& followed : ray.followed) object["rays"].push_back(json_of(followed, names));
  for (const Untraced& u : ray.untraced)
    object["not_traced"].push_back(
        {{"kind", name_of(u.kind)},
         {"weight", u.weight},
         {"why", u.why == NotTraced::importance ? "importance" : "total reflection"}});
  return object;
}

}  // namespace

json to_json(const PixelTrace& trace) {
  json samples = json::array();
  for (const auto& [traced, story_ray, story] : trace.samples) {
    json leaves = json::array();
    for (const LeafStretches& leaf : story.leaves)
      leaves.push_back({{"leaf", leaf.leaf},
                        {"name", (*trace.leaf_names)[leaf.leaf]},
                        {"subtracted", leaf.is_subtracted},
                        {"stretches", json_of(leaf.stretches)}});
    samples.push_back(
        {{"sample", traced.number ? json(*traced.number) : json("centre")},
         {"film", {traced.x, traced.y}},
         {"weight", traced.weight},
         {"color", json_of(traced.ray.color)},
         {"ray", json_of(traced.ray, *trace.leaf_names)},
         {"csg", {{"ray", story_ray}, {"leaves", leaves}, {"material", json_of(story.material)}}}});
  }
  return {{"pixel", {trace.pixel.x, trace.pixel.y}}, {"samples", samples}, {"truncated", trace.truncated}};
}

}  // namespace rayfarm
