// Elementary functions with the same bits on every CPU.
//
// glibc chooses FMA or non-FMA variants of sin, cos, exp, pow, ... at run time, and about 1 result in 1,400 differs
// by one ulp between them. These use only exactly specified operations (+ - * / sqrt fma floor rint ldexp), so a
// picture, a rotation or a script has the same bits everywhere. Accuracy: within 2 ulp over the ranges stated.
// Special cases (NaN, infinities, signed zeros, domain errors) answer as C's functions do, without setting errno.
#pragma once

namespace rayfarm::deterministic {

double sin(double radians);  // |x| <= 1e9 within 2 ulp (of the result or 1e-16 near a zero); larger: reduced less exactly
double cos(double radians);
double tan(double radians);
double sin_deg(double degrees);  // exact for multiples of 30 (0, +-0.5, +-1)
double cos_deg(double degrees);
double tan_deg(double degrees);
double asin(double x);
double acos(double x);
double atan(double x);
double atan2(double y, double x);
double exp(double x);
double log(double x);
double log2(double x);
double log10(double x);
double pow(double base, double exponent);
/// base^n by squaring; n >= 0. Exactly the same chain for a base, whatever the CPU.
double integer_power(double base, unsigned n);

}  // namespace rayfarm::deterministic
