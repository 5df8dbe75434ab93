// What people call the leaves of a scene's tree.
#pragma once
#include <string>
#include <vector>

#include "common/scene/scene.h"

namespace rayfarm {

/// By leaf number (in preorder): the names on the way down to it, its kind unless it has a name of its own,
/// and its number: "clown/sphere #12", "floor #0".
std::vector<std::string> leaf_names(const Scene& scene);
/// By leaf: whether differences take it away (and no other difference takes that away again).
std::vector<bool> subtracted_leaves(const Scene& scene);

}  // namespace rayfarm
