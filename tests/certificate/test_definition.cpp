// One definition of the problem (proofs/definition.md): inspection, certificate, checker and the engine of runs speak
// of the same load, pattern, pairs and point.
// Level `states`: a certificate that refutes an equilibrium ends the run.
#include "certificate/state_certifier.hpp"
#include "checker/claims.hpp"
#include "core/work.hpp"
#include "linear/factorisation.hpp"
#include "statics/decisions.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/regular.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"
#include "verified/configuration.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

#include <boost/test/data/test_case.hpp>

using namespace isostat;
using namespace crafted;

namespace {

State stored(const std::string& name) {
    return read_state(scratch::data("definition/" + name + ".json")).state;
}

/// What the engine of runs says: the contact that opens, nothing for an equilibrium; undecided is a failure.
Result<OpeningDecision> decided(const State& state, std::optional<LoadLimit>* low = nullptr) {
    const Regular at(state);
    const VertexEnclosure vertex = enclose_vertex(state.packing, at.structure, at.factorisation, at.inverse);
    Statics statics(state.packing, state.load, at.structure, at.factorisation, at.inverse, {{}, &vertex});
    const double sigma = state.load.loaded_stress();
    auto decision = decide_opening(statics, sigma, OpeningRule::most_negative, {}, 0);
    if (low != nullptr) {
        auto limit = find_limit(statics, sigma, -1);
        if (limit.ok()) {
            *low = limit.value();
        }
    }
    return decision;
}

struct Known {
    const char* name;
    Verdict verdict;
};
std::ostream& operator<<(std::ostream& out, const Known& known) {
    return out << known.name;
}
constexpr std::array<Known, 9> known_states{{{"load-product", Verdict::refuted},
                                             {"structural", Verdict::refuted},
                                             {"02-tension", Verdict::refuted},
                                             {"07-load-rounding-proved", Verdict::refuted},
                                             {"07-load-rounding-refuted", Verdict::proved},
                                             {"08-interval", Verdict::proved},
                                             {"11-same-height-opens", Verdict::proved},
                                             {"11-same-height-refuted", Verdict::proved},
                                             {"fixed-pair", Verdict::refuted}}};

Verdict answer(const State& state, const CertificateClaims& made, const std::string& claim) {
    return claims::verdict_on(verify(claims::certificate_of(state, made)), claim);
}

/// Two disks in a box, and what a run would say of them if it were wrong.
struct Claimed {
    State state = crafted::two_disks(1, 2, 1, 1);
    EquilibriumRecord record;
    RunCounters counters;
    crafted::Recorder next;
    scratch::Folder folder;
    Claimed() {
        record.number = 3;
        record.verdict = Verdict::proved;
    }
    std::optional<Failure> told() {
        StateCertifier certifier(folder.path(), "test", counters, next);
        certifier.on_equilibrium(record, state, std::vector<double>(state.contacts.size(), 1.0));
        return certifier.objection();
    }
};

/// Certifies each equilibrium with the structure that the run passes on, without it, and the one after with it too.
struct Twice final : RunObserver {
    const ProvedStructure* proved = nullptr;
    State before;
    int equilibria = 0;
    void on_structure(const ProvedStructure& structure) override { proved = &structure; }
    void on_equilibrium(const EquilibriumRecord&, const State& state, const std::vector<double>&) override {
        const auto text = [&](const State& of, const ProvedStructure* given, long rank_proofs) {
            const auto kind = static_cast<std::size_t>(Work::rank_proofs);
            const long done = work_done()[kind];
            const Certification truth = certify(of, {}, given);
            BOOST_TEST((truth.verdict == Verdict::proved));
            BOOST_TEST(work_done()[kind] - done == rank_proofs);
            Certificate certificate;
            certificate.state = of;
            certificate.claims = truth.claims;
            return certificate_text(certificate);
        };
        BOOST_TEST(text(state, proved, 0) == text(state, nullptr, 1));
        if (equilibria++ > 0) {
            BOOST_TEST(text(before, proved, 1) == text(before, nullptr, 1));
        }
        State moved = state; // by less than a rounding of the claims, with the same contacts
        moved.packing.q[0] = std::nextafter(moved.packing.q[0], 0.0);
        BOOST_TEST(text(moved, proved, 1) == text(moved, nullptr, 1));
        before = state;
        proved = nullptr;
    }
};

} // namespace

