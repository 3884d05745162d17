// States of clumps: closed forms, and packings by an independent program.
#include "certificate/averages.hpp"
#include "oracle/truth.hpp"
#include "packing/bodies.hpp"
#include "support/clumps.hpp"
#include "support/test.hpp"
#include "support/units.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using namespace isostat::test;

namespace {

bool lies_within(const Interval& interval, double value) {
    return interval.lower <= value && value <= interval.upper && interval.upper - interval.lower < 1e-11;
}

Inspection inspected(const State& state) {
    return required(inspect_vertex(with_free_motions_held(state)));
}

const std::vector<std::string> unions{"dimer_20_1",  "dimer_20_2",  "dimer_20_3",  "dimer2_20_1", "dimer2_20_2",
                                      "dimer2_20_3", "trimer_20_1", "trimer_20_2", "trimer_20_3"};

} // namespace

BOOST_AUTO_TEST_CASE(a_dimer_that_lies_has_the_forces_of_the_closed_form_and_one_limit) {
    const Certification truth = certify(lying_dimer(12, 12));
    BOOST_TEST((truth.verdict == Verdict::proved));
    BOOST_TEST(truth.counting.dof_count == 5);
    BOOST_TEST(truth.counting.contact_count == 5);
    const std::vector<double> expected{12, 7, 5, 12, 12, 13}; // tan phi = 5/12; the bar bears a thrust of 12 / cos phi
    BOOST_TEST_REQUIRE(truth.finite.size() == expected.size());
    for (std::size_t l = 0; l < expected.size(); ++l) {
        BOOST_TEST(lies_within(truth.finite[l], expected[l]),
                   "force " << l << " in [" << truth.finite[l].lower << ", " << truth.finite[l].upper << "]");
    }
    BOOST_TEST(lies_within(truth.claims.load_interval->low.stress, 5));
    BOOST_TEST((truth.claims.load_interval->low.opens == Contact{ContactKind::lower_wall, 0, 1}));
    BOOST_TEST(truth.claims.load_interval->high.unbounded);
    BOOST_TEST(truth.signs.positive == 5);
}

BOOST_AUTO_TEST_CASE(dimers_in_space_and_in_a_channel_have_the_forces_of_the_closed_form) {
    struct Expected {
        State state;
        int dofs;
        std::vector<double> forces;
        double low;
        Contact opens;
    };
    const std::vector<Expected> all{
        {lying_dimer_in_space(), 8, {7, 7, 4, 6, 10, 4, 6, 10, 11}, 6, {ContactKind::lower_wall, 0, 2}},
        {row_of_dimers(), 4, {15, 6, 14, 20, 13}, 14, {ContactKind::lower_wall, 0, 1}}};
    for (const Expected& expected : all) {
        const Certification truth = certify(expected.state);
        BOOST_TEST((truth.verdict == Verdict::proved),
                   (truth.claims.undecided.empty() ? "" : truth.claims.undecided[0]));
        BOOST_TEST(truth.counting.dof_count == expected.dofs);
        BOOST_TEST(truth.counting.contact_count == expected.dofs);
        BOOST_TEST_REQUIRE(truth.finite.size() == expected.forces.size());
        for (std::size_t l = 0; l < expected.forces.size(); ++l) {
            const Interval& f = truth.finite[l]; // lengths such as 2.8 are rounded: some 1e-15
            BOOST_TEST((f.lower - 1e-12 < expected.forces[l] && expected.forces[l] < f.upper + 1e-12));
        }
        BOOST_TEST(std::abs(truth.claims.load_interval->low.stress.lower - expected.low) < 1e-11);
        BOOST_TEST((truth.claims.load_interval->low.opens == expected.opens));
    }
}

BOOST_AUTO_TEST_CASE(below_that_limit_the_lying_dimer_is_refuted) {
    const Certification truth = certify(lying_dimer(12, 4.9));
    BOOST_TEST((truth.verdict == Verdict::refuted));
    BOOST_TEST(truth.signs.negative == 1);
}

BOOST_AUTO_TEST_CASE(a_bar_under_tension_is_no_traction_of_a_contact) {
    // The large member is pulled to the left, the small one to the right; the walls are away.
    const State state = clumps_of(R"({"format": "isostat-state", "version": 2, "length": [9, 9],
        "walls": {"lower": ["absent", "fixed"], "upper": ["absent", "absent"]}, "load": {"reference_length": [1, 1]},
        "disks": [[1, 1, 1], [3, 1, 1], [5, 1, 0.5]], "bars": [[0, 1, 2]], "fixed": [2],
        "disk_force": [[-1, -1], [3, -1], [0, 0]], "contacts": [[0, "bottom"], [1, "bottom"]]})");
    State pulled = state;
    pulled.packing.q[4] = 4.5;
    pulled.contacts.insert(pulled.contacts.begin(), isostat::pair_of(1, 2));
    const Certification truth = certify(pulled);
    BOOST_TEST((truth.claims.forces.has_value()));
    BOOST_TEST_REQUIRE(truth.finite.size() == 4U);
    BOOST_TEST(lies_within(truth.finite[3], -1)); // the bar
    BOOST_TEST(lies_within(truth.finite[0], 2));
    BOOST_TEST(truth.signs.negative == 0);
    BOOST_TEST(truth.claims.stable);
}

