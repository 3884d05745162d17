#include "core/dot.hpp"
#include "support/disguised_cells.hpp"
#include "support/prepared.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

using namespace isostat;

namespace {

bool contains(const Interval& interval, double value, double width) {
    return interval.lower <= value + 1e-15 && value - 1e-15 <= interval.upper &&
           interval.upper - interval.lower < width;
}

/// The forces of a state, proved at its true vertex.
void check_forces(const State& state, const std::vector<double>& expected) {
    const Certification truth = certify(state);
    BOOST_TEST(truth.claims.vertex.has_value());
    BOOST_TEST_REQUIRE(truth.finite.size() == expected.size());
    for (std::size_t l = 0; l < expected.size(); ++l) {
        BOOST_TEST(contains(truth.finite[l], expected[l], 1e-10),
                   isostat::to_string(state.contacts[l]) << " in [" << truth.finite[l].lower << ", "
                                                         << truth.finite[l].upper << "], not " << expected[l]);
    }
}

StateFile first_equilibrium(const std::string& name) {
    return isostat::read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/" + name + "_16.json");
}

void check_interval(const Certification& truth, double low, double high, double within) {
    BOOST_TEST_REQUIRE(truth.claims.load_interval.has_value());
    const auto& ends = *truth.claims.load_interval;
    BOOST_TEST(std::abs(ends.low.stress.lower - low) < within);
    BOOST_TEST(std::abs(ends.low.stress.upper - low) < within);
    BOOST_TEST(std::abs(ends.high.stress.lower - high) < within);
    BOOST_TEST(std::abs(ends.high.stress.upper - high) < within);
}

/// The same contacts carry the same forces.
void check_same_forces(const State& a, const State& b) {
    const Certification one = certify(a);
    const Certification other = certify(b);
    BOOST_TEST((one.verdict == Verdict::proved));
    BOOST_TEST((other.verdict == Verdict::proved));
    for (std::size_t l = 0; l < a.contacts.size(); ++l) {
        BOOST_TEST((one.finite[l].lower <= other.finite[l].upper && other.finite[l].lower <= one.finite[l].upper));
    }
}

} // namespace

BOOST_AUTO_TEST_CASE(one_disk_bears_the_forces_of_its_periods) {
    const State state = cells::one_disk(2, 3);
    check_forces(state, {3, 2});
    const Certification truth = certify(state);
    BOOST_TEST((truth.verdict == Verdict::proved));
    BOOST_TEST(truth.counting.dof_count == 2);
    BOOST_TEST_REQUIRE(truth.claims.load_interval.has_value());
    BOOST_TEST(contains(truth.claims.load_interval->low.stress, 0, 1e-9));
    BOOST_TEST(truth.claims.load_interval->high.unbounded);
}

BOOST_AUTO_TEST_CASE(one_tilted_disk_bears_pressure_and_shear) {
    const double f1 = 2, f2 = 1;
    for (const double t : {0.0, 0.25, -0.5}) {
        const double half = f2 / std::sqrt(3.0);
        check_forces(cells::one_tilted_disk(f1, f2, t), {half + t, half - t, f1 - (half - t) / 2});
    }
}

BOOST_AUTO_TEST_CASE(a_shear_beyond_what_the_tilt_bears_is_refuted) {
    BOOST_TEST((certify(cells::one_tilted_disk(2, 1, 0.57)).verdict == Verdict::proved));
    BOOST_TEST((certify(cells::one_tilted_disk(2, 1, 0.58)).verdict == Verdict::refuted)); // 1 / sqrt 3 is between
}

