#include <cstdio>

#include "master/diagnostics/pixel_trace.h"

namespace rayfarm {
namespace {

std::string shown(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", number);
  return text;
}

std::string shown(const Vec3d& v) { return "(" + shown(v.x) + ", " + shown(v.y) + ", " + shown(v.z) + ")"; }

std::string shown(const std::vector<Stretch>& stretches) {
  std::string all;
  for (const Stretch& s : stretches) all += (all.empty() ? "" : ", ") + shown(s.in) + " to " + shown(s.out);
  return all.empty() ? "nowhere" : all;
}

class Writer {
 public:
  explicit Writer(const std::vector<std::string>& leaf_names) : names_(leaf_names) {}

  void add(const PixelTrace::Sample& sample, Pixel pixel) {
    const TracedSample& traced = sample.traced;
    line(0, "pixel " + std::to_string(pixel.x) + "," + std::to_string(pixel.y) +
                (traced.number ? " sample " + std::to_string(*traced.number) : " centre") + " at film (" +
                shown(traced.x) + ", " + shown(traced.y) + "): color " + shown(traced.ray.color));
    next_ray_ = 0;
    add(traced.ray, 1);
    line(1, "along ray " + std::to_string(sample.story_ray));
    for (const LeafStretches& leaf : sample.story.leaves)
      line(2, "in " + names_[leaf.leaf] + (leaf.is_subtracted ? " (subtracted)" : "") + ": " +
                  shown(leaf.stretches));
    line(2, "in material: " + shown(sample.story.material));
  }
  std::string text;

 private:
  void line(std::size_t level, const std::string& words) {
    text += std::string(2 * level, ' ') + words + '\n';
  }

  void add(const RayRecord& ray, std::size_t level) {
    std::string words = "ray " + std::to_string(next_ray_++) + ", " + name_of(ray.kind) + ", from " +
                        shown(ray.path.origin) + " weight " + shown(ray.weight) + " importance " +
                        shown(ray.importance) + " adds " + shown(ray.color * ray.importance);
    if (ray.hit)
      line(level, words + ": " + (ray.hit->entering ? "enters " : "leaves ") + names_[ray.hit->leaf] +
                      " at " + shown(ray.hit->point) + " after " + shown(ray.hit->distance) + ", normal " +
                      shown(ray.hit->normal));
    else
      line(level, words + ": missed, towards " + shown(ray.path.direction));
    for (const GlowOnRay& glow : ray.glows)
      line(level + 1,
           "through glow shell " + std::to_string(glow.glow) + " adds " + shown(glow.color * ray.importance));
    for (const LightAtHit& light : ray.lights) add(light, ray.importance, level + 1);
    for (const RayRecord& followed : ray.followed) add(followed, level + 1);
    for (const Untraced& untraced : ray.untraced)
      line(level + 1,
           std::string(name_of(untraced.kind)) + " ray of weight " + shown(untraced.weight) +
               " not traced: " +
               (untraced.why == NotTraced::importance ? "too little importance" : "total reflection"));
    if (ray.depth_reached)
      line(level + 1, "no rays followed: depth " + std::to_string(ray.depth) + " is the last");
  }

  void add(const LightAtHit& light, double importance, std::size_t level) {
    const std::string number = "light " + std::to_string(light.light);
    const std::string adds = " adds " + shown(light.color * importance);
    switch (light.fate) {
      case LightFate::ambient:
        return line(level, "ambient " + number + adds);
      case LightFate::reached:
        return line(level, "shadow ray to " + number + " at " + shown(light.at) + " reached it," + adds);
      case LightFate::behind:
        return line(level, number + " at " + shown(light.at) + " is behind the surface");
      case LightFate::blocked:
        return line(level, "shadow ray to " + number + " at " + shown(light.at) + " blocked" +
                               (light.blocker ? " by " + names_[light.blocker->leaf] + " at " +
                                                    shown(light.blocker->point)
                                              : " at once"));
    }
  }

  const std::vector<std::string>& names_;
  std::uint32_t next_ray_ = 0;  // of the sample
};

}  // namespace

std::string text_of(const PixelTrace& trace) {
  Writer writer(*trace.leaf_names);
  for (const PixelTrace::Sample& sample : trace.samples) writer.add(sample, trace.pixel);
  if (trace.samples.empty()) writer.text += "the camera has no ray there\n";
  if (trace.truncated) writer.text += "there are more rays than these\n";
  return std::move(writer.text);
}

}  // namespace rayfarm
