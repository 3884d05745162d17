// The gate is a fact of the types; the factors solve what they should.
#include "linear/disturbed.hpp"
#include "linear/factorisation.hpp"
#include "statics/statics.hpp"
#include "support/crafted.hpp"
#include "support/regular.hpp"

#include <isostat/io/state_file.hpp>

#include <type_traits>

using namespace isostat;
using namespace crafted;

// Without a structure there is no factorisation, and none is made by accident: from a proof, or by a name that says so.
static_assert(!std::is_default_constructible_v<IsostaticStructure>);
static_assert(!std::is_constructible_v<IsostaticStructure, const sparse::Matrix<double>&>);
static_assert(!std::is_constructible_v<IsostaticStructure, const Packing&, const std::vector<Contact>&>);
static_assert(!std::is_aggregate_v<IsostaticStructure>);
static_assert(!std::is_default_constructible_v<Factorisation>);
static_assert(!std::is_constructible_v<Factorisation, const sparse::Matrix<double>&>);
static_assert(!std::is_constructible_v<Factorisation, const Packing&>);
static_assert(std::is_constructible_v<Factorisation, const IsostaticStructure&>);
static_assert(!std::is_constructible_v<Statics, const Packing&, const Load&>);
// A verdict is not a truth value.
static_assert(!std::is_convertible_v<Verdict, bool>);

BOOST_AUTO_TEST_CASE(several_right_hand_sides_are_solved_like_one_after_the_other) {
    const State state = three_disks(1, 1.2, 1.4, 1, 1);
    const auto proved = crafted::Regular::proved(state);
    const Factorisation factorisation(proved);
    const auto n = static_cast<std::size_t>(proved.size());
    std::vector<double> together(6 * n);
    for (std::size_t k = 0; k < together.size(); ++k) {
        together[k] = std::sin(static_cast<double>(k));
    }
    const std::vector<double> right_hand_sides = together;
    factorisation.solve_forces(together, 6);
    const sparse::Matrix<double>& h = proved.matrix();
    for (std::size_t s = 0; s < 6; ++s) {
        std::vector<double> residual(right_hand_sides.begin() + static_cast<long>(s * n),
                                     right_hand_sides.begin() + static_cast<long>((s + 1) * n));
        for (std::size_t l = 0; l < n; ++l) {
            for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                const auto k = static_cast<std::size_t>(e);
                residual[static_cast<std::size_t>(h.row[k])] -= h.value[k] * together[s * n + l];
            }
        }
        for (const double r : residual) {
            BOOST_TEST(std::abs(r) < 1e-13);
        }
    }
}

BOOST_AUTO_TEST_CASE(rattlers_move_in_a_block_of_their_own_and_the_rest_stays_at_exactly_0) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex400.txt").state;
    const auto proved = crafted::Regular::proved(state);
    const IsostaticStructure& structure = proved;
    const Factorisation whole(structure);
    int blocks = 0;
    for (int slot = 0; slot < structure.size(); ++slot) {
        const auto block = Factorisation::of_moving_block(structure, slot);
        if (!block) {
            continue;
        }
        ++blocks;
        const std::vector<double>& quick = block->approximate().mechanism(slot);
        const std::vector<double>& slow = whole.approximate().mechanism(slot);
        double size = 0, off = 0;
        for (std::size_t mu = 0; mu < quick.size(); ++mu) {
            size = std::max(size, std::abs(slow[mu]));
            off = std::max(off, std::abs(quick[mu] - slow[mu]));
        }
        BOOST_TEST(size > 0);
        BOOST_TEST(off < 1e-11 * size);
        const auto moving = std::ranges::count_if(quick, [](double c) { return c != 0; });
        BOOST_TEST(moving <= static_cast<long>(quick.size() / 4));
    }
    BOOST_TEST(blocks > 20);                   // two contacts of each rattler at least
    BOOST_TEST(blocks < structure.size() / 2); // the backbone moves as a whole
}

BOOST_AUTO_TEST_CASE(a_guess_changes_the_way_and_not_the_forces) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex400.txt").state;
    const auto proved = crafted::Regular::proved(state);
    const auto stale = disturbed(proved.matrix(), 1e-3);
    const Factorisation fresh(proved);
    const Factorisation taken_over(proved, ApproximateInverse(stale));
    const auto n = static_cast<std::size_t>(proved.size());
    std::vector<double> f(n, 1.0);
    fresh.solve_forces(f);
    const double size = std::abs(*std::ranges::max_element(f));
    std::vector<double> guess = f;
    for (std::size_t l = 0; l < n; ++l) {
        guess[l] *= 1 + 1e-4 * std::cos(static_cast<double>(l));
    }
    std::vector<double> from_nothing(n, 1.0);
    taken_over.solve_forces_from(from_nothing, {}, 1e-12);
    const int without = taken_over.passes();
    std::vector<double> from_guess(n, 1.0);
    taken_over.solve_forces_from(from_guess, guess, 1e-12);
    BOOST_TEST(!taken_over.is_fresh());
    BOOST_TEST(taken_over.passes() - without < without);
    for (std::size_t l = 0; l < n; ++l) {
        BOOST_TEST(std::abs(from_nothing[l] - f[l]) < 1e-9 * size);
        BOOST_TEST(std::abs(from_guess[l] - f[l]) < 1e-9 * size);
    }
}