BOOST_AUTO_TEST_CASE(own_image_of_two_disks_takes_what_the_centred_rectangle_leaves) {
    State state = cells::two_disks(true, 5, 2);
    state.contacts.push_back(cells::across(0, 0, 1, 0));
    const double f1 = 5, f2 = 2;
    for (const double t : {0.0, 0.3}) {
        state.load.shear = {t};
        const double even = f2 * 2 / (2 * 1.6);
        const double odd = t * 2 / (2 * 1.2);
        const Certification truth = certify(state);
        BOOST_TEST((truth.claims.vertex.has_value()));
        // Contacts (0, 0) and (-1, -1) share a line, as do (-1, 0) and (0, -1); the shear tells the two pairs apart.
        BOOST_TEST(contains(truth.finite[0], truth.finite[3].lower, 1e-10));
        BOOST_TEST(contains(truth.finite[1], truth.finite[2].lower, 1e-10));
        BOOST_TEST(std::abs(truth.finite[0].lower + truth.finite[1].lower - 2 * even) < 1e-10);
        BOOST_TEST(std::abs(std::abs(truth.finite[0].lower - truth.finite[1].lower) - 2 * odd) < 1e-10);
        BOOST_TEST(contains(truth.finite[4], f1 - f2 * 1.2 / 1.6, 1e-10));
    }
}

BOOST_AUTO_TEST_CASE(one_disk_in_a_channel) {
    const State state = cells::channel_disk();
    check_forces(state, {2, 3, 3});
    BOOST_TEST((certify(state).verdict == Verdict::proved));
    BOOST_TEST(certify(state).counting.dof_count == 3);
}

// Two disks R1 > R2 in a channel: one rests in the gap that the images of the other leave, or stands on it. Between the
// ratios F2/F1 = (R1 - R2)/sqrt(R1 R2) and 2h/R1 both are equilibria.
BOOST_AUTO_TEST_CASE(two_disks_in_a_channel_have_the_two_states_of_a_loop) {
    for (const auto& [large, small] : {std::pair(2.0, 1.0), {1.5, 0.8}, {1.0, 0.75}}) {
        BOOST_TEST_INFO_SCOPE("radii " << large << ", " << small);
        const double tilt = (large - small) / (large + small); // of the line of centres
        const double pair = 1 / std::sqrt(1 - tilt * tilt);    // of which F1 is the part along x
        State pressed = cells::between_images(large, small);
        pressed.load.stress[1] = 4;
        check_forces(pressed, {4 - 2 * pair * tilt, 4, 2 * pair * tilt, pair, pair});
        const double opens = (large - small) / std::sqrt(large * small);
        pressed.load.stress[1] = opens * 1.001;
        BOOST_TEST((certify(pressed).verdict == Verdict::proved));
        pressed.load.stress[1] = opens * 0.999;
        BOOST_TEST((certify(pressed).verdict == Verdict::refuted));

        const double reach = large + small;
        const double rise = std::sqrt(reach * reach - large * large);
        State high =
            cells::in_channel({{large, 0, large}, {small, large, large + rise}}, 2 * large, large + rise + small, 1, 1,
                              {crafted::bottom(0), crafted::top(1), cells::across(0, 1, 0, 0),
                               cells::across(0, 1, -1, 0), cells::across(0, 0, 1, 0)});
        const double back = 2 * rise / large;
        const double f2 = 0.5 * back;
        high.load.stress[1] = f2;
        const double bears = f2 * reach / (2 * rise);
        check_forces(high, {f2, f2, bears, bears, 1 - bears * large / reach});
        high.load.stress[1] = back * 0.999;
        BOOST_TEST((certify(high).verdict == Verdict::proved));
        high.load.stress[1] = back * 1.001;
        BOOST_TEST((certify(high).verdict == Verdict::refuted));
    }
}

BOOST_AUTO_TEST_CASE(first_equilibria_of_an_independent_program) {
    struct Known {
        const char* name;
        double low, high;
    };
    for (const Known& known :
         {Known{"rect", 0.7027637466432636, 1.3794962837050024}, Known{"tilt", 0.9930651761293112, 1.8029080469581122},
          Known{"channel", 0.519226501649397, 1.0005767055665702}}) {
        BOOST_TEST_INFO_SCOPE(known.name);
        const StateFile file = first_equilibrium(known.name);
        const Certification truth = certify(file.state);
        BOOST_TEST((truth.verdict == Verdict::proved));
        BOOST_TEST(truth.counting.rank == static_cast<int>(file.state.contacts.size()));
        for (std::size_t l = 0; l < file.forces.size(); ++l) {
            BOOST_TEST(std::abs(truth.finite[l].lower - file.forces[l]) < 1e-9);
            BOOST_TEST(std::abs(truth.finite[l].upper - file.forces[l]) < 1e-9);
        }
        check_interval(truth, known.low, known.high, 1e-9);
    }
}

