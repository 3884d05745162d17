// The last rung: MPFR with 100 digits.
#include "certificate/true_vertex_at.hpp"

#include <boost/multiprecision/mpfr.hpp>

namespace isostat {

namespace {

using Multi =
    boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<100, boost::multiprecision::allocate_stack>,
                                  boost::multiprecision::et_off>;

} // namespace

/// 100 digits are 333 bits, rounded to nearest.
template <> struct Arithmetic<Multi> {
    static constexpr double unit = 0x1p-330;
    static constexpr Rung rung = Rung::multiprecision;
    static constexpr int corrections = 60;
    static constexpr int refinements = 60;
    static Multi difference(double a, double b) { return Multi(a) - Multi(b); }
    static Multi product(double a, double b) { return Multi(a) * Multi(b); }
    static double rounded(const Multi& x) { return x.convert_to<double>(); }
};

template <int Dim>
std::unique_ptr<TrueVertex<Dim>> in_multiprecision(const Subject<Dim>& subject, const Centre<Dim>& centre) {
    return std::make_unique<TrueVertexAt<Dim, Multi>>(subject, centre);
}

template std::unique_ptr<TrueVertex<2>> in_multiprecision<2>(const Subject<2>&, const Centre<2>&);

} // namespace isostat
