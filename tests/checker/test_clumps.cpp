// Certificates of clumps: bars and held coordinates, and what a forger makes of them.
#include "checker/claims.hpp"
#include "checker/evidence.hpp"
#include "checker/strut.hpp"
#include "checker/vertex.hpp"
#include "support/bad_input.hpp"
#include "support/clumps.hpp"
#include "support/forger.hpp"

using namespace claims;
using namespace isostat::test;

namespace {

Certificate of_clumps(const State& state) {
    const State held = with_free_motions_held(state);
    return certificate_of(held, certify(held).claims);
}

/// A claim about all that is held, with a diagonal form that says no more than its curvature, so that what a forger
/// changes besides is judged by the rest.
Certificate with_a_minimum(Certificate certificate, double away, double curvature) {
    MinimumClaim claim{away, curvature};
    const std::vector<Contact>& list = certificate.state.contacts;
    std::ranges::copy_if(list, std::back_inserter(claim.held),
                         [](const Contact& contact) { return contact.kind == ContactKind::held; });
    for (std::size_t i = 0; i < claim.held.size(); ++i) {
        claim.form.push_back({1.01 * curvature, 1e9});
        claim.form.insert(claim.form.end(), claim.held.size() - i - 1, Interval{0, 0});
    }
    certificate.claims.minimum = claim;
    return certificate;
}

/// What the checker says of such a claim about a state.
Verdict on_a_minimum_of(const State& state, double curvature = 1e-3) {
    return read_and_verified(with_a_minimum(of_clumps(state), 1, curvature)).verdict;
}

/// The minimum that is certified is proved again.
Verification verified_minimum(const Certificate& certificate) {
    BOOST_REQUIRE(certificate.claims.minimum.has_value());
    const Verification verification = read_and_verified(certificate);
    BOOST_TEST((verification.verdict == Verdict::proved), verification.checks.back().detail);
    return verification;
}

using NamedForgeries = std::vector<std::pair<const char*, std::function<void(Certificate&)>>>;

void none_verifies(const Certificate& right, const NamedForgeries& forgeries) {
    for (const auto& [what, forge] : forgeries) {
        Certificate forged = right;
        forge(forged);
        BOOST_TEST((verify(forged).verdict != Verdict::proved), what);
    }
}

Certificate with_a_vague_form(const Certificate& certificate) {
    return with_a_minimum(certificate, certificate.claims.minimum->away, certificate.claims.minimum->curvature);
}

} // namespace

BOOST_AUTO_TEST_CASE(members_that_lie_level_bear_one_force_where_nothing_else_presses_on_them) {
    const auto equal = [](const State& state) {
        const isostat::checker::Evidence evidence(state, CheckerArithmetic::automatic);
        const auto at = [&state](int member) {
            return static_cast<std::size_t>(std::ranges::find(state.contacts, pair_of(member, 2)) -
                                            state.contacts.begin());
        };
        return isostat::checker::equal_by_place(evidence, evidence.finite_load, {}, at(0), at(1));
    };
    BOOST_TEST(equal(perch(1, 1, 3)));
    BOOST_TEST(!equal(notch(1, 1))); // the side walls press on the dimer
    State unequal = perch(1, 1, 3);
    unequal.packing.radius[1] += 0x1p-53;
    BOOST_TEST(!equal(unequal));
    State pushed = perch(1, 1, 3);
    pushed.load.disk_force[2] = 0x1p-40;
    BOOST_TEST(!equal(pushed));
}

/// A side wall that one body touches bears what the other one does, whatever presses on the top.
BOOST_AUTO_TEST_CASE(an_end_without_limit_is_proved_where_only_the_balance_of_the_whole_keeps_a_force) {
    const Certificate certificate = of_clumps(notch(1, 2));
    BOOST_TEST_REQUIRE(certificate.claims.load_interval.has_value());
    BOOST_TEST(certificate.claims.load_interval->high.unbounded);
    BOOST_TEST((verdict_on(read_and_verified(certificate), "load_interval") == Verdict::proved));
}

