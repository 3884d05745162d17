// The linear programmes and the proofs at their end, from starts that are known.

#include "../../src/preparation/polish.hpp"
#include "../../src/preparation/programme.hpp"
#include "check.hpp"
#include "support/prepared.hpp"

namespace {

using namespace isostat;
namespace room = isostat::preparation; // the suite has the same name

class Noise {
  public:
    explicit Noise(unsigned long long seed) : engine_(seed) {}
    double operator()() { return 2 * (static_cast<double>(engine_() >> 11U) * 0x1p-53) - 1; } // in [-1, 1)
  private:
    std::mt19937_64 engine_;
};

/// Disks on a square lattice with noise: no overlap, no contact.
Packing loose_lattice(int side, unsigned long long seed) {
    Noise noise(seed);
    Packing packing;
    for (int k = 0; k < side * side; ++k) {
        packing.radius.push_back(0.75 + 0.2 * noise());
        packing.q.push_back(2.2 * (k % side) + 1.1 + 0.1 * noise());
        packing.q.push_back(2.2 * (k / side) + 1.1 + 0.1 * noise());
    }
    packing.q.push_back(2.2 * side);
    packing.q.push_back(2.2 * side);
    return packing;
}

double smallest_gap(const Packing& packing) {
    double smallest = std::numeric_limits<double>::infinity();
    for (const Contact& pair : oracle::all_pairs(packing)) {
        smallest = std::min(smallest, gap(packing, pair));
    }
    return smallest;
}

} // namespace

BOOST_AUTO_TEST_CASE(a_step_of_a_programme_never_makes_an_overlap) {
    for (unsigned long long seed = 1; seed <= 10; ++seed) {
        Packing packing = loose_lattice(7, seed);
        const std::vector<double> g = generic_infinitesimal(packing.radius, seed);
        room::ContactProgramme programme(g, 0.3, room::ProgrammeMethod::simplex, nullptr);
        for (int k = 0; k < 6; ++k) {
            const double area = packing.length(0) * packing.length(1);
            const room::ProgrammeStep step = programme.solve(packing, 1e-7);
            BOOST_REQUIRE((step.outcome == room::ProgrammeStep::Outcome::optimal));
            for (std::size_t c = 0; c < packing.q.size(); ++c) {
                packing.q[c] += step.displacement[c];
            }
            BOOST_TEST(smallest_gap(packing) > -1e-8); // the programme's own feasibility tolerance is 1e-9
            BOOST_TEST(packing.length(0) * packing.length(1) < area);
            BOOST_TEST(step.contacts.size() + static_cast<std::size_t>(step.bounds) == packing.q.size());
        }
    }
}

// Two methods that share nothing but the programme: same point; same contacts where the optimum is not degenerate.
BOOST_AUTO_TEST_CASE(interior_points_and_the_simplex_method_end_at_the_same_point) {
    const auto compare = [](const Packing& packing, unsigned long long seed, bool contacts) {
        const std::vector<double> g = generic_infinitesimal(packing.radius, seed);
        room::ContactProgramme simplex(g, 0.3, room::ProgrammeMethod::simplex, nullptr);
        room::ContactProgramme interior(g, 0.3, room::ProgrammeMethod::interior_first, nullptr);
        const room::ProgrammeStep expected = simplex.solve(packing, 1e-5);
        const room::ProgrammeStep step = interior.solve(packing, 1e-5);
        BOOST_REQUIRE((expected.outcome == room::ProgrammeStep::Outcome::optimal));
        BOOST_REQUIRE((step.outcome == room::ProgrammeStep::Outcome::optimal));
        BOOST_TEST(step.pivots == 0); // not by way of Clp
        double apart = 0;
        for (std::size_t c = 0; c < packing.q.size(); ++c) {
            apart = std::max(apart, std::abs(step.displacement[c] - expected.displacement[c]));
        }
        BOOST_TEST(apart < 1e-6);
        if (contacts) {
            BOOST_TEST((step.contacts == expected.contacts));
            BOOST_TEST(step.bounds == expected.bounds);
        }
    };
    for (unsigned long long seed = 1; seed <= 6; ++seed) {
        compare(loose_lattice(6, seed), seed, false); // many disks at their trust bounds by symmetry
    }
    const State vertex = prepared(100, 2);
    for (const double amplitude : {1e-6, 1e-3, 1e-2}) {
        Noise noise(5);
        Packing shaken = vertex.packing;
        for (double& x : shaken.q) {
            x = x * (1 + amplitude) + 0.5 * amplitude * noise();
        }
        compare(shaken, 2, true);
    }
}