BOOST_AUTO_TEST_CASE(a_body_held_at_one_member_is_a_rotational_rattler_by_counting) {
    const Inspection inspection = inspected(disk_with_a_dangling_member());
    BOOST_TEST(inspection.equilibrium);
    BOOST_TEST((inspection.stable == Verdict::proved));
    BOOST_TEST(inspection.counting.dof_count == 5);
    BOOST_TEST(inspection.counting.contact_count == 4);
    BOOST_TEST(inspection.counting.mechanisms == 1);
    BOOST_TEST(inspection.rotational_rattlers == std::vector<int>{0}, boost::test_tools::per_element());
    BOOST_TEST(inspection.rattlers.empty());
}

/// Beyond 1e100 no bound counts: nothing is claimed, and nothing is refuted.
BOOST_AUTO_TEST_CASE(a_clump_of_lengths_beyond_the_bounds_is_undecided) {
    State state = with_free_motions_held(disk_with_a_dangling_member());
    units::stretch(state.packing, 0x1p400);
    BOOST_TEST((certify(state).verdict == Verdict::undecided));
    const auto result = inspect_vertex(state);
    BOOST_TEST((result.ok() ? result.value().record.verdict == Verdict::undecided
                            : result.failure().kind == isostat::FailureKind::undecided));
}

BOOST_AUTO_TEST_CASE(what_is_held_so_that_the_list_is_not_regular_is_counted_by_nobody) {
    State state = disk_with_a_dangling_member();
    state.contacts.push_back({ContactKind::held, 0, 0}); // x of the disk, which two walls hold
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::undecided));
    BOOST_TEST(!truth.claims.counting);
}

