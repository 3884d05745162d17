#pragma once
/// \file
/// Contact forces at every precision behind one interface, and proved comparisons of them.

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

/// What the stored stress lacks to the exact one, for a limit load: known to any number of bits.
class LoadShift {
  public:
    virtual ~LoadShift() = default;
    /// An interval of about `bits` bits, as far as the ladder behind it goes.
    [[nodiscard]] virtual PreciseInterval value(int bits) const = 0;
};

/// A quantity by which contacts are ordered: p_l + (at - from) s_l with p, s the solutions of two right-hand sides,
/// possibly divided by |d_l|, d a third solution, then proved not zero. All doubles are exact.
struct ForceExpression {
    ContactId contact;
    int part = 0;
    int slope_part = -1; ///< -1: no second term
    double at = 0;
    double from = 0;
    const LoadShift* shift = nullptr; ///< added to `at`; not on the rung exact
    bool minus_magnitude = false;     ///< -|.| instead of the sum (held coordinates)
    int divisor_part = -1;            ///< d; -1: none
};

/// What a right-hand side is besides its doubles.
struct LoadTerms {
    /// Rows whose component is a product, of which the double is the rounded value: on every rung the exact one is
    /// meant.
    std::vector<ExactProduct> products;
    /// The force itself depends on the configuration: |F(q) - F(q*)|_2 <= rate |q - q*|_2 (true stresses).
    double rate = 0;
};

/// The solutions of H f = F for several right-hand sides, all on one rung, each with its proved bound:
///   double -> refined with residuals in double-double -> in MPFR with first_bits, twice as many, ... max_bits ->
///   exact.
/// With `first_accuracy` the rung double has two steps: see LadderOptions.
/// The rungs in floating point need the bound of the inverse (V3) and are skipped when there is none or when a climb
/// gained nothing; exact numbers need only the proof of rank that `structure` is. Solutions are computed when asked
/// for. The arguments must outlive the object.
class ForceLadder {

  public:
    ForceLadder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                const InverseBound& inverse, LadderOptions options = {}, const VertexEnclosure* vertex = nullptr);
    ~ForceLadder();
    ForceLadder(ForceLadder&&) noexcept;
    ForceLadder& operator=(ForceLadder&&) noexcept;

    /// Adds a right-hand side (one number per degree of freedom, taken as exact); returns its number, from 0.
    /// `guess`: of the solution, or empty; changes the cost.
    int add(std::vector<double> force, LoadTerms terms = {}, std::vector<double> guess = {});
    [[nodiscard]] const std::vector<double>& force(int part) const;

    /// The solution on the present rung. A zero right-hand side has the exact solution 0 with bound 0 on every rung.
    [[nodiscard]] const ForceSolution& solution(int part) const;
    /// What is known of the solution so far, without solving: empty, or one number per contact.
    [[nodiscard]] std::span<const double> known(int part) const;
    /// Component l of the solution on the present rung, as a hexadecimal floating-point number with `bits` bits of
    /// mantissa (rounded to nearest): for records and references.
    [[nodiscard]] std::string digits(int part, ContactId contact, int bits) const;

    /// log2 of a proved bound of the error of what `digits` rounds (every component): -infinity for exact numbers.
    /// Below the range of double it says more than `solution().bound`.
    [[nodiscard]] double bound_exponent(int part) const;

    /// Goes to the next rung that can tell more; false when there is none.
    bool climb();
    [[nodiscard]] Rung rung() const;
    [[nodiscard]] int bits() const;
    /// A bound of |H - H*|_2 between the stored configuration and the one that is spoken of (0 without a vertex).
    [[nodiscard]] double normal_uncertainty() const;

    /// The rung exact is not used: for expressions with a shift.
    void without_exact_numbers();
    /// What must be added to `force.at` for the quantity (without divisor) to vanish. \pre its slope is proved not 0.
    /// The arguments of the ladder must outlive the result; the ladder itself need not, and climbs when more bits are
    /// asked for.
    [[nodiscard]] std::shared_ptr<const LoadShift> zero_of(const ForceExpression& force) const;

    /// Sign of a quantity, and of the difference a - b, on the present rung.
    [[nodiscard]] Order sign(const ForceExpression& a) const;
    [[nodiscard]] Order compare(const ForceExpression& a, const ForceExpression& b) const;

  private:
    struct Implementation;
    std::shared_ptr<Implementation> implementation_; ///< with the results of `zero_of`
};

} // namespace isostat
