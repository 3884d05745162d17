#pragma once
/// \file
/// One vertex of a run, with all that is proved of it, and the checks of records against it. Every check returns what
/// is wrong or what stays open; nothing: the record is right.

#include "checker/evidence.hpp"
#include "checker/run_records.hpp"

#include <memory>

namespace isostat::checker {

/// An answer that is not "proved".
struct Objection {
    bool wrong = false; ///< the record contradicts what was found; false: it could not be decided
    std::string text;
};
using Objections = std::optional<Objection>;

/// Records hold numbers that were computed in double: they are compared to this relative size.
inline constexpr double record_tolerance = 1e-9;

/// A vertex at a load. The state stays where it is: the evidence refers to it.
struct Place {
    std::unique_ptr<State<2>> state;
    std::unique_ptr<Evidence> evidence;
    std::vector<int> zeros; ///< structural zeros of the finite load

    [[nodiscard]] double stress() const {
        return state->load.stress[static_cast<std::size_t>(state->load.loaded_axis)];
    }
    [[nodiscard]] Range coordinate(std::size_t k) const;
    [[nodiscard]] Range length(int axis) const;
};

/// The vertex near a configuration; an objection when none is proved there, or a force is neither told from 0 nor a
/// structural zero.
Objections make_place(State<2> state, Place& place);

/// Which contact the rule opens at a vertex.
struct Decision {
    std::string kind;            ///< "tension", "rattler", or empty: an equilibrium
    std::vector<int> candidates; ///< contacts whose (infinitesimal) force is negative
};
Objections decide(const Place& place, Decision& decision);

/// The opening of an arc: `opened` is its position in the contact list.
Objections check_limit(const Place& place, const EventRecord& event, std::size_t opened);
Objections check_rule(const Place& place, const EventRecord& event, std::size_t opened, const std::string& rule);

/// No overlap at the end of an arc, the potential fell along it, and the record's strain, work and power are those.
Objections check_end(const Place& from, const Place& to, const EventRecord& event);

/// A row of equilibria.csv against the vertex that was reached.
Objections check_equilibrium(const Place& place, const EquilibriumLine& line);

/// A stored state against the vertex that was reached.
Objections check_stored(const Place& place, const State<2>& stored);

} // namespace isostat::checker