BOOST_AUTO_TEST_CASE(forces_do_not_depend_on_the_pin_the_representatives_the_names_the_basis_and_the_axes) {
    for (const char* name : {"rect", "tilt", "channel"}) {
        const State state = first_equilibrium(name).state;
        State other = state;
        other.packing.cell.pin = 5;
        check_same_forces(state, other);
    }
    // Dead forces: in another basis F1 takes what the tilt had.
    const State tilt = first_equilibrium("tilt").state, rect = first_equilibrium("rect").state;
    std::vector<isostat::Image> shift(tilt.packing.radius.size());
    shift[3] = cells::image(1, 0);
    shift[7] = cells::image(0, -1);
    shift[8] = cells::image(-1, 1);
    check_same_forces(tilt, cells::shifted(tilt, shift).state);
    check_same_forces(tilt, cells::in_other_basis(tilt, 1).state);
    check_same_forces(rect, cells::reversed(rect).state);
    check_same_forces(rect, cells::transposed(rect).state);
}

BOOST_AUTO_TEST_CASE(a_rattler_must_not_overlap_an_image) {
    for (const double radius : {0.3, 0.5}) {
        const Certification truth = certify(cells::with_a_rattler(radius));
        BOOST_TEST(truth.signs.structural_zero == 2);
        BOOST_TEST((truth.verdict == (radius < 0.4 ? Verdict::proved : Verdict::refuted)));
    }
}

BOOST_AUTO_TEST_CASE(jammed_in_words_that_the_counts_prove) {
    const State rect = first_equilibrium("rect").state;
    const isostat::CellInspection r = isostat::inspect_cell(rect, certify(rect));
    BOOST_TEST((r.collective.verdict == Verdict::proved));
    BOOST_TEST((r.strict.verdict == Verdict::refuted)); // one shear of the cell is left
    BOOST_TEST_REQUIRE(r.backbone.has_value());
    BOOST_TEST(r.backbone_disks == 15);
    const auto& rows = *r.backbone;
    const std::vector<int> dofs{28, 29, 30, 31};
    const std::vector<int> h{2, 1, 0, 0};
    const std::vector<int> k{0, 0, 0, 1};
    for (std::size_t s = 0; s < 4; ++s) {
        BOOST_TEST(rows[s].dof_count == dofs[s]);
        BOOST_TEST(rows[s].contact_count == 30);
        BOOST_TEST(rows[s].hyperstaticity == h[s]);
        BOOST_TEST(rows[s].mechanisms == k[s]);
        BOOST_TEST((rows[s].rank_exact == Verdict::proved));
    }
    const State tilt = first_equilibrium("tilt").state;
    const isostat::CellInspection t = isostat::inspect_cell(tilt, certify(tilt));
    BOOST_TEST((t.collective.verdict == Verdict::proved));
    BOOST_TEST((t.strict.verdict == Verdict::proved)); // sigma_2 = 1 is a pressure, between 0.993 and 1.803
    BOOST_TEST(t.all[3].mechanisms == 0);
    const State square = cells::square_lattice(3, false);
    const isostat::CellInspection s = isostat::inspect_cell(square, certify(square));
    BOOST_TEST((s.collective.verdict == Verdict::undecided));
    BOOST_TEST(!s.backbone.has_value());
}

