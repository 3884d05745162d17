#include "trajectory/segment_start.hpp"

#include "contact/words.hpp"
#include "trajectory/ties/ties.hpp"

namespace isostat {

namespace {

Result<SegmentStart> prove_start(const State& state, Prover& prover) {
    auto vertex = prover.vertex(state.packing, state.contacts, {state.load});
    if (!vertex.ok()) {
        return vertex.failure();
    }
    auto gaps = prover.gaps(*vertex.value());
    if (!gaps.ok()) {
        return gaps.failure();
    }
    return SegmentStart{std::move(vertex.value()), std::move(gaps.value())};
}

/// True: a choice was made.
Result<bool> choose_contacts(State& state, Prover& prover, const TieSettling& ties) {
    const auto dofs = static_cast<std::size_t>(DofMap(state.packing).dof_count());
    const bool hyperstatic = state.contacts.size() > dofs;
    if (hyperstatic) {
        if (auto failure = ties.choose_contacts()) {
            return *failure;
        }
    }
    const auto listed = prove_start(state, prover);
    if (!listed.ok()) {
        return listed.failure();
    }
    const ZeroGaps& zero = listed.value().gaps.zero;
    const auto overlap = settle_touching(*listed.value().vertex, zero);
    if (hyperstatic || !overlap || overlap->kind != FailureKind::overlap) {
        return hyperstatic;
    }
    for (const auto& [contact, order] : zero) {
        state.contacts.push_back(contact);
    }
    if (auto failure = ties.choose_contacts()) {
        return *failure;
    }
    return true;
}

} // namespace

Result<SegmentStart> start_segment(State& state, Prover& prover, const TieSettling& ties, bool resumed) {
    prover.start_at(state.packing);
    bool chosen = false;
    if (ties.settles() && !resumed) {
        const auto choice = choose_contacts(state, prover, ties);
        if (!choice.ok()) {
            return choice.failure();
        }
        chosen = choice.value();
    }
    auto start = prove_start(state, prover);
    if (!start.ok()) {
        return start;
    }
    SegmentStart& begun = start.value();
    if (begun.gaps.negative) {
        return failed(FailureKind::overlap, "{} overlap", named(*begun.gaps.negative, state.packing.dimension));
    }
    if (auto failure = ties.resume(*begun.vertex, begun.gaps.zero)) {
        return *failure;
    }
    begun.chosen = chosen || !begun.gaps.zero.empty();
    return start;
}

} // namespace isostat
