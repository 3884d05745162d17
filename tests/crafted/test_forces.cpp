// Forces, rattlers and degenerate scenes against answers found by other means.
// Enclosed self-stresses and motions against the exact ones, and for lattices that have no exact bases.
#include "crafted/enclosed_bases.hpp"
#include "crafted/examples.hpp"
#include "examples.hpp"
#include "rigidity/isostatic.hpp"
#include "support/exact_lattices.hpp"
#include "support/scale.hpp"

#include <isostat/preparation/preparation.hpp>

namespace {

using namespace isostat::crafted;
using examples::inspected;
using isostat::Contact;
using isostat::Verdict;
using isostat::WallKind;
using Vector = std::array<Number, 2>;

/// (1 - t^2, 2 t) / (1 + t^2), turned by a multiple of a right angle: a rational direction.
Vector direction(std::mt19937_64& random) {
    const Number t = Number(static_cast<int>(random() % 50)) / Number(50);
    const Number s = (Number(1) + t * t).inverse();
    const Number c = (Number(1) - t * t) * s, d = Number(2) * t * s;
    switch (random() % 4) {
    case 0: return {c, d};
    case 1: return {-d, c};
    case 2: return {-c, -d};
    default: return {d, -c};
    }
}

void add(ExactPacking& packing, const Vector& centre, const Number& radius, bool fixed) {
    packing.centre.push_back({centre[0], centre[1], {}});
    packing.radius.push_back(radius);
    packing.fixed.push_back(fixed ? 1 : 0);
}

/// The vector of the span of `basis` that is 1 at free[which] and 0 at the other free components, by elimination in
/// the field. Empty when the free components do not fix it.
std::vector<Number> exact_vector(std::vector<std::vector<Number>> basis, const std::vector<int>& free,
                                 std::size_t which) {
    for (std::size_t k = 0; k < free.size(); ++k) {
        const auto column = static_cast<std::size_t>(free[k]);
        std::size_t pivot = k;
        while (pivot < basis.size() && basis[pivot][column].is_zero()) {
            ++pivot;
        }
        if (pivot == basis.size()) {
            return {};
        }
        std::swap(basis[k], basis[pivot]);
        const Number scale = basis[k][column].inverse();
        for (Number& x : basis[k]) {
            x *= scale;
        }
        for (std::size_t r = 0; r < basis.size(); ++r) {
            const Number factor = basis[r][column];
            for (std::size_t c = 0; r != k && !factor.is_zero() && c < basis[r].size(); ++c) {
                basis[r][c] -= factor * basis[k][c];
            }
        }
    }
    return basis[which];
}

int check(const std::vector<EnclosedVector>& vectors, const std::vector<std::vector<Number>>& basis,
          const std::vector<int>& free) {
    BOOST_REQUIRE_EQUAL(free.size(), basis.size());
    for (std::size_t k = 0; k < vectors.size(); ++k) {
        const std::vector<Number> exact = exact_vector(basis, free, k);
        BOOST_REQUIRE_EQUAL(exact.size(), vectors[k].value.size());
        BOOST_TEST(vectors[k].free == free[k]);
        BOOST_TEST(vectors[k].radius < 1e-6);
        const Number radius = Number::from_double(vectors[k].radius);
        for (std::size_t c = 0; c < exact.size(); ++c) {
            const Number error = exact[c] - Number::from_double(vectors[k].value[c]);
            BOOST_TEST((error <= radius && -error <= radius));
        }
    }
    return static_cast<int>(vectors.size());
}

} // namespace

