#include "tests/support/moved_scene.h"

#include <cmath>

namespace rayfarm {

Scene scaled(Scene scene, int k) {
  const double f = std::ldexp(1.0, k);
  Affine& root = scene.nodes[0].parent_from_node;
  root.linear *= f, root.offset *= f;
  std::visit([&](auto& camera) { camera.from *= f; }, scene.camera);
  if (auto* parabolic = std::get_if<ParabolicCamera>(&scene.camera)) parabolic->size *= f;
  if (auto* orthographic = std::get_if<OrthographicCamera>(&scene.camera)) orthographic->width *= f;
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light)) point->at *= f;
    if (auto* r = std::get_if<RectangleLight>(&light)) {
      r->at *= f, r->width *= f, r->height *= f;
      r->dim[1] /= f, r->dim[2] /= f * f;
    }
  }
  return scene;
}

Scene shifted(Scene scene, const glm::dvec3& by) {
  scene.nodes[0].parent_from_node.offset += by;
  std::visit([&](auto& camera) { camera.from += by; }, scene.camera);
  for (Light& light : scene.lights) {
    if (auto* point = std::get_if<PointLight>(&light)) point->at += by;
    if (auto* rectangle = std::get_if<RectangleLight>(&light)) rectangle->at += by;
  }
  return scene;
}

}  // namespace rayfarm
