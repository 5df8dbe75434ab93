// Traced samples of a pixel as people and programs read them.
#pragma once
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "master/diagnostics/csg_story.h"
#include "master/diagnostics/ray_tree.h"

namespace rayfarm {

using LeafNames = std::shared_ptr<const std::vector<std::string>>;

struct PixelTrace {
  Pixel pixel;
  struct Sample {
    TracedSample traced;
    std::uint32_t story_ray = 0;  // which of its rays: numbers as in text_of(), parents before their children
    CsgStory story;
  };
  std::vector<Sample> samples;
  LeafNames leaf_names;    // by leaf
  bool truncated = false;  // there were more rays than the limits allow
};

/// As traced_samples(). The story is told of ray number story_ray; throws SettingsError when there is no such ray, or
/// when another than the primary one is asked for of all samples.
PixelTrace pixel_trace(const World& world, LeafNames leaf_names, const RenderSettings& settings, Pixel pixel,
                       const SampleChoice& choice, std::uint32_t story_ray = 0,
                       const RecordLimits& limits = {});

/// An indented tree for each sample, a line for each ray and light; ends in a newline.
std::string text_of(const PixelTrace& trace);
/// Infinite lengths are null; colours and vectors are arrays of three.
nlohmann::json to_json(const PixelTrace& trace);
/// A drawing, seen along the axis that shows the rays largest: red what the camera sees, yellow to the lights, dark
/// behind what blocks them.
std::string svg_of(const PixelTrace& trace);

}  // namespace rayfarm
