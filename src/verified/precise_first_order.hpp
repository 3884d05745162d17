#pragma once
/// \file
/// First-order terms of gaps beyond double: what `FirstOrder` does not tell from 0.

#include "verified/enclosed_vertex.hpp"
#include "verified/order.hpp"

#include <isostat/core/contact.hpp>

#include <array>
#include <memory>
#include <vector>

namespace isostat {

/// The answers of `FirstOrder::rate` and `FirstOrder::gap` with first_bits ... max_bits bits, until the sign is told
/// (statement V6: motions at the true vertex in MPFR). The arguments must outlive the object. Cost: a vertex per rung
/// for all questions, and per question a motion: N products and a solve per 30 bits or so.
class PreciseFirstOrder {
  public:
    PreciseFirstOrder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                      const InverseBound& inverse, const LadderOptions& options);
    PreciseFirstOrder(const PreciseFirstOrder&) = delete;
    PreciseFirstOrder& operator=(const PreciseFirstOrder&) = delete;
    ~PreciseFirstOrder();

    /// Rate of the gap of a pair that touches at the true vertex when the gap of `opened` grows at unit rate
    /// (`direction` -1: falls) and all others stay closed.
    [[nodiscard]] Enclosure rate(ContactId opened, int direction, const Contact& pair);
    /// Second derivative of that gap on the same motion, in the gap of `opened`; with first_bits only.
    [[nodiscard]] Enclosure bend(ContactId opened, int direction, const Contact& pair);
    /// Its gap is eps c + O(eps^2) for the radii R_i + eps rho_i, the contacts closed: c.
    [[nodiscard]] Enclosure gap(const std::vector<double>& rho, const Contact& pair);

  private:
    struct Rung;
    using Sum = std::array<double, 2>; ///< of two numbers, exactly
    [[nodiscard]] Enclosure climb(const std::vector<Sum>& approach, const Sum& grown, const Contact& pair);
    [[nodiscard]] static Sum grown(const std::vector<double>& rho, const Contact& pair);
    /// Null: no vertex was enclosed with so many bits.
    Rung* rung(int number);

    const Packing& packing_;
    const IsostaticStructure& structure_;
    const Factorisation& factorisation_;
    const InverseBound& inverse_;
    LadderOptions options_;
    std::vector<std::unique_ptr<Rung>> rungs_;
};

} // namespace isostat