BOOST_AUTO_TEST_CASE(forces_of_random_chains_agree_with_back_substitution) {
    // Disk k touches disk k - 1 and its own small fixed support: two contacts each, solved from the free end inwards.
    std::mt19937_64 random(41);
    int compared = 0, positive = 0, refused = 0;
    for (int sample = 0; sample < isostat::testing::scaled(1500); ++sample) {
        const int length = 1 + static_cast<int>(random() % 4);
        ExactPacking packing;
        packing.load = ExactLoad{};
        std::vector<Vector> to_previous, to_support, weight;
        add(packing, {Number(0), Number(0)}, Number(1), true);
        std::size_t previous = 0;
        std::vector<std::size_t> disk, support;
        const Number root = sqrt(Number(1 + static_cast<int>(random() % 3)));
        for (int k = 0; k < length; ++k) {
            const Number radius = Number(1 + static_cast<int>(random() % 4)) / Number(2) * root;
            const Vector a = direction(random), b = direction(random);
            const Number reach = packing.radius[previous] + radius, small = Number(1) / Number(10);
            const Vector centre = {packing.centre[previous][0] - a[0] * reach,
                                   packing.centre[previous][1] - a[1] * reach};
            disk.push_back(packing.radius.size());
            add(packing, centre, radius, false);
            support.push_back(packing.radius.size());
            add(packing, {centre[0] + b[0] * (radius + small), centre[1] + b[1] * (radius + small)}, small, true);
            to_previous.push_back(a);
            to_support.push_back(b);
            weight.push_back({Number(static_cast<int>(random() % 7) - 3), Number(static_cast<int>(random() % 7) - 3)});
            previous = disk.back();
        }
        packing.load->disk.resize(2 * packing.radius.size());
        for (std::size_t k = 0; k < disk.size(); ++k) {
            packing.load->disk[2 * disk[k]] = weight[k][0];
            packing.load->disk[2 * disk[k] + 1] = weight[k][1];
        }
        const auto contacts = exact_contacts(packing);
        if (!contacts.ok() || contacts.value().size() != 2 * disk.size()) {
            ++refused;
            continue;
        }
        const Inspection inspection = inspected(packing);
        // The last disk first: f_a a + f_b b = its load plus what the next disk pushes onto it.
        std::vector<Number> expected_previous(disk.size()), expected_support(disk.size());
        bool regular = true, all_positive = true, any_negative = false;
        Vector carried{};
        for (std::size_t k = disk.size(); k-- > 0 && regular;) {
            const Vector total = {weight[k][0] + carried[0], weight[k][1] + carried[1]};
            const Vector &a = to_previous[k], &b = to_support[k];
            const Number det = a[0] * b[1] - a[1] * b[0];
            regular = !det.is_zero();
            if (regular) {
                expected_previous[k] = (total[0] * b[1] - total[1] * b[0]) / det;
                expected_support[k] = (a[0] * total[1] - a[1] * total[0]) / det;
                carried = {a[0] * expected_previous[k], a[1] * expected_previous[k]};
                for (const Number* f : {&expected_previous[k], &expected_support[k]}) {
                    all_positive = all_positive && f->sign() > 0;
                    any_negative = any_negative || f->sign() < 0;
                }
            }
        }
        if (!regular) {
            BOOST_REQUIRE(inspection.hyperstaticity > 0);
            BOOST_REQUIRE((inspection.special_position == Verdict::proved));
            continue;
        }
        BOOST_REQUIRE_EQUAL(inspection.verdict(), "isostatic");
        BOOST_REQUIRE(inspection.forces_unique);
        for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
            const Contact& contact = inspection.contacts[l];
            for (std::size_t k = 0; k < disk.size(); ++k) {
                const auto is = [&](std::size_t i, std::size_t j) {
                    return contact.i == static_cast<int>(std::min(i, j)) &&
                           contact.j == static_cast<int>(std::max(i, j));
                };
                if (is(disk[k], support[k])) {
                    BOOST_REQUIRE((inspection.forces[l] == expected_support[k]));
                } else if (is(disk[k], k == 0 ? 0 : disk[k - 1])) {
                    BOOST_REQUIRE((inspection.forces[l] == expected_previous[k]));
                }
            }
        }
        BOOST_REQUIRE((inspection.support == (all_positive   ? Support::positive
                                              : any_negative ? Support::none
                                                             : Support::with_zeros)));
        BOOST_REQUIRE_EQUAL(inspection.stable == Verdict::proved, all_positive);
        ++compared;
        positive += all_positive ? 1 : 0;
    }
    BOOST_TEST_MESSAGE(compared << " compared, " << positive << " positive, " << refused << " with overlaps");
    BOOST_TEST(compared > 300);
    BOOST_TEST(positive > 20);
}

