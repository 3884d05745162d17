#pragma once
// What the rungs in floating point share: private to the room.

#include "verified/force_rung.hpp"

#include <map>

namespace isostat {

constexpr mpfr_prec_t low_bits = 160; ///< of comparisons on the rungs double and double-double, and of exact roots

PreciseInterval unknown_interval(mpfr_prec_t bits);

/// 2-norm of the motion that opens contact l at unit rate.
template <int Dim, class T> PreciseInterval norm_of_motion(const ContactSystem<Dim, T>& system, std::size_t l);

/// Expressions as intervals, made of what the rung knows of single components.
template <int Dim> class IntervalRung : public ForceRung<Dim> {
  public:
    using ForceRung<Dim>::ForceRung;
    Order sign(const ForceExpression& a) final;
    Order compare(const ForceExpression& a, const ForceExpression& b) final;
    PreciseInterval zero_of(const ForceExpression& force, int bits) final;
    [[nodiscard]] Real digits(const RightHandSide& part, ContactId contact, int bits) const override;
    [[nodiscard]] double bound_exponent(const RightHandSide& part) const override;

  protected:
    /// Component l of a part that is not zero and was brought here.
    [[nodiscard]] virtual PreciseInterval enclosed(const RightHandSide& part, std::size_t l) const;

  private:
    /// 2-norm of the mechanism that opens contact l at unit rate.
    [[nodiscard]] virtual PreciseInterval norm_of_mechanism(std::size_t l) = 0;
    PreciseInterval component(int part, std::size_t l);
    PreciseInterval evaluate(const ForceExpression& e);
    [[nodiscard]] Order order_of(const PreciseInterval& value) const;
    const PreciseInterval& mechanism_norm(std::size_t l);

    std::map<std::size_t, PreciseInterval> mechanism_; ///< by contact
};

extern template PreciseInterval norm_of_motion<2>(const ContactSystem<2, dd_real>&, std::size_t);
extern template PreciseInterval norm_of_motion<2>(const ContactSystem<2, Real>&, std::size_t);
extern template class IntervalRung<2>;

} // namespace isostat
