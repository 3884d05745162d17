#pragma once
// The true vertex in MPFR, coordinate by coordinate: private to the rooms verified and trajectory.

#include "verified/enclosed_vertex.hpp"

#include <optional>

namespace isostat {

/// Statement V5 with any number of bits. The arguments must outlive the object.
class PreciseVertex {
  public:
    PreciseVertex(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                  const InverseBound& inverse)
        : packing_(packing), structure_(structure), factorisation_(factorisation),
          at_q_(Neighbourhood::of(packing, structure.contacts(), inverse)) {}

    /// Encloses the vertex, starting from the place found with fewer bits; false: no vertex was proved. Cost: N gaps
    /// and a solve per 30 bits or so.
    bool enclose(int bits) {
        const std::vector<Real> start = vertex_ ? vertex_->at().correction() : std::vector<Real>();
        vertex_.emplace(Arithmetic<Real>(bits), packing_, structure_, factorisation_, at_q_, start);
        return vertex_->exists();
    }
    /// Coordinate k of the true vertex, in the bits of the last `enclose`; the stored value for coordinates that cannot
    /// move. \pre `enclose` succeeded.
    [[nodiscard]] PreciseInterval operator[](std::size_t k) const {
        const int bits = vertex_->at().arithmetic().bits();
        const PreciseInterval stored = difference(packing_.q[k], 0, bits);
        return structure_.dofs().dof_of(k) < 0
                   ? stored
                   : stored + PreciseInterval(vertex_->at().correction()[k], vertex_->radius().real(), bits);
    }

  private:
    const Packing& packing_;
    const IsostaticStructure& structure_;
    const Factorisation& factorisation_;
    Neighbourhood at_q_;
    std::optional<EnclosedVertex<Real>> vertex_;
};

} // namespace isostat
