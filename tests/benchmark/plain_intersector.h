// How a renderer answers rays that does not care to be right in hard cases: textbook formulas in double precision, no
// error bounds, and what lies nearer than a fixed distance is the surface that the ray leaves. Everything else is as
// ours: the same hierarchy, the same trees, the crossings of an object's leaves sorted and its value followed.
#pragma once
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "common/geometry/gather.h"
#include "common/math/overload.h"
#include "common/render/world_parts.h"

namespace rayfarm::benchmarks {

constexpr double too_near = 1e-4;  // as in the original

struct PlainSpan {
  double enter = infinity, leave = -infinity;
  bool is_ahead() const { return enter < leave && leave > too_near; }
};

struct PlainLeaf {
  Vec3d row[3], offset;
  Solid solid;
};

struct PlainHit {
  std::uint32_t leaf;
  double t;
  Vec3d point, normal;
};

namespace plain {

inline PlainSpan cut(const PlainSpan& a, const PlainSpan& b) {
  return {std::max(a.enter, b.enter), std::min(a.leave, b.leave)};
}

inline PlainSpan between(double a, double b) { return {std::min(a, b), std::max(a, b)}; }

inline PlainSpan quadric(double A, double B, double C) {
  const double disc = B * B - A * C;
  if (!(disc > 0) || A == 0) return {};
  const double root = std::sqrt(disc), per_A = 1 / A;
  return {(-B - root) * per_A, (-B + root) * per_A};
}

inline PlainSpan slab(double o, double d, double low, double high) {
  const double per_d = 1 / d;
  return between((low - o) * per_d, (high - o) * per_d);
}

inline PlainSpan span(const Sphere&, const Vec3d& o, const Vec3d& d) {
  return quadric(dot(d, d), dot(o, d), dot(o, o) - 1);
}
inline PlainSpan span(const Cylinder& c, const Vec3d& o, const Vec3d& d) {
  const PlainSpan tube = quadric(d.x * d.x + d.y * d.y, o.x * d.x + o.y * d.y, o.x * o.x + o.y * o.y - 1);
  return tube.is_ahead() ? cut(tube, slab(o.z, d.z, c.z_min, c.z_max)) : PlainSpan{};
}
inline PlainSpan span(const Cube&, const Vec3d& o, const Vec3d& d) {
  return cut(cut(slab(o.x, d.x, 0, 1), slab(o.y, d.y, 0, 1)), slab(o.z, d.z, 0, 1));
}
inline PlainSpan span(const Plane&, const Vec3d& o, const Vec3d& d) {
  const double t = -o.z / d.z;
  return d.z < 0 ? PlainSpan{t, infinity} : PlainSpan{-infinity, t};
}
template <class Other>
PlainSpan span(const Other&, const Vec3d&, const Vec3d&) {
  throw std::invalid_argument("no plain formula for this solid");
}

inline Vec3d normal(const Sphere&, const Vec3d& p) { return p; }
inline Vec3d normal(const Cylinder& c, const Vec3d& p) {
  const double side = std::fabs(p.x * p.x + p.y * p.y - 1);
  if (std::fabs(p.z - c.z_max) < side) return {0, 0, 1};
  if (std::fabs(p.z - c.z_min) < side) return {0, 0, -1};
  return {p.x, p.y, 0};
}
inline Vec3d normal(const Cube&, const Vec3d& p) {
  const Vec3d q = p - Vec3d{0.5, 0.5, 0.5};
  const double most = max_abs(q);
  return {std::fabs(q.x) == most ? q.x : 0, std::fabs(q.y) == most ? q.y : 0,
          std::fabs(q.z) == most ? q.z : 0};
}
inline Vec3d normal(const Plane&, const Vec3d&) { return {0, 0, 1}; }
template <class Other>
Vec3d normal(const Other&, const Vec3d&) {
  return {};
}

}  // namespace plain

class PlainIntersector {
 public:
  explicit PlainIntersector(const World::Parts& world) : world_(world) {
    for (const Leaf& leaf : world.leaves)
      leaves_.push_back({{leaf.row[0], leaf.row[1], leaf.row[2]}, leaf.offset, leaf.solid});
  }

  std::optional<PlainHit> first_hit(const RayQuery& q) {
    bool starts_inside = false;
    Start best;
    visit(q, best.t, [&](const ObjectRef& ref) {
      const Start start = start_of(ref, q, best.t);
      starts_inside = start.inside;
      if (start.t < best.t) best = start;
      return !starts_inside;
    });
    if (starts_inside) best = way_out(q);
    if (best.t == infinity) return std::nullopt;
    return hit_at(q, best);
  }

