#pragma once
/// \file
/// Contact forces at every precision behind one interface, and proved comparisons of them.

#include <isostat/core/ids.hpp>
#include <isostat/verified/force_solution.hpp>

#include <memory>
#include <string>
#include <vector>

namespace isostat {

/// How far a ladder may climb.
struct LadderOptions {
    int first_bits = 256; ///< of the first rung in MPFR; doubled on every climb
    int max_bits = 4096;  ///< cap: a comparison that is open there is a tie "to max_bits bits", unless exact
    int exact_size =
        2000; ///< largest N_f for which exact numbers are tried (0.04 s at 200, 1 s at 800, grows like N_f^2.5)
};

/// A quantity by which contacts are ordered: p_l + (at - from) s_l with p, s the solutions of two right-hand sides,
/// possibly divided by |d_l| (d a third solution, then proved not zero) or by the 2-norm of the mechanism that opens
/// contact l at unit rate. All doubles are exact.
struct ForceExpression {
    enum class Divisor : unsigned char { none, part, mechanism };
    ContactId contact;
    int part = 0;
    int slope_part = -1; ///< -1: no second term
    double at = 0;
    double from = 0;
    bool minus_magnitude = false; ///< -|.| instead of the sum (held coordinates)
    Divisor divisor = Divisor::none;
    int divisor_part = -1;
};

/// Answer of a comparison: the sign of a quantity or of a difference.
struct Order {
    bool decided = false; ///< false: open at the precision reached; `sign` says nothing
    int sign = 0;         ///< -1, 0 or +1; 0 is *proved*: both sides are exactly equal
    double margin = 0;    ///< |centre| / radius of the enclosure that decided; infinite for exact numbers
    Rung rung = Rung::none;
    int bits = 0; ///< as in ForceSolution
};

/// The solutions of H f = F for several right-hand sides, all on one rung, each with its proved bound:
///   double -> refined with residuals in double-double -> in MPFR with first_bits, twice as many, ... max_bits ->
///   exact.
/// The rungs in floating point need the bound of the inverse (V3) and are skipped when there is none or when a climb
/// gained nothing; exact numbers need only the proof of rank that `structure` is. Solutions are computed when asked
/// for. The arguments must outlive the object.
template <int Dim> class ForceLadder {
  public:
    ForceLadder(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                const Factorisation& factorisation, const InverseBound& inverse, LadderOptions options = {});
    ~ForceLadder();
    ForceLadder(ForceLadder&&) noexcept;
    ForceLadder& operator=(ForceLadder&&) noexcept;

    /// Adds a right-hand side (one number per degree of freedom, taken as exact); returns its number, from 0.
    int add(std::vector<double> force);
    [[nodiscard]] const std::vector<double>& force(int part) const;

    /// The solution on the present rung. A zero right-hand side has the exact solution 0 with bound 0 on every rung.
    const ForceSolution& solution(int part) const;
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

    /// Sign of a quantity, and of the difference a - b, on the present rung.
    [[nodiscard]] Order sign(const ForceExpression& a) const;
    [[nodiscard]] Order compare(const ForceExpression& a, const ForceExpression& b) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

extern template class ForceLadder<2>;

} // namespace isostat
