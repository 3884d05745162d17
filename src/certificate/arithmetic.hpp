#pragma once
/// \file
/// The number types of the rungs, with the error that is granted to one of their operations.

#include <isostat/core/verdict.hpp>

#include <qd/dd_real.h>

namespace isostat {

/// `unit`: a sum of two numbers errs by at most unit (|a| + |b|), a product or quotient by unit times the result.
/// `difference` and `product` of two doubles err by at most unit times the result. `corrections`, `refinements`: caps
/// of the iterations, which stop by themselves at the rounding of the type.
template <class T> struct Arithmetic;

template <> struct Arithmetic<double> {
    static constexpr double unit = 0x1p-53;
    static constexpr Rung rung = Rung::double_bound;
    static constexpr int corrections = 0; // the vertex is enclosed around the stored doubles themselves
    static constexpr int refinements = 2;
    static double difference(double a, double b) { return a - b; }
    static double product(double a, double b) { return a * b; }
    static double rounded(double x) { return x; }
};

/// libqd: its own bounds are 2^-103 for a (sloppy) sum and 2^-102 for products; differences and products of two doubles
/// are exact.
template <> struct Arithmetic<dd_real> {
    static constexpr double unit = 0x1p-98;
    static constexpr Rung rung = Rung::double_double;
    static constexpr int corrections = 8;
    static constexpr int refinements = 8;
    static dd_real difference(double a, double b) { return dd_real::sub(a, b); }
    static dd_real product(double a, double b) { return dd_real::mul(a, b); }
    static double rounded(const dd_real& x) { return x.x[0]; }
};

} // namespace isostat
