#include "verified/precise_vertex.hpp"

namespace isostat {

bool PreciseVertex::enclose(int bits) {
    const std::vector<Real> start = vertex_ ? vertex_->at().correction() : std::vector<Real>();
    vertex_.emplace(Arithmetic<Real>(bits), packing_, structure_, factorisation_, at_q_, start);
    return vertex_->exists();
}

PreciseInterval PreciseVertex::operator[](std::size_t k) const {
    const int bits = vertex_->at().arithmetic().bits();
    PreciseInterval stored = difference(packing_.q[k], 0, bits);
    if (structure_.dofs().dof_of(k) < 0) {
        return stored;
    }
    return stored + PreciseInterval(vertex_->at().correction()[k], vertex_->radius().real(), bits);
}

} // namespace isostat