BOOST_AUTO_TEST_CASE(what_is_certified_of_clumps_verifies) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_1", "trimer_20_3"}) {
        BOOST_TEST((read_and_verified(of_clumps(clumps(name))).verdict == Verdict::proved), name);
    }
    for (const State& state :
         {lying_dimer(12, 12), disk_with_a_dangling_member(), lying_dimer_in_space(), row_of_dimers()}) {
        const Certificate certificate = of_clumps(state);
        for (const CheckerArithmetic arithmetic : {CheckerArithmetic::singular_value, CheckerArithmetic::fixed64,
                                                   CheckerArithmetic::gmp, CheckerArithmetic::rational}) {
            BOOST_TEST((read_and_verified(certificate, arithmetic).verdict == Verdict::proved));
        }
    }
}

BOOST_AUTO_TEST_CASE(forged_certificates_of_clumps_do_not_verify) {
    struct ClumpForgery {
        const char* claim;
        std::function<void(Certificate&)> forge;
    };
    const Certificate sound = of_clumps(clumps("dimer2_20_2")); // a rattler, three rotational rattlers
    const auto bar = static_cast<std::size_t>(
        std::ranges::find_if(sound.state.contacts, [](const Contact& c) { return c.kind == ContactKind::bar; }) -
        sound.state.contacts.begin());
    const std::vector<ClumpForgery> forgeries{
        {"counting", [](Certificate& c) { ++c.claims.counting->hypostaticity; }},
        {"counting",
         [](Certificate& c) { // as if the bars were contacts
             c.claims.counting->dof_count += 20;
             c.claims.counting->contact_count += 20;
             c.claims.counting->rank += 20;
         }},
        {"counting",
         [](Certificate& c) { // as if what is held were contacts
             c.claims.counting->contact_count += c.claims.counting->hypostaticity;
             c.claims.counting->rank += c.claims.counting->hypostaticity;
             c.claims.counting->hypostaticity = 0;
         }},
        {"forces",
         [bar](Certificate& c) {
             std::swap(c.claims.forces->finite[bar].lower, c.claims.forces->finite[bar].upper);
             c.claims.forces->finite[bar].lower = -c.claims.forces->finite[bar].lower;
             c.claims.forces->finite[bar].upper = -c.claims.forces->finite[bar].upper;
         }},
        {"forces",
         [](Certificate& c) { // a held coordinate is no structural zero
             c.claims.forces->structural_zeros.pop_back();
             c.claims.forces->infinitesimal.pop_back();
             c.claims.forces->finite.back() = {-1e-9, 1e-9};
         }},
        {"forces",
         [](Certificate& c) { // and the multipliers that they have are claimed
             c.state.load.infinitesimal.assign(80, 0.01);
             for (isostat::Interval& f : c.claims.forces->infinitesimal) {
                 f = {-1e3, 1e3};
             }
         }},
        {"forces", [](Certificate& c) { c.state.load.disk_force.assign(80, 1e-3); }},
        {"vertex", [](Certificate& c) { c.state.packing.bars[3].length *= 1 + 1e-6; }},
        {"gaps", [](Certificate& c) { c.claims.gaps->smallest *= 2; }},
        {"gaps", [](Certificate& c) { c.claims.gaps->where = isostat::pair_of(0, 1); }}, // members of one body
        {"load_interval",
         [](Certificate& c) {
             c.claims.load_interval->high.stress.lower += 0.1;
             c.claims.load_interval->high.stress.upper += 0.1;
         }},
        {"load_interval", [bar](Certificate& c) { c.claims.load_interval->low.opens = c.state.contacts[bar]; }},
    };
    BOOST_TEST((read_and_verified(sound).verdict == Verdict::proved));
    for (std::size_t k = 0; k < forgeries.size(); ++k) {
        Certificate forged = sound;
        forgeries[k].forge(forged);
        BOOST_TEST_INFO_SCOPE("forgery " << k);
        const Verification found = read_and_verified(forged);
        BOOST_TEST((found.verdict != Verdict::proved));
        BOOST_TEST((verdict_on(found, forgeries[k].claim) != Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(a_held_coordinate_that_bears_the_load_is_no_equilibrium) {
    Certificate certificate = of_clumps(dimer_across(3, 4.1));
    BOOST_TEST(!certificate.claims.forces);
    // The claims of the same list with the load along the bar: there the force on what is held is 0, not by counting.
    Certificate balanced = of_clumps(dimer_across(3, 4));
    for (Certificate* const forged : {&certificate, &balanced}) {
        forged->claims.counting = isostat::CountingClaim{5, 4, 4, 0, 1};
        forged->claims.vertex = isostat::VertexClaim{1e-9, 1e-6};
        forged->claims.forces =
            isostat::ForcesClaim{{{2.9, 3.1}, {3.9, 4.1}, {2.9, 3.1}, {3.9, 4.2}, {-10, 10}, {-1, 1}}, {}, {}};
        forged->claims.stable = true;
        const Verification found = read_and_verified(*forged);
        BOOST_TEST((verdict_on(found, "counting") == Verdict::proved));
        BOOST_TEST((verdict_on(found, "vertex") == Verdict::proved));
        BOOST_TEST((verdict_on(found, "forces") != Verdict::proved));
        BOOST_TEST((verdict_on(found, "stable") != Verdict::proved));
    }
    BOOST_TEST((verdict_on(read_and_verified(certificate), "forces") == Verdict::refuted));
}

/// Not isostatic: the potential has a minimum along mechanisms, and one claim stands in the place of all others.
BOOST_AUTO_TEST_CASE(a_minimum_along_mechanisms_is_certified_and_verified) {
    for (const State& state : {disk_in_a_corner(), disk_in_a_corner(0x1p-30), two_disks_in_a_corner(),
                               sphere_in_a_corner(), pendulums(-5, -8), flat_beside_steep()}) {
        const Certificate certificate = of_clumps(state);
        BOOST_TEST(!certificate.claims.counting.has_value());
        const Verification verification = verified_minimum(certificate);
        BOOST_TEST((verdict_on(verification, "minimum") == Verdict::proved), verification.checks.back().detail);
        const auto& numbers = verification.checks.back().numbers;
        BOOST_REQUIRE(numbers.size() == 2U);
        BOOST_TEST(numbers[1].second >= certificate.claims.minimum->curvature);
        BOOST_TEST(numbers[1].second < 12.5); // 25/8 per radian squared; of the sphere 49/8, and more per coordinate
    }
    for (const State& state : {disk_in_a_corner(std::acos(-1)), disk_in_a_corner(0.5), dimer_across(3, 4)}) {
        BOOST_TEST(!of_clumps(state).claims.minimum.has_value());
    }
}

/// Of cells and under true stresses: the curvature that the checker finds is that of the closed form, on the held
/// coordinate, a length of the cells.
BOOST_AUTO_TEST_CASE(minima_in_cells_and_under_true_stresses_are_verified_to_their_closed_form) {
    const std::vector<std::pair<State, double>> all{
        {dimer_in_a_cell(2), (12 - 2 * (3 + 81.0 / 64)) / (5.25 * 5.25)},
        {spheres_in_a_cell(2), (18 - 3888.0 / 343) / (3 * 78.0 * 78 / 49)},
        {turned_rectangle(1, 1), 8320.0 / (68 * 68)}}; // a flank moves by 68/13 per radian
    for (const auto& [state, curvature] : all) {
        const Certificate certificate = of_clumps(state);
        const double found = verified_minimum(certificate).checks.back().numbers.at(1).second;
        BOOST_TEST(found == curvature, boost::test_tools::tolerance(1e-6));
        Certificate forged = certificate;
        forged.claims.minimum->curvature = curvature * (1 + 1e-6);
        BOOST_TEST((verify(forged).verdict == Verdict::undecided));
    }
    Certificate leaning = of_clumps(dimer_that_leans_along_one_period());
    BOOST_TEST((verify(leaning).verdict == Verdict::proved));
    leaning.state.packing.cell.keep_shape(); // the size of the cell would be another potential
    BOOST_TEST((verify(leaning).verdict == Verdict::undecided));
    for (const State& state : {dimer_in_a_cell(1), dimer_in_a_cell(1.42), spheres_in_a_cell(1)}) {
        BOOST_TEST(!of_clumps(state).claims.minimum.has_value());
        BOOST_TEST((on_a_minimum_of(state, 1e-6) != Verdict::proved));
    }
}

/// Claims of free motions, where a bar is level with what it hangs from at the held place alone.
BOOST_AUTO_TEST_CASE(what_is_level_where_it_is_held_is_no_free_motion_for_the_checker) {
    for (const double second : {-2.0, 2.0}) {
        Certificate forged = of_clumps(pendulums(-1, second));
        forged.claims = CertificateClaims{};
        forged.claims.counting = CountingClaim{2, 0, 0, 0, 2, Rung::exact};
        forged.claims.vertex = VertexClaim{1e-12, 1e-11, Rung::double_bound};
        ForcesClaim forces;
        for (const Contact& contact : forged.state.contacts) {
            const bool held = contact.kind == ContactKind::held;
            forces.finite.push_back(held ? Interval{0, 0} : Interval{-4, 4});
            if (held) {
                forces.structural_zeros.push_back(static_cast<int>(forces.finite.size()) - 1);
                forces.infinitesimal.push_back({0, 0});
            }
        }
        forged.claims.forces = forces;
        forged.claims.gaps = GapsClaim{4, {ContactKind::disk_disk, 1, 3}, Rung::double_bound};
        forged.claims.load_interval = LoadIntervalClaim{};
        forged.claims.load_interval->low.unbounded = forged.claims.load_interval->high.unbounded = true;
        forged.claims.stable = true;
        const Verification verification = read_and_verified(forged);
        BOOST_TEST((verdict_on(verification, "forces") != Verdict::proved));
        BOOST_TEST((verdict_on(verification, "stable") != Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(minima_of_ovals_are_certified_and_verified) {
    for (const State& state :
         {clumps("oval_1.1_16_1"), clumps("oval_1.4_16_1"), clumps("oval_1.4_16_2"), oval_in_a_box(1, 1)}) {
        verified_minimum(of_clumps(state));
    }
}

BOOST_AUTO_TEST_CASE(forged_minima_of_ovals_do_not_verify) {
    const Certificate right = with_a_vague_form(of_clumps(oval_in_a_box(1, 1)));
    BOOST_TEST((verify(right).verdict == Verdict::proved));
    const NamedForgeries forgeries{
        {"no arcs: circles that overlap the walls", [](Certificate& c) { c.state.packing.arcs.clear(); }},
        {"clockwise",
         [](Certificate& c) {
             c.state.packing.arcs[0] = {3, 2, 1, 0};
         }},
        {"arcs that cross",
         [](Certificate& c) {
             c.state.packing.arcs[0] = {0, 2, 1, 3};
         }},
        {"a bar that is not the difference of the radii",
         [](Certificate& c) {
             c.state.packing.bars[0].length = std::nextafter(5.0, 6.0);
             c.claims.minimum->away = 1e-6;
         }},
        {"a load that turns it", [](Certificate& c) { c.state.load.stress[0] = 1.5; }},
        {"steeper than it is", [](Certificate& c) { c.claims.minimum->curvature = 2; }},
        {"a fixed disk beside it", [](Certificate& c) {
             c.state.packing.fixed = {0, 1, 0, 0};
         }}};
    none_verifies(right, forgeries);
    // What the circle of a flank touches beyond its arc.
    BOOST_TEST((on_a_minimum_of(circle_of_an_oval_in_a_corner()) != Verdict::proved));
    // At a joint, and a hair beside it on either side.
    const double joint = std::atan2(4, 3);
    for (const double off : {0.0, 0x1p-50, -0x1p-50}) {
        BOOST_TEST((on_a_minimum_of(oval_in_a_box(1, 1, joint + off)) != Verdict::proved));
    }
}

/// Straight flanks on each other: bodies that touch, and members that overlap by both heights.
BOOST_AUTO_TEST_CASE(the_smallest_gap_of_ovals_is_that_of_their_nearest_arcs) {
    State state = clumps("oval_1.4_16_2");
    const Certificate certificate = of_clumps(state);
    const checker::Evidence evidence(certificate.state, CheckerArithmetic::automatic, true);
    const auto gaps = checker::smallest_gaps(evidence.problem, certificate.state, evidence.vertex);
    BOOST_TEST_REQUIRE(!gaps.empty());
    const auto expected = nlohmann::json::parse(state.provenance)["expected"]["smallest_other_gap"].get<double>();
    BOOST_TEST(std::abs(gaps.front().value.lower.get_d() - expected) < 1e-9);
}

BOOST_AUTO_TEST_CASE(an_oval_alone_without_walls_has_no_gap) {
    State state = oval_in_a_box(1, 1);
    std::erase_if(state.contacts, [](const Contact& c) { return c.is_unilateral(); });
    for (std::size_t a = 0; a < 2; ++a) {
        state.packing.walls.lower[a] = state.packing.walls.upper[a] = isostat::WallKind::absent;
    }
    state.load.stress = {};
    const Verification verification = read_and_verified(of_clumps(state));
    BOOST_TEST((verification.verdict == Verdict::proved), verification.checks.back().detail);
}

/// Both arcs have the gap, and roundings say which one has the larger: the prover may name the other one.
BOOST_AUTO_TEST_CASE(an_oval_above_a_wall_that_a_joint_points_to_verifies) {
    for (int k = 0; k < 20; ++k) {
        State state = oval_in_a_box(1, 1, std::atan2(4, 3) - std::acos(-1) / 2 + 1e-15 * k);
        std::erase_if(state.contacts, [](const Contact& c) { return c.is_unilateral(); });
        state.packing.walls.upper[0] = state.packing.walls.upper[1] = isostat::WallKind::absent;
        state.load.stress = {};
        for (std::size_t i = 0; i < 8; ++i) {
            state.packing.q[i] += 5 + k * (i % 2 == 0 ? 0.37 : 0.317);
        }
        std::rotate(state.packing.arcs[0].begin(), state.packing.arcs[0].begin() + k % 4, state.packing.arcs[0].end());
        const Verification verification = read_and_verified(of_clumps(state));
        BOOST_TEST((verification.verdict == Verdict::proved), k);
    }
}

BOOST_AUTO_TEST_CASE(forged_minima_do_not_verify) {
    const Certificate right = with_a_vague_form(of_clumps(disk_in_a_corner(0x1p-20)));
    BOOST_TEST((read_and_verified(right).verdict == Verdict::proved));
    const NamedForgeries forgeries{
        {"nearer than it is", [](Certificate& c) { c.claims.minimum->away = 0x1p-22; }},
        {"steeper than it is", [](Certificate& c) { c.claims.minimum->curvature = 12.6; }},
        {"turned by half a radian", [](Certificate& c) { c.state.packing.q[2] = 1.3; }},
        {"a force that pulls off the wall",
         [](Certificate& c) {
             c.state.load.disk_force = {0, 0, 3, 4};
         }},
        {"a torque", [](Certificate& c) { c.state.load.disk_force[2] = -3.5; }},
        {"another arm", [](Certificate& c) { c.state.packing.bars[0].length = 0.7; }},
        {"infinitesimal loads",
         [](Certificate& c) {
             c.state.load.infinitesimal = {0, 0, 1, 0};
         }},
        {"true stresses", [](Certificate& c) { c.state.load.kind = LoadKind::true_stress; }},
        {"a contact left out", [](Certificate& c) { c.state.contacts.erase(c.state.contacts.begin()); }},
        {"a wrong count", [](Certificate& c) { c.claims.counting = CountingClaim{3, 3, 3, 0, 0, Rung::exact}; }}};
    none_verifies(right, forgeries);
    // On its head: where the prover found a minimum below.
    BOOST_TEST((on_a_minimum_of(disk_in_a_corner(std::acos(-1))) != Verdict::proved));
    // What ends the way to it is further than the stored place.
    BOOST_TEST((on_a_minimum_of(disk_that_lands()) == Verdict::undecided));
    // Too far from where it would hang; where the left wall would have to pull.
    for (const double angle : {0.5, 0x1p-9}) {
        BOOST_TEST((on_a_minimum_of(disk_in_a_corner(angle)) == Verdict::undecided));
    }
    Certificate pulled = with_a_vague_form(of_clumps(disk_in_a_corner()));
    pulled.state.packing.q[2] = 1.375;
    pulled.state.load.disk_force[2] = 3;
    BOOST_TEST((verify(pulled).verdict == Verdict::undecided));
    // An isostatic state has no mechanism along which there could be one.
    BOOST_TEST((on_a_minimum_of(lying_dimer(12, 12)) == Verdict::undecided));
    // Two that hang above each other touch: no way is left.
    State near = disk_in_a_corner();
    near.packing.walls.upper[0] = WallKind::fixed;
    near.packing.length(0) = 2 + 0x1p-30;
    BOOST_TEST((read_and_verified(of_clumps(near)).verdict == Verdict::proved));
    near.packing.length(0) = 2;
    BOOST_TEST(!of_clumps(near).claims.minimum.has_value());
    BOOST_TEST((on_a_minimum_of(near) != Verdict::proved));
}

/// Of a sphere that hangs: two coordinates, and an entry between them.
BOOST_AUTO_TEST_CASE(a_forged_form_does_not_verify) {
    const Certificate right = of_clumps(sphere_in_a_corner());
    BOOST_TEST((read_and_verified(right).verdict == Verdict::proved));
    BOOST_TEST_REQUIRE(right.claims.minimum->held.size() == 2U);
    BOOST_TEST_REQUIRE(right.claims.minimum->form.size() == 3U);
    const auto found = [&right](const auto& forge) {
        Certificate forged = right;
        forge(*forged.claims.minimum);
        return verdict_on(read_and_verified(forged), "minimum");
    };
    for (std::size_t entry = 0; entry < 3; ++entry) {
        const Interval true_one = right.claims.minimum->form[entry];
        const double width = true_one.upper - true_one.lower;
        BOOST_TEST(width < 1e-9);
        for (const double by : {-2.0, 2.0}) { // widths
            const auto moved = [&](double share) {
                return [&, share](MinimumClaim& claim) {
                    claim.form[entry] = {true_one.lower + share * width, true_one.upper + share * width};
                };
            };
            BOOST_TEST((found(moved(by)) == Verdict::refuted));
            BOOST_TEST((found(moved(by / 16)) == Verdict::proved)); // the true one is still in there
        }
        const auto narrow = [&](MinimumClaim& claim) { // narrower than any enclosure
            claim.form[entry].lower = claim.form[entry].upper = true_one.lower + width / 2;
        };
        BOOST_TEST((found(narrow) != Verdict::proved));
    }
    const std::vector<std::pair<const char*, std::function<void(MinimumClaim&)>>> forgeries{
        {"in another order", [](MinimumClaim& claim) { std::swap(claim.held[0], claim.held[1]); }},
        {"diagonal entries exchanged", [](MinimumClaim& claim) { std::swap(claim.form[0], claim.form[2]); }},
        {"one coordinate left out",
         [](MinimumClaim& claim) {
             claim.held.pop_back();
             claim.form.resize(1);
         }},
        {"one coordinate twice", [](MinimumClaim& claim) { claim.held[1] = claim.held[0]; }},
        {"says nothing",
         [](MinimumClaim& claim) {
             claim.form.assign(3, {-1e300, 1e300});
         }},
        {"no numbers", [](MinimumClaim& claim) {
             claim.form.assign(3, {-HUGE_VAL, HUGE_VAL});
         }}};
    for (const auto& [what, forge] : forgeries) {
        BOOST_TEST((found(forge) != Verdict::proved), what);
    }
    Certificate short_of_one = right; // as no file is
    short_of_one.claims.minimum->form.pop_back();
    BOOST_TEST((verify(short_of_one).verdict != Verdict::proved));
    short_of_one.claims.minimum->form.push_back({std::nan(""), std::nan("")});
    BOOST_TEST((verify(short_of_one).verdict != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(files_without_the_form_or_with_another_number_of_entries_are_refused) {
    const std::string text = certificate_text(of_clumps(disk_in_a_corner()));
    const std::size_t at = text.find(",\"form\":");
    BOOST_TEST_REQUIRE(at != std::string::npos);
    const std::string form = text.substr(at, text.find("]]", at) + 2 - at);
    const std::vector<std::pair<std::string, std::vector<std::string>>> spoiled{
        {"", {"claims.minimum.form", "missing"}},
        {",\"form\":[]", {"claims.minimum.form", "upper triangle", "1 values, 0 found"}},
        {",\"form\":[[\"nan\",13]]", {"claims.minimum.form[0]", "number"}},
        {",\"form\":[[null,13]]", {"claims.minimum.form[0]", "number"}},
        {",\"form\":[[13,12]]", {"claims.minimum.form[0]", "lower <= upper"}}};
    for (const auto& [by, words] : spoiled) {
        std::string other = text;
        other.replace(at, form.size(), by);
        expect_bad_input([&other = other] { (void)parse_certificate(forger::sealed_certificate(other), "file"); },
                         words);
    }
}

BOOST_AUTO_TEST_CASE(without_bars_nothing_may_be_held) {
    Certificate certificate = of_clumps(disk_with_a_dangling_member());
    State& state = certificate.state;
    state.packing.bars.clear();
    std::erase_if(state.contacts, [](const Contact& c) { return c.kind == ContactKind::bar; });
    certificate.claims.forces.reset();
    BOOST_TEST((read_and_verified(certificate).verdict != Verdict::proved));
}

BOOST_AUTO_TEST_CASE(at_no_stress_the_interval_of_what_is_held_is_refuted) {
    // The lid presses on a dangling member alone: at sigma_2 = 0 nothing turns it, at any other stress it turns.
    const State state = clumps_of(R"({"format": "isostat-state", "version": 2, "length": [2, 3],
        "load": {"stress": [1, 0], "reference_length": [1, 1]}, "disks": [[1, 1, 1], [1.375, 2.5, 0.5]],
        "bars": [[0, 1, "0x1.8bd171a07e38ap0"]],
        "contacts": [[0, "left"], [0, "right"], [0, "bottom"], [1, "top"]]})");
    Certificate certificate = of_clumps(state);
    BOOST_TEST(!certificate.claims.load_interval);
    certificate.claims.load_interval = isostat::LoadIntervalClaim{{true, {}, {}}, {true, {}, {}}};
    certificate.claims.counting = isostat::CountingClaim{5, 4, 4, 0, 1};
    certificate.claims.vertex = isostat::VertexClaim{1e-9, 1e-6};
    const Verification found = read_and_verified(certificate);
    BOOST_TEST((verdict_on(found, "load_interval") == Verdict::refuted));
}

BOOST_AUTO_TEST_CASE(states_whose_bars_differ_are_different_states) {
    const State state = clumps("trimer_20_1");
    State other = state;
    BOOST_TEST(isostat::state_difference(state, other).empty());
    other.packing.bars[7].length = std::nextafter(other.packing.bars[7].length, 10);
    BOOST_TEST(isostat::state_difference(state, other) == "a bar");
}

BOOST_AUTO_TEST_CASE(members_of_one_body_are_no_pair_for_the_checker) {
    const State state = clumps("trimer_20_1");
    BOOST_TEST(!checker::is_free_pair(state, isostat::pair_of(0, 2)));
    BOOST_TEST(checker::is_free_pair(state, isostat::pair_of(0, 3)));
}