  bool is_blocked(const RayQuery& q) {
    bool blocked = false;
    const double light = 1;
    visit(q, light, [&](const ObjectRef& ref) { return !(blocked = start_of(ref, q, light).t <= light); });
    return blocked;
  }

 private:
  /// The first change of side ahead of the ray, of an object or of all.
  struct Start {
    bool inside = false;
    double t = infinity;
    std::uint32_t leaf = no_leaf;
  };
  struct Event {
    double t;
    std::uint32_t item, leaf;
  };

  template <class Visit>
  void visit(const RayQuery& q, const double& t_max, Visit&& visit_object) const {
    for (const ObjectRef& ref : world_.endless_objects)
      if (!visit_object(ref)) return;
    world_.bvh.visit(q, t_max,
                     [&](std::uint32_t place) { return visit_object(world_.bounded_objects[place]); });
  }

  static Vec3d local(const PlainLeaf& l, const Vec3d& v) {
    return {dot(l.row[0], v), dot(l.row[1], v), dot(l.row[2], v)};
  }

  PlainSpan span_of(std::uint32_t number, const RayQuery& q) const {
    const PlainLeaf& leaf = leaves_[number];
    const Vec3d o = local(leaf, q.ray.origin) + leaf.offset, d = local(leaf, q.ray.direction);
    return std::visit([&](const auto& solid) { return plain::span(solid, o, d); }, leaf.solid);
  }

  Start start_of(const ObjectRef& ref, const RayQuery& q, double t_max) {
    if (ref.leaf != no_leaf) {
      const PlainSpan span = span_of(ref.leaf, q);
      if (!span.is_ahead()) return {};
      const bool inside = !(span.enter > too_near);
      return {inside, inside ? span.leave : span.enter, ref.leaf};
    }
    const std::span<const CsgItem> items = world_.items_of(world_.objects[ref.object]);
    const bool inside = gather(items, q, t_max);
    for (std::size_t i = 0; i < events_.size();) {
      const Event& first = events_[i];
      do toggle(items, counts_, events_[i].item);
      while (++i < events_.size() && events_[i].t == first.t);  // as in the original
      if (is_inside(items[0], counts_[0]) != inside) return {inside, first.t, first.leaf};
    }
    return {inside, infinity, no_leaf};
  }

  bool gather(std::span<const CsgItem> items, const RayQuery& q, double t_max) {
    counts_.assign(items.size(), 0);
    events_.clear();
    for (std::uint32_t i = 0; i < items.size();) {
      const CsgItem& item = items[i];
      const BoxSpan box = span_in(item.box, q, t_max);
      if (box.entry > box.exit) {
        i = item.next;
        continue;
      }
      if (item.leaf != no_leaf) {
        const PlainSpan span = span_of(item.leaf, q);
        if (span.is_ahead()) {
          if (span.enter > too_near)
            events_.push_back({span.enter, i, item.leaf});
          else
            toggle(items, counts_, i);
          events_.push_back({span.leave, i, item.leaf});
        }
      }
      ++i;
    }
    std::sort(events_.begin(), events_.end(), [](const Event& a, const Event& b) { return a.t < b.t; });
    return is_inside(items[0], counts_[0]);
  }

  /// Where a ray that starts inside some objects has left them all.
  Start way_out(const RayQuery& q) {
    int inside = 0;
    std::vector<Event> all;
    visit(q, infinity, [&](const ObjectRef& ref) {
      const std::span<const CsgItem> items = world_.items_of(world_.objects[ref.object]);
      bool is_in = gather(items, q, infinity);
      inside += is_in;
      for (const Event& e : events_) {
        toggle(items, counts_, e.item);
        if (is_inside(items[0], counts_[0]) == is_in) continue;
        is_in = !is_in;
        all.push_back({e.t, is_in ? 1u : 0u, e.leaf});
      }
      return true;
    });
    std::sort(all.begin(), all.end(), [](const Event& a, const Event& b) { return a.t < b.t; });
    for (const Event& e : all)
      if ((inside += e.item ? 1 : -1) == 0) return {true, e.t, e.leaf};
    return {};
  }

  PlainHit hit_at(const RayQuery& q, const Start& start) const {
    const PlainLeaf& leaf = leaves_[start.leaf];
    const Vec3d point = q.ray.origin + q.ray.direction * start.t;
    const Vec3d p = local(leaf, point) + leaf.offset;
    const Vec3d n = std::visit([&](const auto& solid) { return plain::normal(solid, p); }, leaf.solid);
    return {start.leaf, start.t, point,
            normalized(leaf.row[0] * n.x + leaf.row[1] * n.y + leaf.row[2] * n.z)};
  }

  const World::Parts& world_;
  std::vector<PlainLeaf> leaves_;
  std::vector<std::int32_t> counts_;
  std::vector<Event> events_;
};

}  // namespace rayfarm::benchmarks
