// The vertex of a list of contacts: proved near the soft place, or refused with the reason.
#include "rigidity/isostatic.hpp"
#include "snap/backbone.hpp"
#include "snap/force_split.hpp"
#include "support/scratch.hpp"
#include "support/spheres.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <Eigen/Dense>
#include <Eigen/SparseCore>

using namespace isostat;
using compare::Snap;
using compare::SnapOutcome;
using compare::SoftState;

namespace {

/// An equilibrium of 100 disks, without rattlers' contacts, pushed to the place of soft grains of that stiffness.
struct Sample {
    State state = read_state(scratch::data("vertex100.txt")).state;
    std::vector<Contact> list = compare::carrying(state, certify(state));
    State backbone = compare::snap({state.packing, list, state.load}).backbone;

    [[nodiscard]] SoftState soft(double stiffness, std::vector<double>* forces = nullptr) const {
        const Snap exact = compare::snap({state.packing, list, state.load});
        const auto there = compare::soften(exact.backbone, state.load.loaded_stress(), stiffness);
        SoftState out{state.packing, list, state.load};
        const std::size_t d = state.packing.axes();
        for (std::size_t b = 0; b < exact.disks.size(); ++b) {
            std::copy_n(&there->packing.q[d * b], d, &out.packing.q[d * static_cast<std::size_t>(exact.disks[b])]);
        }
        std::copy(there->packing.q.begin() + static_cast<std::ptrdiff_t>(there->packing.length_at(0)),
                  there->packing.q.end(),
                  out.packing.q.begin() + static_cast<std::ptrdiff_t>(state.packing.length_at(0)));
        if (forces != nullptr) {
            *forces = there->forces;
        }
        return out;
    }
};

Sample of_cell(const std::string& name) {
    return {read_any_state(scratch::data("cells/" + name + ".json")).state};
}

/// In a box, a slab (walls along z), an orthorhombic and a triclinic cell.
constexpr std::array sphere_names{"box_uniform_30_1", "slab_uniform_30_1", "ortho_uniform_30_1", "tri_uniform_30_1"};
Sample of_spheres(const std::string& name) {
    return {test::on_its_lengths(test::state_of_spheres(test::read_spheres(name)))};
}

/// With its rattlers at rest it is an equilibrium, and these contacts carry.
State rests_on(const Snap& found, const std::vector<Contact>& list) {
    const State state = required(compare::with_resting_rattlers(found, 3));
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::proved));
    BOOST_TEST((compare::carrying(state, truth) == list));
    return state;
}

} // namespace

BOOST_AUTO_TEST_CASE(soft_spheres_snap_to_their_vertex_in_walls_slabs_and_cells) {
    for (const char* name : sphere_names) {
        BOOST_TEST_INFO_SCOPE(name);
        const Sample sample = of_spheres(name);
        std::vector<double> forces;
        SoftState soft = sample.soft(1e6, &forces);
        const Snap found = compare::snap(soft);
        BOOST_TEST_REQUIRE((found.outcome == SnapOutcome::vertex), found.reason);
        double way = 0;
        for (const int disk : found.disks) {
            const auto i = static_cast<std::size_t>(disk);
            double square = 0;
            for (std::size_t k = 3 * i; k < 3 * i + 3; ++k) {
                square += std::pow(soft.packing.q[k] - found.packing.q[k], 2);
            }
            BOOST_TEST(found.moved[i] >= std::sqrt(square));
            way = std::max(way, std::sqrt(square));
        }
        BOOST_TEST(found.distance < way + 1e-10);
        BOOST_TEST(way > 1e-8);
        const double mean = compare::mean_force(forces);
        BOOST_TEST(compare::split_forces(soft, forces, mean, found).rest < 1e-8);
        rests_on(found, sample.list);
        // A contact less holds nothing; one more is too many; beyond the interval a force has the other sign.
        SoftState wrong = soft;
        wrong.contacts.erase(wrong.contacts.begin() + 5);
        BOOST_TEST((compare::snap(wrong).outcome == SnapOutcome::moving));
        wrong = soft;
        wrong.load.stress[2] *= 1.3;
        const Snap overloaded = compare::snap(wrong);
        BOOST_TEST((overloaded.outcome == SnapOutcome::refuted), overloaded.reason);
    }
}

