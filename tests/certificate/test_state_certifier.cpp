// Level `states`: a certificate that refutes an equilibrium ends the run.
#include "certificate/state_certifier.hpp"
#include "core/work.hpp"
#include "support/crafted.hpp"
#include "support/prepared.hpp"
#include "support/scratch.hpp"
#include "support/segments.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

#include <cmath>

using namespace isostat;

namespace {

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

BOOST_AUTO_TEST_SUITE(certificate)

BOOST_AUTO_TEST_CASE(the_structure_that_a_run_has_proved_serves_its_certificate_and_no_other) {
    State state = prepared(60, 2);
    RunCounters counters;
    Twice observer;
    BOOST_TEST(run_segment(state, towards(4), 0, {}, counters, observer).completed);
    BOOST_TEST(observer.equilibria == 5);
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
    const auto objection = wrong.told();
    BOOST_REQUIRE(objection.has_value());
    BOOST_TEST((objection->kind == FailureKind::contradiction));
    BOOST_TEST(objection->message().find("equilibrium 3 is refuted by its certificate") != std::string::npos);
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

BOOST_AUTO_TEST_SUITE_END()
