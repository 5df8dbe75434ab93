#include "common/render/world.h"

#include <unordered_map>

#include "common/render/world_parts.h"

namespace rayfarm {
namespace {

/// What a subtree inherits.
struct Inherited {
  BoundedAffine world_from_parent;
  std::optional<Vec3d> color;
  std::uint32_t material = 0;
  std::uint32_t first_texture = 0, textures = 0;  // range of Parts::textures, those of ancestors first
  bool casts_shadow = true;
};

/// Walks the scene's tree once and fills the flat arrays.
class Builder {
 public:
  explicit Builder(World::Parts& parts) : parts_(parts) {}

  void build() {
    Inherited top;
    top.material = static_cast<std::uint32_t>(parts_.scene.materials.size());
    add_objects(0, top);
    parts_.placements.shrink_to_fit();
    sort_objects();
  }

 private:
  const Node& node(std::uint32_t i) const { return parts_.scene.nodes[i]; }

  Inherited inherited_by(std::uint32_t number, const Inherited& from_above) {
    const Node& n = node(number);
    Inherited result = from_above;
    result.world_from_parent = from_above.world_from_parent * bounded(n.parent_from_node);
    result.material = n.material.value_or(from_above.material);
    if (n.color) result.color = vec(*n.color);
    if (n.no_shadow) result.casts_shadow = false;
    if (n.textures.empty()) return result;
    // A new range, shared by all that inherits it.
    result.first_texture = static_cast<std::uint32_t>(parts_.textures.size());
    result.textures = from_above.textures + static_cast<std::uint32_t>(n.textures.size());
    for (std::uint32_t i = 0; i < from_above.textures; ++i)
      parts_.textures.push_back(Texture(parts_.textures[from_above.first_texture + i]));
    parts_.textures.insert(parts_.textures.end(), n.textures.begin(), n.textures.end());
    return result;
  }

  /// Splits unions into their parts; anything else but a glow shell becomes an object. Returns the node after the
  /// subtree.
  std::uint32_t add_objects(std::uint32_t number, const Inherited& above) {
    if (const Glow* glow = std::get_if<Glow>(&node(number).content)) {
      parts_.glows.push_back(
          make_glow_shell(*glow, above.world_from_parent * bounded(node(number).parent_from_node)));
      return number + 1;
    }
    const Operation* operation = std::get_if<Operation>(&node(number).content);
    if (operation && operation->op == CsgOp::unite) {
      const Inherited inherited = inherited_by(number, above);
      std::uint32_t child = number + 1;
      for (std::uint32_t i = 0; i < operation->children; ++i) child = add_objects(child, inherited);
      return child;
    }
    const auto first = static_cast<std::uint32_t>(parts_.items.size());
    const std::uint32_t next = add_item(number, above, first, 0).next;
    cut(first);
    find_twins(first);
    parts_.objects.push_back({first, static_cast<std::uint32_t>(parts_.items.size()) - first});
    return next;
  }

  /// A subtree's box in two frames. A rotated long thing cut short is small in its own frame only, so each
  /// inner node's box is the overlap of what both frames say.
  struct Boxes {
    Box world, parent;
  };

  struct Added {
    std::uint32_t next;  // the node after the subtree
    Boxes boxes;
  };

  Added add_item(std::uint32_t number, const Inherited& above, std::uint32_t object, std::uint32_t parent) {
    const Inherited inherited = inherited_by(number, above);
    const BoundedAffine parent_from_node = bounded(node(number).parent_from_node);
    const auto index = static_cast<std::uint32_t>(parts_.items.size());
    parts_.items.emplace_back().parent = parent;
    Added added{number + 1, {}};
    if (const Operation* operation = std::get_if<Operation>(&node(number).content)) {
      parts_.items[index].op = operation->op;
      parts_.items[index].children = operation->children;
      Boxes combined;
      for (std::uint32_t i = 0; i < operation->children; ++i) {
        const auto child = static_cast<std::uint32_t>(parts_.items.size());
        const Added below = add_item(added.next, inherited, object, index - object);
        added.next = below.next;
        parts_.items[child].weight = operation->op == CsgOp::subtract && i > 0 ? 2 : 1;
        combined.world = box_after(operation->op, i, combined.world, below.boxes.world);
        combined.parent = box_after(operation->op, i, combined.parent, below.boxes.parent);
      }
      added.boxes = {overlap(combined.world, moved(combined.parent, inherited.world_from_parent)),
                     moved(combined.parent, parent_from_node)};
    } else {
      const Solid& solid = std::get<Solid>(node(number).content);
      const std::uint32_t* asset = asset_of(solid);
      const Facets* facets = asset ? parts_.scene.assets[*asset].facets() : nullptr;
      parts_.items[index].leaf = add_leaf(make_leaf(solid, inherited.world_from_parent, facets), inherited);
      added.boxes = {bounds_of(solid, inherited.world_from_parent, facets),
                     bounds_of(solid, parent_from_node, facets)};
    }
    parts_.items[index].box = added.boxes.world;
    parts_.items[index].next = static_cast<std::uint32_t>(parts_.items.size()) - object;
    return added;
  }

