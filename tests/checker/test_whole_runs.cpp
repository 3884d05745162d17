// Runs from a start that is no equilibrium to whatever ends them: every recorded arc is replayed, and an altered one
// found.
// Nearly equal disks: where some stand nearly in line two branches of the motion come near each other, and steps in
// double may end on the wrong one. Small steps from the equilibrium before tell them apart.
#include "checker/rational.hpp"
#include "checker/replay.hpp"
#include "support/mirror.hpp"
#include "support/played.hpp"
#include "support/prepared.hpp"
#include "support/scratch.hpp"
#include "support/spheres.hpp"

#include <isostat/checker/verify.hpp>

#include <boost/multiprecision/mpfr.hpp>

#include <tuple>

using namespace isostat;
using namespace checker;
namespace fs = std::filesystem;

namespace {

/// Plays one segment up, or down, with the start; how it ends does not matter.
void play_whole(const State& state, int equilibria, const RunOptions& options, const fs::path& folder) {
    (void)played::into(folder, state, {towards(equilibria)}, options, true);
}

/// The number of this name in the last or the first record, times a factor.
RunVerification with_a_larger(const fs::path& run, const std::string& name, bool last, double factor = 1 + 1e-6) {
    const std::string events = scratch::read(run / "events.jsonl"), key = "\"" + name + "\":";
    const std::size_t at = last ? events.rfind(key) : events.find(key);
    BOOST_REQUIRE(at != std::string::npos);
    const std::string old = forger::value_of(events.substr(at), name);
    return forger::altered(run, "events.jsonl", key + old, key + forger::times(old, factor));
}

/// Its sigma2 is above what the contacts bear.
State overloaded(double factor) {
    State state = prepared(14, 3);
    state.load.stress[1] *= factor;
    return state;
}

/// 36 disks, equal but for a jitter of 1e-9.
void play(std::uint64_t seed, int equilibria, const fs::path& folder) {
    PreparationOptions options{.disks = 36};
    options.diameters.kind = RadiiLaw::equal;
    options.jitter = 1e-9;
    options.seed = seed;
    BOOST_REQUIRE(played::into(folder, prepared(options), {towards(equilibria)}).completed);
}

} // namespace

BOOST_FIXTURE_TEST_CASE(the_way_from_a_start_that_is_no_equilibrium_is_replayed, scratch::InFolder) {
    play_whole(overloaded(2), 1, {}, folder / "run");
    const RunVerification run = played::proved(folder / "run");
    const std::string events = scratch::read(folder / "run/events.jsonl");
    BOOST_TEST_REQUIRE(events.find("\"equilibrium\":0") != std::string::npos);
    BOOST_TEST(run.equilibria_proved == run.equilibria);
    BOOST_TEST(with_a_larger(folder / "run", "force", false).wrong != "");
    played::refuted(forger::altered(folder / "run", "events.jsonl", "\"kind\":\"tension\"", "\"kind\":\"limit\""), "");
    // Another contact opens first: then equilibrium 0 would have another list.
    const std::string start = scratch::read(folder / "run/start.json");
    State other = read_state(folder / "run/start.json").state;
    other.contacts.pop_back();
    write_state(folder / "run/start.json", other);
    forger::seal(folder / "run");
    BOOST_TEST(verify_run(folder / "run").wrong.find("start.json has other contacts") != std::string::npos);
    scratch::write(folder / "run/start.json", start);
    forger::seal(folder / "run");
    played::proved(folder / "run");
}

BOOST_FIXTURE_TEST_CASE(arcs_that_lead_to_no_equilibrium_are_replayed, scratch::InFolder) {
    RunOptions options{.max_arcs = 3};
    for (const bool from_start : {false, true}) { // the first rearrangement does not end, or none begins
        const fs::path run = folder / (from_start ? "none" : "first");
        play_whole(from_start ? overloaded(3) : prepared(36, 3), 4, options, run);
        BOOST_TEST_REQUIRE(scratch::read(run / "events.jsonl").find("\"arc\":3") != std::string::npos);
        const RunVerification answer = verify_run(run);
        played::without_objection(answer);
        BOOST_TEST(answer.arcs_proved == answer.arcs);
        BOOST_TEST(with_a_larger(run, "work", true).wrong != "");
        BOOST_TEST(with_a_larger(run, "step", true, 10).wrong != "");
    }
}

BOOST_FIXTURE_TEST_CASE(what_the_rule_random_draws_is_drawn_again, scratch::InFolder) {
    play_whole(prepared(36, 3), 2, {.rule = OpeningRule::random, .rule_seed = 5}, folder / "run");
    played::proved(folder / "run");
    played::refuted(forger::altered(folder / "run", "run.json", "\"rule_seed\": 5", "\"rule_seed\": 6"),
                    "the rule 'random' draws");
}

// The load at which a force vanishes is not a double: what goes on from there means the exact one.
BOOST_FIXTURE_TEST_CASE(a_run_from_a_state_stored_at_a_limit_is_replayed_at_the_load_that_is_meant, scratch::InFolder) {
    RunOptions options{.ties = TiePolicy::choose};
    play_whole(crafted::mirror_forces(), -1, options, folder / "first");
    const State reached = read_state(folder / "first/states/eq_000001.json").state;
    BOOST_TEST_REQUIRE((reached.perturbation && reached.perturbation->load_zero.i >= 0));
    play_whole(reached, 1, options, folder / "second");
    const RunVerification run = verify_run(folder / "second");
    played::without_objection(run);
    BOOST_TEST(run.equilibria_proved == run.equilibria);

    // A force that vanishes at another load is not the one that is meant.
    const ExactLoad meant = meant_load(reached);
    BOOST_TEST((meant.shift.lower != 0 && meant.shift.upper != 0));
    State elsewhere = reached;
    elsewhere.load.set_loaded_stress(elsewhere.load.loaded_stress() * (1 + 1e-6));
    const ExactLoad stored = meant_load(elsewhere);
    BOOST_TEST((stored.shift.lower == 0 && stored.shift.upper == 0));
    write_state(folder / "second/states/eq_000000.json", elsewhere, {});
    forger::seal(folder / "second");
    BOOST_TEST((verify_run(folder / "second").verdict != Verdict::proved));
}

