#pragma once
/// \file
/// Contact forces at every precision through one interface, and proved comparisons of forces.

#include "verified/configuration.hpp"
#include "verified/force_solution.hpp"
#include "verified/order.hpp"

#include <isostat/core/contact.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace isostat {

class PreciseInterval;

/// The exact stress minus the stored stress, for a limit load: computable to any number of bits.
class LoadShift {
  public:
    virtual ~LoadShift() = default;
    /// An interval of about `bits` bits, or of as many as its ladder has.
    [[nodiscard]] virtual PreciseInterval value(int bits) const = 0;
};

/// A quantity by which contacts are ordered: p_l + (at - from) s_l with p, s the solutions of two right-hand sides,
/// possibly divided by |d_l|, where d is a third solution, proved not zero. All doubles are exact.
struct ForceExpression {
    ContactId contact;
    int part = 0;
    int slope_part = -1; ///< -1: there is no second term
    double at = 0;
    double from = 0;
    const LoadShift* shift = nullptr; ///< added to `at`; not used on the rung exact
    bool minus_magnitude = false;     ///< for held coordinates: -|.| instead of the sum
    int divisor_part = -1;            ///< right-hand side of d; -1: no divisor
};

/// How a right-hand side differs from its doubles.
struct LoadTerms {
    /// Rows whose exact component is a product, of which the double
    /// is the rounded value: every rung uses the exact product.
    std::vector<ExactProduct> products;
    /// The force itself depends on the configuration: |F(q) - F(q*)|_2 <= rate |q - q*|_2 (true stresses).
    double rate = 0;
};

/// The solutions of H f = F for several right-hand sides, all on one rung, each
/// with its proved bound: double -> refined with residuals in double-double ->
/// in MPFR with first_bits, twice as many, ... max_bits -> exact.
/// With `first_accuracy` the rung double has two steps: see LadderOptions.
/// The rungs in floating point need the bound of the inverse (V3) and are skipped when there is none or when a climb
/// gained nothing; exact numbers need only the rank, which `structure` proves. Solutions are computed on first use. The
/// arguments must outlive the object.
class ForceLadder {

  public:
    ForceLadder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                const InverseBound& inverse, LadderOptions options = {}, const VertexEnclosure* vertex = nullptr);
    ~ForceLadder();
    ForceLadder(ForceLadder&&) noexcept;
    ForceLadder& operator=(ForceLadder&&) noexcept;

    /// Adds a right-hand side (one number per degree of freedom, taken as exact); returns its number, from 0. `guess`
    /// of the solution, or empty: changes the cost.
    int add(std::vector<double> force, LoadTerms terms = {}, std::vector<double> guess = {});
    [[nodiscard]] const std::vector<double>& force(int part) const;

    /// The solution on the present rung. A zero right-hand side has the exact solution 0 with bound 0 on every rung.
    [[nodiscard]] const ForceSolution& solution(int part) const;
    /// The solution as known so far, without solving: empty, or one number per contact.
    [[nodiscard]] std::span<const double> known(int part) const;
    /// Component l of the solution on the present rung, as a hexadecimal floating-point number with `bits` bits of
    /// mantissa (rounded to nearest): for records and references.
    [[nodiscard]] std::string digits(int part, ContactId contact, int bits) const;

    /// log2 of a proved bound of the error, in every component, of the number that `digits` rounds: -infinity for exact
    /// numbers. It keeps its precision below the range of double, where `solution().bound` loses it.
    [[nodiscard]] double bound_exponent(int part) const;

    /// Goes to the next rung that can decide more; false when there is none.
    bool climb();
    [[nodiscard]] Rung rung() const;
    [[nodiscard]] int bits() const;
    /// A bound of |H - H*|_2 between the stored configuration and the true vertex (0 without a vertex).
    [[nodiscard]] double normal_uncertainty() const;

    /// The rung exact is not used from now on: for expressions with a shift.
    void without_exact_numbers();
    /// The amount to add to `force.at` so that the quantity (without divisor) vanishes.
    /// \pre its slope is proved not 0. The arguments of the ladder must outlive the
    /// result; the ladder itself need not. The result climbs when more bits are asked for.
    [[nodiscard]] std::shared_ptr<const LoadShift> zero_of(const ForceExpression& force) const;

    /// Sign of a quantity, and of the difference a - b, on the present rung.
    [[nodiscard]] Order sign(const ForceExpression& a) const;
    [[nodiscard]] Order compare(const ForceExpression& a, const ForceExpression& b) const;

  private:
    struct Implementation;
    std::shared_ptr<Implementation> implementation_; ///< shared with the results of `zero_of`
};

} // namespace isostat
