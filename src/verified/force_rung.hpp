#pragma once
// One rung of the ladder of forces, and the common part of the rungs in floating point: private to the room.

#include "verified/ladder_problem.hpp"
#include "verified/real.hpp"

#include <memory>

namespace isostat {

/// Solutions in one arithmetic, and expressions of them. The problem must outlive the rung.
class ForceRung {
  public:
    /// `rough`: solutions of estimated accuracy (`first_accuracy`) suffice.
    ForceRung(LadderProblem& problem, Rung rung, int bits, bool rough = false)
        : problem_(problem), rung_(rung), bits_(bits), rough_(rough) {}
    ForceRung(const ForceRung&) = delete;
    ForceRung& operator=(const ForceRung&) = delete;
    virtual ~ForceRung() = default;

    [[nodiscard]] Rung rung() const { return rung_; }
    [[nodiscard]] int bits() const { return bits_; }
    /// Brings `part.solution` to this rung from what is known of it. Called for every force of every decision.
    void bring(RightHandSide& part) {
        const ForceSolution& s = part.solution;
        if (s.value.empty() || s.rung != rung_ || s.bits != bits_ || (part.rough && !rough_)) {
            solve_anew(part);
        }
    }
    virtual Order sign(const ForceExpression& a) = 0;
    virtual Order compare(const ForceExpression& a, const ForceExpression& b) = 0;
    /// See `ForceLadder::zero_of`; with about `bits` bits where more are known.
    virtual PreciseInterval zero_of(const ForceExpression& force, int bits) = 0;
    /// Component l of a part that is not zero, rounded once to `bits` bits.
    [[nodiscard]] virtual Real digits(const RightHandSide& part, ContactId contact, int bits) const = 0;
    [[nodiscard]] virtual double bound_exponent(const RightHandSide& part) const = 0;
    /// A bound of |H - H*|_2 between the stored configuration and the true vertex.
    virtual double normal_uncertainty() = 0;
    /// The next rung in floating point; null when there is none, or when it would not decide more.
    virtual std::unique_ptr<ForceRung> next() = 0;

  protected:
    LadderProblem& problem_;

  private:
    void solve_anew(RightHandSide& part);
    /// \pre the right-hand side is not zero.
    virtual void solve(RightHandSide& part) = 0;

    Rung rung_;
    int bits_;
    bool rough_;
};

/// `accuracy` > 0: solutions to this relative accuracy, estimated, suffice.
std::unique_ptr<ForceRung> double_rung(LadderProblem& problem, double accuracy);
/// Null when lengths or loads leave the range in which products of doubles are exact, or when forces of the true vertex
/// are asked for and double-double did not enclose it.
std::unique_ptr<ForceRung> double_double_rung(LadderProblem& problem);
/// Null when forces of the true vertex are asked for and it was not enclosed with this many bits. `start`: a correction
/// of the stored coordinates near the vertex, or empty.
std::unique_ptr<ForceRung> multiprecision_rung(LadderProblem& problem, int bits, const std::vector<Real>& start = {});
/// Null when exact numbers would be too expensive or would not be those of the true vertex, or when the matrix is not
/// regular. `last`: the previous rung, which bounds the distance of the normals from those of the true vertex.
std::unique_ptr<ForceRung> exact_rung(LadderProblem& problem, ForceRung& last);

// exact: bits of comparisons
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
