#pragma once
/// \file
/// One vertex of a run, with all that is proved of it, and the checks of records against it. Every check returns what
/// is wrong or undecided; an empty result: the record is right.

#include "checker/evidence.hpp"
#include "checker/first_order.hpp"
#include "checker/run_records.hpp"
#include "checker/vertex.hpp"

#include <memory>

namespace isostat::checker {

/// A result of a check that is not "proved".
struct Objection {
    bool wrong = false; ///< the record contradicts what was proved; false: undecided
    std::string text;
    bool for_good = false; ///< more digits of the vertex would not change it
};
using Objections = std::optional<Objection>;

/// Relative size of the agreement of recorded numbers without a bound, which were computed in double. Bounds of a
/// length, a strain or the potential may not be larger.
inline constexpr double record_tolerance = 1e-9; // checker.md record_tolerance
/// Such a tolerance for the strain at the end of an arc.
inline constexpr double arc_strain_tolerance = 1e-6; // checker.md arc_strain_tolerance
/// Such a tolerance for bounds of forces and of ends of intervals, which grow with the condition number.
inline constexpr double force_tolerance = 1e-3; // checker.md force_tolerance
/// A power turn is located in double: the power there, and the rate of the held coordinate, agree up to this.
inline constexpr double turn_tolerance = 1e-6; // checker.md turn_tolerance

/// The exact stress minus the stored stress of a state, and the first-order term of the stress: different from 0 only
/// for runs whose ties were settled at first order, after a limit load.
struct ExactLoad {
    Range shift{Rational(0)};
    Range rate{Rational(0)};
};

/// A recorded number with its recorded bound.
struct Bounded {
    double value = 0;
    double bound = 0;
};

/// The number found lies within the recorded bound; undecided when the bound is above `loosest`.
Objections compare(const std::string& name, const Bounded& said, const Range& found, double loosest);

/// A first-order term with its bound against the range found: the two must have a number in common. A wide bound
/// contradicts nothing and proves nothing; decisions that depend on the term use the range that was found.
Objections check_said(const std::string& what, const Bounded& said, const Range& found);

/// The largest magnitude.
double largest_force(const ContactForces& forces);

/// As `compare`, for a number that may be recorded without a bound (NaN): then undecided.
Objections compare_if_bounded(const std::string& name, const Bounded& said, const Range& found, double loosest);

/// A vertex at a load. The state is not copied, because the evidence refers to it. Forces are those at the exact load.
struct Place {
    std::unique_ptr<State> state;
    std::unique_ptr<Evidence> evidence;
    std::vector<int> zeros; ///< structural zeros of the finite load
    ExactLoad load;
    std::vector<bool> silent; ///< with `fresh`: contacts whose force is 0 at the exact turn
    int fresh = -1; ///< row of the coordinate held since the last turn: multiplier 0 up to the place of the turn
    // Only in runs that settle ties at first order:
    bool chooses = false; ///< where these terms do not decide, the rule chooses: set before `make_place`
    std::unique_ptr<FirstOrder> first;
    std::vector<int> ties;          ///< forces that cannot be told from 0 and are no structural zeros
    std::vector<Range> first_force; ///< first-order terms of all forces at the load
    std::vector<Gap> touching;      ///< pairs whose gaps cannot be told from 0, with their first-order gaps
    std::vector<TieRecord> said;    ///< recorded ties of the arc that ended here

    [[nodiscard]] bool is_held(std::size_t contact) const { return state->contacts[contact].kind == ContactKind::held; }

    /// A bar bears forces of either sign, so it neither opens nor limits.
    [[nodiscard]] bool is_bar(std::size_t contact) const { return state->contacts[contact].kind == ContactKind::bar; }

    /// The name of a contact as in records.
    [[nodiscard]] std::string named(const Contact& contact) const {
        return to_string(contact, state->packing.dimension);
    }
    [[nodiscard]] double stress() const { return state->load.loaded_stress(); }
    /// The nearest pairs (K9); computed on first use, by one thread.
    [[nodiscard]] const std::vector<Gap>& gaps() const;
    [[nodiscard]] Range coordinate(std::size_t k) const;
    [[nodiscard]] Range length(int axis) const;

