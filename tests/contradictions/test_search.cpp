// Every pair of answers about one state: inspect, certify, verify, a run, crafted inspection, and the truth to 200
// digits. ISOSTAT_LONG=1: a million states; ISOSTAT_STATES=N: as many as one likes.
#include "contradictions/jamming.hpp"
#include "contradictions/states.hpp"
#include "oracle/claims.hpp"
#include "support/crafted.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/scene/scene.hpp>

#include <chrono>
#include <ctime>
#include <iostream>

using namespace isostat;
using namespace contradictions;

namespace {

/// One defect, in words.
using Objections = std::vector<std::string>;

/// The answer of one command about "isostatic equilibrium without overlap".
struct Answers {
    Verdict inspect = Verdict::undecided;
    Verdict certify = Verdict::undecided;
    Verdict verify = Verdict::undecided;
    Verdict run = Verdict::undecided;
    Verdict crafted = Verdict::undecided;
};

struct Count {
    long tried = 0, true_equilibria = 0, contradictions = 0;
    long refused = 0;                    ///< true equilibria that no run starts from
    long exact = 0;                      ///< what `certify` leaves undecided because a force or a gap is exactly 0
    double by_truth = 0, by_certify = 0; ///< seconds
    std::array<long, 5> undecided{};
};

/// CPU time of this thread.
double seconds() {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

void check_verdict(const char* who, Verdict verdict, int truth, Objections& wrong) {
    if (verdict == Verdict::proved && truth <= 0) {
        wrong.push_back(std::string(who) + " proves what is false");
    }
    if (verdict == Verdict::refuted && truth > 0) {
        wrong.push_back(std::string(who) + " refutes what is true");
    }
}

/// What `inspect` shows, number by number.
void check_inspection(const Inspection& inspection, const State& state, const Truth& truth, Objections& wrong) {
    const EquilibriumRecord& r = inspection.record;
    if (!inspection.truth.claims.vertex) {
        return;
    }
    if (Real(r.gap_residual) < truth.stored_gap - negligible) {
        wrong.push_back("the largest gap of a contact is " + oracle::text(truth.stored_gap));
    }
    if (const double smallest = truth.singular_value(); r.sigma_min_bound > smallest * (1 + 1e-9) + 1e-14) {
        wrong.push_back("the smallest singular value is " + std::to_string(smallest));
    }
    const Real room = negligible * truth.force_scale;
    for (std::size_t l = 0; l < inspection.forces.size(); ++l) {
        const bool zero = inspection.structural_zero[l] != 0;
        const Real off = abs(Real(zero ? 0 : inspection.forces[l]) - truth.force[l]);
        if (off > Real(zero ? 0 : r.force_bound) + room) {
            wrong.push_back("inspect: force of " + to_string(state.contacts[l]) + " is " +
                            oracle::text(truth.force[l]));
        }
    }
    if (inspection.truth.claims.gaps) {
        const OtherPair* nearest = truth.nearest();
        if (std::isinf(r.min_gap) != (nearest == nullptr) ||
            (nearest != nullptr && abs(truth.gap(r.min_gap_contact) - nearest->gap) > Real(1e-13))) {
            wrong.emplace_back("inspect names another pair as the nearest");
        }
    }
}

/// A short run: what it says of its start, and what it opens there.
Verdict run_from(const State& state, const Truth& truth, Count& tally, Objections& wrong) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(state.packing.dimension); ++a) {
        if (!(state.load.stress[a] > 0)) {
            return Verdict::undecided;
        }
    }
    try {
        check_start(state, "state");
    } catch (const Error&) { // a run takes no such start: contacts that look open as stored
        tally.refused += truth.at_rest() > 0 ? 1 : 0;
        return Verdict::undecided;
    }
    RunOptions options;
    options.max_arcs = 1; // whether the start is an equilibrium is what is asked
    const ::crafted::Played played = ::crafted::play(state, +1, 1, {}, options);
    const auto& arcs = played.records.arcs;
    if (!arcs.empty() && arcs.front().equilibrium == 0) {
        const std::vector<Contact> right = truth.most_negative();
        if (std::ranges::find(right, arcs.front().opened) == right.end()) {
            wrong.push_back("a run opens " + to_string(arcs.front().opened) + ", not " +
                            (right.empty() ? "nothing" : to_string(right.front())));
        }
        return Verdict::refuted; // rearranged before it was one
    }
    return played.records.equilibria.empty() ? Verdict::undecided : played.records.equilibria.front().verdict;
}

