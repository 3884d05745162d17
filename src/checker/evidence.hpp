#pragma once
/// \file
/// Everything that the checker proves of a state before it reads a claim, and words for it.

#include "checker/forces.hpp"

#include <isostat/checker/verify.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::checker {

struct Evidence {
    /// `near`: factors of the matrix at a configuration close by, or nothing; with `automatic` only. `digits`: those
    /// of the problem; forces get as many more. `around`: everything holds at every vertex of the list with other
    /// values of the held coordinates which, to first order, move no coordinate farther than that (K28).
    Evidence(const State& checked, CheckerArithmetic arithmetic, bool held_allowed = false,
             const std::shared_ptr<const Solver>& near = {}, int digits = usual_digits, const Rational& around = 0);
    Evidence(const Evidence&) = delete; // the forces refer to the problem
    Evidence& operator=(const Evidence&) = delete;

    const State& state;
    Problem problem;
    bool square = false;
    std::optional<int> rank; ///< of the stored matrix
    InverseBound inverse;
    TrueVertex vertex;
    // At the true vertex, if it was found:
    Forces finite_load;
    ContactForces forces; ///< under the load of the state
    /// The load per unit of the loaded stress, forces per that unit, and per unit of eps: computed on first use, by one
    /// thread.
    [[nodiscard]] const Forces& unit_load() const;
    [[nodiscard]] const ContactForces& slopes() const;
    [[nodiscard]] const ContactForces& infinitesimal() const;
    std::shared_ptr<const Solver> solver; ///< filled when the matrix is square

    [[nodiscard]] std::string name(std::size_t contact) const { return named(state.contacts[contact]); }
    [[nodiscard]] std::string named(const Contact& contact) const {
        return to_string(contact, state.packing.dimension);
    }
    /// How many rows are of one kind; and whether some row is no contact.
    [[nodiscard]] int count(ContactKind kind) const;
    [[nodiscard]] bool has_other_rows() const { return count(ContactKind::bar) + count(ContactKind::held) > 0; }
    /// The true vertex is known to half of the digits or better: the factors were good.
    [[nodiscard]] bool well_known() const {
        return vertex.found && vertex.radius < power_of_two(problem.fine + problem.digits / 2);
    }
    [[nodiscard]] std::string why_no_inverse() const;
    [[nodiscard]] std::string why_no_vertex() const;

  private:
    mutable std::optional<Forces> unit_load_;
    mutable std::optional<ContactForces> slopes_;
    mutable std::optional<ContactForces> infinitesimal_;
};

/// Change of the loaded stress to where the force of a contact vanishes. \pre its slope is not 0
Range step_to_limit(const Evidence& evidence, std::size_t contact);

/// The forces after a change of the loaded stress.
struct ForcesAfter {
    const Evidence& evidence;
    Range step;
    Bounds step_in_double = bounds_of(step);

    [[nodiscard]] Range operator[](std::size_t l) const { return evidence.forces[l] + step * evidence.slopes()[l]; }
    /// Seen in double, or else in exact numbers.
    [[nodiscard]] bool positive(std::size_t l) const {
        return (evidence.forces.bounds(l) + step_in_double * evidence.slopes().bounds(l)).positive() ||
               (*this)[l].positive();
    }
    [[nodiscard]] std::vector<Range> all() const;
};

/// Positions of the ranges that contain 0.
std::vector<int> having_zero(const ContactForces& ranges);

/// The verdict on two statements together: refuted before undecided, undecided before proved.
Verdict both(Verdict a, Verdict b);

/// The verdict on a claimed interval from a proved range of the same number.
Verdict lies_in(const Range& value, const Interval& claimed);

/// "[lower, upper]" with all digits, rounded outwards.
std::string shown(const Range& range);
std::string shown(const Interval& interval);

/// Fills the answer into the check of a claim.
ClaimCheck answer(ClaimCheck check, Verdict verdict, const std::string& detail);

/// The answers about all claims, from the evidence of their state.
Verification judge(const CertificateClaims& claims, const Evidence& evidence);
/// Parts of `judge` in files of their own, for claims that are present.
ClaimCheck judge_forces(const Evidence& evidence, const ForcesClaim& claim);
ClaimCheck judge_load_interval(const Evidence& evidence, const LoadIntervalClaim& claim);
ClaimCheck judge_minimum(const Evidence& evidence, const MinimumClaim& claim);
/// One end of the interval; direction 1 is the upper end. `text` gets what was proved.
Verdict judge_load_end(const Evidence& evidence, const LoadEndClaim& claim, int direction, std::string& text);

} // namespace isostat::checker
