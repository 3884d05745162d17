#pragma once
// A structure with its statics, about the stored configuration or about the true vertex near it.

#include "statics/decisions.hpp"
#include "support/regular.hpp"

#include <isostat/contact/state.hpp>

namespace crafted {

struct AtVertex : Regular {
    isostat::VertexEnclosure vertex;
    isostat::Statics statics;

    /// `truth`: answers are about the true vertex.
    explicit AtVertex(isostat::State s, bool truth = true, isostat::LadderOptions options = {})
        : Regular(std::move(s)), vertex(isostat::enclose_vertex(state.packing, structure, inverse)),
          statics(state.packing, state.load, structure, factorisation, inverse, {options, truth ? &vertex : nullptr}) {}
    [[nodiscard]] isostat::Contact contact(isostat::ContactId l) const { return state.contacts[l.index()]; }
    [[nodiscard]] double sigma() const { return state.load.stress[1]; }
};

} // namespace crafted