/// The products of stress and length, exactly.
isostat::crafted::ExactLoad exact_load(const State& state) {
    isostat::crafted::ExactLoad load;
    for (const WallForce& wall : state.load.wall_forces(state.packing)) {
        const auto axis = static_cast<std::size_t>(wall.coordinate) - state.packing.length_at(0);
        const auto axes = static_cast<std::size_t>(state.packing.dimension);
        (axis < axes ? load.wall[axis] : load.tilt[axis - axes]) = exact::Number::from_double(wall.stress) *
                                                                   exact::Number::from_double(wall.length) *
                                                                   exact::Number::from_double(wall.other);
    }
    for (const double f : state.load.disk_force) {
        load.disk.push_back(exact::Number::from_double(f));
    }
    return load;
}

/// The same doubles as exact numbers, where they touch exactly.
Verdict crafted_verdict(const State& state) {
    if (state.load.kind != LoadKind::nominal) {
        return Verdict::undecided;
    }
    isostat::crafted::ExactPacking packing = isostat::crafted::exact_copy(state.packing);
    const auto contacts = isostat::crafted::exact_contacts(packing);
    std::vector<Contact> listed = state.contacts;
    std::ranges::sort(listed);
    if (!contacts.ok() || contacts.value() != listed) {
        return Verdict::undecided;
    }
    packing.load = exact_load(state);
    const isostat::crafted::Inspection inspection = isostat::crafted::inspect_contacts(packing, contacts.value());
    return inspection.stable;
}

/// Rank of the stored doubles: by `certify` modulo a prime, by crafted inspection in the field.
void check_counts(const State& state, const CertificateClaims& claims, Objections& wrong) {
    const bool held = std::ranges::any_of(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    if (held || !claims.counting) {
        return;
    }
    const isostat::crafted::ExactPacking packing = isostat::crafted::exact_copy(state.packing);
    const isostat::crafted::Inspection exact = isostat::crafted::inspect_contacts(packing, state.contacts);
    if (exact.rank_exact == Verdict::proved &&
        (exact.dof_count != claims.counting->dof_count || exact.hyperstaticity != claims.counting->hyperstaticity ||
         exact.mechanisms != claims.counting->hypostaticity)) {
        wrong.emplace_back("exact numbers count otherwise: N_f = " + std::to_string(exact.dof_count) + ", h = " +
                           std::to_string(exact.hyperstaticity) + ", k = " + std::to_string(exact.mechanisms));
    }
}

std::string file_of(const State& state) {
    return state_text(state);
}

Objections ask(const State& state, const Truth& truth, bool run, Count& tally) {
    Objections wrong;
    const int equilibrium = truth.equilibrium();
    Answers answers;
    const Result<Inspection> inspection = inspect_vertex(state);
    if (inspection.ok()) {
        check_inspection(inspection.value(), state, truth, wrong);
        answers.inspect = inspection.value().record.verdict;
        const EquilibriumRecord& record = inspection.value().record;
        if (inspection.value().equilibrium != (record.verdict == Verdict::proved)) {
            wrong.emplace_back("inspect: equilibrium and verdict differ");
        }
        if (inspection.value().stable == Verdict::proved && equilibrium <= 0) {
            wrong.emplace_back("inspect proves a stability that is not there");
        }
    } else if (inspection.failure().kind == FailureKind::not_isostatic) {
        answers.inspect = Verdict::refuted;
    }
    Certificate certificate;
    certificate.state = state;
    const double begin = seconds();
    const Certification certified = certify(state);
    tally.by_certify += seconds() - begin;
    certificate.claims = certified.claims;
    answers.certify = certified.verdict;
    tally.exact += certified.verdict == Verdict::undecided && equilibrium == 0 ? 1 : 0;
    std::ranges::copy(oracle::objections(certified.claims, state, truth), std::back_inserter(wrong));
    if (run || state.packing.dimension == plane || !state.packing.cell.any()) { // in exact numbers, which takes 50 ms
        check_counts(state, certified.claims, wrong);
    }
    std::ranges::copy(jamming_objections(state, truth, certified), std::back_inserter(wrong));
    const Verification verified = verify(certificate);
    answers.verify = verified.verdict;
    for (const ClaimCheck& check : verified.checks) {
        if (check.claimed && check.verdict == Verdict::refuted) {
            wrong.push_back("verify refutes a claim of certify, " + check.claim + ": " + check.detail);
        }
    }
    if (run) {
        answers.run = run_from(state, truth, tally, wrong);
        check_verdict("run", answers.run, truth.at_rest(), wrong);
    }
    answers.crafted = crafted_verdict(state);
    check_verdict("inspect", answers.inspect, equilibrium, wrong);
    check_verdict("certify", answers.certify, equilibrium, wrong);
    check_verdict("verify", answers.verify, equilibrium, wrong);
    // Crafted inspection speaks of stability under the finite load: where a force is 0 it may differ.
    const bool all_finite =
        std::ranges::all_of(truth.force, [&](const Real& f) { return sign_of(f, truth.force_scale) > 0; });
    if (all_finite) {
        check_verdict("crafted", answers.crafted, equilibrium, wrong);
    }
    int k = 0;
    for (const Verdict v : {answers.inspect, answers.certify, answers.verify, answers.run, answers.crafted}) {
        tally.undecided[static_cast<std::size_t>(k++)] += v == Verdict::undecided ? 1 : 0;
    }
    return wrong;
}

long states_asked() {
    if (const char* count = std::getenv("ISOSTAT_STATES")) {
        return std::atol(count);
    }
    return std::getenv("ISOSTAT_LONG") != nullptr ? 1'000'000 : 20'000;
}

/// All, or the one that ISOSTAT_CLASS names: then all states are of it.
std::vector<std::size_t> classes_asked(const std::vector<StateClass>& classes) {
    const char* only = std::getenv("ISOSTAT_CLASS");
    std::vector<std::size_t> asked;
    for (std::size_t c = 0; c < classes.size(); ++c) {
        if (only == nullptr || std::string(only) == classes[c].name) {
            asked.push_back(c);
        }
    }
    BOOST_REQUIRE_MESSAGE(!asked.empty(), "no class is called '" << only << "'");
    return asked;
}

} // namespace

