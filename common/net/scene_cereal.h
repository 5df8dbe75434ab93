// The fields of a scene, in the order in which they travel.
#pragma once
#include "common/net/cereal_io.h"
#include "common/scene/scene.h"

namespace rayfarm {

template <class Archive>
void serialize(Archive& archive, Affine& a) {
  archive(a.linear[0], a.linear[1], a.linear[2], a.offset);
}
template <class Archive>
void serialize(Archive& archive, Cylinder& c) {
  archive(c.z_min, c.z_max);
}
template <class Archive>
void serialize(Archive& archive, Cone& c) {
  archive(c.z_min, c.z_max);
}
template <class Archive>
void serialize(Archive& archive, Torus& t) {
  archive(t.R, t.r);
}
template <class Archive>
void serialize(Archive& archive, RoundedCube& c) {
  archive(c.r);
}
template <class Archive>
void serialize(Archive& archive, Mesh& m) {
  archive(m.asset);
  boolean(archive, m.smooth);
}
template <class Archive>
void serialize(Archive& archive, Bezier& b) {
  archive(b.asset);
}
template <class Archive>
void serialize(Archive& archive, Material& m) {
  archive(m.color, m.ambient, m.diffuse, m.specular, m.exponent, m.transmission, m.index, m.schlick);
}
template <class Archive>
void serialize(Archive& archive, Checker& c) {
  archive(c.fu, c.fv, c.color);
}
template <class Archive>
void serialize(Archive& archive, Stripes& s) {
  archive(s.fu, s.fv, s.color);
}
template <class Archive>
void serialize(Archive& archive, Glow& g) {
  archive(g.shape, g.color, g.exponent);
}
template <class Archive>
void serialize(Archive& archive, ImageTexture& i) {
  archive(i.asset, i.fu, i.fv);
  boolean(archive, i.smooth);
}
/// Its content travels by itself.
template <class Archive>
void serialize(Archive& archive, Asset& a) {
  std::string digest = a.digest();
  text(archive, digest, 64);
  if constexpr (is_loading<Archive>) a = Asset(digest);
}
template <class Archive>
void serialize(Archive& archive, Operation& o) {
  enumeration(archive, o.op, CsgOp::exclusive_or);
  archive(o.children);
}
template <class Archive>
void serialize(Archive& archive, Node& n) {
  archive(n.content, n.parent_from_node, n.material, n.color, n.textures);
  text(archive, n.name, max_name);
  boolean(archive, n.no_shadow);
}
template <class Archive>
void serialize(Archive& archive, PerspectiveCamera& c) {
  archive(c.from, c.direction, c.up, c.angle_deg);
}
template <class Archive>
void serialize(Archive& archive, FisheyeCamera& c) {
  archive(c.from, c.direction, c.up, c.angle_deg);
}
template <class Archive>
void serialize(Archive& archive, ParabolicCamera& c) {
  archive(c.from, c.direction, c.up, c.radius, c.size);
}
template <class Archive>
void serialize(Archive& archive, OrthographicCamera& c) {
  archive(c.from, c.direction, c.up, c.width);
}
template <class Archive>
void serialize(Archive& archive, AmbientLight& l) {
  archive(l.intensity);
}
template <class Archive>
void serialize(Archive& archive, PointLight& l) {
  archive(l.at, l.intensity);
}
template <class Archive>
void serialize(Archive& archive, RectangleLight& l) {
  archive(l.at, l.width, l.height, l.intensity, l.dim);
}
template <class Archive>
void serialize(Archive& archive, ImageDefaults& i) {
  archive(i.width, i.height, i.spp);
  boolean(archive, i.shadows), boolean(archive, i.reflections), boolean(archive, i.refractions);
}
template <class Archive>
void serialize(Archive& archive, Animation& a) {
  archive(a.start, a.stop, a.fps);
}
template <class Archive>
void serialize(Archive& archive, Scene& s) {
  archive(s.nodes, s.materials, s.assets, s.camera, s.background, s.lights, s.image, s.animation);
  boolean(archive, s.nested_media);
}

}  // namespace rayfarm
