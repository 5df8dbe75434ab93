// A small job, as a submitter sends it.
#pragma once
#include "common/net/codec.h"
#include "master/farm.h"
#include "tests/support/simple_job.h"

namespace rayfarm {

/// 96x80 pixels: four tiles of one sphere.
inline JobSpec small_job() {
  const SceneData scene = scene_data(simple_scene());
  JobSpec spec;
  spec.name = "small";
  spec.output = "small.exr";
  spec.scene_hash = scene.hash;
  spec.scene_bytes = scene.bytes;
  spec.settings.width = 96, spec.settings.height = 80, spec.settings.spp = 4;
  return spec;
}

}  // namespace rayfarm