BOOST_AUTO_TEST_CASE(no_two_answers_differ_and_none_differs_from_the_truth) {
    const auto begin = std::chrono::steady_clock::now();
    constexpr std::uint64_t seed = 21;
    const std::vector<StateClass> classes = state_classes();
    const std::vector<std::size_t> asked = classes_asked(classes);
    const long each = states_asked() / static_cast<long>(asked.size()) + 1;
    int shown = 0;
    std::cout << "seed " << seed << ", " << each << " states of each class\n"
              << "| class | states | equilibria | contradictions | undecided: inspect | certify | of them exact ties | "
                 "verify | run | no start of a run | ms: certify | 200 digits |\n"
              << "|---|---|---|---|---|---|---|---|---|---|---|---|\n";
    for (const std::size_t c : asked) {
        Count tally;
        long runs = 0;
        for (long k = 0, tries = 0; k < each && tries < 400 * each; ++tries) {
            oracle::Random random(seed + 1000 * c + 1'000'003ULL * static_cast<std::uint64_t>(tries));
            const auto state = classes[c].make(random);
            if (!state) {
                continue;
            }
            const double begun = seconds();
            const Truth truth(*state);
            if (!truth.known) {
                continue;
            }
            ++k;
            ++tally.tried;
            tally.by_truth += seconds() - begun;
            tally.true_equilibria += truth.at_rest() > 0 ? 1 : 0;
            const bool run = k % 10 == 0;
            runs += run ? 1 : 0;
            const Objections wrong = [&]() -> Objections {
                try {
                    return ask(*state, truth, run, tally);
                } catch (const Error& error) {
                    return {"one command refuses what another takes: " + std::string(error.what())};
                }
            }();
            if (!wrong.empty()) {
                ++tally.contradictions;
                if (shown++ < 20) {
                    std::string all;
                    for (const std::string& w : wrong) {
                        all += "\n  " + w;
                    }
                    BOOST_ERROR(classes[c].name << ", try " << tries << ":" << all << "\n" << file_of(*state));
                }
            }
        }
        const auto share = [&](std::size_t who, long of) {
            return of == 0 ? 0.0 : 100.0 * static_cast<double>(tally.undecided[who]) / static_cast<double>(of);
        };
        std::cout << std::setprecision(3) << "| " << classes[c].name << " | " << tally.tried << " | "
                  << tally.true_equilibria << " | " << tally.contradictions << " | " << share(0, tally.tried) << " % | "
                  << share(1, tally.tried) << " % | "
                  << (tally.undecided[1] == 0
                          ? 100.0
                          : 100.0 * static_cast<double>(tally.exact) / static_cast<double>(tally.undecided[1]))
                  << " % | " << share(2, tally.tried) << " % | "
                  << (runs == 0 ? 0.0
                                : 100.0 * static_cast<double>(tally.undecided[3] - (tally.tried - runs)) /
                                      static_cast<double>(runs))
                  << " % of " << runs << " | " << tally.refused << " | "
                  << 1e3 * tally.by_certify / static_cast<double>(tally.tried) << " | "
                  << 1e3 * tally.by_truth / static_cast<double>(tally.tried) << " |" << std::endl;
        BOOST_TEST(tally.contradictions == 0, classes[c].name << ": " << tally.contradictions << " contradictions");
        BOOST_TEST(tally.tried == each, classes[c].name << ": only " << tally.tried << " states were made");
        BOOST_TEST((tally.true_equilibria > 0 || !classes[c].has_equilibria));
        BOOST_TEST(tally.true_equilibria < tally.tried);
        if (std::string(classes[c].name).starts_with("exact numbers")) {
            BOOST_TEST(2 * tally.undecided[4] < tally.tried); // crafted inspection speaks of most
        }
    }
    std::cout << std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() << " s\n";
}
