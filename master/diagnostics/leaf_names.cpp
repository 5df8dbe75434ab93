#include "master/diagnostics/leaf_names.h"

namespace rayfarm {

namespace {

/// Returns the node after the subtree.
std::size_t add_names(const Scene& scene, std::size_t number, const std::string& above,
                      std::vector<std::string>& names) {
  const Node& node = scene.nodes[number];
  if (const auto* solid = std::get_if<Solid>(&node.content)) {
    const std::string own = node.name.empty() ? std::string(kind_of(*solid)) : node.name;
    names.push_back(above + own + " #" + std::to_string(names.size()));
    return number + 1;
  }
  if (std::holds_alternative<Glow>(node.content)) return number + 1;  // is no leaf
  const std::string path = node.name.empty() ? above : above + node.name + "/";
  const std::uint32_t children = std::get<Operation>(node.content).children;
  std::size_t next = number + 1;
  for (std::uint32_t i = 0; i < children; ++i) next = add_names(scene, next, path, names);
  return next;
}

std::size_t add_signs(const Scene& scene, std::size_t number, bool subtracted, std::vector<bool>& leaves) {
  const Node& node = scene.nodes[number];
  if (std::holds_alternative<Solid>(node.content)) leaves.push_back(subtracted);
  const auto* operation = std::get_if<Operation>(&node.content);
  std::size_t next = number + 1;
  for (std::uint32_t i = 0; operation && i < operation->children; ++i)
    next = add_signs(scene, next, subtracted != (operation->op == CsgOp::subtract && i > 0), leaves);
  return next;
}

}  // namespace

std::vector<bool> subtracted_leaves(const Scene& scene) {
  std::vector<bool> leaves;
  add_signs(scene, 0, false, leaves);
  return leaves;
}

std::vector<std::string> leaf_names(const Scene& scene) {
  std::vector<std::string> names;
  add_names(scene, 0, "", names);
  return names;
}

}  // namespace rayfarm
