// Runs of clumps re-checked from their records: bars are kept, members of one body are no pair, free motions are held.
// Runs of spheres re-checked from their records; what is altered in them must not be proved.
#include "checker/replay.hpp"
#include "checker/run_records.hpp"
#include "support/clumps.hpp"
#include "support/played.hpp"
#include "support/scratch.hpp"
#include "support/spheres.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using json::Json;

namespace {

const RunOptions every_level{.max_strain = 1e9, .certify = CertifyLevel::arcs};

/// As a scene starts: what can move freely is held, and comes to rest in the run.
State at_the_start(State state) {
    state = with_free_motions_held(std::move(state));
    state.load.refer_to(state.packing);
    (void)snap_to_grid(state.packing);
    return test::with_infinitesimal(std::move(state));
}

/// From a start as scenes have it; the run is proved.
RunVerification proved_run(const State& start, const std::vector<Segment>& segments, const RunOptions& options,
                           const std::filesystem::path& folder) {
    played::completely(folder, at_the_start(start), segments, options, true);
    return played::proved(folder);
}

int total(const checker::RunRecords& records, const std::string& column) {
    int sum = 0;
    for (const EquilibriumLine& line : records.equilibria) {
        sum += line.integer(column);
    }
    return sum;
}

struct SphereRun {
    const char* name;
    int equilibria;
};

/// Boxes, slabs and two kinds of cell; walls along z open and close, and images of three numbers.
constexpr std::array sphere_runs{SphereRun{"box_uniform_30_1", 2}, SphereRun{"slab_uniform_30_1", 3},
                                 SphereRun{"ortho_uniform_30_1", 3}, SphereRun{"tri_uniform_30_1", 4}};

void play_spheres(const SphereRun& run, const std::filesystem::path& folder,
                  CertifyLevel level = CertifyLevel::decisions, const std::function<void(State&)>& change = {}) {
    State start = test::state_of_spheres(test::read_spheres(run.name));
    if (change) {
        change(start);
    }
    snap_to_grid(start.packing);
    played::completely(folder, start, {towards(run.equilibria)}, {.max_strain = 1e9, .certify = level});
}

/// Each alters one record of an arc.
const std::vector<std::pair<std::string, std::function<void(Json&)>>> sphere_alterations{
    {"stress", [](Json& arc) { arc["sigma3"] = arc["sigma3"].get<double>() * (1 + 1e-6); }},
    {"strain", [](Json& arc) { arc["eps3"] = arc["eps3"].get<double>() * (1 + 1e-6); }},
    {"power", [](Json& arc) { arc["power"] = arc["power"].get<double>() * 1.001; }},
    {"work", [](Json& arc) { arc["work"] = arc["work"].get<double>() * 1.001; }},
    {"closed", [](Json& arc) { arc["closed"] = arc["closed"] == "0-back" ? "0-front" : "0-back"; }},
    {"opened", [](Json& arc) { arc["opened"] = arc["opened"] == "0-back" ? "0-front" : "0-back"; }},
};

} // namespace

BOOST_AUTO_TEST_CASE(runs_of_clumps_are_proved_with_the_way_of_every_arc) {
    int held = 0, turns = 0;
    for (const char* const name :
         {"dimer_20_1", "dimer_20_10", "dimer2_20_2", "dimer2_20_3", "trimer_20_1", "trimer_20_3"}) {
        BOOST_TEST_INFO_SCOPE(name);
        const scratch::Folder folder;
        const RunVerification run =
            proved_run(test::clumps(name), {towards(-5), towards(5)}, every_level, folder / "run");
        BOOST_TEST(run.ways_proved == run.arcs);
        BOOST_TEST(run.equilibria_proved == 11);
        turns += run.turns_checked;
        held += total(checker::read_records(folder / "run"), "held");
    }
    BOOST_TEST(turns > 0);
    BOOST_TEST(held > 0); // equilibria at which a free motion stays where its power turned
}

BOOST_AUTO_TEST_CASE(runs_of_clumps_without_witnesses_are_followed_past_members_that_overlap) {
    for (const char* const name : {"dimer_20_1", "trimer_20_1"}) {
        const scratch::Folder folder;
        proved_run(test::clumps(name), {towards(-5), towards(5)}, {.max_strain = 1e9}, folder / "run");
    }
}

BOOST_AUTO_TEST_CASE(closed_forms_of_dimers_run_and_are_proved) {
    for (const State& state : {test::lying_dimer(12, 12), test::lying_dimer_in_space()}) {
        const scratch::Folder folder;
        const RunVerification run = proved_run(state, {towards(-1)}, every_level, folder / "run");
        BOOST_TEST(run.ways_proved == run.arcs);
    }
}

