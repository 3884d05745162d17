#pragma once
// What the rungs in floating point share: private to the room.

#include "verified/force_rung.hpp"

namespace isostat {

constexpr mpfr_prec_t low_bits = 160; ///< of comparisons on the rungs double and double-double, and of exact roots

/// Expressions as intervals, made of what the rung knows of single components.
class IntervalRung : public ForceRung {
  public:
    using ForceRung::ForceRung;
    Order sign(const ForceExpression& a) final;
    Order compare(const ForceExpression& a, const ForceExpression& b) final;
    PreciseInterval zero_of(const ForceExpression& force, int bits) final;
    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override;
    [[nodiscard]] double bound_exponent(const RightHandSide& part) const override;

  protected:
    /// Component l of a part that is not zero and was brought here.
    [[nodiscard]] virtual PreciseInterval enclosed(const RightHandSide& part, std::size_t l) const;

  private:
    PreciseInterval component(int part, std::size_t l);
    PreciseInterval evaluate(const ForceExpression& e);
    [[nodiscard]] Order order_of(const PreciseInterval& value) const;
};

} // namespace isostat
