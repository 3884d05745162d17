// Clumps: the theorem on generic shapes (U7), what T7, T8, S3 and S4 say of single grains and fails for bodies, and a
// search for a body that contacts alone keep in a minimum. T5 and T6: test_regular_edges.cpp.
#include "families.hpp"
#include "packing/bodies.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/rigidity/counting.hpp>

#include <eigen3/Eigen/Dense>

using namespace isostat;
using namespace families;

namespace statement_clumps { // names of its own, beside test_generic_isostaticity.cpp

namespace {

ExactPacking example(const std::string& name) {
    return crafted::read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/clump_" + name + ".toml").packing;
}

std::vector<Contact> contacts_of(const ExactPacking& packing) {
    return unilateral(required(crafted::exact_contacts(packing)));
}

/// Radii and places of all members vary: members are disks by themselves, and only bodies make no pair of them.
int rank_with_shapes(const ExactPacking& packing) {
    return rank_with(packing, contacts_of(packing), Radii::all);
}

void check_statement(const ExactPacking& packing, const std::string& name) {
    BOOST_TEST(rank_with_shapes(packing) == static_cast<int>(contacts_of(packing).size()), name);
}

void join(ExactPacking& packing, int i, int j) {
    packing.bars.push_back({i, j,
                            std::hypot((packing.centre[j][0] - packing.centre[i][0]).to_double(),
                                       (packing.centre[j][1] - packing.centre[i][1]).to_double())});
}

/// Equal dimers of which the members overlap, in rows on top of each other.
ExactPacking stacked(int columns, int rows) {
    ExactPacking packing = empty_box(3 * columns, 2 * rows);
    for (int r = 0; r < rows; ++r) {
        for (int c = 0; c < columns; ++c) {
            add(packing, Number(3 * c + 1), Number(2 * r + 1), Number(1));
            add(packing, Number(3 * c + 2), Number(2 * r + 1), Number(1));
            join(packing, packing.disk_count() - 2, packing.disk_count() - 1);
        }
    }
    return packing;
}

/// Neighbours of a square lattice joined, along x or along y by turns.
ExactPacking joined(int size) {
    ExactPacking packing = square_lattice(size, size, false);
    std::vector<unsigned char> taken(packing.radius.size(), 0);
    for (int i = 0; i < packing.disk_count(); ++i) {
        for (int j = i + 1; j < packing.disk_count() && taken[static_cast<std::size_t>(i)] == 0; ++j) {
            const Number dx = packing.centre[j][0] - packing.centre[i][0];
            const Number dy = packing.centre[j][1] - packing.centre[i][1];
            if (taken[static_cast<std::size_t>(j)] == 0 && (dx * dx + dy * dy - Number(4)).is_zero() &&
                (i % 3 == 0 ? dx : dy).is_zero()) {
                taken[static_cast<std::size_t>(i)] = taken[static_cast<std::size_t>(j)] = 1;
                join(packing, i, j);
            }
        }
    }
    return packing;
}

/// W'' = - sum f |u|^2 / d over contacts and bars along a motion, u the relative velocity: exact.
Number second_variation(const ExactPacking& packing, const crafted::Inspection& found) {
    const DofMap dofs(crafted::approximate(packing));
    const auto velocity = [&](int disk, int axis) {
        const int dof = dofs.dof_of(static_cast<std::size_t>(2 * disk + axis));
        return dof < 0 ? Number(0) : found.motions.front()[static_cast<std::size_t>(dof)];
    };
    Number sum(0);
    for (std::size_t l = 0; l < found.contacts.size(); ++l) {
        const Contact& c = found.contacts[l];
        for (int axis = 0; axis < 2 && c.of_disks(); ++axis) {
            const Number u = velocity(c.j, axis) - velocity(c.i, axis);
            sum -= found.forces[l] * u * u / crafted::scale_of_row(packing, c);
        }
    }
    return sum;
}

/// A body among fixed disks, see below.
struct Family {
    Eigen::ArrayXd fx, fy, a, member, fixed; // forces but the last, places and radii
    double form = -1;
    bool apart = false;
};

void judge(Family& f) {
    const Eigen::Index n = f.a.size();
    Eigen::ArrayXd x(n), y(n);
    x << f.fx, -f.fx.sum();
    y << f.fy, -f.fy.sum();
    const Eigen::ArrayXd t = (x * x + y * y).sqrt();
    const Eigen::ArrayXd d = f.member + f.fixed, b = f.a + d;
    f.form = -(t * f.a * b / d).sum() / t.sum();
    f.apart = t.minCoeff() > 1e-3 * t.sum();
    for (Eigen::Index k = 0; k < n; ++k) {
        for (Eigen::Index l = 0; l < n; ++l) {
            const double cosine = (x[k] * x[l] + y[k] * y[l]) / (t[k] * t[l]);
            const double square = f.a[k] * f.a[k] + b[l] * b[l] - 2 * f.a[k] * b[l] * cosine;
            const double touching = f.member[k] + f.fixed[l];
            f.apart = f.apart && (k == l || square >= touching * touching);
        }
    }
}

} // namespace

/// U7 (a), at the most special places: equal members, parallel contacts, members that overlap.
BOOST_AUTO_TEST_CASE(radii_and_places_of_members_follow_every_gap_of_clumps) {
    int special = 0;
    for (int m = 1; m <= 6; ++m) {
        for (int n = 1; n <= 4; ++n) {
            check_statement(stacked(m, n), "stacked");
            special += required(crafted::inspect(stacked(m, n))).hyperstaticity;
        }
        check_statement(joined(m), "joined");
    }
    BOOST_TEST(special > 100);
    for (const char* const name : {"dimer_flat", "dimer_lies", "dimer_across", "trimer_and_disk", "channel_row",
                                   "counterexample_three_on_a_wall"}) {
        check_statement(example(name), name);
    }
    // In cells a tilt that moves is needed, as of disks (T7p): the lattice of dimers has one.
    check_statement(example("cell_square"), "cell_square");
}

/// Without variable radii: two equal members between two walls, wherever they are in their body.
BOOST_AUTO_TEST_CASE(places_of_members_alone_do_not_follow_every_gap) {
    const ExactPacking flat = example("dimer_flat");
    BOOST_TEST(rank_with(flat, contacts_of(flat), Radii::none) == 5);
    BOOST_TEST(rank_with_shapes(flat) == 6);
}

/// Without the hypothesis that no two members of a body touch from within.
BOOST_AUTO_TEST_CASE(members_that_touch_from_within_have_gaps_that_nothing_parts) {
    const ExactPacking tangent = example("counterexample_tangent_members");
    BOOST_TEST(contacts_of(tangent).size() == 4U);
    BOOST_TEST(rank_with_shapes(tangent) == 3);
    ExactPacking apart = tangent; // smaller inner members touch nothing
    apart.radius[1] = apart.radius[3] = Number(1) / Number(4);
    check_statement(apart, "apart");
}

/// T7 (b) is of almost all shapes: three equal members in a row have a self-stress wherever they stand on a wall.
BOOST_AUTO_TEST_CASE(three_equal_members_in_a_row_on_a_wall_have_a_self_stress) {
    ExactPacking row = example("counterexample_three_on_a_wall");
    for (const int shift : {0, 1, 17}) {
        for (auto& centre : row.centre) {
            centre[0] += Number(shift);
        }
        BOOST_TEST(required(crafted::inspect(row)).hyperstaticity == 1);
    }
    row.centre[1][1] += Number(1) / Number(1000);
    BOOST_TEST(required(crafted::inspect(row)).hyperstaticity == 0);
}

/// T8 would refute it: forces > 0 without self-stress, a mechanism, tangential velocities at contacts of two disks. S3
/// would find a traction: what is held bears nothing, and the power p' = - W'' falls through 0.
BOOST_AUTO_TEST_CASE(a_body_may_rest_in_a_strict_minimum_where_t8_and_s3_find_none_of_single_grains) {
    const ExactPacking packing = example("counterexample_t8_pendulum");
    const crafted::Inspection found = required(crafted::inspect(packing));
    BOOST_TEST(found.hyperstaticity == 0);
    BOOST_TEST(found.mechanisms == 1);
    BOOST_TEST((found.forces[0].sign() > 0 && found.forces[1].sign() > 0));
    for (const std::size_t dof : {0U, 1U}) { // of a member at its contact with a fixed disk
        BOOST_TEST(!found.motions.front()[dof].is_zero());
    }
    const Number turn = found.motions.front()[4] / Number(28); // (0, -24) turns about (0, 4)
    BOOST_TEST((second_variation(packing, found) == Number(49) * turn * turn));
    BOOST_TEST((found.stable != Verdict::refuted));
    State state;
    state.packing = crafted::approximate(packing);
    state.contacts = found.contacts;
    state.load.stress = {0, 0};
    state.load.disk_force = {0, 0, 0, 0, 0, -8, 0, 0, 0, 0};
    state.load.refer_to(state.packing);
    BOOST_TEST(certify(with_free_motions_held(state)).claims.minimum.has_value());
    ExactPacking higher = packing; // the load at (0, -16): 8 (4 + 16) < 175
    higher.centre[2][1] = Number(-16);
    const crafted::Inspection above = required(crafted::inspect(higher));
    BOOST_TEST(second_variation(higher, above).sign() < 0);
}

/// S4 (c): a disk without load that two contacts hold, not in one line, carries no force. A member does.
BOOST_AUTO_TEST_CASE(a_member_that_two_contacts_hold_carries_forces_that_are_not_in_one_line) {
    const crafted::Inspection found = required(crafted::inspect(example("dimer_lies")));
    int held = 0;
    for (std::size_t l = 0; l < found.contacts.size(); ++l) {
        if (found.contacts[l].i == 1 && found.contacts[l].is_unilateral()) {
            BOOST_TEST(found.forces[l].sign() > 0);
            ++held;
        }
    }
    BOOST_TEST(held == 2);
}

/// One body among fixed disks, loaded by its contacts alone, that turns about the point where their normals meet: U7
/// (c) asks whether W'' = - sum t a b / d is ever positive. Contact k: along e_k, the member's centre at a_k, that of
/// the fixed disk at b_k = a_k + R_k + rho_k, the force t_k e_k.
BOOST_AUTO_TEST_CASE(no_body_was_found_that_contacts_alone_keep_in_a_minimum) {
    std::mt19937_64 random(1);
    const auto uniform = [&](double low, double high) {
        return low + (high - low) * (static_cast<double>(random() >> 11) * 0x1p-53);
    };
    const auto bounded = [](const Eigen::ArrayXd& x, double low) { return x.max(low).min(1); };
    const auto search = [&](int contacts, bool apart) {
        double best = -1;
        for (int start = 0; start < 60; ++start) {
            Family f;
            do {
                const auto values = [&](Eigen::Index count, double low) -> Eigen::ArrayXd {
                    return Eigen::ArrayXd::NullaryExpr(count, [&] { return uniform(low, 1); });
                };
                f = {values(contacts - 1, -1), values(contacts - 1, -1), values(contacts, -1), values(contacts, 0.05),
                     values(contacts, 0.05)};
                judge(f);
            } while (apart && !f.apart);
            double step = 0.3;
            for (int trial = 0; trial < 2000; ++trial) {
                Family next = f;
                for (Eigen::ArrayXd* part : {&next.fx, &next.fy, &next.a, &next.member, &next.fixed}) {
                    *part += part->unaryExpr([&](double) { return step * uniform(-1, 1) * uniform(0, 1); });
                }
                next.a = bounded(next.a, -1);
                next.member = bounded(next.member, 0.01);
                next.fixed = bounded(next.fixed, 0.01);
                judge(next);
                const bool better = next.form > f.form && (next.apart || !apart);
                f = better ? next : f;
                step = better ? std::min(2 * step, 0.3) : std::max(0.97 * step, 1e-7);
            }
            best = std::max(best, f.form);
        }
        return best;
    };
    for (const int contacts : {3, 4, 5}) {
        const double best = search(contacts, true);
        BOOST_TEST_MESSAGE(contacts << " contacts: largest W'' " << best);
        BOOST_TEST(best <= 1e-14);
        BOOST_TEST(best > -1e-2);                  // the search climbs to the bound
        BOOST_TEST(search(contacts, false) > 0.1); // where members overlap fixed disks it passes it
    }
}

} // namespace statement_clumps
