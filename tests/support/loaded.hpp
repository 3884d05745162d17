#pragma once
// A structure with its statics, about the stored configuration or about the true vertex near it.

#include "statics/decisions.hpp"

#include <isostat/contact/state.hpp>

#include <boost/test/unit_test.hpp>

#include <utility>

namespace crafted {

/// The parts refer to each other, so it stays where it is made.
struct AtVertex {
    isostat::State state;
    isostat::IsostaticStructure structure;
    isostat::Factorisation factorisation;
    isostat::InverseBoundCache cache;
    isostat::InverseBound inverse;
    isostat::VertexEnclosure vertex;
    isostat::Statics statics;

    /// `truth`: answers are about the true vertex.
    explicit AtVertex(isostat::State s, bool truth = true, isostat::LadderOptions options = {})
        : state(std::move(s)), structure(proved(state)), factorisation(structure),
          inverse(isostat::bound_inverse(structure, factorisation, cache)),
          vertex(isostat::enclose_vertex(state.packing, structure, inverse)),
          statics(state.packing, state.load, structure, factorisation, inverse, {options, truth ? &vertex : nullptr}) {}
    static isostat::IsostaticStructure proved(const isostat::State& s) {
        auto result = isostat::IsostaticStructure::prove(s.packing, s.contacts);
        BOOST_TEST_REQUIRE(result.ok());
        return std::move(result.value());
    }
    [[nodiscard]] isostat::Contact contact(isostat::ContactId l) const { return state.contacts[l.index()]; }
    [[nodiscard]] double sigma() const { return state.load.stress[1]; }
};

} // namespace crafted