/// Where true stresses change together no end is proved: what contradicts the record may be another vertex.
BOOST_FIXTURE_TEST_CASE(what_contradicts_an_end_that_is_not_proved_is_left_undecided, scratch::InFolder) {
    State start = test::on_its_lengths(test::state_of_spheres(test::read_spheres("box_uniform_30_1")));
    start.load.kind = LoadKind::true_stress;
    start.load.stress = {1, 1, 1};
    start.load.follow({-1, -1, 2});
    snap_to_grid(start.packing);
    play_whole(start, 1, {}, folder / "run");
    played::proved(folder / "run");
    const RunVerification forged = with_a_larger(folder / "run", "power", true, 1.001);
    BOOST_TEST((forged.verdict == Verdict::undecided), forged.wrong);
    BOOST_TEST_REQUIRE(!forged.undecided.empty());
    BOOST_TEST(forged.undecided.back().find("not provably") != std::string::npos, forged.undecided.back());
}

// Phi = sum sigma_a ln L_a falls from an equilibrium to the next one, and grows on the way back.
BOOST_FIXTURE_TEST_CASE(under_true_stresses_an_arc_on_which_phi_grows_is_refuted, scratch::InFolder) {
    State start = prepared(14, 5);
    start.load.kind = LoadKind::true_stress;
    play_whole(start, 1, {}, folder / "run");
    std::array<Place, 2> place;
    const State end = read_state(folder / "run/states/eq_000001.json").state;
    for (std::size_t k = 0; k < 2; ++k) {
        State state = k == 1 ? end : read_state(folder / "run/states/eq_000000.json").state;
        state.load = end.load;
        (void)make_place(std::move(state), place[k]);
        BOOST_TEST_REQUIRE(place[k].evidence->vertex.found);
    }
    const auto phi_falls = [&](const Place& from, const Place& to) {
        const std::vector<Range> forces = to.evidence->forces;
        const auto l = static_cast<std::size_t>(
            std::ranges::max_element(forces, [](const Range& a, const Range& b) { return a.lower < b.lower; }) -
            forces.begin());
        EventRecord event;
        event.closed = to_string(to.state->contacts[l]);
        event.power = forces[l].lower.get_d();
        event.power_bound = 1e-9 * event.power;
        const double reference = to.state->load.reference_length[1];
        event.strain = (reference - to.length(1).lower.get_d()) / reference;
        event.strain_bound = 1e-9;
        event.work_bound = 0;
        return check_end(from, to, event, false);
    };
    BOOST_TEST(!phi_falls(place[0], place[1]));
    const auto back = required(phi_falls(place[1], place[0]));
    BOOST_TEST(back.wrong);
    BOOST_TEST(back.text.find("does not decrease") != std::string::npos, back.text);
}

BOOST_AUTO_TEST_CASE(logarithms_are_enclosed_narrowly) {
    using Real = boost::multiprecision::mpfr_float_100;
    for (const double x : {1.0, 1 + 0x1p-52, 1 + 1e-9, 1.1, 2.0, 37.0, 1023.0, 1e-3, 0.5, 1 - 1e-12}) {
        const Range found = logarithm(Range(Rational(x)));
        const Real exact = log(Real(x));
        const auto real = [](const Rational& r) { return Real(r.get_num().get_str()) / Real(r.get_den().get_str()); };
        BOOST_TEST((real(found.lower) <= exact && exact <= real(found.upper)));
        BOOST_TEST(Rational(found.upper - found.lower).get_d() < 1e-140);
    }
    const Range wide = logarithm({Rational(1, 4096), Rational(4096)});
    BOOST_TEST((wide.lower <= -8.3 && wide.upper >= 8.3));
}

BOOST_AUTO_TEST_CASE(ends_near_another_branch_are_proved_and_what_contradicts_them_is_not,
                     *boost::unit_test::label("slow")) {
    const scratch::Folder scratch_folder;
    // The arc in question leads to the last equilibrium: it opens this contact.
    for (const auto& [seed, equilibria, opened] :
         {std::tuple{11, 10, "1-31"}, std::tuple{29, 10, "12-34"}, std::tuple{37, 12, "5-7"}}) {
        BOOST_TEST_INFO_SCOPE("seed " << seed);
        const fs::path folder = scratch_folder / std::to_string(seed);
        play(static_cast<std::uint64_t>(seed), equilibria, folder);
        const RunVerification run = played::proved(folder);
        BOOST_TEST(run.equilibria_proved == equilibria + 1);
        const std::string events = scratch::read(folder / "events.jsonl");
        const std::size_t arc = events.rfind("\"opened\":\"" + std::string(opened));
        BOOST_TEST_REQUIRE(arc != std::string::npos);
        const std::size_t eps2 = events.find("\"eps2\":", arc) + 7;
        const std::string said = events.substr(eps2, events.find(',', eps2) - eps2);
        std::string other = said;
        other[9] = other[9] == '5' ? '6' : '5';
        const RunVerification forged = forger::altered(folder, "events.jsonl", said, other);
        BOOST_TEST((forged.verdict != Verdict::proved));
    }
}
