// Crafted packings in cells: contacts through images, and what may not matter for them.

#include "examples.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>

#include <Eigen/Dense>

namespace {

using namespace examples;
using namespace isostat::crafted;
using isostat::Contact;
using isostat::StrainCounts;
using isostat::Verdict;

/// The doubles of an exact packing in its contacts, under equal stresses.
isostat::State in_contacts(const ExactPacking& packing, const std::vector<Contact>& contacts) {
    isostat::State state;
    state.packing = approximate(packing);
    state.contacts = contacts;
    state.load.stress = {1, 1};
    state.load.refer_to(state.packing);
    return state;
}

/// x_j - x_i + A m for every m of a few periods, compared with the sum of the radii.
std::vector<Contact> by_force(const ExactPacking& packing, int most) {
    std::vector<Contact> out;
    const bool x = packing.cell.periodic[0], y = packing.cell.periodic[1];
    for (int i = 0; i < packing.disk_count(); ++i) {
        for (int j = i; j < packing.disk_count(); ++j) {
            const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
            for (int m = x ? -most : 0; m <= (x ? most : 0); ++m) {
                for (int p = y ? -most : 0; p <= (y ? most : 0); ++p) {
                    const isostat::Image image{{static_cast<std::int8_t>(m), static_cast<std::int8_t>(p), 0}};
                    const Number dx = packing.centre[b][0] - packing.centre[a][0] + Number(m) * packing.length[0] +
                                      Number(p) * packing.tilt[0];
                    const Number dy = packing.centre[b][1] - packing.centre[a][1] + Number(p) * packing.length[1];
                    const Number d = packing.radius[a] + packing.radius[b];
                    if ((i != j || image > isostat::Image{}) && (dx * dx + dy * dy - d * d).is_zero()) {
                        out.push_back(isostat::pair_of(i, j, image));
                    }
                }
            }
        }
    }
    std::ranges::sort(out);
    return out;
}

std::vector<std::string> sorted(const std::vector<Number>& numbers) {
    std::vector<std::string> out;
    std::ranges::transform(numbers, std::back_inserter(out), &Number::text);
    std::ranges::sort(out);
    return out;
}

bool same(const StrainCounts& a, const StrainCounts& b) {
    return std::ranges::equal(a, b, [](const isostat::Counting& one, const isostat::Counting& other) {
        return one.dof_count == other.dof_count && one.contact_count == other.contact_count && one.rank == other.rank &&
               one.rank_exact == other.rank_exact;
    });
}

/// The disk at another of its images.
void move(ExactPacking& packing, std::size_t disk, int m, int p) {
    packing.centre[disk][0] += Number(m) * packing.length[0] + Number(p) * packing.tilt[0];
    packing.centre[disk][1] += Number(p) * packing.length[1];
}

} // namespace

// Any representatives and any pin: a gauge. All contacts are found, wherever the disks are stored.
BOOST_AUTO_TEST_CASE(representatives_and_the_pinned_disk_do_not_matter) {
    std::mt19937_64 random(3);
    int cells = 0;
    for (const std::string& path : packing_files()) {
        const ExactPacking packing = read_packing(path).packing;
        if (!packing.cell.any()) {
            continue;
        }
        ++cells;
        const Inspection before = inspected(packing);
        for (int k = 0; k < 3; ++k) {
            ExactPacking other = packing;
            for (std::size_t i = 0; i < other.radius.size(); ++i) {
                const auto periods = [&](bool repeats) { return repeats ? static_cast<int>(random() % 5) - 2 : 0; };
                const int m = periods(packing.cell.periodic[0]);
                move(other, i, m, periods(packing.cell.periodic[1]));
            }
            other.cell.pin = static_cast<int>(random() % other.radius.size());
            const Inspection after = inspected(other);
            BOOST_TEST_INFO_SCOPE(path);
            std::vector<Contact> pairs;
            std::ranges::copy_if(after.contacts, std::back_inserter(pairs), &Contact::of_disks);
            BOOST_TEST((pairs == by_force(other, 7)));
            BOOST_TEST(after.rank == before.rank);
            BOOST_TEST(after.generic_rank == before.generic_rank);
            BOOST_TEST((after.hold == before.hold));
            BOOST_TEST((after.stable == before.stable));
            BOOST_TEST((after.second_order == before.second_order));
            BOOST_TEST(after.strains.has_value() == packing.cell.all());
            if (after.jamming) {
                BOOST_TEST(after.jamming->disks == before.jamming->disks);
                BOOST_TEST((after.jamming->collective == before.jamming->collective));
                BOOST_TEST((after.jamming->strict == before.jamming->strict));
            }
            BOOST_TEST((!after.strains || same(*after.strains, *before.strains)));
            if (before.forces_unique) {
                BOOST_TEST((sorted(after.forces) == sorted(before.forces)));
            }
        }
    }
    BOOST_TEST(cells >= 13);
}