/// The last equilibrium supports every load, though by their patterns most forces could change with it.
BOOST_FIXTURE_TEST_CASE(a_run_of_dimers_is_proved_up_to_the_column_that_supports_every_load, scratch::InFolder) {
    const SegmentOutcome outcome = played::into(folder / "run", at_the_start(test::clumps("dimer_20_2")), {towards(30)},
                                                {.max_strain = 1e9}, true);
    fails(outcome.failure, FailureKind::no_limit);
    const RunVerification run = played::proved(folder / "run");
    BOOST_TEST(run.equilibria_proved > 10);
}

/// Of two contacts that bear one force the infinitesimal loads take one: of a body between them at a power turn (S4),
/// and of the members of a dimer that lies level (S7). The checker finds the same order.
BOOST_AUTO_TEST_CASE(runs_are_proved_where_two_contacts_of_a_body_bear_one_force) {
    for (const auto& [name, equilibria] : {std::pair("dimer2_20_8", 1), std::pair("dimer_20_5", 7)}) {
        BOOST_TEST_INFO_SCOPE(name);
        const scratch::Folder folder;
        proved_run(test::clumps(name), {towards(equilibria)}, {.max_strain = 1e9}, folder / "run");
    }
}

/// What differs in the body makes another run: of a state file the bars are compared with those of the replay.
BOOST_FIXTURE_TEST_CASE(a_stored_state_with_another_bar_is_refuted, scratch::InFolder) {
    proved_run(test::lying_dimer(12, 12), {towards(-1)}, {.max_strain = 1e9}, folder);
    for (const char* const file : {"states/eq_000000.json", "states/eq_000001.json"}) {
        BOOST_TEST((forger::altered(folder, file, "1.625", "1.62500001").verdict == Verdict::refuted), file);
    }
}

/// A bar bears forces of either sign: no arc opens one, and none ends a supported interval.
BOOST_AUTO_TEST_CASE(a_bar_that_is_said_to_open_or_to_limit_is_refuted) {
    Certificate certificate;
    certificate.state = with_free_motions_held(test::clumps("dimer_20_2"));
    certificate.claims = certify(certificate.state).claims;
    BOOST_TEST((verify(certificate).verdict == Verdict::proved));
    BOOST_TEST(certificate.claims.load_interval->low.opens.is_unilateral());
    for (const Contact& contact : certificate.state.contacts) {
        if (contact.kind == ContactKind::bar) {
            Certificate forged = certificate;
            forged.claims.load_interval->low.opens = contact;
            BOOST_TEST((verify(forged).verdict == Verdict::refuted));
        }
    }
    // Bars that bear the force of one contact alone vanish with it; the infinitesimal loads order contacts only.
    for (const char* const name : {"dimer_20_3", "trimer_20_1", "trimer_20_2"}) { // k = 0
        const Certification made = certify(test::with_infinitesimal(test::clumps(name)));
        BOOST_TEST_REQUIRE(made.claims.load_interval.has_value());
        BOOST_TEST(made.claims.load_interval->low.opens.is_unilateral());
        BOOST_TEST(made.claims.load_interval->high.opens.is_unilateral());
    }
}

BOOST_AUTO_TEST_CASE(every_equilibrium_and_both_ends_of_every_arc_are_proved) {
    for (const SphereRun& run : sphere_runs) {
        BOOST_TEST_INFO_SCOPE(run.name);
        const scratch::Folder folder;
        play_spheres(run, folder.path() / "run");
        BOOST_TEST(played::proved(folder.path() / "run").equilibria_proved == run.equilibria + 1);
    }
}

BOOST_AUTO_TEST_CASE(paths_in_the_space_of_stresses_are_proved_and_others_refuted) {
    for (const LoadKind kind : {LoadKind::nominal, LoadKind::true_stress}) {
        const scratch::Folder scratch_folder;
        const std::filesystem::path folder = scratch_folder.path() / "run";
        State start = test::state_of_spheres(test::read_spheres("box_uniform_30_1"));
        if (kind == LoadKind::true_stress) {
            start.load.kind = kind;
            start.load.stress = {1, 1, 1};
            start.load.refer_to(start.packing);
        }
        start.load.follow({-1, -1, 2});
        snap_to_grid(start.packing);
        played::completely(folder, start, {towards(2)}, {.max_strain = 1e9});
        (void)played::proved(folder);
        const std::string rows = scratch::read(folder / "equilibria.csv");
        BOOST_TEST((rows.find("segment,t,ratio,p,q,eps1,eps2,eps3,") != std::string::npos), rows.substr(0, 100));
        // Another path through the same first state has other slopes.
        const std::filesystem::path first = folder / "states/eq_000000.json";
        std::string text = scratch::read(first);
        const std::string direction = "[-1.0,-1.0,2.0]";
        BOOST_TEST_REQUIRE(text.find(direction) != std::string::npos);
        scratch::write(first, text.replace(text.find(direction), direction.size(), "[-1.0,-1.0,2.25]"));
        forger::seal(folder);
        BOOST_TEST((verify_run(folder).verdict == Verdict::refuted));
    }
}