// As an interior-point method leaves them where the cost hardly changes along the way: here one, or two, are taken
// away.
BOOST_AUTO_TEST_CASE(contacts_left_open_are_found_along_their_mechanisms) {
    const State vertex = prepared(60, 3);
    const std::vector<double>& g = vertex.load.infinitesimal;
    room::ContactProgramme programme(g, 0.3, room::ProgrammeMethod::interior_first, nullptr);
    const std::vector<Contact> all = programme.solve(vertex.packing, 1e-7).contacts;
    BOOST_TEST_REQUIRE(all.size() == vertex.packing.q.size());
    for (std::size_t l = 0; l < all.size(); ++l) {
        for (const std::size_t taken : {1U, 2U}) {
            std::vector<Contact> contacts = all;
            contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>(l));
            if (taken == 2) {
                contacts.erase(contacts.begin() + static_cast<std::ptrdiff_t>((l + 17) % contacts.size()));
            }
            Packing packing = vertex.packing;
            BOOST_TEST(programme.complete(packing, 1e-7, contacts));
            if (taken == 1) {
                BOOST_TEST((contacts == all), to_string(all[l]));
            }
            BOOST_TEST(contacts.size() == all.size());
            BOOST_TEST(smallest_gap(packing) > -1e-6);
        }
    }
    std::vector<Contact> few(all.begin(), all.begin() + 20);
    Packing packing = vertex.packing;
    BOOST_TEST(!programme.complete(packing, 1e-7, few));
}

BOOST_AUTO_TEST_CASE(an_infeasible_programme_has_no_interior_point) {
    // x >= 1 and -x >= 0, |x| <= 2
    const room::BoxedProgramme programme{{0, 1, 2}, {0, 0}, {1, -1}, {1, 0}, {1}, {2}};
    BOOST_TEST(!room::interior_point(programme, 1e-12, nullptr).converged);
    const room::BoxedProgramme feasible{{0, 1, 2}, {0, 0}, {1, -1}, {-0.5, -1}, {1}, {2}};
    const room::ActiveSet answer = room::interior_point(feasible, 1e-12, nullptr);
    BOOST_REQUIRE(answer.converged);
    BOOST_TEST(std::abs(answer.x[0] + 0.5) < 1e-9);
    BOOST_TEST(answer.row[0] == 1);
    BOOST_TEST(answer.row[1] == 0);
    BOOST_TEST(answer.column[0] == 0);
}

BOOST_AUTO_TEST_CASE(a_vertex_found_with_interior_points_is_proved_like_any_other) {
    for (unsigned long long seed = 1; seed <= 4; ++seed) {
        check::is_proved_vertex(vertex_near(loose_lattice(6, seed), {.large_above = 0}), 1);
    }
}

BOOST_AUTO_TEST_CASE(a_shaken_vertex_is_found_again) {
    const State vertex = prepared(100, 2);
    const auto before = inspect_vertex(vertex);
    for (const double amplitude : {0.0, 1e-9, 1e-6, 1e-4}) {
        BOOST_TEST_INFO_SCOPE("amplitude " << amplitude);
        Noise noise(5);
        Packing shaken = vertex.packing;
        for (double& x : shaken.q) {
            x = x * (1 + amplitude) + amplitude * noise();
        }
        PreparationOptions options;
        options.seed = 2; // the same infinitesimal loads
        const auto found = vertex_near(shaken, options);
        check::is_proved_vertex(found, 1);
        for (std::size_t l = 0; l < vertex.contacts.size(); ++l) {
            if (before.value().structural_zero[l] == 0) { // a rattler may have another place to rest
                BOOST_TEST(std::ranges::binary_search(found.contacts, vertex.contacts[l]));
            }
        }
        BOOST_TEST(found.packing.length(0) == vertex.packing.length(0), boost::test_tools::tolerance(1e-14));
        BOOST_TEST(found.packing.length(1) == vertex.packing.length(1), boost::test_tools::tolerance(1e-14));
    }
}

