// Intersection and set operations as textbooks have them: no error bounds, crossings merged when a rule calls
// them the same. What ours is compared with.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "common/geometry/leaf.h"
#include "common/math/overload.h"
#include "tests/stability/scenes.h"

namespace rayfarm::stability {

/// The line's crossings with a solid, ascending, in and out in turn.
template <class T>
struct TextbookSpans {
  std::array<T, 4> at{};
  int count = 0;

  void add(T enter, T leave) {
    if (!(enter < leave)) return;
    at[count++] = enter, at[count++] = leave;
  }
};

/// A leaf as a textbook places it: the inverse of the whole chain, in T.
template <class T>
class TextbookLeaf {
 public:
  TextbookLeaf(const Solid& solid, const Affine& world_from_local)
      : leaf_(make_leaf(solid, bounded(world_from_local))) {
    for (int i = 0; i < 3; ++i) {
      row_[i] = {T(leaf_.row[i].x), T(leaf_.row[i].y), T(leaf_.row[i].z)};
      offset_[i] = T(leaf_.offset[i]);
    }
  }

  TextbookSpans<T> spans(const Ray& ray) const {
    Vec3<T> o = vec_of(ray.origin), d = vec_of(ray.direction);
    o = Vec3<T>{dot(row_[0], o), dot(row_[1], o), dot(row_[2], o)} + offset_;
    d = {dot(row_[0], d), dot(row_[1], d), dot(row_[2], d)};
    TextbookSpans<T> spans;
    std::visit(Overload{
                   [&](const Sphere&) {
                     put_quadric(spans, o, d, {1, 1, 1}, everything);
                   },
                   [&](const Cube&) {
                     put(spans, slab(slab(slab(everything, o.x, d.x, 0, 1), o.y, d.y, 0, 1), o.z, d.z, 0, 1));
                   },
                   [&](const Cylinder& c) {
                     put_quadric(spans, o, d, {1, 1, 0}, slab(everything, o.z, d.z, T(c.z_min), T(c.z_max)));
                   },
                   [&](const auto&) { put_ours(spans, ray); },  // there is no textbook one for it
               },
               leaf_.solid);
    return spans;
  }

 private:
  struct Part {
    T enter, leave;
  };
  static constexpr Part everything{-std::numeric_limits<T>::infinity(), std::numeric_limits<T>::infinity()};

  static Vec3<T> vec_of(const Vec3d& v) { return {T(v.x), T(v.y), T(v.z)}; }
  static void put(TextbookSpans<T>& spans, const Part& p) { spans.add(p.enter, p.leave); }

  static Part slab(const Part& p, T o, T d, T low, T high) {
    if (d == 0) return o > low && o < high ? p : Part{1, 0};
    const T a = (low - o) / d, b = (high - o) / d;
    return {std::max(p.enter, std::min(a, b)), std::min(p.leave, std::max(a, b))};
  }

  /// The discriminant of the whole quadratic, from the ray's origin.
  static void put_quadric(TextbookSpans<T>& spans, Vec3<T> o, Vec3<T> d, const Vec3<T>& axes,
                          const Part& in) {
    o = o * axes, d = d * axes;
    const T a = dot(d, d), b = dot(o, d), c = dot(o, o) - 1, disc = b * b - a * c;
    if (!(disc > 0) || a == 0) return;
    const T root = std::sqrt(disc);
    put(spans, {std::max(in.enter, (-b - root) / a), std::min(in.leave, (-b + root) / a)});
  }

  void put_ours(TextbookSpans<T>& spans, const Ray& ray) const {
    const Crossings c = crossings(leaf_, RayQuery(ray));
    for (int i = 0; i + 1 < std::min(c.count, 4); i += 2)
      spans.add(T(c.at[static_cast<std::size_t>(i)].t), T(c.at[static_cast<std::size_t>(i) + 1].t));
  }

  Leaf leaf_;
  Vec3<T> row_[3]{}, offset_{};
};

/// When two crossings are one.
struct SameRule {
  std::string name;
  double absolute = 0, relative = 0;  // apart by at most that; that part of t

  template <class T>
  bool operator()(T a, T b) const {
    return std::fabs(a - b) <= T(absolute) + T(relative) * std::max(std::fabs(a), std::fabs(b));
  }
};

inline bool holds(CsgOp op, bool a, bool b) {
  switch (op) {
    case CsgOp::unite:
      return a || b;
    case CsgOp::intersect:
      return a && b;
    case CsgOp::subtract:
      return a && !b;
    case CsgOp::exclusive_or:
      return a != b;
  }
  return false;
}

/// Where the line passes the boundary of `a op b`: up to eight places. Returns how many.
template <class T>
int merged(CsgOp op, const TextbookSpans<T>& a, const TextbookSpans<T>& b, const SameRule& same,
           std::array<T, 8>& boundaries) {
  bool in_a = false, in_b = false;
  int i = 0, k = 0, count = 0;
  while (i < a.count || k < b.count) {
    const bool both = i < a.count && k < b.count && same(a.at[i], b.at[k]);
    const bool take_a = both || k == b.count || (i < a.count && a.at[i] < b.at[k]);
    const bool take_b = both || !take_a;
    const bool before = holds(op, in_a, in_b);
    const T t = take_a ? a.at[i] : b.at[k];
    if (take_a) in_a = !in_a, ++i;
    if (take_b) in_b = !in_b, ++k;
    if (holds(op, in_a, in_b) != before) boundaries[count++] = t;
  }
  return count;
}

}  // namespace rayfarm::stability