BOOST_AUTO_TEST_CASE(a_force_on_the_dangling_member_makes_its_motion_no_free_one) {
    State state = disk_with_a_dangling_member();
    state.load.disk_force = {0, 0, 1e-3, 0};
    const Certification truth = certify(with_free_motions_held(state));
    BOOST_TEST((truth.verdict == Verdict::undecided));
    BOOST_TEST(!truth.claims.counting);
    const Inspection inspection = inspected(state);
    BOOST_TEST(!inspection.equilibrium);
    BOOST_TEST((inspection.stable == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(a_dimer_across_a_box_is_balanced_where_the_potential_has_a_maximum) {
    const Inspection inspection = inspected(dimer_across(3, 4));
    BOOST_TEST(!inspection.equilibrium);
    BOOST_TEST(inspection.counting.mechanisms == 1);
    BOOST_TEST((inspection.stable == Verdict::refuted), inspection.remark);
    BOOST_TEST(inspection.second_order.negative());
}

/// N = 2, N_f = 3: hypostatic, and a minimum, which hangs below the place where the force points away from the corner.
/// A sphere that hangs at an arm of 7/8 under a force of 7, n = (2, 3, 6)/7 along it: W'' = 8 per square of the way of
/// its small member, which is (1 + n_a^2/n_c^2, ..) on two coordinates a, b, c following by n.dx = 0.
BOOST_AUTO_TEST_CASE(the_form_of_a_minimum_in_a_certificate_encloses_the_closed_form) {
    const Certification sphere = certify(with_free_motions_held(sphere_in_a_corner()));
    BOOST_REQUIRE(sphere.claims.minimum.has_value());
    const std::vector<Contact>& held = sphere.claims.minimum->held;
    BOOST_TEST_REQUIRE(held.size() == 2U);
    const std::array<double, 3> n{2, 3, 6};
    const auto axis = [&held](std::size_t i) { return static_cast<std::size_t>(held[i].i % 3); };
    const double last = n.at(3 - axis(0) - axis(1));
    const std::vector<Interval>& form = sphere.claims.minimum->form;
    std::size_t entry = 0;
    for (std::size_t i = 0; i < 2; ++i) {
        for (std::size_t j = i; j < 2; ++j, ++entry) {
            const double expected = 8 * ((i == j ? 1 : 0) + n.at(axis(i)) * n.at(axis(j)) / (last * last));
            BOOST_TEST(form.at(entry).lower < expected - 1e-13);
            BOOST_TEST(form.at(entry).upper > expected + 1e-13);
            BOOST_TEST(form.at(entry).upper - form.at(entry).lower < 1e-9);
        }
    }
    for (const auto& [state, expected] : {std::pair(disk_in_a_corner(), 12.5),
                                          std::pair(dimer_in_a_cell(2), (12 - 2 * (3 + 81.0 / 64)) / (5.25 * 5.25))}) {
        const Certification truth = certify(with_free_motions_held(state));
        BOOST_REQUIRE(truth.claims.minimum.has_value());
        BOOST_TEST_REQUIRE(truth.claims.minimum->form.size() == 1U);
        BOOST_TEST(truth.claims.minimum->form[0].lower < expected - 1e-14);
        BOOST_TEST(truth.claims.minimum->form[0].upper > expected + 1e-14);
        BOOST_TEST(truth.claims.minimum->form[0].upper - truth.claims.minimum->form[0].lower < 1e-9);
    }
}

BOOST_AUTO_TEST_CASE(a_disk_in_a_corner_under_an_eccentric_load_has_a_minimum_that_is_proved) {
    const Inspection hanging = inspected(disk_in_a_corner());
    BOOST_TEST(hanging.counting.mechanisms == 1);
    BOOST_TEST((hanging.stable == Verdict::proved), hanging.remark);
    BOOST_TEST(std::abs(hanging.second_order.value - 12.5) <= hanging.second_order.radius);
    BOOST_TEST(hanging.remark.find("W'' >= 12.4") != std::string::npos, hanging.remark);
    BOOST_TEST(hanging.rotational_rattlers.empty()); // the load turns it
    const Enclosure second =
        hanging.yielding->second_variation.at(0); // 25/8, the mean of the members at an arm of 5/16
    BOOST_TEST(std::abs(second.value - 3.125 / (1 + 25.0 / 256)) <= second.radius);
    BOOST_TEST(second.radius < 1e-9);
    BOOST_TEST((inspected(disk_in_a_corner(std::acos(-1))).stable == Verdict::refuted));
    // Stored beside the minimum, which is at most as far as said, and that far.
    const Inspection beside = inspected(disk_in_a_corner(0x1p-20));
    BOOST_TEST((beside.stable == Verdict::proved), beside.remark);
    const double away = std::stod(beside.remark.substr(beside.remark.find("within ") + 7));
    BOOST_TEST(away > 0.625 * 0x1p-20);
    BOOST_TEST(away < 0x1p-18);
    BOOST_TEST((inspected(disk_in_a_corner(0.5)).stable == Verdict::undecided));
    BOOST_TEST((inspected(disk_that_lands()).stable == Verdict::undecided));
}

/// Newton's step tells how far the minimum is, and not the multipliers over the least curvature, 2^-30 over 2^-20.
BOOST_AUTO_TEST_CASE(a_minimum_is_proved_where_the_potential_is_flat_along_one_mechanism_and_steep_along_another) {
    const Inspection both = inspected(flat_beside_steep());
    BOOST_TEST((both.stable == Verdict::proved), both.remark);
    const double away = std::stod(both.remark.substr(both.remark.find("within ") + 7));
    BOOST_TEST(away >= 0x1p-30);
    BOOST_TEST(away < 0x1p-27);
    State far = flat_beside_steep();
    far.packing.q[6] = 7 + 0x1p-7; // too far for the form, which changes
    BOOST_TEST((inspected(far).stable == Verdict::undecided));
}

BOOST_AUTO_TEST_CASE(several_mechanisms_have_a_minimum_together_or_none) {
    const State two = two_disks_in_a_corner();
    const Inspection hanging = inspected(two);
    BOOST_TEST(hanging.counting.mechanisms == 2);
    BOOST_TEST((hanging.stable == Verdict::proved), hanging.remark);
    for (const std::size_t member : {1U, 3U}) { // one of them stands on its head
        State turned = two;
        for (const std::size_t a : {0U, 1U}) {
            turned.packing.q[2 * member + a] = 2 * two.packing.q[2 * member - 2 + a] - two.packing.q[2 * member + a];
        }
        BOOST_TEST((inspected(turned).stable == Verdict::refuted));
    }
    State touching = two; // a pair that touches beside the contacts leaves no way
    touching.contacts.erase(std::ranges::find(touching.contacts, Contact{ContactKind::disk_disk, 0, 2}));
    BOOST_TEST((inspected(touching).stable != Verdict::proved));
}

/// Ovals and dimers; two dimers turn about their one member with contacts, and where that moves on a mechanism a held
/// coordinate turns them. Eigenvalues do not depend on which coordinate is held.
BOOST_AUTO_TEST_CASE(free_motions_leave_the_eigenvalues_of_the_others_as_they_are) {
    const State state = clumps("mixed_16_3");
    const auto expected = nlohmann::json::parse(state.provenance)["expected"];
    const Inspection inspection = inspected(state);
    BOOST_TEST_REQUIRE((inspection.stable == Verdict::proved), inspection.remark);
    BOOST_TEST(inspection.rotational_rattlers.size() == 2U);
    std::vector<Enclosure> all = inspection.yielding->second_variation;
    all.insert(all.begin(), 2, Enclosure{0, 0}); // of the free motions
    BOOST_TEST_REQUIRE(all.size() == expected["second_variation"].size());
    for (std::size_t i = 0; i < all.size(); ++i) {
        BOOST_TEST(std::abs(all[i].value - expected["second_variation"][i].get<double>()) < 1e-9);
        BOOST_TEST(all[i].radius < 1e-7);
    }
}

/// The row of such a bar is 0 along x where it is level with what it hangs from. The motion is no free one.
BOOST_AUTO_TEST_CASE(what_is_level_with_the_load_only_where_it_is_held_is_no_free_motion) {
    const Inspection hanging = inspected(pendulums(-1, -2));
    BOOST_TEST(hanging.counting.mechanisms == 2);
    BOOST_TEST(!hanging.truth.claims.stable);
    BOOST_TEST((hanging.stable == Verdict::proved), hanging.remark);
    BOOST_TEST(hanging.remark.find("strict local minimum") != std::string::npos, hanging.remark);
    BOOST_TEST(hanging.rotational_rattlers.empty());
    for (const auto& [first, second] : {std::pair(-1.0, 2.0), std::pair(1.0, -2.0), std::pair(1.0, 2.0)}) {
        const Inspection standing = inspected(pendulums(first, second));
        BOOST_TEST(!standing.truth.claims.counting);
        BOOST_TEST((standing.stable == Verdict::refuted), standing.remark);
    }
}

/// Lengths of the cell move on the mechanism, in opposite directions: relative velocities through images matter.
BOOST_AUTO_TEST_CASE(a_dimer_in_a_cell_has_the_second_variation_of_its_closed_form) {
    const Inspection upright = inspected(dimer_in_a_cell(2));
    BOOST_TEST(upright.counting.dof_count == 3);
    BOOST_TEST(upright.counting.contact_count == 2);
    BOOST_TEST_REQUIRE((upright.stable == Verdict::proved), upright.remark);
    const double second = 12 - 2 * (3 + 81.0 / 64); // per radian squared
    const Enclosure found = upright.yielding->second_variation.at(0);
    BOOST_TEST(std::abs(found.value - second / (1 + 2 * 5.25 * 5.25)) <= found.radius);
    BOOST_TEST(found.radius < 1e-9);
    const auto& rate = upright.yielding->length_rate;
    BOOST_TEST(std::abs(rate[0].value - 5.25 * 5.25 / second) <= rate[0].radius);
    BOOST_TEST(std::abs(rate[1].value + 5.25 * 5.25 / second) <= rate[1].radius);
    BOOST_TEST(rate[1].radius < 1e-6);
    for (const double g : {1.0, 1.42}) { // positive above 1.4219
        const Inspection falls = inspected(dimer_in_a_cell(g));
        BOOST_TEST((falls.stable == Verdict::refuted), falls.remark);
        const double scale = 5.25 * 5.25; // s is a length of the cell
        BOOST_TEST(std::abs(falls.second_order.value - (6 * g - 2 * (3 + 81.0 / 64)) / scale) <=
                   falls.second_order.radius);
    }
    BOOST_TEST((inspected(dimer_in_a_cell(1.423)).stable == Verdict::proved));
    // At another load it moves; a tilt without load falls over.
    BOOST_TEST((inspected(dimer_in_a_cell(2, 1, 1.1)).stable == Verdict::undecided));
    BOOST_TEST((inspected(dimer_in_a_cell(2, 1, 1, R"("x", "y", "xy")")).stable == Verdict::undecided));
    // One period moves; the size of the cell would be another potential.
    State leaning = dimer_that_leans_along_one_period();
    const Inspection leans = inspected(leaning);
    BOOST_TEST_REQUIRE((leans.stable == Verdict::proved), leans.remark);
    const Enclosure along = leans.yielding->second_variation.at(0);
    BOOST_TEST(std::abs(along.value - (69.0 / 4 - 3 - 81.0 / 64) / (1 + 5.25 * 5.25)) <= along.radius);
    leaning.packing.cell.keep_shape();
    BOOST_TEST((inspected(leaning).stable == Verdict::undecided));
    // Stored beside the minimum, and off the grid of the cell.
    State beside = dimer_in_a_cell(2);
    for (std::size_t k = 0; k < 4; ++k) {
        beside.packing.q[k] += 1.0 / 3;
    }
    beside.packing.q[2] += 0x1p-30;
    beside.packing.q[3] -= 0x1p-30;
    const auto near = required(inspect_mechanism(beside, count_contacts(beside.packing, beside.contacts)));
    BOOST_TEST((near.stable == Verdict::proved), near.remark);
    BOOST_TEST(near.away > 0x1p-31);
    BOOST_TEST(near.away < 0x1p-26);
}

BOOST_AUTO_TEST_CASE(bodies_in_space_have_minima_along_mechanisms) {
    const State corner = sphere_in_a_corner();
    BOOST_TEST((inspected(corner).stable == Verdict::proved));
    const auto hanging = required(inspect_mechanism(corner, count_contacts(corner.packing, corner.contacts)));
    BOOST_TEST((hanging.stable == Verdict::proved), hanging.remark);
    BOOST_TEST(hanging.record.mechanisms == 2);
    BOOST_TEST(hanging.curvature > 7.99); // 49/8 per radian squared, of an arm of 7/8
    BOOST_TEST(hanging.curvature < 8 * (1 + 1e-9));
    State standing = corner;
    for (std::size_t a = 0; a < 3; ++a) {
        standing.packing.q[3 + a] = 2 - corner.packing.q[3 + a];
    }
    BOOST_TEST((inspected(standing).stable == Verdict::refuted));
    const State cell = spheres_in_a_cell(2);
    const auto upright = required(inspect_mechanism(cell, count_contacts(cell.packing, cell.contacts)));
    BOOST_TEST((upright.stable == Verdict::proved), upright.remark);
    const double least = (18 - 3888.0 / 343) / 108; // two coordinates of the member at the square arm 108 are held
    BOOST_TEST(upright.curvature < least * (1 + 1e-9));
    BOOST_TEST(upright.curvature > least * 0.999);
    BOOST_TEST((inspected(spheres_in_a_cell(1)).stable == Verdict::refuted));
}

/// The area times the potential of true stresses: lengths that move against each other lower it.
BOOST_AUTO_TEST_CASE(under_true_stresses_the_second_variation_has_the_term_of_the_lengths) {
    const Inspection turned = inspected(turned_rectangle(1, 1));
    BOOST_TEST_REQUIRE((turned.stable == Verdict::proved), turned.remark);
    const Enclosure second = turned.yielding->second_variation.at(0);
    BOOST_TEST(std::abs(second.value - 8320.0 / 4169) <= second.radius); // X and Y move by half of the lengths
    BOOST_TEST(second.radius < 1e-9);
    const auto& rate = turned.yielding->length_rate;
    BOOST_TEST(std::abs(rate[0].value - 150.0 / 169) <= rate[0].radius);
    BOOST_TEST(std::abs(rate[1].value + 150.0 / 169) <= rate[1].radius);
    BOOST_TEST(rate[1].radius < 1e-6);
    // The forces are sigma_1 L_y and sigma_2 L_x: lengths of 60/13 that change by -+150/169.
    BOOST_TEST(std::abs(turned.yielding->down.stress - 5.0 / 31) < 1e-9);
    BOOST_TEST(std::abs(turned.yielding->up.stress - 6.2) < 1e-9);
    BOOST_TEST((inspected(turned_rectangle(1, 1.1)).stable == Verdict::undecided));
    // Under dead loads 4/3 of each other every angle is neutral; under the true stresses of the same forces it falls.
    State falls = oval_in_a_box(4, 3, std::atan2(5, 12));
    BOOST_TEST((inspected(falls).stable == Verdict::undecided));
    falls.load.kind = LoadKind::true_stress;
    falls.load.stress = {98, 45};
    BOOST_TEST((inspected(falls).stable == Verdict::refuted));
    // With forces on disks they have no potential.
    State loaded = turned_rectangle(1, 1);
    loaded.load.disk_force.assign(16, 0);
    BOOST_TEST((inspected(loaded).stable == Verdict::proved));
    loaded.load.disk_force[1] = 0x1p-40;
    BOOST_TEST((inspected(loaded).stable != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(a_dimer_across_a_box_under_another_load_moves) {
    const Inspection inspection = inspected(dimer_across(3, 4.1));
    BOOST_TEST(!inspection.equilibrium);
    BOOST_TEST(inspection.remark.find("mechanism moves") != std::string::npos, inspection.remark);
}

BOOST_AUTO_TEST_CASE(equal_members_lying_flat_have_a_self_stress) {
    const State flat = clumps_of(R"({"format": "isostat-state", "version": 2, "length": [4, 2],
        "disks": [[1, 1, 1], [3, 1, 1]], "bars": [[0, 1, 2]],
        "contacts": [[0, "left"], [0, "bottom"], [1, "bottom"], [1, "right"], [0, "top"], [1, "top"]]})");
    const isostat::Counting counting = certify(flat).counting;
    BOOST_TEST(counting.dof_count == 5);
    BOOST_TEST(counting.contact_count == 6);
    BOOST_TEST(counting.hyperstaticity == 1);
    BOOST_TEST(counting.mechanisms == 0);
}

BOOST_AUTO_TEST_CASE(members_on_one_line_are_refused_until_one_is_off_the_line) {
    const char* const text = R"({{"format": "isostat-state", "version": 2, "length": [6, 2],
        "disks": [[1, 1, 1], [3, 1, 1], [5, 1, 1]{}], "bars": {},
        "contacts": [[0, "left"], [0, "bottom"], [1, "bottom"], [2, "bottom"], [2, "right"], [0, "top"], [1, "top"], [2, "top"]]}})";
    const State line = clumps_of(fmt::format(fmt::runtime(text), "", "[[0, 1, 2], [0, 2, 4], [1, 2, 2]]"));
    BOOST_CHECK_THROW(certify(line), Error);
    const State made_rigid = clumps_of(fmt::format(
        fmt::runtime(text), ", [1, 1.5, 0.25]",
        R"([[0, 1, 2], [0, 3, 0.5], [1, 3, "0x1.07e0f66afed07p+1"], [0, 2, 4], [2, 3, "0x1.01fe03f61bad0p+2"]])"));
    const isostat::Counting counting = certify(made_rigid).counting;
    BOOST_TEST(counting.dof_count == 5);
    BOOST_TEST(counting.contact_count == 8);
    BOOST_TEST(counting.hyperstaticity ==
               3); // three on the bottom and three under the lid: 3 + 3 - 2, less one for the lid
    BOOST_TEST(counting.mechanisms == 0);
}

/// Counts, rattlers, stability of bodies in a box by an independent program.
BOOST_AUTO_TEST_CASE(unions_of_an_independent_program_are_proved_with_its_counts) {
    for (const std::string& name : unions) {
        const State state = clumps(name);
        const auto expected = nlohmann::json::parse(state.provenance)["expected"];
        const Inspection inspection = inspected(state);
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_TEST(inspection.equilibrium, inspection.remark);
        BOOST_TEST((inspection.stable == Verdict::proved));
        const isostat::Bodies bodies(state.packing);
        int rattlers = 0;
        for (const int i : inspection.rattlers) {
            rattlers += bodies.of(i) == i ? 1 : 0;
        }
        BOOST_TEST(rattlers == static_cast<int>(expected["rattlers"].size()));
        BOOST_TEST(inspection.rotational_rattlers.size() == expected["rotational_rattlers"].size());
        BOOST_TEST(inspection.counting.contact_count == expected["N"].get<int>());
        BOOST_TEST(inspection.counting.dof_count - 3 * rattlers == expected["N_f_of_loaded_bodies"].get<int>());
        BOOST_TEST(inspection.counting.hyperstaticity == expected["h"].get<int>());
        BOOST_TEST(inspection.counting.mechanisms - 3 * rattlers == expected["k"].get<int>());
        BOOST_TEST(inspection.record.min_gap <= expected["smallest_other_gap"].get<double>() + 1e-12);
        BOOST_TEST(inspection.record.min_gap > expected["smallest_other_gap"].get<double>() - 1e-9);
        BOOST_TEST(inspection.record.min_gap_bound == 0); // a lower bound
        BOOST_TEST(!inspection.yielding.has_value());     // of free motions W'' is 0, by counting
        for (const auto& value : expected["second_variation"]) {
            BOOST_TEST(std::abs(value.get<double>()) < 1e-9);
        }
    }
}

/// Contacts are closed and bear positive forces, and W'' is negative as the body turns on which a torque acts. Where
/// the angles are free motions the same kinds of packings are proved, above.
BOOST_AUTO_TEST_CASE(places_where_held_angles_bear_torques_are_no_equilibria) {
    const std::vector<State> places = held_angles();
    BOOST_TEST(places.size() == 15U);
    for (std::size_t i = 0; i < places.size(); ++i) {
        BOOST_TEST_INFO_SCOPE("place " << i);
        const Inspection inspection = inspected(places[i]);
        BOOST_TEST((inspection.record.verdict == Verdict::refuted));
        BOOST_TEST((inspection.stable != Verdict::proved));
        BOOST_TEST(inspection.remark.find("the mechanism moves") != std::string::npos, inspection.remark);
        const Certification truth = certify(with_free_motions_held(places[i]));
        BOOST_TEST((truth.verdict != Verdict::proved));
        BOOST_TEST(!truth.claims.minimum.has_value());
        BOOST_TEST(!truth.claims.counting.has_value());
        BOOST_TEST(!truth.claims.stable);
    }
}

/// The caps of an oval between four walls turn by nothing but the load: a minimum up to F_1 / F_2 = 4/3.
BOOST_AUTO_TEST_CASE(an_oval_between_four_walls_rests_up_to_the_ratio_of_its_arms) {
    const auto inspection = required(inspect_mechanism(
        oval_in_a_box(1, 1), count_contacts(oval_in_a_box(1, 1).packing, oval_in_a_box(1, 1).contacts)));
    BOOST_TEST((inspection.stable == Verdict::proved), inspection.remark);
    BOOST_TEST(inspection.record.dof_count == 5);
    BOOST_TEST(inspection.record.contact_count == 4);
    BOOST_TEST(inspection.record.mechanisms == 1);
    BOOST_TEST(inspection.record.force_bound > 0);
    BOOST_TEST(std::abs(inspection.forces[0] - 1) <= inspection.record.force_bound);
    BOOST_TEST(std::isnan(inspection.record.stress_low)); // not asked
    BOOST_TEST(inspection.record.opens_low.i == -1);
    BOOST_TEST(std::isinf(inspection.record.min_gap)); // no pair is left
    BOOST_TEST(inspection.curvature < 2.0 / 9);        // 2 per radian squared: of a cap, that moves by 3, or of a flank
    BOOST_TEST(inspection.curvature > 0.124);
    const Enclosure upright = inspection.yielding->second_variation.at(0);
    BOOST_TEST(std::abs(upright.value - 2) <= upright.radius); // no body and no wall moves but the angle
    BOOST_TEST(upright.radius < 1e-9);
    BOOST_TEST(inspection.yielding->down.flattens); // W'' = 8 F_2 - 6 F_1 per radian squared, and nothing moves
    BOOST_TEST(std::abs(inspection.yielding->down.stress - 0.75) < 1e-9);
    BOOST_TEST(!inspection.yielding->up.flattens);
    const auto stable = [](double f1, double f2, double angle = 0) {
        return inspected(oval_in_a_box(f1, f2, angle)).stable;
    };
    BOOST_TEST((stable(3.99, 3) == Verdict::proved));
    BOOST_TEST((stable(4.01, 3) == Verdict::refuted));
    BOOST_TEST((stable(4, 3) == Verdict::undecided));
    BOOST_TEST((stable(1, 1, 0x1p-40) == Verdict::proved)); // a minimum is near
    BOOST_TEST((stable(1, 1, 0.1) != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(the_unit_of_length_of_an_oval_does_not_matter) {
    for (const double unit : {0x1p-300, 0x1p300}) {
        State state = oval_in_a_box(1, 1);
        units::stretch(state.packing, unit);
        BOOST_TEST((inspected(state).stable == Verdict::proved), unit);
    }
}

/// A force g upwards on the right cap turns the oval: tan theta = 3 g / (8 F_2 - 6 F_1 - 4 g), here 5/12 with g = 5/28.
BOOST_AUTO_TEST_CASE(a_turned_oval_yields_at_the_rate_of_its_closed_form) {
    State state = oval_in_a_box(1, 1, std::atan2(5, 12));
    state.load.disk_force = {0, 5.0 / 28, 0, 0, 0, 0, 0, 0};
    const Inspection inspection = inspected(state);
    BOOST_TEST_REQUIRE((inspection.stable == Verdict::proved), inspection.remark);
    BOOST_TEST_REQUIRE(inspection.yielding.has_value());
    const double turning = 144.0 / 169 * -70 / 27; // of the angle, per unit of F_2
    const auto& lengths = inspection.yielding->length_rate;
    BOOST_TEST(std::abs(lengths[0].value + 6 * 5.0 / 13 * turning) <= lengths[0].radius);
    BOOST_TEST(std::abs(lengths[1].value - 8 * 5.0 / 13 * turning) <= lengths[1].radius);
    BOOST_TEST(lengths[1].radius < 1e-6);
    // W'' = (8 F_2 - 6 F_1 - 4 g) cos + 3 g sin per radian squared; the middle moves by 3 sin and 4 sin, the walls
    // twice.
    const Enclosure second = inspection.yielding->second_variation.at(0);
    BOOST_TEST(std::abs(second.value - (9.0 / 7 * 12 / 13 + 15.0 / 28 * 5 / 13) / (1 + 125.0 * 25 / 169)) <=
               second.radius);
    BOOST_TEST(second.radius < 1e-9);
    // The forces of the walls are F_1 on both sides, F_2 on the lid and F_2 - g on the bottom, which would open
    // at 5/28. Before, d2W on the held coordinate would vanish, by its difference between two such equilibria.
    const auto form = [&state](double f2) {
        State near = oval_in_a_box(1, f2, std::atan2(3 * 5.0 / 28, 8 * f2 - 6 - 4 * 5.0 / 28));
        near.load.disk_force = state.load.disk_force;
        const Interval entry = certify(with_free_motions_held(near)).claims.minimum.value().form.at(0);
        return (entry.lower + entry.upper) / 2;
    };
    const double rate = (form(1 + 0x1p-13) - form(1 - 0x1p-13)) / 0x1p-12;
    BOOST_TEST(inspection.yielding->down.flattens);
    BOOST_TEST(inspection.yielding->down.stress == 1 - form(1) / rate, boost::test_tools::tolerance(1e-6));
    BOOST_TEST((inspection.yielding->up.contact.i == -1)); // it turns back between the walls
}

/// The circles of the flanks reach beyond the oval: what they touch there the oval does not.
BOOST_AUTO_TEST_CASE(a_contact_at_a_joint_or_beyond_is_no_contact_of_arcs) {
    const double joint = std::atan2(4, 3);
    State at_joint = oval_in_a_box(1, 1, joint); // the wall is level with a joint: cap and flank touch it both
    BOOST_TEST((inspected(at_joint).stable != Verdict::proved));
    // Turned by a load to near where the flank ends, tan theta = 3/4 at g = 1/4, and stored beside the minimum.
    const auto turned = [](double g, double beside) {
        State state = oval_in_a_box(1, 1, std::atan(3 * g / (2 - 4 * g)) - beside);
        state.load.disk_force = {0, g, 0, 0, 0, 0, 0, 0};
        return inspected(state).stable;
    };
    BOOST_TEST((turned(0.25 - 1e-8, 0) == Verdict::proved));
    BOOST_TEST((turned(0.25 - 1e-3, 1e-7) == Verdict::proved));
    BOOST_TEST((turned(0.25 - 1e-8, 1e-7) != Verdict::proved)); // the joint is as near as the minimum may be
    const auto beyond = inspected(circle_of_an_oval_in_a_corner());
    BOOST_TEST((beyond.stable != Verdict::proved));
    BOOST_TEST(beyond.remark.find("not inside the arcs") != std::string::npos, beyond.remark);
    BOOST_TEST(!certify(with_free_motions_held(circle_of_an_oval_in_a_corner())).claims.minimum.has_value());
}

/// Stored, the arcs turn to the left; where the bars have their lengths, the joints 0-1 and 1-2 are in the other order.
BOOST_AUTO_TEST_CASE(a_ring_that_is_convex_only_as_it_is_stored_proves_nothing) {
    const State state = isostat::test::clumps_of(R"({"format": "isostat-state", "version": 2, "length": [100, 100],
        "walls": {"lower": ["absent", "absent"], "upper": ["absent", "absent"]},
        "load": {"stress": [0, 0], "reference_length": [1, 1]}, "contacts": [], "arcs": [[0, 1, 2, 3, 4]],
        "disks": [[0, 0, 5.796875], [0.07743, 0.7931, 5], [-0.01775, -0.20236, 6], [-0.1432, -0.38156, 5.78125],
                  [-0.8586, 0.14893, 6.671875]],
        "bars": [[0, 1, 0.796875], [0, 4, 0.875], [1, 2, 1], [1, 3, 1.195383822673135], [1, 4, 1.1378028342522102],
                 [2, 3, 0.21875], [3, 4, 0.890625]]})");
    const auto found = certify(with_free_motions_held(state));
    BOOST_TEST(found.claims.vertex.has_value()); // 0.003 away
    BOOST_TEST(!found.claims.gaps.has_value());
    BOOST_TEST(!found.claims.stable);
}

/// The cap touches the bottom 1e-11 beside the joint with the flank, whose circle reaches 2.5e-22 below: in doubles
/// both arcs are as near.
BOOST_AUTO_TEST_CASE(an_oval_that_touches_beside_a_joint_is_not_said_to_overlap) {
    const State state = isostat::test::clumps_of(R"({"format": "isostat-state", "version": 2, "length": [100, 100],
        "walls": {"lower": ["fixed", "fixed"], "upper": ["absent", "absent"]},
        "load": {"stress": [0, 0], "reference_length": [1, 1]}, "arcs": [[3, 0, 1, 2]],
        "disks": [[20, 1, 1], [15.199999999986, -0.39999999995199964, 6], [15.200000000036, 4.600000000048, 1],
                  [20.00000000005, 6, 6]],
        "bars": [[0, 1, 5], [0, 2, 6], [0, 3, 5], [1, 2, 5], [2, 3, 5]],
        "contacts": [["held", 0], ["held", 1], ["held", 6]]})");
    const auto found = certify(state);
    BOOST_TEST(found.claims.vertex.has_value());
    BOOST_TEST(!found.claims.gaps.has_value());
    BOOST_TEST(found.refuted.empty());
}

/// Newton's method and elimination in 200 digits, which share nothing with the program.
BOOST_AUTO_TEST_CASE(intervals_of_the_forces_of_clumps_hold_those_of_200_digits) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_1"}) {
        const State state = with_free_motions_held(clumps(name));
        const Certification truth = certify(state);
        const isostat::oracle::Truth digits(state);
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_TEST_REQUIRE(digits.known, digits.why);
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            const isostat::oracle::Real& f = digits.force[l];
            BOOST_TEST((isostat::oracle::Real(truth.finite[l].lower) <= f + 1e-60 &&
                        f - 1e-60 <= isostat::oracle::Real(truth.finite[l].upper)),
                       isostat::to_string(state.contacts[l]));
        }
    }
}