BOOST_AUTO_TEST_CASE(an_altered_arc_of_spheres_is_not_proved, *boost::unit_test::label("slow")) {
    const scratch::Folder scratch_folder;
    const std::filesystem::path folder = scratch_folder.path() / "run";
    play_spheres(sphere_runs[1], folder);
    const std::string events = scratch::read(folder / "events.jsonl");
    std::vector<Json> arcs;
    for (std::size_t begin = 0; begin < events.size(); begin = events.find('\n', begin) + 1) {
        arcs.push_back(Json::parse(events.substr(begin, events.find('\n', begin) - begin)));
    }
    for (const auto& [what, alter] : sphere_alterations) {
        const std::size_t altered = arcs.size() / 2;
        std::string text;
        for (std::size_t k = 0; k < arcs.size(); ++k) {
            Json arc = arcs[k];
            if (k == altered) {
                alter(arc);
            }
            text += json::dumped(arc) + "\n";
        }
        scratch::write(folder / "events.jsonl", text);
        forger::seal(folder);
        const RunVerification found = verify_run(folder);
        // Where steps in double do not find the end that is named nothing is refuted.
        const Verdict expected = what == "closed" ? Verdict::undecided : Verdict::refuted;
        BOOST_TEST((found.verdict == expected), what << ": " << found.wrong);
    }
}

/// Raised along z, and a triclinic cell sheared in two of its planes.
BOOST_AUTO_TEST_CASE(the_way_of_every_arc_of_spheres_is_proved_from_its_witness) {
    const auto prove = [](const SphereRun& run, int loaded) {
        BOOST_TEST_INFO_SCOPE(run.name << " along " << loaded);
        const scratch::Folder folder;
        play_spheres(run, folder.path() / "run", CertifyLevel::arcs,
                     [loaded](State& start) { start.load.loaded_axis = loaded; });
        const RunVerification found = played::proved(folder.path() / "run");
        BOOST_TEST(found.ways_proved == found.arcs);
    };
    prove({"box_uniform_30_1", 1}, 2);
    prove({"slab_uniform_30_1", 3}, 2);
    prove({"tri_uniform_30_1", 1}, 3);
    prove({"tri_uniform_30_1", 1}, 5);
}

/// The run itself says nothing of the power of true stresses; the checker proves that it is positive.
BOOST_FIXTURE_TEST_CASE(the_way_of_spheres_is_proved_under_true_stresses, scratch::InFolder) {
    play_spheres({"slab_uniform_30_1", 3}, folder.path() / "run", CertifyLevel::arcs, [](State& start) {
        start.load.kind = LoadKind::true_stress;
        start.load.stress = {1, 1, 1};
        start.load.refer_to(start.packing);
    });
    const RunVerification found = played::proved(folder.path() / "run");
    BOOST_TEST(found.ways_proved == found.arcs);
}

BOOST_AUTO_TEST_CASE(a_forged_witness_of_spheres_proves_no_way) {
    const scratch::Folder scratch_folder;
    const std::filesystem::path folder = scratch_folder.path() / "run";
    play_spheres({"tri_uniform_30_1", 1}, folder, CertifyLevel::arcs, [](State& start) { start.load.loaded_axis = 5; });
    const std::filesystem::path file = folder / "certificates/arcs.jsonl";
    const std::string true_text = scratch::read(file);
    const auto forged = [&](const std::function<void(Json&)>& alter) {
        Json first = Json::parse(true_text.substr(0, true_text.find('\n')));
        alter(first);
        scratch::write(file, json::dumped(first) + true_text.substr(true_text.find('\n')));
        forger::seal(folder);
        return verify_run(folder);
    };
    const auto moved = [](std::size_t component, double by) {
        return [=](Json& witness) { witness["end"][component] = witness["end"][component].get<double>() + by; };
    };
    for (const std::size_t component : {0U, 40U}) {
        const RunVerification found = forged(moved(component, 0.01));
        BOOST_TEST((found.verdict == Verdict::undecided), component << ": " << found.wrong);
        BOOST_TEST(found.ways_proved < found.arcs);
    }
    const RunVerification same = forged([](Json&) {});
    BOOST_TEST(same.ways_proved == same.arcs);
}

// S4 is of the plane: two walls and a held coordinate leave no sphere out of what is compared.
BOOST_AUTO_TEST_CASE(no_contact_of_spheres_is_left_out_at_a_turn) {
    State state = test::state_of_spheres(test::read_spheres("closed_rattler"));
    snap_to_grid(state.packing);
    const auto wall = std::ranges::find_if(
        state.contacts, [](const Contact& c) { return c.kind == ContactKind::lower_wall && c.i == 1 && c.j == 2; });
    BOOST_REQUIRE(wall != state.contacts.end());
    *wall = {ContactKind::held, 5, 0};
    checker::Place place;
    const auto row = static_cast<int>(wall - state.contacts.begin());
    (void)checker::make_place(state, place, {}, row);
    BOOST_TEST(std::ranges::count(place.silent, true) == 0);
    BOOST_TEST(place.silent.size() == state.contacts.size());
}