BOOST_AUTO_TEST_CASE(a_disk_between_fixed_ones_is_held_exactly_when_its_normals_surround_it) {
    // Against a self-stress: 0 is interior to the hull exactly when h = N - 2 and some self-stress is > 0 everywhere.
    std::mt19937_64 random(43);
    int held = 0, rattlers = 0, bridges = 0;
    for (int sample = 0; sample < isostat::testing::scaled(1500); ++sample) {
        ExactPacking packing;
        add(packing, {Number(0), Number(0)}, Number(1), false);
        const auto count = 1 + random() % 4;
        for (std::size_t k = 0; k < count; ++k) {
            Vector a = direction(random);
            if (k > 0 && random() % 3 == 0) { // exactly opposite to the one before
                a = {-packing.centre.back()[0] / Number::parse("1.01"),
                     -packing.centre.back()[1] / Number::parse("1.01")};
            }
            add(packing, {a[0] * Number::parse("1.01"), a[1] * Number::parse("1.01")}, Number::parse("0.01"), true);
        }
        // Directions drawn twice give one support: drop the repeated ones.
        for (std::size_t i = packing.centre.size(); i-- > 2;) {
            for (std::size_t j = 1; j < i; ++j) {
                if (packing.centre[i] == packing.centre[j]) {
                    packing.centre.erase(packing.centre.begin() + static_cast<std::ptrdiff_t>(i));
                    packing.radius.pop_back();
                    packing.fixed.pop_back();
                    break;
                }
            }
        }
        const Inspection inspection = inspected(packing);
        BOOST_REQUIRE_EQUAL(inspection.contacts.size(), packing.radius.size() - 1);
        const bool strict = inspection.one_sign.kind == isostat::exact::OneSign::strict;
        const bool some = inspection.one_sign.kind != isostat::exact::OneSign::none;
        BOOST_REQUIRE(inspection.one_sign_decided);
        switch (inspection.hold[0]) {
        case DiskHold::held:
            BOOST_REQUIRE(strict);
            BOOST_REQUIRE_EQUAL(inspection.rank, 2);
            ++held;
            break;
        case DiskHold::bridge:
            BOOST_REQUIRE(some);
            BOOST_REQUIRE(!(strict && inspection.rank == 2));
            ++bridges;
            break;
        default: BOOST_REQUIRE(!some); ++rattlers;
        }
    }
    BOOST_TEST(held > 50);
    BOOST_TEST(bridges > 50);
    BOOST_TEST(rattlers > 50);
}

BOOST_AUTO_TEST_CASE(a_stored_vertex_is_isostatic_and_its_exact_forces_solve_the_double_system) {
    isostat::PreparationOptions options{.disks = 12, .seed = 3};
    isostat::PreparationReport report;
    const auto state = required(isostat::prepare(options, report));
    const auto& packing = state.packing;
    ExactPacking exact = exact_copy(packing);
    const auto force = state.load.external_force(packing);
    exact.load = ExactLoad{{Number::from_double(-force[24]), Number::from_double(-force[25])}, {}};
    const Inspection inspection = inspect_contacts(exact, state.contacts);
    BOOST_TEST(inspection.verdict() == "isostatic");
    BOOST_TEST((inspection.special_position == Verdict::refuted));
    BOOST_REQUIRE(inspection.forces_unique);
    const isostat::DofMap dofs(packing);
    const auto matrix = isostat::contact_matrix(packing, dofs, inspection.contacts);
    std::vector<double> residual(force.begin(), force.begin() + 26);
    int zeros = 0;
    for (std::size_t l = 0; l < 26; ++l) {
        for (int e = matrix.start[l]; e < matrix.start[l + 1]; ++e) {
            const auto entry = static_cast<std::size_t>(e);
            residual[static_cast<std::size_t>(matrix.row[entry])] -=
                matrix.value[entry] * inspection.forces[l].to_double();
        }
        zeros += inspection.forces[l].is_zero() ? 1 : 0;
        BOOST_TEST(inspection.forces[l].sign() >= 0);
        BOOST_TEST((inspection.forces[l].is_zero() == (inspection.structural_zero[l] != 0)));
    }
    BOOST_TEST(zeros == 2 * report.rattlers);
    for (const double r : residual) {
        BOOST_TEST(std::abs(r) < 1e-12 * 10);
    }
}

