#pragma once
// The common part of the rungs in floating point: private to the room.

#include "verified/force_rung.hpp"

namespace isostat {

constexpr mpfr_prec_t low_bits = 160; ///< for comparisons on the rungs double and double-double, and for exact roots

/// Expressions as intervals, made of the enclosures of single components on the rung.
class IntervalRung : public ForceRung {
  public:
    using ForceRung::ForceRung;
    Order sign(const ForceExpression& a) final;
    Order compare(const ForceExpression& a, const ForceExpression& b) final;
    PreciseInterval zero_of(const ForceExpression& force, int bits) final;
    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override;
    [[nodiscard]] double bound_exponent(const RightHandSide& part) const override;

  protected:
    /// Component l of a part that is not zero and is on this rung.
    [[nodiscard]] virtual PreciseInterval enclosed(const RightHandSide& part, std::size_t l) const;

  private:
    PreciseInterval component(int part, std::size_t l);
    PreciseInterval evaluate(const ForceExpression& e);
    [[nodiscard]] Order order_of(const PreciseInterval& value) const;
};

} // namespace isostat
