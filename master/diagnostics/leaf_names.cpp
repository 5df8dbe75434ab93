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

}  // namespace

std::vector<std::string> leaf_names(const Scene& scene) {
  std::vector<std::string> names;
  add_names(scene, 0, "", names);
  return names;
}

}  // namespace rayfarm
