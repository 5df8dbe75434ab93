#include "common/geometry/bezier_facets.h"

#include <algorithm>

namespace rayfarm {
namespace {

/// One coordinate of a net's sixteen points.
using Values = std::array<double, 16>;

constexpr std::size_t across_u = 1, across_v = 4;  // from a point of a net to the next

/// Halves four values, `stride` apart. Source: de Casteljau's algorithm.
template <class T>
void halve(const T* c, std::size_t stride, T* low, T* high) {
  const auto middle = [](const T& a, const T& b) { return (a + b) * 0.5; };
  const T ab = middle(c[0], c[stride]), bc = middle(c[stride], c[2 * stride]),
          cd = middle(c[2 * stride], c[3 * stride]);
  const T abc = middle(ab, bc), bcd = middle(bc, cd), whole = middle(abc, bcd);
  const T last = c[3 * stride];
  low[0] = c[0], low[stride] = ab, low[2 * stride] = abc, low[3 * stride] = whole;
  high[0] = whole, high[stride] = bcd, high[2 * stride] = cd, high[3 * stride] = last;
}

/// Halves a net along u (stride across_u) or v (across_v).
template <class T>
void halve(const std::array<T, 16>& net, std::size_t stride, std::array<T, 16>& low,
           std::array<T, 16>& high) {
  const std::size_t step = stride == across_u ? across_v : across_u;
  for (std::size_t i = 0; i < 4; ++i) halve(&net[i * step], stride, &low[i * step], &high[i * step]);
}

struct Basis {
  explicit Basis(double x) {
    const double y = 1 - x;
    value = {y * y * y, 3 * x * y * y, 3 * x * x * y, x * x * x};
    slope = {-3 * y * y, 3 * y * y - 6 * x * y, 6 * x * y - 3 * x * x, 3 * x * x};
  }
  std::array<double, 4> value, slope;
};

/// A function of (u, v) given by sixteen Bezier values, with its derivatives.
template <class T>
struct Jet {
  T value{}, by_u{}, by_v{};
};
template <class T>
Jet<T> jet_at(const std::array<T, 16>& net, const Basis& u, const Basis& v) {
  Jet<T> jet;
  for (std::size_t row = 0; row < 4; ++row) {
    T value{}, slope{};
    for (std::size_t column = 0; column < 4; ++column) {
      value = value + net[4 * row + column] * u.value[column];
      slope = slope + net[4 * row + column] * u.slope[column];
    }
    jet.value = jet.value + value * v.value[row];
    jet.by_u = jet.by_u + slope * v.value[row];
    jet.by_v = jet.by_v + value * v.slope[row];
  }
  return jet;
}

/// A place close by that is not on a border.
double inside(double x) {
  constexpr double close = 1.0 / 1024;
  return x + (0.5 - x) * close;
}

struct Range {
  double low = infinity, high = -infinity;
};
Range range_of(const Values& values) {
  Range r;
  for (const double x : values) r = {least(r.low, x), greatest(r.high, x)};
  return r;
}

Box box_of(const BezierNet& net) {
  Box box;
  for (const Vec3d& p : net) box = hull(box, {p, p});
  return box;
}

/// A piece in the line's frame.
struct FramedNet {
  Values x, y, t;
  double u0 = 0, v0 = 0, du = 1, dv = 1;  // its range of the whole piece's (u, v)
};

void halve(const FramedNet& net, bool along_u, FramedNet& low, FramedNet& high) {
  const std::size_t stride = along_u ? across_u : across_v;
  low = high = net;
  halve(net.x, stride, low.x, high.x);
  halve(net.y, stride, low.y, high.y);
  halve(net.t, stride, low.t, high.t);
  if (along_u) {
    low.du = high.du = net.du / 2, high.u0 += high.du;
  } else {
    low.dv = high.dv = net.dv / 2, high.v0 += high.dv;
  }
}

struct Vec2 {
  double x = 0, y = 0;
};
double size_of(const Vec2& v) { return std::fabs(v.x) + std::fabs(v.y); }

Vec2 step_from(const FramedNet& net, std::size_t point, std::size_t stride) {
  return {net.x[point + stride] - net.x[point], net.y[point + stride] - net.y[point]};
}

template <class Visit>
bool all_steps(const FramedNet& net, std::size_t stride, Visit&& visit) {
  const std::size_t step = stride == across_u ? across_v : across_u;
  for (std::size_t line = 0; line < 4; ++line)
    for (std::size_t i = 0; i < 3; ++i)
      if (!visit(step_from(net, line * step + i * stride, stride))) return false;
  return true;
}

double length_along(const FramedNet& net, std::size_t stride) {
  double sum = 0;
  all_steps(net, stride, [&](const Vec2& s) {
    sum += size_of(s);
    return true;
  });
  return sum;
}

/// Of the steps from point to point; of any length.
Vec2 mean_direction(const FramedNet& net, std::size_t stride) {
  Vec2 sum;
  all_steps(net, stride, [&](const Vec2& s) {
    sum.x += s.x, sum.y += s.y;
    return true;
  });
  const double size = size_of(sum);
  return {sum.x / size, sum.y / size};
}

}  // namespace

/// The search for all roots of one piece.
class BezierFacets::Search {
 public:
  Search(const ShearedLine& line, std::uint32_t place, double t_max)
      : line_(line), place_(place), t_max_(t_max), nearness_(2 * line.wide().margin) {}