  private:
    mutable std::optional<std::vector<Gap>> gaps_;
};

/// The vertex near a configuration; an objection when no vertex is proved there, or a force is neither told from 0 nor
/// a structural zero. `near`: factors of the matrix nearby, or null. `digits`: of the problem, and `usual_digits` where
/// fewer leave an objection.
Objections make_place(State state, Place& place, const ExactLoad& load = {}, int fresh = -1,
                      const std::shared_ptr<const Solver>& near = {}, int digits = few_digits);
/// The exact load of a stored state: if the state says so, the load next to the stored one at which a force vanishes.
ExactLoad meant_load(const State& state);
/// The same vertex with more digits; on failure the old one stays. Returns the objections of `make_place`.
Objections sharpen(Place& place, int digits);

/// All grains of a contact, which is no held coordinate, bear finite forces in other contacts: then the load does work
/// when it opens, though not at first order.
bool grains_bear_force(const Place& place, std::size_t contact);

/// The record of the last arc, or the stored state, says that the force of a contact was left at 0.
bool is_left(const Place& place, std::size_t l);

/// Which contact the rule opens at a vertex.
struct Decision {
    std::string kind;            ///< "tension", "rattler", or empty: an equilibrium
    std::vector<int> candidates; ///< contacts whose (infinitesimal) force is negative
    std::vector<int> open;       ///< contacts that may also have a negative force
};
/// `still`: coordinates held without a finite force stay held, as free motions of clumps may (U2 in proofs/clumps.md).
Objections decide(const Place& place, Decision& decision, bool still = false);

/// The opening of an arc: `opened` is its position in the contact list,
/// `bound` that of the end of the interval in the row of the equilibrium.
Objections check_limit(const Place& place, const EventRecord& event, double bound, std::size_t opened,
                       ExactLoad& at_limit);
/// An end of the supported interval, at which contact `opened` opens.
Objections check_load_end(const Place& place, const Bounded& stress, std::size_t opened, int direction);
/// As `check_load_end`, in a run that settles ties at first order. `said`: recorded ties; null: no record.
Objections check_limit_at(const Place& place, const Bounded& stress, std::size_t opened, ExactLoad& at_limit,
                          const std::vector<TieRecord>* said);
Objections check_rule(const Place& place, const EventRecord& event, std::size_t opened, const RunRecords& run);

/// No overlap at the end of an arc, the potential fell along it, and recorded strain, work and power agree. `rattles`:
/// the infinitesimal loads moved grains that carry no finite load.
Objections check_end(const Place& from, const Place& to, const EventRecord& event, bool rattles);

/// The start of the arcs to equilibrium 0: nothing overlaps there, and the contacts are those of start.json, unless the
/// run chose among the touching pairs. Where ties are chosen, pairs that start.json does not list may overlap at first
/// order.
Objections check_start(const Place& place, const State& given);

/// The touching pairs at the start of an arc: pairs that close again on a path of length O(eps) end the arc there.
Objections check_step(const Place& place, const EventRecord& event, std::size_t opened, int direction);
/// First-order terms that the record names, against those found. `from`: start of the arc, `to`: its end.
Objections check_ties(const Place& base, const Place& from, const Place& to, const EventRecord& event,
                      std::size_t opened, int direction);

/// At a power turn: the multiplier of the held coordinate is 0 up to the accuracy of its place, and it is the fastest.
Objections check_turn(const Place& place, const EventRecord& event, bool rattles);

/// A row of equilibria.csv against the vertex that was reached.
Objections check_equilibrium(const Place& place, const EquilibriumLine& line);

/// A stored state against the vertex that was reached. `start`: start of the run, which may be as far from its vertex
/// as the proof of this vertex allows.
Objections check_stored(const Place& place, const State& stored, const std::optional<State>& start);
/// The forces in the file of a state, if it has any.
Objections check_stored_forces(const Place& place, const std::vector<double>& forces);

} // namespace isostat::checker
