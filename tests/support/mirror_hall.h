// A glass ball in a mirroring hall: one sample traces 2^depth rays.
#pragma once
#include "common/scene/scene.h"

namespace rayfarm {

inline Scene mirror_hall() {
  Scene scene;
  Material glass;
  glass.specular = 1, glass.transmission = 1;
  scene.materials = {glass};
  scene.nodes = {{Operation{CsgOp::unite, 2}, {}, 0u, {}, {}, {}},
                 {Sphere{}, {}, {}, {}, {}, {}},
                 {Operation{CsgOp::subtract, 2}, {}, {}, {}, {}, {}},
                 {Sphere{}, scaling({20, 20, 20}), {}, {}, {}, {}},
                 {Sphere{}, scaling({10, 10, 10}), {}, {}, {}, {}}};
  scene.camera = PerspectiveCamera{{0, 0, -5}, {0, 0, 1}, {0, 1, 0}, 10};
  return scene;
}

}  // namespace rayfarm