BOOST_AUTO_TEST_CASE(jammed_strictly_is_told_by_the_forces_under_a_pressure) {
    const auto strict = [](const State& state) { return isostat::inspect_cell(state, certify(state)).strict.verdict; };
    // L = (2, sqrt 3), t = 1: under a pressure F1/F2 = sqrt 3/2, whatever the load of the state.
    BOOST_TEST((strict(cells::one_tilted_disk(1, 2 / std::sqrt(3.0), 0)) == Verdict::proved));
    BOOST_TEST((strict(cells::one_tilted_disk(1, 0.125, 0)) == Verdict::proved));
    BOOST_TEST((strict(cells::one_tilted_disk(1, 0.5, 0.125)) == Verdict::proved)); // under a shear too
    BOOST_TEST((strict(cells::one_disk(1, 1)) == Verdict::refuted));                // no tilt
    // Own image in a centred rectangle, X = 1.2, Y = 1.6: f = F1 - F2 X/Y, at F1/F2 = Y/X. With the image along the
    // longer period in its place, X = 1.6 and Y = 1.2 do not touch.
    State state = cells::two_disks(true, 5, 2);
    state.contacts.push_back(cells::across(0, 0, 1, 0));
    state.load.shear = {0.25};
    BOOST_TEST((strict(state) == Verdict::proved));
    // The tilted equilibrium at the end of its interval, above the pressure: the forces at the pressure are the same.
    State tilt = first_equilibrium("tilt").state;
    tilt.load.stress[1] = 1.75;
    BOOST_TEST((strict(tilt) == Verdict::proved));
    // Other reference lengths: the pressure is at another nominal stress.
    tilt.load.stress[1] = 3.5;
    tilt.load.reference_length[0] /= 2;
    BOOST_TEST((strict(tilt) == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(an_own_image_that_touches_along_a_fixed_period_is_counted) {
    // The triangular lattice of one disk: its image along x touches, and L_x does not move. C7 (a) said: refuted.
    const auto one = [](double width) {
        State state = cells::in_cell({{1, 0.25, 0.5}}, {width, std::sqrt(4 - width * width / 4), width / 2}, true, 1, 1,
                                     {cells::across(0, 0, 0, 1), cells::across(0, 0, 1, -1)});
        state.packing.cell.period_moves[0] = false;
        return isostat::inspect_cell(state, certify(state));
    };
    const isostat::CellInspection touching = one(2), apart = one(2.125);
    BOOST_TEST((touching.strict.verdict == Verdict::proved), touching.strict.reason);
    BOOST_TEST((apart.strict.verdict == Verdict::refuted), apart.strict.reason);
    BOOST_TEST_REQUIRE(touching.backbone.has_value());
    for (std::size_t s = 0; s < 4; ++s) {
        const Counting &all = touching.all[s], &backbone = (*touching.backbone)[s];
        BOOST_TEST(all.contact_count == 3);
        BOOST_TEST(all.mechanisms == 0);
        BOOST_TEST(backbone.contact_count == 3);
        BOOST_TEST(backbone.mechanisms == 0);
        BOOST_TEST(apart.all[s].contact_count == 2);
    }
    BOOST_TEST(apart.all[3].mechanisms == 1);
    // Along a column, L_y and the tilt at rest: two strains are short, an image closes one.
    State column = cells::in_cell({{1, 0, 0}}, {2, 2, 0}, false, 1, 1, {cells::across(0, 0, 1, 0)});
    column.packing.cell.period_moves[1] = false;
    const isostat::CellInspection c = isostat::inspect_cell(column, certify(column));
    BOOST_TEST((c.collective.verdict == Verdict::proved));
    BOOST_TEST((c.strict.verdict == Verdict::refuted), c.strict.reason);
    BOOST_TEST(c.all[3].contact_count == 2);
    BOOST_TEST(c.all[3].mechanisms == 1);
}

BOOST_AUTO_TEST_CASE(own_images_of_rattlers_leave_the_strict_answer_open) {
    // Rows of disks of radius 1 between rows of a disk that is as wide and bears nothing.
    State state = cells::in_cell({{1, 0, 0}, {1, 1, 4}}, {2, 8, 1}, true, 1, 1, {});
    state.packing.cell.period_moves[0] = false;
    BOOST_TEST((isostat::inspect_cell(state, certify(state)).strict.verdict == Verdict::undecided));
    BOOST_TEST(isostat::inspect_cell(state, certify(state)).all[3].contact_count == 2);
}

BOOST_AUTO_TEST_CASE(states_with_a_mechanism_are_counted_not_followed) {
    fails(isostat::inspect_vertex(cells::in_cell({{1, 0, 0}}, {2, 2, 0}, true, 1, 1,
                                                 {cells::across(0, 0, 0, 1), cells::across(0, 0, 1, 0)})),
          isostat::FailureKind::not_isostatic, {"N_f = 3, N = 2, rank 2, h = 0, k = 1"});
}

namespace {

State isotropic(std::uint64_t seed) {
    isostat::PreparationOptions options{.disks = 30, .seed = seed, .aspect = 1.25};
    options.cell = isostat::PreparedCell::isotropic;
    return prepared(options);
}

/// Power of the finite forces in a stretch of the whole cell, the disks at rest, and how far they are from balance on
/// the disks: in doubles, with geometry of its own.
std::array<double, 2> power_and_imbalance(const State& state, const Certification& truth) {
    const auto& p = state.packing;
    std::vector<double> balance(2 * p.radius.size(), 0.0);
    double power = 0;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& c = state.contacts[l];
        const double f = 0.5 * (truth.finite[l].lower + truth.finite[l].upper);
        const std::array<double, 2> periods{c.image.m[0] * p.length(0) + c.image.m[1] * p.lattice(0, 1),
                                            c.image.m[1] * p.length(1)};
        const auto i = static_cast<std::size_t>(2 * c.i), j = static_cast<std::size_t>(2 * c.j);
        std::array<double, 2> r{};
        for (std::size_t a = 0; a < 2; ++a) {
            r[a] = p.q[j + a] - p.q[i + a] + periods[a];
        }
        const double d = std::hypot(r[0], r[1]);
        for (std::size_t a = 0; a < 2; ++a) {
            balance[i + a] -= f * r[a] / d;
            balance[j + a] += f * r[a] / d;
            power += f * r[a] / d * periods[a];
        }
    }
    return {power, isostat::largest(balance)};
}

} // namespace

BOOST_AUTO_TEST_CASE(a_cell_that_keeps_its_shape_bears_a_pressure) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
        const State state = isotropic(seed);
        BOOST_TEST(state.contacts.size() == 2 * state.packing.radius.size() - 1);
        BOOST_TEST(std::abs(state.packing.length(1) / state.packing.length(0) - 1.25) < 1e-12);
        const Certification truth = certify(state);
        BOOST_TEST((truth.verdict == Verdict::proved));
        const auto [power, imbalance] = power_and_imbalance(state, truth);
        BOOST_TEST(power > 0); // what a pressure presses on
        BOOST_TEST(imbalance < 1e-9);
        const auto cell = isostat::inspect_cell(state, truth);
        BOOST_TEST(cell.all[1].hyperstaticity == 0);
        BOOST_TEST(cell.all[1].mechanisms == 0);
        BOOST_TEST((cell.collective.verdict == Verdict::proved));
        BOOST_TEST((cell.strict.verdict == Verdict::refuted));
        // C13 (a): the period along x alone gives the same forces, times one factor.
        State other = state;
        other.packing.cell.keeps_shape = false;
        other.packing.cell.period_moves = {true, false};
        const Certification along_x = certify(other);
        BOOST_TEST((along_x.verdict == Verdict::proved));
        double least = HUGE_VAL, most = 0;
        for (std::size_t l = 0; l < state.contacts.size(); ++l) {
            if (truth.structural_zero[l] == 0) {
                const double ratio = along_x.finite[l].lower / truth.finite[l].lower;
                least = std::min(least, ratio);
                most = std::max(most, ratio);
            }
        }
        BOOST_TEST(most / least - 1 < 1e-6);
        BOOST_TEST(least > 0);
        // Another basis of the lattice, whose tilt makes a stretch of x do little work.
        check_same_forces(state, cells::in_other_basis(state, 1).state);
    }
}

BOOST_AUTO_TEST_CASE(a_cell_that_keeps_its_shape_is_not_pulled) {
    State pulled = isotropic(1);
    pulled.load.stress = {-1, -1};
    BOOST_TEST((certify(pulled).verdict == Verdict::refuted));
}
