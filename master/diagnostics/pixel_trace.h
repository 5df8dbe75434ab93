// Traced samples of a pixel as people and programs read them.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "master/diagnostics/csg_story.h"
#include "master/diagnostics/ray_tree.h"

namespace rayfarm {

struct PixelTrace {
  Pixel pixel;
  struct Sample {
    TracedSample traced;
    CsgStory story;  // of the primary ray
  };
  std::vector<Sample> samples;
  std::vector<std::string> leaf_names;  // by leaf
};

/// Which samples of the pixel: traced with its story.
PixelTrace::Sample with_story(const World& world, TracedSample traced);

/// An indented tree for each sample, a line for each ray and light; ends in a newline.
std::string text_of(const PixelTrace& trace);
/// Infinite lengths are null; colours and vectors are arrays of three.
nlohmann::json to_json(const PixelTrace& trace);
/// A drawing, seen along the axis that shows the rays largest: red what the camera sees, yellow to the lights, dark
/// behind what blocks them.
std::string svg_of(const PixelTrace& trace);

}  // namespace rayfarm
