#pragma once
/// \file
/// First-order terms of gaps beyond double, for those that `FirstOrder` cannot tell from 0.

#include "verified/enclosed_vertex.hpp"
#include "verified/order.hpp"

#include <isostat/core/contact.hpp>

#include <array>
#include <memory>
#include <vector>

namespace isostat {

/// `FirstOrder::rate` and `FirstOrder::gap` with first_bits ... max_bits bits, until the sign is decided (statement V6:
/// motions at the true vertex in MPFR). The arguments must outlive the object. Cost: a vertex per rung for all calls,
/// and per call a motion: N products and a solve per 30 bits or so.
class PreciseFirstOrder {
  public:
    PreciseFirstOrder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                      const InverseBound& inverse, const LadderOptions& options);
    PreciseFirstOrder(const PreciseFirstOrder&) = delete;
    PreciseFirstOrder& operator=(const PreciseFirstOrder&) = delete;
    ~PreciseFirstOrder();

    /// Rate of the gap of a pair that touches at the true vertex when the gap of `opened` grows at unit rate
    /// (`direction` -1: falls) and the other contacts stay closed.
    [[nodiscard]] Enclosure rate(ContactId opened, int direction, const Contact& pair);
    /// Second derivative of that gap on the same motion, by the gap of `opened`; with first_bits only.
    [[nodiscard]] Enclosure bend(ContactId opened, int direction, const Contact& pair);
    /// c in the gap eps c + O(eps^2) of the pair for the radii R_i + eps rho_i with the contacts closed.
    [[nodiscard]] Enclosure gap(const std::vector<double>& rho, const Contact& pair);

  private:
    struct Rung;
    using Sum = std::array<double, 2>; ///< an exact sum of two numbers
    [[nodiscard]] Enclosure climb(const std::vector<Sum>& approach, const Sum& grown, const Contact& pair);
    [[nodiscard]] static Sum grown(const std::vector<double>& rho, const Contact& pair);
    /// Null: no vertex was enclosed with this many bits.
    Rung* rung(int number);

    const Packing& packing_;
    const IsostaticStructure& structure_;
    const Factorisation& factorisation_;
    const InverseBound& inverse_;
    LadderOptions options_;
    std::vector<std::unique_ptr<Rung>> rungs_;
};

} // namespace isostat