BOOST_AUTO_TEST_CASE(factors_can_be_moved_and_outlive_their_structure) {
    const State state = two_disks(1, 2, 1, 1);
    std::optional<Factorisation> kept;
    {
        const auto proved = crafted::Regular::proved(state);
        Factorisation factorisation(proved);
        kept.emplace(std::move(factorisation));
    }
    std::vector<double> force(6, 0.0);
    force[4] = -1; // inward on the right wall
    kept->solve_forces(force);
    BOOST_TEST(force[0] == 1.0, boost::test_tools::tolerance(1e-14)); // the left wall answers
}

BOOST_AUTO_TEST_CASE(factors_taken_over_from_another_structure_solve_as_well_as_fresh_ones) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const auto first = crafted::Regular::proved(state);
    const Factorisation base(first);
    ApproximateInverse inverse = base.approximate();
    std::vector<Contact> contacts = state.contacts;
    Packing packing = state.packing;
    const auto n = static_cast<std::size_t>(first.size());
    // Contacts give way to held coordinates, one of the places twice, while the grains move a little.
    const std::array<std::size_t, 4> places{10, 77, 10, 150};
    for (std::size_t k = 0; k < places.size(); ++k) {
        const std::vector<double>& v = inverse.mechanism(static_cast<int>(places[k]));
        const auto fastest = std::ranges::max_element(v, [](double a, double b) { return std::abs(a) < std::abs(b); });
        contacts[places[k]] = Contact{ContactKind::held, static_cast<int>(fastest - v.begin()), 0};
        for (std::size_t i = 0; i < packing.q.size(); ++i) {
            packing.q[i] += 1e-5 * std::sin(static_cast<double>(i + k));
        }
        const auto now = required(IsostaticStructure::prove(packing, contacts));
        inverse = inverse.exchanged(static_cast<int>(places[k]), now.matrix());
        const Factorisation taken_over(now, inverse);
        const Factorisation fresh(now);
        BOOST_TEST(!taken_over.is_fresh());
        for (const bool forces : {true, false}) {
            std::vector<double> a(n);
            for (std::size_t i = 0; i < n; ++i) {
                a[i] = std::cos(static_cast<double>(3 * i));
            }
            std::vector<double> b = a;
            forces ? taken_over.solve_forces(a) : taken_over.solve_velocities(a);
            forces ? fresh.solve_forces(b) : fresh.solve_velocities(b);
            double size = 0, difference = 0;
            for (std::size_t i = 0; i < n; ++i) {
                size = std::max(size, std::abs(b[i]));
                difference = std::max(difference, std::abs(a[i] - b[i]));
            }
            BOOST_TEST(difference < 1e-9 * size);
        }
        BOOST_TEST(!taken_over.is_fresh()); // it did converge
        BOOST_TEST(inverse.exchanges() == static_cast<int>(k) + 1);
    }
    std::vector<double> zero(n, 0.0);
    Factorisation(first, inverse).solve_forces(zero);
    BOOST_TEST((zero == std::vector<double>(n, 0.0)));
}

BOOST_AUTO_TEST_CASE(factors_that_do_not_converge_are_replaced_by_fresh_ones) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const auto structure = crafted::Regular::proved(state);
    sparse::Matrix<double> other = structure.matrix(); // the same pattern, unrelated values
    for (std::size_t e = 0; e < other.value.size(); ++e) {
        other.value[e] = std::sin(static_cast<double>(e * e + 1));
    }
    const Factorisation factorisation(structure, ApproximateInverse(other));
    const Factorisation fresh(structure);
    std::vector<double> a(static_cast<std::size_t>(structure.size()), 1.0);
    std::vector<double> b = a;
    factorisation.solve_forces(a);
    fresh.solve_forces(b);
    BOOST_TEST(factorisation.is_fresh());
    for (std::size_t i = 0; i < a.size(); ++i) {
        BOOST_TEST(std::abs(a[i] - b[i]) <= 1e-9 * (1 + std::abs(b[i])));
    }
}

BOOST_AUTO_TEST_CASE(factors_of_a_singular_or_overflowing_matrix_are_replaced_by_fresh_ones) {
    const State state = read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state;
    const auto structure = crafted::Regular::proved(state);
    const sparse::Matrix<double>& matrix = structure.matrix();
    const auto n = static_cast<std::size_t>(structure.size());
    const Factorisation fresh(structure);
    for (const double factor : {0.0, 1e-308, 1e-300, 1e-160, 1e-8, 1e8, 1e160, 1e300}) {
        for (const std::size_t column : {std::size_t{0}, n / 2, n - 1}) {
            sparse::Matrix<double> other = matrix;
            for (auto e = static_cast<std::size_t>(other.start[column]);
                 e < static_cast<std::size_t>(other.start[column + 1]); ++e) {
                other.value[e] *= factor;
            }
            for (const bool forces : {true, false}) {
                const Factorisation factorisation(structure, ApproximateInverse(other));
                std::vector<double> a(n, 1.0);
                std::vector<double> b = a;
                forces ? factorisation.solve_forces(a) : factorisation.solve_velocities(a);
                forces ? fresh.solve_forces(b) : fresh.solve_velocities(b);
                double off = 0, size = 0;
                for (std::size_t i = 0; i < n; ++i) {
                    BOOST_TEST(std::isfinite(a[i]), "factor " << factor << " column " << column);
                    off = std::max(off, std::abs(a[i] - b[i]));
                    size = std::max(size, std::abs(b[i]));
                }
                BOOST_TEST(off <= 1e-9 * size, "factor " << factor << " column " << column << " forces " << forces
                                                         << ": " << off << " of " << size);
            }
        }
    }
}
