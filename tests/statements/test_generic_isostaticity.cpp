// T7: attempts to find a packing where varying coordinates and radii cannot follow every change of the gaps, and what
// happens when a hypothesis is dropped.
#include "families.hpp"

using namespace isostat;
using namespace families;

namespace {

std::vector<Contact> contacts_of(const ExactPacking& packing) {
    return required(crafted::exact_contacts(packing));
}

void check_statement(const ExactPacking& packing, const std::string& name) {
    BOOST_TEST_INFO_SCOPE(name << ", n = " << packing.disk_count());
    const auto contacts = contacts_of(packing);
    const int count = static_cast<int>(contacts.size());
    BOOST_TEST(rank_with(packing, contacts, Radii::all) == count);
    BOOST_TEST(count <= 3 * packing.disk_count() + 2);
}

} // namespace

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_on_square_lattices) {
    for (int columns = 1; columns <= 7; ++columns) {
        for (int rows = 1; rows <= columns; ++rows) {
            check_statement(square_lattice(columns, rows, false), "square lattice");
        }
    }
    check_statement(square_lattice(20, 20, false), "square lattice");
}

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_on_triangular_lattices) {
    for (int columns = 1; columns <= 6; ++columns) {
        for (int rows = 1; rows <= 6; ++rows) {
            check_statement(triangular_lattice(columns, rows), "triangular lattice");
        }
    }
    check_statement(triangular_lattice(20, 20), "triangular lattice");
}

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_with_two_sizes) {
    for (int m = 2; m <= 8; ++m) {
        const ExactPacking packing = square_lattice(m, m, true);
        check_statement(packing, "two sizes");
        // Four more contacts and two more coordinates for each small disk: far above the isostatic number.
        const int holes = (m - 1) * (m - 1);
        BOOST_TEST(static_cast<int>(contacts_of(packing).size()) == 2 * m * m + 2 * m + 4 * holes);
    }
}

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_in_apollonian_strips) {
    for (const int largest : {4, 12, 40, 200, 1000}) {
        const ExactPacking packing = apollonian_strip(3, largest);
        check_statement(packing, "Apollonian strip");
        const int n = packing.disk_count();
        // Three contacts for each disk after the first three, which have eight: the most that T7 allows is 3 n + 2.
        BOOST_TEST(static_cast<int>(contacts_of(packing).size()) == 3 * (n - 3) + 10);
        BOOST_TEST(rank_with(packing, contacts_of(packing), Radii::none) <= 2 * n + 2);
    }
    BOOST_TEST(apollonian_strip(3, 1000).disk_count() > 200);
}

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_in_random_towers) {
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const ExactPacking packing = random_tower(8, seed);
        if (crafted::exact_contacts(packing).ok()) {
            check_statement(packing, "tower " + std::to_string(seed));
        } else {
            ++refused; // overlaps: not a packing
        }
    }
    BOOST_TEST(refused < 50);
}

BOOST_AUTO_TEST_CASE(a_common_radius_adds_nothing_to_the_rank) {
    for (int m = 2; m <= 6; ++m) {
        const ExactPacking packing = square_lattice(m, m, false);
        const auto contacts = contacts_of(packing);
        BOOST_TEST(rank_with(packing, contacts, Radii::none) == 2 * m * m + 2);
        BOOST_TEST(rank_with(packing, contacts, Radii::common) == 2 * m * m + 2);
    }
    const ExactPacking packing = triangular_lattice(4, 4);
    const auto contacts = contacts_of(packing);
    BOOST_TEST(rank_with(packing, contacts, Radii::none) == rank_with(packing, contacts, Radii::common));
}

BOOST_AUTO_TEST_CASE(equal_radii_are_a_critical_value_though_the_rank_with_radii_is_full) {
    const ExactPacking packing = counterexample("t7_equal_radii");
    const auto contacts = contacts_of(packing);
    BOOST_TEST(contacts.size() == 17u);
    BOOST_TEST(rank_with(packing, contacts, Radii::none) == 14);
    BOOST_TEST(rank_with(packing, contacts, Radii::all) == 17);
}

BOOST_AUTO_TEST_CASE(without_movable_walls_the_statement_fails) {
    const ExactPacking packing = counterexample("t7_walls_that_cannot_move");
    const auto contacts = contacts_of(packing);
    BOOST_TEST(contacts.size() == 4u);
    const auto kernel = exact::kernel(gap_derivative(packing, contacts, Radii::all));
    BOOST_TEST((kernel.exact == Verdict::proved));
    BOOST_TEST(kernel.rank == 3);
    // The same disk with movable upper walls.
    ExactPacking movable = packing;
    movable.walls = Walls::box();
    BOOST_TEST(rank_with(movable, contacts, Radii::all) == 4);
}

