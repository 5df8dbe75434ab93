// What geometry over a number type needs besides + - * /: the same words for one double and, later, for a
// pack; for a double-double (double_double.h), where a double is not enough.
#pragma once
#include <cmath>
#include <limits>

namespace rayfarm {

/// Half the distance from 1 to the next double: each operation is right to within this factor.
constexpr double unit_roundoff = std::numeric_limits<double>::epsilon() / 2;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A bound on the relative error of n operations in a row. Source: N. J. Higham, Accuracy and Stability of
/// Numerical Algorithms, section 3.1 (gamma_n).
constexpr double gamma_bound(int n) { return n * unit_roundoff / (1 - n * unit_roundoff); }

/// The same for other number types.
template <class T>
constexpr double unit_roundoff_of = std::numeric_limits<T>::epsilon() / 2;

inline double select(bool condition, double yes, double no) { return condition ? yes : no; }
inline double with_sign_of(double size, double sign) { return std::copysign(size, sign); }  // size >= 0
inline bool none(bool condition) { return !condition; }
inline double least(double a, double b) { return b < a ? b : a; }
inline double greatest(double a, double b) { return a < b ? b : a; }

}  // namespace rayfarm
