// A three-component vector for closed-form geometry. The number type is a parameter: double now, a pack of
// eight later, so that single-ray and packet kernels share source and bits.
#pragma once
#include <algorithm>
#include <cmath>

namespace rayfarm {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
  T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
  bool operator==(const Vec3&) const = default;
};

using Vec3d = Vec3<double>;

template <class T>
Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
Vec3<T> operator*(const Vec3<T>& a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
Vec3<T> operator*(T s, const Vec3<T>& a) {
  return a * s;
}
/// Componentwise, as colours are multiplied.
template <class T>
Vec3<T> operator*(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
Vec3<T>& operator+=(Vec3<T>& a, const Vec3<T>& b) {
  return a = a + b;
}
template <class T>
T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
T length(const Vec3<T>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
template <class T>
Vec3<T> normalized(const Vec3<T>& a) {
  const T l = length(a);
  return {a.x / l, a.y / l, a.z / l};
}
template <class T>
T sum_abs(const Vec3<T>& a) {
  using std::fabs;
  return fabs(a.x) + fabs(a.y) + fabs(a.z);
}
/// The largest component's magnitude: the norm in which error bounds are kept.
template <class T>
T max_abs(const Vec3<T>& a) {
  using std::fabs, std::max;
  return max(fabs(a.x), max(fabs(a.y), fabs(a.z)));
}

}  // namespace rayfarm
