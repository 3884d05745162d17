// The rung of doubles.
#include "certificate/true_vertex_at.hpp"

namespace isostat {

std::unique_ptr<TrueVertex> in_double(const Subject& subject, const ProvedStructure& centre) {
    return std::make_unique<TrueVertexAt<double>>(subject, centre, Arithmetic<double>());
}

} // namespace isostat
