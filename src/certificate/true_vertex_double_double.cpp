// The rung of double-double (libqd).
#include "certificate/true_vertex_at.hpp"

namespace isostat {

std::unique_ptr<TrueVertex> in_double_double(const Subject& subject, const ProvedStructure& centre) {
    return std::make_unique<TrueVertexAt<dd_real>>(subject, centre, Arithmetic<dd_real>());
}

} // namespace isostat
