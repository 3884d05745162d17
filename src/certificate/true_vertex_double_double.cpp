// The rung of double-double (libqd).
#include "certificate/true_vertex_at.hpp"

namespace isostat {

template <int Dim>
std::unique_ptr<TrueVertex<Dim>> in_double_double(const Subject<Dim>& subject, const Centre<Dim>& centre) {
    return std::make_unique<TrueVertexAt<Dim, dd_real>>(subject, centre, Arithmetic<dd_real>());
}

template std::unique_ptr<TrueVertex<2>> in_double_double<2>(const Subject<2>&, const Centre<2>&);

} // namespace isostat