/// N below N_f, and one mechanism for each contact that is missing: W'' is positive along all of them.
BOOST_AUTO_TEST_CASE(ovals_of_an_independent_program_rest_in_strict_minima_with_its_counts) {
    for (const char* const name :
         {"oval_1.1_16_1", "oval_1.1_16_2", "oval_1.1_16_3", "oval_1.4_16_1", "oval_1.4_16_2"}) {
        const State state = clumps(name);
        const auto expected = nlohmann::json::parse(state.provenance)["expected"];
        const Inspection inspection = inspected(state);
        BOOST_TEST_INFO_SCOPE(name);
        BOOST_TEST((inspection.stable == Verdict::proved), inspection.remark);
        const int rattlers = static_cast<int>(expected["rattlers"].size());
        BOOST_TEST(static_cast<int>(inspection.rattlers.size()) == 4 * rattlers); // members
        BOOST_TEST(inspection.counting.contact_count == expected["N"].get<int>());
        BOOST_TEST(inspection.counting.dof_count - 3 * rattlers == expected["N_f_of_loaded_bodies"].get<int>());
        BOOST_TEST(inspection.counting.hyperstaticity == 0);
        BOOST_TEST(inspection.counting.mechanisms - 3 * rattlers == expected["k"].get<int>());
        BOOST_TEST(std::abs(inspection.record.min_gap - expected["smallest_other_gap"].get<double>()) < 1e-9);
        const auto& eigenvalues = inspection.yielding->second_variation;
        BOOST_TEST_REQUIRE(eigenvalues.size() == expected["second_variation"].size());
        for (std::size_t i = 0; i < eigenvalues.size(); ++i) {
            BOOST_TEST(std::abs(eigenvalues[i].value - expected["second_variation"][i].get<double>()) < 1e-9);
            BOOST_TEST(eigenvalues[i].radius > 0);
            BOOST_TEST(eigenvalues[i].radius < 1e-5);
        }
    }
}

/// Forces are positive and nothing overlaps, as in the packings above.
BOOST_AUTO_TEST_CASE(a_saddle_of_ovals_is_no_minimum) {
    const State saddle = clumps("saddle_1.1_20_102");
    const Inspection inspection = inspected(saddle);
    BOOST_TEST(!inspection.equilibrium);
    BOOST_TEST((inspection.stable == Verdict::refuted), inspection.remark);
    BOOST_TEST(!inspection.yielding.has_value());
    const Certification truth = certify(with_free_motions_held(saddle));
    BOOST_TEST((truth.verdict != Verdict::proved));
    BOOST_TEST(!truth.claims.minimum.has_value());
    BOOST_TEST(!truth.claims.stable);
}

BOOST_AUTO_TEST_CASE(the_stress_of_clumps_is_that_of_the_walls) {
    const State state = clumps("trimer_20_1");
    const isostat::ForceAverages mean = isostat::force_averages(state, certify(state));
    BOOST_TEST(std::abs(mean.stress[0][0] * state.packing.length(1) - 1) < 1e-9);
    BOOST_TEST(std::abs(mean.stress[1][1] * state.packing.length(0) - 1) < 1e-9);
}