BOOST_AUTO_TEST_CASE(scenes_with_hardly_anything_in_them) {
    ExactPacking one;
    add(one, {Number(5), Number(5)}, Number(1), false);
    Inspection answer = inspected(one);
    BOOST_TEST(answer.dof_count == 2);
    BOOST_TEST(answer.contacts.empty());
    BOOST_TEST(answer.mechanisms == 2);
    BOOST_TEST(answer.rigid_motions == 2);
    BOOST_TEST(answer.verdict() == "isostatic");
    BOOST_TEST((answer.hold[0] == DiskHold::rattler));
    one.load = ExactLoad{{}, {Number(1), Number(0)}};
    BOOST_TEST((inspected(one).support == Support::unbalanced));
    one.load = ExactLoad{{}, {Number(0), Number(0)}};
    BOOST_TEST((inspected(one).support == Support::positive)); // no force is asked for
    one.load.reset();
    one.fixed = {1};
    answer = inspected(one);
    BOOST_TEST(answer.dof_count == 0);
    BOOST_TEST(answer.mechanisms == 0);
    BOOST_TEST(answer.verdict() == "isostatic");
    // Movable walls that touch nothing are mechanisms.
    one.fixed = {0};
    one.walls = isostat::Walls::box();
    one.length = {Number(20), Number(20)};
    answer = inspected(one);
    BOOST_TEST(answer.dof_count == 4);
    BOOST_TEST(answer.mechanisms == 4);
    BOOST_TEST(answer.rigid_motions == 0);
}

BOOST_AUTO_TEST_CASE(common_rigid_motions_are_mechanisms_under_any_walls_and_fixed_disks) {
    const WallKind lower[] = {WallKind::absent, WallKind::fixed};
    const WallKind upper[] = {WallKind::absent, WallKind::fixed, WallKind::movable};
    for (int code = 0; code < 36 * 3; ++code) {
        ExactPacking
            packing; // four unit disks in a square, diagonals braced by small disks: rigid but for common motions
        packing.walls.lower = {lower[code % 2], lower[code / 2 % 2]};
        packing.walls.upper = {upper[code / 4 % 3], upper[code / 12 % 3]};
        packing.length = {Number(4), Number(4)};
        for (const int x : {1, 3}) {
            for (const int y : {1, 3}) {
                add(packing, {Number(x), Number(y)}, Number(1), false);
            }
        }
        add(packing, {Number(2), Number(2)}, Number::parse("sqrt(2) - 1"), false);
        for (int f = 0; f < code / 36; ++f) {
            packing.fixed[static_cast<std::size_t>(f)] = 1;
        }
        const Inspection answer = inspected(packing);
        BOOST_REQUIRE((answer.rank_exact == Verdict::proved));
        BOOST_TEST(answer.internal_mechanisms() == 0, "code " << code);
        BOOST_TEST(answer.dof_count + answer.hyperstaticity ==
                   static_cast<int>(answer.contacts.size()) + answer.mechanisms);
    }
}

BOOST_AUTO_TEST_CASE(enclosures_contain_the_exact_vectors_of_the_examples) {
    int stresses = 0, motions = 0;
    for (const auto& path : examples::packing_files()) {
        const PackingFile file = read_packing(path);
        const auto inspection = required(inspect(file.packing));
        const EnclosedBases bases = enclose_bases(file.packing, inspection, 1000);
        if (bases.verdict != Verdict::proved || inspection.bases_exact != Verdict::proved) {
            BOOST_TEST_MESSAGE(path << ": no enclosure");
            continue;
        }
        BOOST_TEST_INFO_SCOPE(path);
        stresses += check(bases.self_stresses, inspection.self_stresses, bases.free_contacts);
        motions += check(bases.motions, inspection.motions, bases.free_dofs);
    }
    BOOST_TEST(stresses > 50);
    BOOST_TEST(motions > 20);
}

BOOST_AUTO_TEST_CASE(a_lattice_without_exact_bases_gets_enclosures) {
    const ExactPacking packing = families::triangular_lattice(15, 15);
    const auto inspection = required(inspect(packing));
    BOOST_TEST((inspection.bases_exact == Verdict::undecided));
    BOOST_TEST((inspection.rank_exact == Verdict::proved));
    const EnclosedBases bases = enclose_bases(packing, inspection, 5);
    BOOST_REQUIRE((bases.verdict == Verdict::proved));
    BOOST_TEST(static_cast<int>(bases.free_contacts.size()) == inspection.hyperstaticity);
    BOOST_REQUIRE_EQUAL(bases.self_stresses.size(), 5U);
    for (const EnclosedVector& vector : bases.self_stresses) {
        BOOST_TEST(vector.radius < 1e-6);
    }
}