  static Box box_after(CsgOp op, std::uint32_t child, const Box& so_far, const Box& box) {
    if (child == 0) return box;
    if (op == CsgOp::intersect) return overlap(so_far, box);
    return op == CsgOp::subtract ? so_far : hull(so_far, box);
  }

  std::uint32_t add_leaf(const Leaf& leaf, const Inherited& inherited) {
    parts_.leaves.push_back(leaf);
    parts_.leaves.back().surface = surface_of(leaf);
    parts_.placements.push_back(make_placement(inherited.world_from_parent));
    LeafSurface surface;
    surface.material = inherited.material;
    surface.color = inherited.color.value_or(vec(parts_.materials[inherited.material].color));
    surface.first_texture = inherited.first_texture, surface.textures = inherited.textures;
    surface.casts_shadow = inherited.casts_shadow;
    parts_.all_cast_shadows = parts_.all_cast_shadows && surface.casts_shadow;
    parts_.surfaces.push_back(surface);
    return static_cast<std::uint32_t>(parts_.leaves.size() - 1);
  }

  /// The number of the first leaf like the last one, its own if there is none.
  std::uint32_t surface_of(const Leaf& last) {
    const std::uint64_t hash = twin_hash(last);
    const auto [begin, end] = first_of_twins_.equal_range(hash);
    for (auto it = begin; it != end; ++it)
      if (are_twins(parts_.leaves[it->second], last)) return it->second;
    const auto number = static_cast<std::uint32_t>(parts_.leaves.size() - 1);
    first_of_twins_.emplace(hash, number);
    return number;
  }

  /// What lies outside the box of what it is combined with cannot matter.
  void cut(std::uint32_t first) {
    for (std::size_t i = first; i < parts_.items.size(); ++i) {
      Box& box = parts_.items[i].box;
      box = overlap(box, parts_.items[first + parts_.items[i].parent].box);
      if (box.is_empty()) box = nowhere();
    }
  }

  /// Which of an object's items are the same surface.
  void find_twins(std::uint32_t first) {
    std::unordered_map<std::uint32_t, std::uint32_t> first_of;  // by surface
    for (std::uint32_t i = first; i < parts_.items.size(); ++i) {
      CsgItem& item = parts_.items[i];
      if (item.leaf == no_leaf) continue;
      const auto [known, is_first] = first_of.emplace(parts_.leaves[item.leaf].surface, i - first);
      if (!is_first) item.first_twin = parts_.items[first + known->second].first_twin = known->second;
    }
  }

  void sort_objects() {
    std::vector<Box> boxes;
    std::vector<ObjectRef> bounded;
    for (std::uint32_t i = 0; i < parts_.objects.size(); ++i) {
      const CsgItem& root = parts_.items[parts_.objects[i].first_item];
      if (root.box.low.x == infinity) continue;  // nowhere
      const bool has_facets = root.leaf != no_leaf && parts_.leaves[root.leaf].facets;
      const ObjectRef ref = has_facets ? ObjectRef{i, no_leaf, root.leaf} : ObjectRef{i, root.leaf};
      if (root.box.is_bounded())
        bounded.push_back(ref), boxes.push_back(root.box);
      else
        parts_.endless_objects.push_back(ref);
    }
    parts_.bvh = Bvh(boxes);
    for (const std::uint32_t number : parts_.bvh.order()) parts_.bounded_objects.push_back(bounded[number]);
  }

  World::Parts& parts_;
  std::unordered_multimap<std::uint64_t, std::uint32_t> first_of_twins_;  // by twin_hash()
};

std::unique_ptr<const World::Parts> built(Scene scene) {
  auto parts = std::make_unique<World::Parts>();
  parts->scene = std::move(scene);
  parts->materials = parts->scene.materials;
  parts->materials.emplace_back();
  Builder(*parts).build();
  return parts;
}

}  // namespace

World::World(Scene scene) : parts_(built(std::move(scene))) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

const Scene& World::scene() const { return parts_->scene; }

}  // namespace rayfarm
