// Links something of every room, so that a missing library shows; then computes in another way, which must be refused.
#include <isostat/isostat.hpp> // every public header: none may need a private one

#include <cfenv>
#include <cstdio>

int main() {
    using namespace isostat;
    const Scene scene = parse_scene("[packing]\ndisks = 16\n", "inline", "");
    PreparationReport report;
    const auto prepared = prepare(scene.preparation, report);
    if (!prepared.ok()) {
        std::printf("%s\n", prepared.failure().message().c_str());
        return 1;
    }
    const State state = parse_state(state_text(prepared.value()), "text").state;
    const auto inspection = inspect_vertex(state);
    if (!inspection.ok() || !inspection.value().equilibrium) {
        return 1;
    }
    std::printf("%d contacts, isostatic equilibrium: %s, table of %zu bytes\n", inspection.value().record.contact_count,
                std::string(to_string(inspection.value().record.verdict)).c_str(), csv_text(state.packing).size());
    const SparseColumns h = contact_matrix(state);
    const auto motion = mechanism(state, state.contacts.front());
    const auto arc = first_arc(state, +1);
    if (!motion.ok() || static_cast<int>(motion.value().size()) != h.rows || !arc.ok()) {
        return 1;
    }
    std::printf("%d x %d contact matrix, an arc opens %s and closes %s\n", h.rows, h.columns,
                to_string(arc.value().opened).c_str(), to_string(arc.value().closed).c_str());
    std::fesetround(FE_UPWARD);
    try {
        (void)inspect_vertex(state);
    } catch (const Error& error) {
        std::fesetround(FE_TONEAREST);
        std::printf("rounding up: %s\n", error.what());
        return error.kind() == ErrorKind::internal ? 0 : 1;
    }
    return 1;
}