BOOST_DATA_TEST_CASE(inspection_certificate_checker_and_runs_give_one_answer, known_states, known) {
    const State state = stored(known.name);
    const auto inspection = required(inspect_vertex(state));
    BOOST_TEST((inspection.record.verdict == known.verdict), inspection.remark);
    const Certification& truth = inspection.truth;
    BOOST_TEST((truth.verdict == known.verdict));
    BOOST_TEST((inspection.stable == (known.verdict == Verdict::proved ? Verdict::proved : Verdict::undecided)));
    for (const ClaimCheck& check : verify(claims::certificate_of(state, truth.claims)).checks) {
        BOOST_TEST((!check.claimed || check.verdict == Verdict::proved), check.claim << ": " << check.detail);
    }
    if (known.name == std::string("02-tension")) {
        return; // a centimetre off its vertex: nothing that a run could start from
    }
    std::optional<LoadLimit> low;
    const auto decision = required(decided(state, &low));
    const bool negative = truth.signs.negative > 0;
    BOOST_TEST(decision.opening.has_value() == negative);
    if (negative) {
        const std::size_t l = decision.opening->contact.index();
        BOOST_TEST(!decision.opening->infinitesimal);
        BOOST_TEST(truth.finite[l].upper < 0);
    } else if (truth.claims.load_interval && !truth.claims.load_interval->low.unbounded) {
        const LoadEndClaim& end = truth.claims.load_interval->low;
        BOOST_REQUIRE(low);
        BOOST_TEST((state.contacts[low->opens.index()] == end.opens));
        BOOST_TEST(low->stress + low->stress_error >= end.stress.lower);
        BOOST_TEST(low->stress - low->stress_error <= end.stress.upper);
    }
}