  void search(const FramedNet& net, int depth) {
    if (!may_pass(net) || --budget_ < 0) return;
    if (passes_once(net) && find_root(net)) return;
    if (depth == deepest || is_edge_on(net)) return;
    FramedNet low, high;
    halve(net, length_along(net, across_u) > length_along(net, across_v), low, high);
    search(low, depth + 1);
    search(high, depth + 1);
  }

  Roots roots;

 private:
  static constexpr int deepest = 52;  // halvings: pairs of roots nearer than 2^-26 of a piece are a tangent
  static constexpr int most_steps = 20;  // of Newton's method

  bool may_pass(const FramedNet& net) const {
    const Range x = range_of(net.x), y = range_of(net.y), t = range_of(net.t);
    if (x.low > nearness_ || x.high < -nearness_ || y.low > nearness_ || y.high < -nearness_) return false;
    return t.high >= -line_.along_error(t.high) && t.low - line_.along_error(t.low) <= t_max_;
  }

  /// All points on one line of the plane, as far as numbers can tell: a tangent.
  bool is_edge_on(const FramedNet& net) const {
    const auto from_first = [&](std::size_t i) { return Vec2{net.x[i] - net.x[0], net.y[i] - net.y[0]}; };
    Vec2 longest;
    for (std::size_t i = 1; i < 16; ++i)
      if (size_of(from_first(i)) > size_of(longest)) longest = from_first(i);
    for (std::size_t i = 1; i < 16; ++i) {
      const Vec2 p = from_first(i);
      if (std::fabs(longest.x * p.y - longest.y * p.x) > nearness_ * size_of(longest)) return false;
    }
    return true;
  }

  /// In coordinates where the mean directions are (1, 0) and (0, 1), all steps keep to the cones about them.
  static bool passes_once(const FramedNet& net) {
    const Vec2 a = mean_direction(net, across_u), b = mean_direction(net, across_v);
    const double det = a.x * b.y - a.y * b.x;
    if (!(det != 0)) return false;
    const auto straightened = [&](const Vec2& s) {
      return Vec2{(b.y * s.x - b.x * s.y) / det, (a.x * s.y - a.y * s.x) / det};
    };
    return all_steps(net, across_u,
                     [&](const Vec2& step) {
                       const Vec2 s = straightened(step);
                       return s.x >= std::fabs(s.y);
                     }) &&
           all_steps(net, across_v, [&](const Vec2& step) {
             const Vec2 s = straightened(step);
             return s.y >= std::fabs(s.x);
           });
  }

