#pragma once
// One rung of the ladder of forces: private to the room.

#include "verified/ladder_problem.hpp"
#include "verified/real.hpp"

#include <memory>

namespace isostat {

/// What one arithmetic knows of the solutions, and of expressions in them. The problem must outlive the rung.
template <int Dim> class ForceRung {
  public:
    ForceRung(LadderProblem<Dim>& problem, Rung rung, int bits) : problem_(problem), rung_(rung), bits_(bits) {}
    ForceRung(const ForceRung&) = delete;
    ForceRung& operator=(const ForceRung&) = delete;
    virtual ~ForceRung() = default;

    [[nodiscard]] Rung rung() const { return rung_; }
    [[nodiscard]] int bits() const { return bits_; }
    /// Brings `part.solution` to this rung, from whatever is known of it.
    void bring(RightHandSide& part);
    virtual Order sign(const ForceExpression& a) = 0;
    virtual Order compare(const ForceExpression& a, const ForceExpression& b) = 0;
    /// See `ForceLadder::zero_of`; of about `bits` bits where more are known.
    virtual PreciseInterval zero_of(const ForceExpression& force, int bits) = 0;
    /// Component l of a part that is not zero, rounded once to `bits` bits.
    [[nodiscard]] virtual Real digits(const RightHandSide& part, ContactId contact, int bits) const = 0;
    [[nodiscard]] virtual double bound_exponent(const RightHandSide& part) const = 0;
    /// A bound of |H - H*|_2 between the stored configuration and the one that is meant.
    virtual double normal_uncertainty() = 0;
    /// The next rung in floating point; null when there is none, or when it would not tell more.
    virtual std::unique_ptr<ForceRung> next() = 0;

  protected:
    LadderProblem<Dim>& problem_;

  private:
    /// `part.solution` is of this rung, though a better one of the same arithmetic may be asked for.
    [[nodiscard]] virtual bool is_enough(const RightHandSide& part) const { return !part.rough; }
    /// \pre the right-hand side is not zero.
    virtual void solve(RightHandSide& part) = 0;

    Rung rung_;
    int bits_;
};

/// `accuracy` > 0: solutions to this relative accuracy, estimated, are enough.
template <int Dim> std::unique_ptr<ForceRung<Dim>> double_rung(LadderProblem<Dim>& problem, double accuracy);
/// Null when no true vertex was enclosed in double-double, though one is meant.
template <int Dim> std::unique_ptr<ForceRung<Dim>> double_double_rung(LadderProblem<Dim>& problem);
/// What the rungs in MPFR hand on to each other.
struct MultiprecisionStart {
    std::shared_ptr<const ExtendedMatrix> matrix; ///< of the rung double-double, or null
    std::vector<Real> coordinate;                 ///< near the true vertex; empty: the stored ones
};
/// Null when no true vertex was enclosed to so many bits, though one is meant.
template <int Dim>
std::unique_ptr<ForceRung<Dim>> multiprecision_rung(LadderProblem<Dim>& problem, MultiprecisionStart start, int bits);
/// Null when exact numbers would be too expensive, would not be about what is meant, or when the matrix is not regular.
/// `last`: the rung before, which says how far normals are from those that are meant.
template <int Dim> std::unique_ptr<ForceRung<Dim>> exact_rung(LadderProblem<Dim>& problem, ForceRung<Dim>& last);

extern template class ForceRung<2>;
extern template std::unique_ptr<ForceRung<2>> double_rung<2>(LadderProblem<2>&, double);
extern template std::unique_ptr<ForceRung<2>> double_double_rung<2>(LadderProblem<2>&);
extern template std::unique_ptr<ForceRung<2>> multiprecision_rung<2>(LadderProblem<2>&, MultiprecisionStart, int);
extern template std::unique_ptr<ForceRung<2>> exact_rung<2>(LadderProblem<2>&, ForceRung<2>&);

} // namespace isostat
