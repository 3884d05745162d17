// The last rung: MPFR with 330 bits, 99 digits.
#include "certificate/true_vertex_at.hpp"

namespace isostat {

template <int Dim>
std::unique_ptr<TrueVertex<Dim>> in_multiprecision(const Subject<Dim>& subject, const Centre<Dim>& centre) {
    constexpr int bits = 330;
    return std::make_unique<TrueVertexAt<Dim, Real>>(subject, centre, Arithmetic<Real>(bits));
}

template std::unique_ptr<TrueVertex<2>> in_multiprecision<2>(const Subject<2>&, const Centre<2>&);

} // namespace isostat