  /// False when Newton's method does not settle; true also when the only root is not in the piece.
  bool find_root(const FramedNet& net) {
    double u = 0.5, v = 0.5;
    for (int i = 0; i < most_steps; ++i) {
      const Basis at_u(u), at_v(v);
      const Jet<double> x = jet_at(net.x, at_u, at_v), y = jet_at(net.y, at_u, at_v);
      const double det = x.by_u * y.by_v - x.by_v * y.by_u;
      const bool is_there = std::fabs(x.value) + std::fabs(y.value) <= nearness_ / 8;
      if (det == 0 && !is_there) return false;
      const double du = det == 0 ? 0 : (x.value * y.by_v - y.value * x.by_v) / det;
      const double dv = det == 0 ? 0 : (y.value * x.by_u - x.value * y.by_u) / det;
      u = least(greatest(u - du, -1), 2), v = least(greatest(v - dv, -1), 2);
      // Steps that move the point by less than its own rounding end it; where u is shrunk to a point, du has no end.
      const double moved =
          std::fabs(du) * size_of({x.by_u, y.by_u}) + std::fabs(dv) * size_of({x.by_v, y.by_v});
      if (!is_there || moved > nearness_ / 8) continue;
      add_root(net, least(greatest(u, 0), 1), least(greatest(v, 0), 1));
      return true;
    }
    return is_outside(u) || is_outside(v);  // it went away, and there is no other
  }
  static bool is_outside(double x) { return x < -0.5 || x > 1.5; }

  /// The three coordinates of a net at (u, v).
  struct Place {
    Place(const FramedNet& net, double at_u, double at_v) {
      const Basis u(at_u), v(at_v);
      x = jet_at(net.x, u, v), y = jet_at(net.y, u, v), t = jet_at(net.t, u, v);
    }
    Jet<double> x, y, t;
    double det() const { return x.by_u * y.by_v - x.by_v * y.by_u; }
    /// How much t changes when the line is moved across.
    double slope() const {
      return (std::fabs(t.by_u * y.by_v - t.by_v * y.by_u) + std::fabs(t.by_v * x.by_u - t.by_u * x.by_v)) /
             std::fabs(det());
    }
  };

  /// Whether lines of u or of v have shrunk to a point there, as at the pole of a ball.
  bool is_shrunk(const Place& there, const Place& middle) const {
    constexpr double little = 1e-6;  // of their length in the middle
    const auto by_u = [&](const Place& p) {
      return size_of({p.x.by_u, p.y.by_u}) + std::fabs(p.t.by_u) * line_.speed();
    };
    const auto by_v = [&](const Place& p) {
      return size_of({p.x.by_v, p.y.by_v}) + std::fabs(p.t.by_v) * line_.speed();
    };
    return by_u(there) <= little * by_u(middle) || by_v(there) <= little * by_v(middle);
  }

  /// (u, v) is the place in the piece that is nearest to the root; there the line passes, or it misses the piece.
  void add_root(const FramedNet& net, double u, double v) {
    const Place there(net, u, v), middle(net, 0.5, 0.5);
    if (std::fabs(there.x.value) > nearness_ || std::fabs(there.y.value) > nearness_ ||
        roots.count == Roots::most)
      return;
    // How far off the line and the piece may be moves t; 4, because a pair of roots that may be none must overlap.
    const double slope = is_shrunk(there, middle) ? Place(net, inside(u), inside(v)).slope() : there.slope();
    const double pulled = 4 * slope * (line_.across_error() + nearness_);
    const Range range = range_of(net.t);
    const double error =
        line_.along_error(there.t.value) + pulled + 16 * unit_roundoff * (range.high - range.low);
    // A net that is passed once has the same side to the line everywhere.
    roots.at[static_cast<std::size_t>(roots.count++)] = {
        {there.t.value, error, place_, line_.enters(middle.det() > 0)},
        net.u0 + u * net.du,
        net.v0 + v * net.dv};
  }