BOOST_AUTO_TEST_CASE(a_sphere_among_its_like_on_a_wall_is_held_by_a_contact_without_force) {
    const State hard = test::on_its_lengths(test::state_of_spheres(test::read_spheres("box_bidisperse_100_1")));
    for (const double swollen : {1.0, 1 + 1e-7}) {
        SoftState soft{hard.packing, compare::able_to_carry(hard.packing, hard.contacts), hard.load};
        for (double& radius : soft.packing.radius) {
            radius *= swollen;
        }
        BOOST_TEST(soft.contacts.size() == 261U);
        BOOST_TEST(std::ranges::count(soft.contacts, Contact(ContactKind::lower_wall, 12, 2)) == 1);
        const Snap found = compare::snap(soft);
        BOOST_TEST_REQUIRE((found.outcome == SnapOutcome::vertex), found.reason);
        BOOST_TEST(found.rattlers.size() == 14U);
        BOOST_TEST(compare::carrying(found).size() == 260U);
        const auto state = required(compare::with_resting_rattlers(found, 3));
        BOOST_TEST((certify(state).verdict == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(soft_grains_are_proved_near_the_vertex_that_they_came_from) {
    const Sample sample;
    for (const double stiffness : {1e5, 1e7}) {
        BOOST_TEST_INFO_SCOPE("stiffness " << stiffness);
        const Snap found = compare::snap(sample.soft(stiffness));
        BOOST_TEST_REQUIRE((found.outcome == SnapOutcome::vertex), found.reason);
        BOOST_TEST(found.counting.hyperstaticity == 0);
        // The distance holds and is no worse than twice the way; the vertex is that of the sample.
        double way = 0;
        for (std::size_t b = 0; b < found.disks.size(); ++b) {
            const auto i = static_cast<std::size_t>(found.disks[b]);
            const SoftState soft = sample.soft(stiffness);
            const double here = std::hypot(soft.packing.q[2 * i] - sample.state.packing.q[2 * i],
                                           soft.packing.q[2 * i + 1] - sample.state.packing.q[2 * i + 1]);
            BOOST_TEST(found.moved[i] >= here - 1e-12);
            way = std::max(way, here);
        }
        BOOST_TEST(found.distance >= way - 1e-12);
        BOOST_TEST(found.distance < way + 1e-11);
        BOOST_TEST(found.truth.claims.vertex->radius < 1e-11);
    }
}

BOOST_AUTO_TEST_CASE(rattlers_come_to_rest_and_the_state_is_an_equilibrium_with_the_list) {
    const Sample sample;
    const Snap found = compare::snap(sample.soft(1e6));
    BOOST_TEST_REQUIRE(!found.rattlers.empty());
    BOOST_TEST(rests_on(found, sample.list).contacts.size() == 202U);
}

BOOST_AUTO_TEST_CASE(frames_of_a_periodic_cell_or_a_channel_snap_to_their_vertex) {
    for (const char* name : {"rect_16", "tilt_16", "channel_16"}) {
        for (const double stiffness : {1e5, 1e7}) {
            BOOST_TEST_INFO_SCOPE(name << ", stiffness " << stiffness);
            const Sample sample = of_cell(name);
            const SoftState soft = sample.soft(stiffness);
            const Snap found = compare::snap(soft);
            BOOST_TEST_REQUIRE((found.outcome == SnapOutcome::vertex), found.reason);
            rests_on(found, sample.list);
            for (std::size_t k = 32; k < soft.packing.q.size(); ++k) { // the cell of the sample
                BOOST_TEST(std::abs(found.packing.q[k] - sample.state.packing.q[k]) < 1e-9);
                BOOST_TEST(found.walls >= std::abs(soft.packing.q[k] - found.packing.q[k]));
            }
            // Another disk is pinned, one that carries nothing if there is one: the vertex is the same.
            SoftState other = soft;
            other.packing.cell.pin = found.rattlers.empty() ? 7 : found.rattlers.front();
            const Snap again = compare::snap(other);
            BOOST_TEST_REQUIRE((again.outcome == SnapOutcome::vertex), again.reason);
            BOOST_TEST(again.packing.length(0) == found.packing.length(0), boost::test_tools::tolerance(1e-12));
        }
    }
}

BOOST_AUTO_TEST_CASE(forces_are_split_into_what_is_left_and_what_the_overlaps_change) {
    std::vector<Sample> samples{Sample(), of_cell("rect_16"), of_cell("tilt_16")};
    for (const Sample& sample : samples) {
        std::vector<double> stiffnesses;
        for (const double stiffness : {1e5, 1e6}) {
            std::vector<double> forces;
            const SoftState soft = sample.soft(stiffness, &forces);
            const Snap found = compare::snap(soft);
            const double mean = compare::mean_force(forces);
            const compare::ForceSplit split = compare::split_forces(soft, forces, mean, found);
            BOOST_TEST(split.rest < 1e-9);
            stiffnesses.push_back(split.stiffness);
            forces[5] += 0.25 * mean;
            const compare::ForceSplit wrong = compare::split_forces(soft, forces, mean, found);
            BOOST_TEST(wrong.rest == 0.25, boost::test_tools::tolerance(1e-6));
            BOOST_TEST((wrong.worst == soft.contacts[5]));
            BOOST_TEST(wrong.stiffness == split.stiffness);
        }
        BOOST_TEST(stiffnesses[0] / stiffnesses[1] == 10.0, boost::test_tools::tolerance(0.1)); // as 1 / K
    }
}

/// The self-stress of a list with h = 1, largest component 1, by dense elimination.
std::vector<double> self_stress_of(const Snap& snap, const SoftState& soft) {
    const Packing packing = compare::of_disks(soft.packing, snap.disks);
    const auto h = contact_matrix(packing, DofMap(packing), snap.backbone.contacts);
    const Eigen::MatrixXd dense = Eigen::Map<const Eigen::SparseMatrix<double>>(
        h.rows, h.cols, h.entries(), h.start.data(), h.row.data(), h.value.data());
    const Eigen::MatrixXd kernel = Eigen::FullPivLU<Eigen::MatrixXd>(dense).kernel();
    BOOST_TEST_REQUIRE(kernel.cols() == 1);
    const Eigen::VectorXd s = kernel.col(0) / kernel.col(0).cwiseAbs().maxCoeff();
    return {s.begin(), s.end()};
}

BOOST_AUTO_TEST_CASE(forces_of_a_hyperstatic_list_are_split_beside_its_self_stress) {
    std::vector<Sample> samples{Sample(), of_cell("rect_16"), of_cell("tilt_16")};
    for (const Sample& sample : samples) {
        std::vector<double> forces;
        SoftState soft = sample.soft(1e6, &forces);
        const double mean = compare::mean_force(forces);
        const Snap exact = compare::snap(soft);
        const double stiffness = compare::split_forces(soft, forces, mean, exact).stiffness;
        Contact near = exact.truth.claims.gaps->where; // a pair that touches not: one contact too many
        near.i = exact.disks[static_cast<std::size_t>(near.i)];
        near.j = near.kind == ContactKind::disk_disk ? exact.disks[static_cast<std::size_t>(near.j)] : near.j;
        soft.contacts.push_back(near);
        forces.push_back(0);
        const Snap list = compare::snap(soft);
        BOOST_TEST_REQUIRE((list.outcome == SnapOutcome::hyperstatic), list.reason);
        compare::Exchanged vertex;
        vertex.state = sample.state;
        vertex.truth = certify(vertex.state);
        const std::vector<double> s = self_stress_of(list, soft);
        for (const double amount : {0.0, 0.1, -3.0}) {
            std::vector<double> given = forces;
            for (std::size_t l = 0; l < given.size(); ++l) {
                given[l] += amount * mean * s[l];
            }
            const auto split = compare::split_surplus(soft, given, mean, list, &vertex);
            BOOST_TEST(split.rest < 1e-9); // they balance whatever the amount
            BOOST_TEST(std::abs(split.self_stress - std::abs(amount)) <= stiffness);
            BOOST_TEST(std::abs(split.downhill - std::abs(amount)) <= stiffness * 1.001 + 1e-9);
            given[5] += 0.25 * mean;
            const auto wrong = compare::split_surplus(soft, given, mean, list, &vertex);
            // The nearest balanced forces keep of the error what is along the self-stress.
            const double square = std::inner_product(s.begin(), s.end(), s.begin(), 0.0);
            double left = 0;
            for (std::size_t l = 0; l < s.size(); ++l) {
                left = std::max(left, 0.25 * std::abs((l == 5 ? 1 : 0) - s[5] * s[l] / square));
            }
            BOOST_TEST(wrong.rest == left, boost::test_tools::tolerance(1e-6));
        }
    }
}

BOOST_AUTO_TEST_CASE(lists_without_a_vertex_are_refused_with_the_reason) {
    const Sample sample;
    SoftState soft = sample.soft(1e6);
    soft.contacts.erase(soft.contacts.begin() + 17);
    const Snap fewer = compare::snap(soft);
    BOOST_TEST((fewer.outcome == SnapOutcome::moving));
    BOOST_TEST(fewer.reason.find("k = 1") != std::string::npos, fewer.reason);

    soft = sample.soft(1e6);
    const Snap exact = compare::snap(soft);
    Contact near = exact.truth.claims.gaps->where; // of disks that both carry a force
    near.i = exact.disks[static_cast<std::size_t>(near.i)];
    near.j = near.kind == ContactKind::disk_disk ? exact.disks[static_cast<std::size_t>(near.j)] : near.j;
    soft.contacts.push_back(near);
    std::ranges::sort(soft.contacts);
    const Snap more = compare::snap(soft);
    BOOST_TEST((more.outcome == SnapOutcome::hyperstatic));
    BOOST_TEST(more.reason.find("h = 1") != std::string::npos, more.reason);
    const auto downhill = required(compare::exchange(soft, 1));
    BOOST_TEST((downhill.truth.verdict == Verdict::proved));
    BOOST_TEST((downhill.contacts == sample.list));

    soft = sample.soft(1e6);
    soft.load.stress[1] *= 1.2; // beyond the interval
    const Snap overloaded = compare::snap(soft);
    BOOST_TEST((overloaded.outcome == SnapOutcome::refuted));
    BOOST_TEST(overloaded.reason.find("the force of") != std::string::npos, overloaded.reason);
}

BOOST_AUTO_TEST_CASE(a_rattler_without_room_is_no_vertex) {
    for (const Sample& sample : {Sample(), of_spheres("box_uniform_30_1")}) {
        SoftState soft = sample.soft(1e6);
        const Snap before = compare::snap(soft);
        BOOST_TEST_REQUIRE(!before.rattlers.empty());
        BOOST_TEST(before.cage > 0.0);
        double& radius = soft.packing.radius[static_cast<std::size_t>(before.rattlers.front())];
        const double fits = radius;
        std::vector<SnapOutcome> outcomes;
        for (double factor = 1; factor < 1.5; factor += 1.0 / 64) {
            radius = factor * fits;
            const Snap after = compare::snap(soft);
            outcomes.push_back(after.outcome);
            if (after.outcome == SnapOutcome::refuted) {
                BOOST_TEST(after.reason.find("has no room") != std::string::npos, after.reason);
            } else if (after.outcome == SnapOutcome::vertex) {
                BOOST_TEST(compare::without_room(after) == "");
            }
        }
        BOOST_TEST((outcomes.front() == SnapOutcome::vertex));
        BOOST_TEST((outcomes.back() == SnapOutcome::refuted));
        BOOST_TEST(std::ranges::is_sorted(outcomes, [](SnapOutcome a, SnapOutcome b) {
            return a == SnapOutcome::vertex &&
                   b == SnapOutcome::refuted; // once there is no room, there is none for more
        }));
    }
}

BOOST_AUTO_TEST_CASE(soft_limits_approach_the_exact_one_as_one_over_the_stiffness) {
    const Sample sample;
    const Certification truth = certify(sample.backbone);
    BOOST_TEST_REQUIRE(truth.claims.load_interval.has_value());
    const double low = truth.claims.load_interval->low.stress.upper,
                 high = truth.claims.load_interval->high.stress.lower;
    for (const int direction : {-1, 1}) {
        const compare::ExactInterval exact{low, high, direction};
        const auto hard = compare::soft_limit(sample.backbone, exact, 1e7);
        const auto soft = compare::soft_limit(sample.backbone, exact, 1e6);
        BOOST_TEST_REQUIRE((hard && soft));
        BOOST_TEST((soft->stress - exact.end()) / (hard->stress - exact.end()) == 10.0,
                   boost::test_tools::tolerance(0.1));
        const auto needed = required(compare::stiffness_needed(sample.backbone, exact));
        const auto there = required(compare::soft_limit(sample.backbone, exact, needed));
        BOOST_TEST(std::abs(there.stress - exact.end()) / exact.end() == 1e-3, boost::test_tools::tolerance(0.3));
    }
}