// The second period vector plus the first one: the same lattice. W = F1 L + F2 L' + T t, and t is t' - L.
BOOST_AUTO_TEST_CASE(another_basis_of_the_lattice_gives_the_same_forces) {
    for (const char* name : {"cell_two_disks_tilted.toml", "cell_one_disk_tilted.toml", "cell_two_disks_tie.toml"}) {
        const ExactPacking packing = example(name);
        ExactPacking other = packing;
        other.tilt[0] += packing.length[0];
        other.load->wall[0] -= packing.load->tilt[0];
        const Inspection before = inspected(packing), after = inspected(other);
        BOOST_TEST((after.contacts != before.contacts));
        BOOST_TEST((sorted(after.forces) == sorted(before.forces)));
        BOOST_TEST((after.support == before.support));
        BOOST_TEST(same(*after.strains, *before.strains));
    }
}

// T7 is false in rectangles, for an open set of radii: X = 4/5 D, Y = 3/5 D, both larger than the radii.
BOOST_AUTO_TEST_CASE(two_disks_of_a_centred_rectangle_bear_a_shear_whatever_their_radii) {
    for (const char* r : {"1", "9/10", "7/10", "sqrt(1/2)", "0.99999"}) {
        ExactPacking packing = example("counterexample_t7_centred_rectangle.toml");
        packing.radius[1] = n(r);
        const Number d = Number(1) + n(r);
        packing.centre[1] = {n("4/5") * d, n("3/5") * d};
        packing.length = {n("8/5") * d, n("6/5") * d};
        const Inspection rectangle = inspected(packing);
        BOOST_TEST(rectangle.hyperstaticity == 1);
        BOOST_TEST(rectangle.mechanisms == 1);
        BOOST_TEST((rectangle.special_position == Verdict::proved));
        packing.cell.tilt_moves = {true};
        const Inspection tilted = inspected(packing);
        BOOST_TEST(tilted.hyperstaticity == 0);
        BOOST_TEST((tilted.rank_exact == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(a_force_vanishes_at_the_load_that_the_closed_form_says) {
    ExactPacking packing = example("cell_one_disk_tilted.toml");
    packing.load->tilt[0] = n("1"); // F2 / sqrt(3)
    BOOST_TEST((inspected(packing).support == Support::with_zeros));
    packing.load->tilt[0] = n("1 + 1e-40");
    BOOST_TEST((inspected(packing).stable == Verdict::refuted));
    packing.load->tilt[0] = n("-1 + 1e-40"); // the other contact
    BOOST_TEST((inspected(packing).support == Support::positive));
}

BOOST_AUTO_TEST_CASE(an_overlap_with_an_image_is_named_however_small) {
    for (const char* depth : {"1e-3", "1e-16", "1e-200"}) {
        ExactPacking packing = example("channel_two_disks_low.toml");
        packing.length[0] = n(std::string("4*sqrt(2) - ") + depth); // disk 1 stays where it touches disk 0
        fails(exact_contacts(packing), isostat::FailureKind::overlap, {"pair 0-1(-1,0)"});
        packing.length[0] = n(std::string("4*sqrt(2) + ") + depth);
        BOOST_TEST(exact_contacts(packing).value().size() == 4U);
        // A disk and its own image one period away, askew.
        packing = example("cell_one_disk_tilted.toml");
        packing.tilt[0] = n(std::string("1 - ") + depth);
        fails(exact_contacts(packing), isostat::FailureKind::overlap, {"pair 0-0(0,1)"});
    }
}

// Triangular lattice with a hole: its neighbours still carry, and a small disk in the hole is a rattler.
BOOST_AUTO_TEST_CASE(rattlers_are_left_out_of_what_is_jammed) {
    ExactPacking packing;
    packing.cell.periodic = {true, true};
    packing.length = {Number(8), n("4*sqrt(3)")};
    for (int row = 0; row < 4; ++row) {
        for (int k = 0; k < 4; ++k) {
            packing.centre.push_back({Number(2 * k + row % 2), Number(row) * n("sqrt(3)")});
            packing.radius.emplace_back(row == 1 && k == 1 ? n("1/2") : Number(1));
        }
    }
    const Inspection hole = inspected(packing);
    BOOST_TEST(hole.jamming->disks == 15);
    BOOST_TEST((hole.jamming->collective == Verdict::proved));
    BOOST_TEST((hole.jamming->strict == Verdict::proved));
    // The pinned disk may be the rattler.
    packing.cell.pin = 5;
    BOOST_TEST((inspected(packing).jamming->strict == Verdict::proved));
    // A dilated cell: nothing touches.
    packing.length[0] = Number(9);
    for (auto& centre : packing.centre) {
        centre[0] *= n("9/8");
        centre[1] *= Number(2);
    }
    packing.length[1] *= Number(2);
    BOOST_TEST((inspected(packing).jamming->collective == Verdict::refuted));
}

/// How many independent mechanisms of the fixed cell lengthen some contact at second order: along them the radius
/// grows. The squares of the relative velocities of all contacts, summed over the kernel of the matrix.
int motions_that_lengthen(const ExactPacking& exact, const std::vector<Contact>& contacts) {
    const isostat::Packing packing = approximate(exact);
    const auto disks = static_cast<Eigen::Index>(packing.disk_count());
    const auto count = static_cast<Eigen::Index>(contacts.size());
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(count, 2 * disks);
    Eigen::MatrixXd apart = Eigen::MatrixXd::Zero(2 * count, 2 * disks);
    for (Eigen::Index l = 0; l < count; ++l) {
        const Contact& c = contacts[static_cast<std::size_t>(l)];
        const auto g = gap_gradient(packing, c);
        for (std::size_t e = 0; e < static_cast<std::size_t>(g.count); ++e) {
            if (g.coordinate[e] < 2 * disks) {
                gradient(l, g.coordinate[e]) = g.value[e];
            }
        }
        for (Eigen::Index a = 0; a < 2; ++a) {
            apart(2 * l + a, 2 * c.i + a) -= 1;
            apart(2 * l + a, 2 * c.j + a) += 1;
        }
    }
    const Eigen::FullPivLU<Eigen::MatrixXd> lu(gradient);
    return static_cast<int>(Eigen::FullPivLU<Eigen::MatrixXd>(apart * lu.kernel()).setThreshold(1e-9).rank());
}

// Disks of one radius on the hexagonal torus of side 1, critical for the radius: the index is k - 2 rattlers -
// 2 (components - 1), as it is of published ones (examples/peers/critical_disks.py).
BOOST_AUTO_TEST_CASE(the_index_of_critical_disks_is_k_less_what_moves_without_a_contact) {
    struct Critical {
        const char* file;
        int index, rattlers, components;
    };
    for (const Critical& c : {Critical{"largest", 0, 0, 1}, Critical{"saddle", 1, 0, 1}, Critical{"row", 2, 0, 1},
                              Critical{"two_rows", 4, 0, 2}, Critical{"row_and_rattler", 2, 1, 1}}) {
        const ExactPacking packing = example("cell_hexagonal_" + std::string(c.file) + ".toml");
        const Inspection found = inspected(packing);
        BOOST_TEST(found.mechanisms - 2 * c.rattlers - 2 * (c.components - 1) == c.index, c.file);
        BOOST_TEST(motions_that_lengthen(packing, exact_contacts(packing).value()) == c.index, c.file);
        BOOST_TEST((found.one_sign.kind == isostat::exact::OneSign::strict),
                   c.file); // critical: a positive self-stress
    }
}

BOOST_AUTO_TEST_CASE(a_state_is_jammed_as_the_exact_packing_where_own_images_touch_along_a_fixed_period) {
    // Radii 1, r, r, heights of their rows h, g, h: the images of disk 0 touch along a period of 2 that does not move.
    // Disks 1 and 2 lie flat upon each other; for r = 0.57 they press outwards more than a pressure bears, and
    // disk 0 leaves its image. For r = 0.6 they do not.
    struct Rows {
        const char *r, *h, *g;
        Verdict strict;
    };
    for (const Rows& rows : {Rows{"57/100", "1/100*sqrt(14649)", "1/100*sqrt(2996)", Verdict::refuted},
                             Rows{"3/5", "1/5*sqrt(39)", "1/5*sqrt(11)", Verdict::proved}}) {
        const std::string first = rows.h, second = first + " + " + rows.g, period = second + " + " + first;
        const ExactPacking packing =
            parse_packing("format = \"isostat-packing 1\"\ndisks = [[0, 0, 1], [1, \"" + first + "\", \"" + rows.r +
                              "\"], [0, \"" + second + "\", \"" + rows.r + "\"]]\n[cell]\nperiod = [2, \"" + period +
                              "\"]\ntilt = 1\nmoves = [\"y\", \"xy\"]\n",
                          "rows")
                .packing;
        const Inspection exact = inspected(packing);
        BOOST_REQUIRE(exact.jamming.has_value());
        BOOST_TEST((exact.jamming->strict == rows.strict));
        const isostat::State state = in_contacts(packing, exact.contacts);
        const isostat::CellInspection seen = isostat::inspect_cell(state, isostat::certify(state));
        BOOST_TEST((seen.collective.verdict == exact.jamming->collective));
        BOOST_TEST((seen.strict.verdict == rows.strict), seen.strict.reason);
        BOOST_TEST(same(*exact.strains, seen.all));
    }
}

/// The same with the cell at rest.
isostat::State in_doubles(const ExactPacking& packing) {
    isostat::State state = in_contacts(packing, exact_contacts(packing).value());
    state.packing.cell.keeps_shape = false;
    state.packing.cell.move(false, false);
    return state;
}

/// The smallest force of the self-stress with the largest entropy, in dense matrices; 0 where none is found.
double smallest_self_stress(isostat::State state) {
    const std::vector<int> rattlers = isostat::rattlers_by_coordination(state.packing, state.contacts);
    const auto rattles = [&](int i) { return std::ranges::binary_search(rattlers, i); };
    std::erase_if(state.contacts, [&](const Contact& c) { return rattles(c.i) || rattles(c.j); });
    const isostat::DofMap dofs(isostat::without_disks(state.packing, rattlers));
    Eigen::MatrixXd h = Eigen::MatrixXd::Zero(dofs.dof_count(), static_cast<Eigen::Index>(state.contacts.size()));
    for (Eigen::Index l = 0; l < h.cols(); ++l) {
        const auto gradient = isostat::gap_gradient(state.packing, state.contacts[static_cast<std::size_t>(l)]);
        for (std::size_t k = 0; k < static_cast<std::size_t>(gradient.count); ++k) {
            if (const int dof = dofs.dof_of(static_cast<std::size_t>(gradient.coordinate[k])); dof >= 0) {
                h(dof, l) -= gradient.value[k];
            }
        }
    }
    Eigen::VectorXd f = Eigen::VectorXd::Ones(h.cols()), v = Eigen::VectorXd::Zero(h.rows());
    for (int step = 0; step < 60; ++step) {
        const Eigen::VectorXd change = (h * f.asDiagonal() * h.transpose()).ldlt().solve(h * f);
        v += change / std::max(1.0, (h.transpose() * change).cwiseAbs().maxCoeff());
        f = (-(h.transpose() * v)).array().exp();
    }
    const Eigen::Index rank = Eigen::FullPivLU<Eigen::MatrixXd>(h).setThreshold(1e-9).rank();
    return rank == h.rows() && (h * f).norm() < 1e-9 ? f.minCoeff() : 0;
}

struct Lattice {
    const char* file;
    bool collective, strict; ///< told in doubles
};

const std::vector<Lattice> lattices{{"packings/cell_hexagonal_largest.toml", true, true},
                                    {"packings/cell_hexagonal_saddle.toml", false, true},
                                    {"packings/cell_hexagonal_row_and_rattler.toml", false, false},
                                    {"packings/cell_square_lattice_2.toml", false, true},
                                    {"packings/cell_triangular_lattice_6.toml", true, true},
                                    {"24_honey.toml", true, true},
                                    {"24_honey2.toml", true, true},
                                    {"24_kagome.toml", false, true},
                                    {"24_square.toml", false, true}};

ExactPacking packing_of(const Lattice& lattice) {
    const std::string file = lattice.file;
    return read_packing(
               (file[0] == '2' ? std::string(ISOSTAT_TEST_DATA) + "/field/" : ISOSTAT_EXAMPLES + std::string("/")) +
               file)
        .packing;
}

BOOST_AUTO_TEST_CASE(lattices_in_doubles_are_jammed_if_their_contacts_close) {
    // h > 0: doubles do not tell by themselves, and what they tell on this condition is so in exact numbers.
    for (const Lattice& lattice : lattices) {
        const ExactPacking packing = packing_of(lattice);
        const Inspection exact = inspected(packing);
        const isostat::State state = in_doubles(packing);
        const isostat::CellInspection seen = isostat::inspect_cell(state, isostat::certify(state));
        BOOST_TEST_INFO_SCOPE(lattice.file);
        BOOST_TEST((seen.collective.verdict == Verdict::undecided));
        BOOST_TEST((seen.strict.verdict == Verdict::undecided));
        BOOST_TEST(seen.collective.if_closed.has_value() == lattice.collective);
        BOOST_TEST(seen.strict.if_closed.has_value() == lattice.strict);
        if (seen.collective.if_closed) {
            BOOST_TEST((seen.collective.if_closed->verdict == exact.jamming->collective));
            BOOST_TEST(seen.local.if_closed.has_value() == (exact.jamming->collective == Verdict::proved));
        }
        if (seen.strict.if_closed) {
            BOOST_TEST((seen.strict.if_closed->verdict == *exact.jamming->strict));
        }
    }
}

BOOST_AUTO_TEST_CASE(forces_stay_positive_at_every_place_that_is_spoken_of) {
    std::mt19937_64 random(7);
    for (const Lattice& lattice : lattices) {
        isostat::State state = in_doubles(packing_of(lattice));
        const auto told = isostat::inspect_cell(state, isostat::certify(state)).collective.if_closed;
        if (!told || told->verdict != Verdict::proved) {
            continue;
        }
        BOOST_TEST_INFO_SCOPE(lattice.file);
        BOOST_TEST(smallest_self_stress(state) > 0.1);
        const std::vector<double> stored = state.packing.q;
        for (int place = 0; place < 5; ++place) {
            Eigen::VectorXd change(static_cast<Eigen::Index>(stored.size()));
            std::ranges::generate(change, [&] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1; });
            change *= told->within / change.norm();
            for (std::size_t k = 0; k < stored.size(); ++k) {
                state.packing.q[k] = stored[k] + change[static_cast<Eigen::Index>(k)];
            }
            BOOST_TEST(smallest_self_stress(state) > 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(what_is_not_near_or_overlaps_is_not_spoken_of) {
    const isostat::State state = in_doubles(example("cell_triangular_lattice_6.toml"));
    const auto told = [](const isostat::State& s) {
        return isostat::inspect_cell(s, isostat::certify(s)).collective.if_closed;
    };
    BOOST_REQUIRE(told(state).has_value());
    BOOST_TEST(told(state)->within > 0);
    BOOST_TEST(told(state)->within <= 1e-3 * state.packing.min_radius());
    isostat::State small = state; // a gap of the list is open by more than the proof spans
    for (double& radius : small.packing.radius) {
        radius *= 0.999;
    }
    BOOST_TEST(!told(small).has_value());
    isostat::State unlisted = state; // a pair that is not listed overlaps
    for (double& radius : unlisted.packing.radius) {
        radius *= 1 + 1e-5;
    }
    unlisted.packing.radius[0] *= 1.01;
    std::erase_if(unlisted.contacts, [](const Contact& c) { return c.i == 0 || c.j == 0; });
    BOOST_TEST(!told(unlisted).has_value());
}

BOOST_AUTO_TEST_CASE(a_rattler_in_a_cell_plays_no_part_in_what_is_so_if_contacts_close) {
    isostat::State state = in_doubles(example("cell_triangular_lattice_6.toml"));
    state.packing.radius[1] *= 0.5;
    int left = 2; // contacts of the rattler, which are open
    std::erase_if(state.contacts, [&](const Contact& c) { return (c.i == 1 || c.j == 1) && left-- <= 0; });
    for (const int pin : {0, 1}) {
        state.packing.cell.pin = pin;
        const auto seen = isostat::inspect_cell(state, isostat::certify(state));
        BOOST_REQUIRE(seen.collective.if_closed.has_value());
        BOOST_TEST((seen.collective.if_closed->verdict == Verdict::proved));
    }
}

BOOST_AUTO_TEST_CASE(a_stored_state_has_the_counts_of_its_stored_numbers) {
    for (const char* name : {"rect_16", "tilt_16"}) {
        const isostat::State state =
            isostat::read_any_state(std::string(ISOSTAT_TEST_DATA) + "/cells/" + name + ".json").state;
        const Inspection exact = inspect_contacts(exact_copy(state.packing), state.contacts);
        const StrainCounts stored = isostat::count_strains(state.packing, state.contacts);
        BOOST_REQUIRE(exact.strains.has_value());
        BOOST_TEST(same(*exact.strains, stored));
        BOOST_TEST(exact.rank == static_cast<int>(state.contacts.size()));
    }
}