  const ShearedLine& line_;
  std::uint32_t place_;
  double t_max_;
  double nearness_;    // roundings of a piece's points
  int budget_ = 4000;  // nets looked at: a curve of tangents would be halved without end
};

BezierFacets::BezierFacets(const BezierGrid& grid) : grid_(grid), closed_(rayfarm::is_closed(grid)) {
  for (const Vec3d& p : grid.points) size_ = greatest(size_, max_abs(p));
  constexpr std::uint32_t most_pieces = 1u << 18;
  const std::uint32_t patches = grid.rows * grid.columns;
  pieces_a_side_ = 8;
  while (pieces_a_side_ > 1 &&
         patches * static_cast<std::uint32_t>(pieces_a_side_ * pieces_a_side_) > most_pieces)
    pieces_a_side_ /= 2;
  cut_into_pieces();
  turned_ = closed_ && looks_inwards();
}

bool BezierFacets::looks_inwards() const {
  double six_volumes = 0;
  for (const Piece& p : pieces_) {
    const Vec3d about = grid_.points[0], &a = p.net[0], &b = p.net[3], &c = p.net[15], &d = p.net[12];
    six_volumes += dot(a - about, cross(b - about, c - about)) + dot(a - about, cross(c - about, d - about));
  }
  return six_volumes < 0;
}

BezierNet BezierFacets::net_of(std::uint32_t patch) const {
  const std::size_t row = 3 * std::size_t{patch / grid_.columns},
                    column = 3 * std::size_t{patch % grid_.columns};
  BezierNet net;
  for (std::size_t i = 0; i < 16; ++i) net[i] = grid_.at(row + i / 4, column + i % 4);
  return net;
}

void BezierFacets::cut_into_pieces() {
  std::vector<Piece> pieces;
  for (std::uint32_t patch = 0; patch < grid_.rows * grid_.columns; ++patch) {
    std::vector<Piece> coarse{{patch, 0, 0, net_of(patch)}};
    for (double side = 0.5; side >= 1.0 / pieces_a_side_; side /= 2) {
      std::vector<Piece> finer;
      for (const Piece& p : coarse) {
        BezierNet left, right;
        halve(p.net, across_u, left, right);
        for (const auto& [net, u0] : {std::pair{left, p.u0}, {right, p.u0 + side}}) {
          Piece low{patch, u0, p.v0, {}}, high{patch, u0, p.v0 + side, {}};
          halve(net, across_v, low.net, high.net);
          finer.push_back(low), finer.push_back(high);
        }
      }
      coarse = std::move(finer);
    }
    pieces.insert(pieces.end(), coarse.begin(), coarse.end());
  }
  std::vector<Box> boxes;
  for (const Piece& p : pieces) boxes.push_back(box_of(p.net)), box_ = hull(box_, boxes.back());
  bvh_ = Bvh(boxes);
  for (const std::uint32_t number : bvh_.order()) pieces_.push_back(pieces[number]);
}

BezierFacets::Roots BezierFacets::roots_of(const ShearedLine& line, std::uint32_t place, double t_max) const {
  FramedNet net;
  for (std::size_t i = 0; i < 16; ++i) {
    const ShearedLine::Place p = line.place_of(pieces_[place].net[i]);
    net.x[i] = p.x, net.y[i] = p.y, net.t[i] = p.t;
  }
  Search search(line, place, t_max);
  search.search(net, 0);
  return search.roots;
}

FacetPoint BezierFacets::point_at(const LocalRay<double>& ray, const FacetCrossing& crossing) const {
  const Roots roots = roots_of(ShearedLine(ray, size_), crossing.part, infinity);
  const Root* best = &roots.at[0];
  for (int i = 1; i < roots.count; ++i) {
    const Root& root = roots.at[static_cast<std::size_t>(i)];
    if (std::fabs(root.crossing.t - crossing.t) < std::fabs(best->crossing.t - crossing.t)) best = &root;
  }
  const Piece& piece = pieces_[crossing.part];
  const double u = piece.u0 + best->u / pieces_a_side_, v = piece.v0 + best->v / pieces_a_side_;
  const BezierNet net = net_of(piece.patch);
  Jet<Vec3d> at = jet_at(net, Basis(u), Basis(v));

  FacetPoint found;
  found.surface.point = at.value;
  found.error = 16 * unit_roundoff * size_;
  found.surface.normal = cross(at.by_u, at.by_v);
  if (!(max_abs(found.surface.normal) > 16 * unit_roundoff * max_abs(at.by_u) * max_abs(at.by_v)) ||
      at.by_u == Vec3d{}) {
    // Where a border has shrunk to a point, the normal is that of a place close by.
    at = jet_at(net, Basis(inside(u)), Basis(inside(v)));
    found.surface.normal = cross(at.by_u, at.by_v);
  }
  if (turned_) found.surface.normal = -found.surface.normal;
  if (found.surface.normal == Vec3d{})
    found.surface.normal = ray.direction * (crossing.entering ? -1.0 : 1.0);
  found.texture = {piece.patch % grid_.columns + u, piece.patch / grid_.columns + v};
  return found;
}

}  // namespace rayfarm
