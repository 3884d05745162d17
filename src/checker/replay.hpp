#pragma once
/// \file
/// One vertex of a run, with all that is proved of it, and the checks of records against it. Every check returns what
/// is wrong or what stays open; nothing: the record is right.

#include "checker/evidence.hpp"
#include "checker/first_order.hpp"
#include "checker/gaps.hpp"
#include "checker/run_records.hpp"

#include <memory>

namespace isostat::checker {

/// An answer that is not "proved".
struct Objection {
    bool wrong = false; ///< the record contradicts what was found; false: it could not be decided
    std::string text;
    bool for_good = false; ///< more digits of the vertex would not change it
};
using Objections = std::optional<Objection>;

/// Records hold numbers that were computed in double: those without a bound are compared to this relative size, and no
/// bound of a length, a strain or the potential may be larger.
inline constexpr double record_tolerance = 1e-9;
/// The same for the strain at the end of an arc.
inline constexpr double arc_strain_tolerance = 1e-6;
/// The same for bounds of forces and of ends of intervals, which are what the structure is conditioned to.
inline constexpr double force_tolerance = 1e-3;
/// A power turn is located in double: the power there, and how fast the coordinate held is, are compared to this.
inline constexpr double turn_tolerance = 1e-6;

/// What the stored stress of a state lacks to the one that is meant, and the first-order term of that: both not 0 only
/// for runs whose ties were settled at first order, after a limit load.
struct ExactLoad {
    Range shift{Rational(0)};
    Range rate{Rational(0)};
};

/// A number of a record with its bound beside it.
struct Bounded {
    double value = 0;
    double bound = 0;
};

/// The number found lies within the bound; undecided when the bound is above `loosest`.
Objections compare(const std::string& name, const Bounded& said, const Range& found, double loosest);

/// A first-order term with its bound against what was found: the two have a number in common. A wide bound contradicts
/// nothing and is evidence of nothing: what hangs on the term is decided by the range that was found.
Objections check_said(const std::string& what, const Bounded& said, const Range& found);

/// The largest magnitude.
double largest_force(const std::vector<Range>& forces);

/// The same for a number that may be recorded without a bound (NaN): undecided then.
Objections compare_if_bounded(const std::string& name, const Bounded& said, const Range& found, double loosest);

/// A vertex at a load. The state stays where it is: the evidence refers to it. Forces are those at the exact load.
struct Place {
    std::unique_ptr<State> state;
    std::unique_ptr<Evidence> evidence;
    std::vector<int> zeros; ///< structural zeros of the finite load
    ExactLoad load;
    std::vector<bool> silent; ///< with `fresh`: contacts whose force is 0 at the turn itself
    int fresh = -1; ///< the row of a coordinate held just now: its multiplier is 0 up to the place of the turn
    // Runs that settle ties at first order only:
    bool chooses = false; ///< what these terms do not tell is chosen by the rule: set before `make_place`
    std::unique_ptr<FirstOrder> first;
    std::vector<int> ties;          ///< forces that cannot be told from 0 and are no structural zeros
    std::vector<Range> first_force; ///< first-order terms of all forces at the load
    std::vector<Gap> touching;      ///< pairs whose gaps cannot be told from 0, with their first-order gaps
    std::vector<TieRecord> said;    ///< of ties, by the record of the arc that ended here

    [[nodiscard]] bool is_held(std::size_t contact) const { return state->contacts[contact].kind == ContactKind::held; }

    /// It bears forces of either sign: it neither opens nor limits.
    [[nodiscard]] bool is_bar(std::size_t contact) const { return state->contacts[contact].kind == ContactKind::bar; }

    /// A contact as records spell it.
    [[nodiscard]] std::string named(const Contact& contact) const {
        return to_string(contact, state->packing.dimension);
    }
    [[nodiscard]] double stress() const { return state->load.loaded_stress(); }
    /// The nearest pairs (K9); swept for when first asked for, by one thread.
    [[nodiscard]] const std::vector<Gap>& gaps() const;
    [[nodiscard]] Range coordinate(std::size_t k) const;
    [[nodiscard]] Range length(int axis) const;

  private:
    mutable std::optional<std::vector<Gap>> gaps_;
};

/// The vertex near a configuration; an objection when none is proved there, or a force is neither told from 0 nor a
/// structural zero. `near`: factors of the matrix close by, or nothing. `digits`: of the problem.
Objections make_place(State state, Place& place, const ExactLoad& load = {}, int fresh = -1,
                      std::shared_ptr<const Solver> near = {}, int digits = usual_digits);
/// The load that a stored state means: where it says so that at which a force vanishes, next to the stored one.
ExactLoad meant_load(const State& state);
/// The same vertex with more digits; the old one stays where none is proved. What `make_place` says of it.
Objections sharpen(Place& place, int digits);

/// All grains of a contact, which is no held coordinate, bear finite forces in other contacts: the load does work when
/// it opens, though not at first order.
bool grains_bear_force(const Place& place, std::size_t contact);

/// Which contact the rule opens at a vertex.
struct Decision {
    std::string kind;            ///< "tension", "rattler", or empty: an equilibrium
    std::vector<int> candidates; ///< contacts whose (infinitesimal) force is negative
    std::vector<int> open;       ///< beside them: it may be
};
/// `still`: what is held without a finite force stays, as free motions of clumps may (U2 in proofs/clumps.md).
Objections decide(const Place& place, Decision& decision, bool still = false);

/// The opening of an arc: `opened` is its position in the contact list, `bound` that of the end of the interval in the
/// row of the equilibrium.
Objections check_limit(const Place& place, const EventRecord& event, double bound, std::size_t opened,
                       ExactLoad& at_limit);
/// An end of the supported interval, at which that contact opens.
Objections check_load_end(const Place& place, const Bounded& stress, std::size_t opened, int direction);
/// The same in a run that settles ties at first order. `said`: of ties, by a record; null: there is none.
Objections check_limit_at(const Place& place, const Bounded& stress, std::size_t opened, ExactLoad& at_limit,
                          const std::vector<TieRecord>* said);
Objections check_rule(const Place& place, const EventRecord& event, std::size_t opened, const RunRecords& run);

/// No overlap at the end of an arc, the potential fell along it, and the record's strain, work and power are those.
/// `rattles`: grains that carry no finite load moved, under the infinitesimal ones.
Objections check_end(const Place& from, const Place& to, const EventRecord& event, bool rattles);

/// The start of the arcs to equilibrium 0: nothing overlaps there, and the contacts are those of start.json, unless the
/// run chose some of the pairs that touch.
Objections check_start(const Place& place, const State& given);

/// The pairs that touch at the start of an arc: those that close again on a way of length O(eps) end it there.
Objections check_step(const Place& place, const EventRecord& event, std::size_t opened, int direction);
/// First-order terms that the record names, against those found. `from`: start of the arc, `to`: its end.
Objections check_ties(const Place& base, const Place& from, const Place& to, const EventRecord& event,
                      std::size_t opened, int direction);

/// At a power turn: the multiplier of the coordinate held is 0 up to the accuracy of its place, and it is the fastest.
Objections check_turn(const Place& place, const EventRecord& event, bool rattles);

/// A row of equilibria.csv against the vertex that was reached.
Objections check_equilibrium(const Place& place, const EquilibriumLine& line);

/// A stored state against the vertex that was reached. `start`: of the run, which may be as far from its vertex as the
/// proof that there is one allows.
Objections check_stored(const Place& place, const State& stored, const std::optional<State>& start);
/// The forces in its file; none may be there.
Objections check_stored_forces(const Place& place, const std::vector<double>& forces);

} // namespace isostat::checker