BOOST_AUTO_TEST_CASE(a_loose_start_without_dynamics_ends_at_a_vertex_too) {
    for (unsigned long long seed = 1; seed <= 4; ++seed) {
        check::is_proved_vertex(vertex_near(loose_lattice(5, seed)), 1);
    }
}

BOOST_AUTO_TEST_CASE(large_overlaps_of_the_start_are_parted) {
    Packing start = loose_lattice(5, 3);
    for (double& x : start.q) {
        x *= 0.6;
    }
    BOOST_REQUIRE(smallest_gap(start) < -0.3);
    check::is_proved_vertex(vertex_near(start), 1);
}

// One contact exchanged for a near miss: Newton closes it, and the proofs must see that something else is wrong then.
BOOST_AUTO_TEST_CASE(a_wrong_contact_list_is_refused) {
    const State vertex = prepared(20, 6);
    std::map<FailureKind, int> refused;
    for (const Contact& near : find_candidates(vertex.packing, 0.3).contacts) {
        if (std::ranges::binary_search(vertex.contacts, near)) {
            continue;
        }
        for (std::size_t l = 0; l < vertex.contacts.size(); ++l) {
            std::vector<Contact> contacts = vertex.contacts;
            contacts[l] = near;
            long iterations = 0;
            const auto polished = room::polish(vertex.packing, contacts, vertex.load, iterations);
            if (polished.ok()) {
                check::is_proved_vertex(polished.value().state, 1);
            } else {
                ++refused[polished.failure().kind];
            }
        }
    }
    BOOST_TEST(refused[FailureKind::not_isostatic] > 0);
    BOOST_TEST(refused[FailureKind::not_converged] > 20); // a force is not compressive
    BOOST_TEST(refused[FailureKind::overlap] > 0);
    long iterations = 0;
    BOOST_TEST(room::polish(vertex.packing, vertex.contacts, vertex.load, iterations).ok());
    std::vector<Contact> few(vertex.contacts.begin(), vertex.contacts.end() - 1);
    fails(room::polish(vertex.packing, few, vertex.load, iterations), FailureKind::not_isostatic);
}

BOOST_AUTO_TEST_CASE(a_cap_on_programmes_is_a_failure_that_keeps_the_configuration) {
    PreparationOptions options{.max_programmes = 1};
    PreparationReport report;
    fails(find_vertex(loose_lattice(4, 1), options, report), FailureKind::not_converged);
    BOOST_REQUIRE(report.last.has_value());
    BOOST_TEST(smallest_gap(*report.last) > -1e-8);
}

BOOST_AUTO_TEST_CASE(other_walls_and_fixed_disks_are_bad_input) {
    PreparationReport report;
    Packing start = loose_lattice(3, 1);
    start.fixed.assign(9, 0);
    start.fixed[4] = 1;
    BOOST_CHECK_THROW(find_vertex(start, PreparationOptions{}, report), Error);
    start = loose_lattice(3, 1);
    start.walls.upper[0] = WallKind::fixed;
    BOOST_CHECK_THROW(find_vertex(start, PreparationOptions{}, report), Error);
    start = loose_lattice(3, 1);
    start.q[7] = std::numeric_limits<double>::quiet_NaN();
    BOOST_CHECK_THROW(find_vertex(start, PreparationOptions{}, report), Error);
    start = loose_lattice(3, 1);
    start.q.back() = -1;
    BOOST_CHECK_THROW(find_vertex(start, PreparationOptions{}, report), Error);
}