BOOST_AUTO_TEST_CASE(with_fixed_disks_the_statement_fails) {
    const ExactPacking packing = counterexample("t7_fixed_disks");
    const auto contacts = contacts_of(packing);
    BOOST_TEST(contacts.size() == 8u);
    const auto kernel = exact::kernel(gap_derivative(packing, contacts, Radii::all));
    BOOST_TEST((kernel.exact == Verdict::proved));
    BOOST_TEST(kernel.rank == 7);
    BOOST_REQUIRE(kernel.basis.size() == 1u);
    const Number along_x = kernel.basis[0][0]; // contact 0-2
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const bool x = c.kind == ContactKind::disk_disk ? packing.centre[static_cast<std::size_t>(c.i)][1] ==
                                                              packing.centre[static_cast<std::size_t>(c.j)][1]
                                                        : c.j == 0;
        BOOST_TEST((kernel.basis[0][l] == (x ? along_x : -along_x)), to_string(c));
    }
}

BOOST_AUTO_TEST_CASE(with_overlaps_the_statement_fails) {
    // Two disks in one place, two others in another: four tangent pairs, each disk with two contacts at one point.
    ExactPacking packing = empty_box(100, 100);
    for (int k = 0; k < 2; ++k) {
        add(packing, 10, 10, 1);
        add(packing, 12, 10, 1);
    }
    std::vector<Contact> contacts;
    for (const auto& [i, j] : {std::pair{0, 1}, std::pair{0, 3}, std::pair{1, 2}, std::pair{2, 3}}) {
        contacts.push_back({ContactKind::disk_disk, i, j});
    }
    const auto kernel = exact::kernel(gap_derivative(packing, contacts, Radii::all));
    BOOST_TEST((kernel.exact == Verdict::proved));
    BOOST_TEST(kernel.rank == 3);
}

BOOST_AUTO_TEST_CASE(self_stresses_of_a_lattice_do_not_balance_in_the_radii) {
    // Self-stresses of a lattice of equal disks (radii fixed) have sum f != 0 at some disk: one that had sum f = 0
    // everywhere would be a null vector with the radii varied, which T7 excludes.
    const ExactPacking packing = square_lattice(3, 3, false);
    const auto contacts = contacts_of(packing);
    const auto kernel = exact::kernel(gap_derivative(packing, contacts, Radii::none));
    BOOST_REQUIRE((kernel.exact == Verdict::proved));
    BOOST_TEST(kernel.basis.size() == 4u);
    for (const auto& stress : kernel.basis) {
        bool balanced = true; // sum f = 0 at every disk
        for (int i = 0; i < packing.disk_count(); ++i) {
            Number sum = 0;
            for (std::size_t l = 0; l < contacts.size(); ++l) {
                const bool pair = contacts[l].kind == ContactKind::disk_disk;
                if (contacts[l].i == i || (pair && contacts[l].j == i)) {
                    sum += stress[l];
                }
            }
            balanced = balanced && sum.is_zero();
        }
        BOOST_TEST(!balanced);
    }
}

BOOST_AUTO_TEST_CASE(first_order_gaps_separate_every_tie_of_a_lattice) {
    // P1: with N_f independent contacts kept closed under R + eps rho, the first-order gap of each other contact is
    // minus sum f (rho_i + rho_j), f the self-stress through it.
    std::mt19937_64 random(17);
    for (const ExactPacking& packing :
         {square_lattice(3, 3, false), square_lattice(4, 2, false), triangular_lattice(3, 3),
          square_lattice(3, 3, true), apollonian_strip(2, 30)}) {
        const auto contacts = contacts_of(packing);
        const auto kernel = exact::kernel(gap_derivative(packing, contacts, Radii::none));
        BOOST_REQUIRE((kernel.exact == Verdict::proved));
        BOOST_TEST(!kernel.basis.empty());
        const auto gap_change = [&](const std::vector<Number>& stress, const std::vector<Number>& rho) {
            Number sum = 0;
            for (std::size_t l = 0; l < contacts.size(); ++l) {
                const bool pair = contacts[l].kind == ContactKind::disk_disk;
                Number change = rho[static_cast<std::size_t>(contacts[l].i)];
                if (pair) {
                    change += rho[static_cast<std::size_t>(contacts[l].j)];
                }
                sum -= stress[l] * change;
            }
            return sum;
        };
        std::vector<Number> rho, in_proportion;
        for (const Number& r : packing.radius) {
            rho.emplace_back(1 + static_cast<long>(random() % 1000003));
            in_proportion.push_back(r);
        }
        for (const auto& stress : kernel.basis) {
            BOOST_TEST(!gap_change(stress, rho).is_zero());
            BOOST_TEST(gap_change(stress, in_proportion).is_zero()); // a change of scale separates nothing
        }
    }
}