BOOST_AUTO_TEST_CASE(the_load_is_the_exact_product_on_every_rung) {
    // Where a force is 0 but for what rounding does to stress times length, the sign is that of the exact product; with
    // the length that the rounded product has, it is the other one.
    const State state = stored("load-product");
    const auto rounded = required(decided(state));
    BOOST_REQUIRE(rounded.opening.has_value());
    BOOST_TEST((rounded.opening->rung >= Rung::double_double));
    State exact = state;
    for (std::size_t a = 0; a < 2; ++a) { // stresses that are the rounded products, lengths 1
        exact.load.stress[a] = state.load.stress[a] * state.load.reference_length[1 - a];
        exact.load.reference_length[1 - a] = 1;
    }
    BOOST_TEST(!required(decided(exact)).opening.has_value());
    BOOST_TEST((inspect_vertex(exact).value().record.verdict == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(the_state_that_is_inspected_is_the_one_that_is_given) {
    const State state = stored("01-overlap"); // a fixed disk, and a wall that is absent with a length of 1e15
    const auto inspection = required(inspect_vertex(state));
    BOOST_TEST((inspection.record.verdict == Verdict::refuted));
    BOOST_TEST(inspection.remark.find("0-1 overlap") != std::string::npos, inspection.remark);
    State apart = state;
    apart.packing.q[2] = 2.5;
    BOOST_TEST((inspect_vertex(apart).value().record.verdict == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(pairs_that_cannot_move_must_not_overlap_either) {
    State state = stored("fixed-pair");
    const Certification overlapping = certify(state);
    BOOST_TEST(!overlapping.claims.gaps.has_value());
    BOOST_TEST(!overlapping.claims.stable);
    BOOST_REQUIRE(!overlapping.refuted.empty());
    BOOST_TEST(overlapping.refuted.front().find("2-3") != std::string::npos, overlapping.refuted.front());
    // A claim from elsewhere is refused by the checker.
    State apart = state;
    apart.packing.q[6] = apart.packing.q[4] + 0.5; // 0.2 + 0.2 < 0.5
    const Certification free = certify(apart);
    BOOST_TEST((free.verdict == Verdict::proved));
    BOOST_TEST((answer(apart, free.claims, "gaps") == Verdict::proved));
    BOOST_TEST((answer(state, free.claims, "gaps") == Verdict::refuted));
    // A fixed disk in a wall that does not move.
    State sunk = apart;
    sunk.packing.q[4] = std::nextafter(0.2, 0.0);
    BOOST_TEST((certify(sunk).verdict == Verdict::refuted));
    BOOST_TEST((answer(sunk, free.claims, "gaps") == Verdict::refuted));
    sunk.packing.q[4] = 0.2; // touches
    BOOST_TEST((certify(sunk).verdict == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(true_stresses_without_loads_on_disks_have_a_strict_minimum) {
    State state = two_disks(1, 2, 1, 1.5);
    state.load.kind = LoadKind::true_stress;
    const Certification free = certify(state);
    BOOST_TEST(free.claims.stable);
    BOOST_TEST((answer(state, free.claims, "stable") == Verdict::proved));
    state.load.disk_force = {1e-3, 0, 0, 0};
    const Certification loaded = certify(state);
    BOOST_TEST(loaded.claims.forces.has_value());
    BOOST_TEST(!loaded.claims.stable);
    CertificateClaims claimed = loaded.claims;
    claimed.stable = true;
    BOOST_TEST((answer(state, claimed, "stable") == Verdict::undecided));
    state.load.kind = LoadKind::nominal;
    BOOST_TEST(certify(state).claims.stable);
}

BOOST_AUTO_TEST_CASE(where_nothing_can_move_there_is_no_equilibrium) {
    const State state = stored("09-no-dof");
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::refuted));
    BOOST_REQUIRE(truth.claims.counting.has_value());
    BOOST_TEST(truth.claims.counting->dof_count == 0);
    fails(inspect_vertex(state), FailureKind::not_isostatic);
    State sunk = state;
    sunk.packing.q[0] = 0.5;
    BOOST_TEST(certify(sunk).refuted.size() == 2U); // and it overlaps
}

BOOST_AUTO_TEST_CASE(the_structure_that_a_run_has_proved_serves_its_certificate_and_no_other) {
    for (const TiePolicy ties : {TiePolicy::stop, TiePolicy::choose}) {
        State state = prepared(60, 2);
        RunCounters counters;
        Twice observer;
        BOOST_TEST(run_segment(state, towards(4), 0, {.ties = ties}, counters, observer).completed);
        BOOST_TEST(observer.equilibria == 5);
    }
}

// What a run left at 0 it calls an equilibrium of the finite loads: what the infinitesimal ones do there is no
// refutation.
BOOST_AUTO_TEST_CASE(a_force_that_a_run_left_at_zero_is_not_refuted_by_the_infinitesimal_loads) {
    State state = parse_state(R"({"format": "isostat-state", "version": 1, "disks": [[1, 1, 1]],
        "length": [10, 2], "walls": {"lower": ["fixed", "fixed"], "upper": ["absent", "movable"]},
        "load": {"kind": "nominal", "stress": [1, 1], "loaded_axis": 1, "reference_length": [1, 1]},
        "infinitesimal": [[1, -1]], "contacts": [[0, "left"], [0, "bottom"], [0, "top"]]})",
                              "state")
                      .state;
    BOOST_TEST((certify(state).verdict == Verdict::refuted));
    state.perturbation.emplace().rho = {0.1};
    BOOST_TEST((certify(state).verdict == Verdict::refuted));
    state.perturbation->zero = {{crafted::left(0), {0, 0}}};
    BOOST_TEST((certify(state).verdict == Verdict::undecided));
    state.load.infinitesimal = {-1, -1};
    BOOST_TEST((certify(state).verdict == Verdict::proved));
    // At the load where it vanishes, which is no double: at the stored one the force is -1e-17.
    state.load.disk_force = {1e-17, 0};
    BOOST_TEST((certify(state).verdict == Verdict::refuted));
    state.perturbation->load_zero = crafted::left(0);
    BOOST_TEST((certify(state).verdict == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(a_refuted_equilibrium_ends_the_run_and_is_not_recorded_as_proved) {
    Claimed wrong;
    wrong.state.load.stress[1] = 0.01; // below the interval that the two disks support
    const auto objection = required(wrong.told());
    BOOST_TEST((objection.kind == FailureKind::contradiction));
    BOOST_TEST(objection.message().find("equilibrium 3 is refuted by its certificate") != std::string::npos);
    BOOST_TEST(wrong.counters.states.refuted == 1);
    BOOST_REQUIRE(wrong.next.equilibria.size() == 1U);
    BOOST_TEST((wrong.next.equilibria[0].verdict == Verdict::refuted));
    BOOST_TEST((wrong.next.equilibria[0].certified == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(a_proved_equilibrium_is_passed_on) {
    Claimed right;
    BOOST_TEST(!right.told().has_value());
    BOOST_TEST(right.counters.states.proved == 1);
    BOOST_TEST((right.next.equilibria[0].certified == Verdict::proved));
}
