// The last rung: MPFR with 330 bits, 99 digits.
#include "certificate/true_vertex_at.hpp"

namespace isostat {

std::unique_ptr<TrueVertex> in_multiprecision(const Subject& subject, const ProvedStructure& centre) {
    constexpr int bits = 330; // true_vertex.md Arithmetic (e of MPFR)
    return std::make_unique<TrueVertexAt<Real>>(subject, centre, Arithmetic<Real>(bits));
}

} // namespace isostat
