// Bounds carried over an exchange of contacts (V8) and made anew for it (V1), against inverse iteration with fresh
// factors.
#include "motion/arc.hpp"
#include "oracle/random.hpp"
#include "statics/statics.hpp"
#include "support/crafted.hpp"
#include "support/regular.hpp"
#include "verified/block_cholesky.hpp"
#include "verified/inverse_bound.hpp"
#include "verified/singular_value.hpp"

#include <isostat/io/state_file.hpp>

#include <Eigen/Dense>

using namespace isostat;
using namespace crafted;

namespace {

/// Smallest singular value by inverse iteration with factors of this very matrix: from above, converged to 1e-3.
double smallest_singular_value(const IsostaticStructure& structure) {
    const Factorisation factorisation(structure);
    std::vector<double> x(static_cast<std::size_t>(structure.size()));
    for (std::size_t k = 0; k < x.size(); ++k) {
        x[k] = std::sin(static_cast<double>(k * k));
    }
    const auto norm = [&] { return std::sqrt(std::inner_product(x.begin(), x.end(), x.begin(), 0.0)); };
    for (int iteration = 0; iteration < 200; ++iteration) {
        const double size = norm();
        for (double& c : x) {
            c /= size;
        }
        factorisation.solve_forces(x);
        factorisation.solve_velocities(x);
    }
    return 1 / std::sqrt(norm());
}

/// The shifts beside the one at which the factorisation begins to fail.
std::pair<double, double> bisected(BlockCholesky& cholesky, double low, double high, int steps) {
    for (int k = 0; k < steps && std::nextafter(low, high) < high; ++k) {
        const double middle = 0.5 * (low + high);
        (cholesky.factorise(middle) ? low : high) = middle;
    }
    return {low, high};
}

/// A start, and one exchange of it along an arc.
struct Exchange : Regular {
    Exchange() : Regular(read_state(std::string(ISOSTAT_TEST_DATA) + "/vertex100.txt").state) {}

    Result<Arc> open(int contact) {
        CandidateList candidates = find_candidates(state.packing, candidate_fraction);
        Load none = state.load; // any contact may open here, not only one that a load drives apart
        none.stress.fill(0);
        const PowerLoad power{&none, false, false};
        return follow_arc({state.packing, structure, factorisation, ContactId(contact)}, power, candidates, {});
    }
};

} // namespace

BOOST_AUTO_TEST_CASE(bounds_after_an_exchange_lie_below_the_smallest_singular_value_and_near_it) {
    Exchange from;
    int carried = 0, fresh = 0;
    for (int opened = 0; opened < from.structure.size(); opened += 7) {
        const auto arc = from.open(opened);
        if (!arc.ok()) {
            continue;
        }
        const auto next = required(
            IsostaticStructure::exchange(from.structure, arc.value().end, ContactId(opened), arc.value().closed));
        const ApproximateInverse approximate = from.factorisation.approximate().exchanged(next.slot(), next.matrix());
        const auto by_cholesky = bound_exchanged(next, approximate, from.cache);
        auto proved = required(IsostaticStructure::prove(arc.value().end, next.contacts()));
        const double sigma = smallest_singular_value(proved);
        if (by_cholesky) {
            BOOST_TEST(by_cholesky->bound.sigma_min < sigma * 1.001);
            BOOST_TEST(by_cholesky->bound.sigma_min > 0.1 * sigma);
            ++fresh;
        }
        // In a box with nothing fixed the tangent has the numbering of the degrees of freedom.
        const auto bound = carry_bound(from.structure, from.inverse, next, approximate, arc.value().tangent);
        if (!bound) {
            continue;
        }
        BOOST_TEST(bound->bound.sigma_min < sigma * 1.001);
        BOOST_TEST(bound->bound.sigma_min > 0.005 * sigma);
        BOOST_TEST((bound->bound.route == InverseBound::Route::carried));
        BOOST_TEST(bound->proof.sigma_min() == bound->bound.sigma_min);
        ++carried;
    }
    BOOST_TEST(carried > 3);
    BOOST_TEST(fresh > 10);
}

BOOST_AUTO_TEST_CASE(without_motion_a_bound_is_carried_with_little_loss_and_a_wrong_guess_costs_only_the_bound) {
    Exchange from;
    // A held coordinate in place of a contact, the packing unmoved: the kept rows are the same.
    const std::vector<double> v = from.factorisation.approximate().mechanism(5);
    const auto fastest = std::ranges::max_element(v, [](double a, double b) { return std::abs(a) < std::abs(b); });
    const Contact held{ContactKind::held, static_cast<int>(fastest - v.begin()), 0};
    const auto next = required(IsostaticStructure::exchange(from.structure, from.state.packing, ContactId(5), held));
    const ApproximateInverse approximate = from.factorisation.approximate().exchanged(5, next.matrix());
    const auto bound = carry_bound(from.structure, from.inverse, next, approximate, v);
    BOOST_TEST_REQUIRE(bound.has_value());
    const auto proved = required(IsostaticStructure::prove(from.state.packing, next.contacts()));
    const double sigma = smallest_singular_value(proved);
    BOOST_TEST(bound->bound.sigma_min < sigma * 1.001);
    BOOST_TEST(bound->bound.sigma_min > 0.5 * std::min(sigma, from.inverse.sigma_min));
    // A guess that is no mechanism at all is refined or refused; what comes out is still a bound.
    oracle::Random random(5);
    std::vector<double> wrong(v.size());
    std::ranges::generate(wrong, [&] { return static_cast<double>(random.integer(2001)) / 1000 - 1; });
    const auto still = carry_bound(from.structure, from.inverse, next, approximate, wrong);
    BOOST_TEST((!still || still->bound.sigma_min < sigma * 1.001));
}

BOOST_AUTO_TEST_CASE(a_shifted_cholesky_factorisation_ends_below_the_smallest_eigenvalue_and_not_above_it) {
    Exchange from;
    const double sigma = smallest_singular_value(from.structure);
    const auto n = static_cast<std::size_t>(from.structure.size());
    FillOrder made;
    BlockCholesky cholesky;
    cholesky.set(from.structure.matrix(), made);
    BOOST_TEST(made.work == cholesky.work());
    // Also a bad order that is said to be good, and the same that is found outgrown.
    FillOrder backwards{made.rows, 1e300};
    std::iota(backwards.rows.rbegin(), backwards.rows.rend(), 0);
    FillOrder outgrown = backwards;
    outgrown.work = made.work;
    for (FillOrder* order : {&made, &backwards, &outgrown}) {
        cholesky.set(from.structure.matrix(), *order); // in the memory of the one before
        BOOST_TEST(cholesky.factorise(0.995 * sigma * sigma));
        BOOST_TEST(!cholesky.factorise(1.005 * sigma * sigma));
        BOOST_TEST(cholesky.factorise(0.5 * sigma * sigma));
        BOOST_TEST(cholesky.error_bound(0.5 * sigma * sigma) < 1e-8);
        BOOST_TEST(cholesky.error_bound(0.5 * sigma * sigma) > 0x1p-53 * static_cast<double>(n));
    }
    BOOST_TEST(backwards.work == 1e300);
    BOOST_TEST((outgrown.rows == made.rows));
    // An odd number of rows: half of the last block is not there.
    sparse::Matrix<double> odd;
    odd.rows = odd.cols = 3;
    odd.start = {0, 2, 4, 6};
    odd.row = {0, 1, 1, 2, 0, 2};
    odd.value = {3, 1, 2, -1, 1, 2}; // H H^T = [[10, 3, 2], [3, 5, -2], [2, -2, 5]]
    FillOrder any;
    cholesky.set(odd, any);
    BOOST_TEST(cholesky.factorise(0.0));
    double low = bisected(cholesky, 0, 0.99, 60).first; // the pivot of the row that is not there is 1 - s
    const auto det = [](double s) {
        const double a = 10 - s;
        const double b = 5 - s;
        return a * (b * b - 4) - 3 * (3 * b + 4) + 2 * (-6 - 2 * b);
    };
    BOOST_TEST(det(0.9) > 0);
    BOOST_TEST(low > 0.9);
    for (double& c : odd.value) {
        c *= 0.25; // now the smallest eigenvalue is below 1
    }
    cholesky.set(odd, any);
    low = bisected(cholesky, 0, 0.99, 60).first;
    BOOST_TEST(low < 0.9);
    BOOST_TEST(std::abs(det(16 * low)) < 1e-9);
    BOOST_TEST(det(15.9 * low) > 0);
}

/// Bidiagonal: H H^T has 2 on its diagonal (1 in the first row) and -1 beside it.
sparse::Matrix<double> chain(int n) {
    sparse::Matrix<double> h;
    h.rows = h.cols = n;
    h.start = {0};
    for (int l = 0; l < n; ++l) {
        h.row.push_back(l);
        h.value.push_back(1);
        if (l + 1 < n) {
            h.row.push_back(l + 1);
            h.value.push_back(-1);
        }
        h.start.push_back(static_cast<int>(h.row.size()));
    }
    return h;
}

BOOST_AUTO_TEST_CASE(the_rounding_of_a_cholesky_factorisation_is_within_its_bound_and_does_not_add_up_over_the_rows) {
    int above = 0;
    for (const int n : {40, 41, 60, 61, 80, 100, 101, 120, 160, 200, 200000, 200001}) {
        const double half = std::sin(std::acos(-1.0) / (2.0 * (2.0 * n + 1)));
        const double smallest = 4 * half * half; // eigenvalue of H H^T, in closed form
        const sparse::Matrix<double> h = chain(n);
        FillOrder order;
        BlockCholesky cholesky;
        cholesky.set(h, order);
        const auto [low, high] = bisected(cholesky, 0.5 * smallest, 2 * smallest, n < 1000 ? 200 : 30);
        BOOST_TEST_REQUIRE(cholesky.factorise(low));
        const double bound = cholesky.error_bound(low);
        BOOST_TEST(low - bound < smallest);
        BOOST_TEST(low - bound > 0.99 * smallest);
        BOOST_TEST(high + bound > smallest);
        above += low > smallest * (1 + 0x1p-51) ? 1 : 0;
    }
    BOOST_TEST(above > 0); // where the bound is needed
}

// A chain whose grains all touch one wall: row n - 1 is full, in L too. By dense matrices in the natural order, which
// has the least fill: the norm of the matrix M of V1, and what its largest row says of it.
BOOST_AUTO_TEST_CASE(the_bound_of_the_rounding_comes_near_the_norm_that_it_bounds) {
    for (const int n : {60, 121, 240}) {
        sparse::Matrix<double> h = chain(n - 1);
        h.rows = h.cols = n;
        sparse::Matrix<double> walled;
        walled.rows = walled.cols = n;
        walled.start = {0};
        for (int l = 0; l < n; ++l) {
            for (int e = l + 1 < n ? h.start[static_cast<std::size_t>(l)] : 0;
                 l + 1 < n && e < h.start[static_cast<std::size_t>(l) + 1]; ++e) {
                walled.row.push_back(h.row[static_cast<std::size_t>(e)]);
                walled.value.push_back(h.value[static_cast<std::size_t>(e)]);
            }
            walled.row.push_back(n - 1);
            walled.value.push_back(l + 1 < n ? 0.05 : 1.0);
            walled.start.push_back(static_cast<int>(walled.row.size()));
        }
        const auto size = static_cast<Eigen::Index>(n);
        Eigen::MatrixXd b = Eigen::MatrixXd::Zero(size, size);
        for (int l = 0; l < n; ++l) {
            for (int e = walled.start[static_cast<std::size_t>(l)]; e < walled.start[static_cast<std::size_t>(l) + 1];
                 ++e) {
                b(walled.row[static_cast<std::size_t>(e)], l) = walled.value[static_cast<std::size_t>(e)];
            }
        }
        constexpr double shift = 1e-20;
        const Eigen::MatrixXd l = Eigen::MatrixXd((b * b.transpose()).llt().matrixL());
        Eigen::VectorXd root(size);
        for (Eigen::Index k = 0; k < size; ++k) {
            const auto entries = (b.row(k).array() != 0).count() + (l.row(k).array().abs() > 1e-13).count() + 4;
            root(k) = std::sqrt(static_cast<double>(entries) * 0x1p-53);
        }
        const Eigen::MatrixXd sum = b.cwiseAbs() * b.cwiseAbs().transpose() + l.cwiseAbs() * l.cwiseAbs().transpose();
        const Eigen::MatrixXd m = root.asDiagonal() * sum * root.asDiagonal();
        const double norm = m.operatorNorm();
        const double row = (root.cwiseAbs2().asDiagonal() * sum).rowwise().sum().maxCoeff();
        FillOrder order;
        BlockCholesky cholesky;
        cholesky.set(walled, order);
        BOOST_TEST_REQUIRE(cholesky.factorise(shift));
        const double bound = cholesky.error_bound(shift);
        BOOST_TEST(bound > 0.9 * norm); // in its own order
        BOOST_TEST(bound < 3 * norm);   // zeros in blocks are counted
        BOOST_TEST(bound < row);
    }
}

BOOST_AUTO_TEST_CASE(rows_of_walls_are_scaled_down_by_powers_of_two_and_no_others) {
    oracle::Random random(9);
    sparse::Matrix<double> h;
    h.rows = 40;
    h.cols = 600;
    h.start = {0};
    std::vector<double> sum(40, 0.0);
    for (int l = 0; l < h.cols; ++l) {
        for (int k = 0; k < h.rows; ++k) {
            if (random.integer(40) < k) { // few entries in the first rows, all columns in the last
                h.row.push_back(k);
                h.value.push_back(random.real(-1, 1));
                sum[static_cast<std::size_t>(k)] += h.value.back() * h.value.back();
            }
        }
        h.start.push_back(static_cast<int>(h.row.size()));
    }
    const std::vector<double> scale = row_scales(h);
    BOOST_TEST_REQUIRE(scale.size() == sum.size());
    int small = 0;
    for (std::size_t k = 0; k < sum.size(); ++k) {
        int exponent = 0;
        BOOST_TEST(std::frexp(scale[k], &exponent) == 0.5);
        BOOST_TEST(scale[k] <= 1);
        BOOST_TEST(((scale[k] < 1) == (sum[k] > 16)));
        if (scale[k] < 1) {
            ++small;
            BOOST_TEST(sum[k] * scale[k] * scale[k] <= 1);
            BOOST_TEST(sum[k] * scale[k] * scale[k] > 0.25);
        }
    }
    BOOST_TEST(small > 5);
    BOOST_TEST(small < 39);
}

BOOST_AUTO_TEST_CASE(rough_forces_lie_within_their_bound_and_the_first_climb_takes_them_to_rounding) {
    Exchange from;
    int compared = 0;
    double worst = 0;
    for (int opened = 0; opened < from.structure.size(); opened += 9) {
        const auto arc = from.open(opened);
        if (!arc.ok()) {
            continue;
        }
        auto next = required(
            IsostaticStructure::exchange(from.structure, arc.value().end, ContactId(opened), arc.value().closed));
        const ApproximateInverse approximate = from.factorisation.approximate().exchanged(next.slot(), next.matrix());
        const auto proved = bound_exchanged(next, approximate, from.cache);
        if (!proved) {
            continue;
        }
        const auto structure = IsostaticStructure::exchanged(std::move(next), proved->proof);
        const Factorisation stale(structure, approximate);
        const Factorisation fresh(structure);
        const Packing& packing = arc.value().end;
        const Statics near(from.state.packing, from.state.load, from.structure, from.factorisation, from.inverse);
        const double sigma = from.state.load.stress[1];
        (void)near.force(ContactId(0), sigma);
        LadderOptions options;
        options.first_accuracy = 1e-8; // rougher is refused: records hold to 1e-7
        Statics rough(packing, from.state.load, structure, stale, proved->bound, {options, nullptr, &near});
        Statics exact(packing, from.state.load, structure, fresh, proved->bound);
        BOOST_TEST_REQUIRE(exact.climb()); // double-double
        const auto differ = [&] {
            double largest = 0;
            for (int l = 0; l < structure.size(); ++l) {
                const ContactId id(l);
                const double f = exact.force(id, sigma).value;
                largest = std::max(largest, std::abs(rough.force(id, sigma).value - f));
                BOOST_TEST(std::abs(rough.force(id, sigma).value - f) <=
                           rough.force(id, sigma).radius + 1e-16 * std::abs(f));
            }
            return largest;
        };
        const double off = differ();
        const double first = rough.bound(sigma);
        worst = std::max(worst, off);
        BOOST_TEST_REQUIRE(rough.climb());
        BOOST_TEST((rough.rung() == Rung::double_bound));
        BOOST_TEST(rough.bound(sigma) <= std::max(1e-3 * first, 1e-9));
        BOOST_TEST(differ() < 1e-9);
        BOOST_TEST_REQUIRE(rough.climb());
        BOOST_TEST((rough.rung() == Rung::double_double));
        ++compared;
    }
    BOOST_TEST(compared > 5);
    BOOST_TEST(worst > 1e-12); // they were rough
}

BOOST_AUTO_TEST_CASE(a_structure_says_what_its_regularity_was_proved_with) {
    Exchange from;
    BOOST_TEST((from.structure.evidence() == RegularityEvidence::elimination));
    const auto next = required(
        IsostaticStructure::exchange(from.structure, from.state.packing, ContactId(5), from.structure.contacts()[5]));
    auto unproved = next;
    BOOST_TEST((IsostaticStructure::without_proof(std::move(unproved)).evidence() == RegularityEvidence::none));
    const auto proved = required(bound_exchanged(next, from.factorisation.approximate(), from.cache));
    auto contacts = next;
    // The proof is of the matrix of next, which the copy shares.
    BOOST_TEST((IsostaticStructure::exchanged(std::move(contacts), proved.proof).evidence() ==
                RegularityEvidence::singular_value));
}

BOOST_AUTO_TEST_CASE(no_proof_is_made_for_a_singular_exchange) {
    Exchange from;
    // Two of the same contact: singular whatever the coordinates are.
    const Contact twice = from.state.contacts[3];
    const auto next = IsostaticStructure::exchange(from.structure, from.state.packing, ContactId(40), twice);
    if (next) { // the pattern alone may have told
        const ApproximateInverse approximate = from.factorisation.approximate().exchanged(40, next->matrix());
        std::vector<double> v = from.factorisation.approximate().mechanism(40);
        BOOST_TEST(!carry_bound(from.structure, from.inverse, *next, approximate, v).has_value());
        BOOST_TEST(!bound_exchanged(*next, from.factorisation.approximate(), from.cache).has_value());
    }
    BOOST_TEST(!IsostaticStructure::prove(from.state.packing, next ? next->contacts() : from.state.contacts).ok() ==
               next.has_value());
}

BOOST_AUTO_TEST_CASE(nothing_is_carried_when_the_grains_moved_farther_than_the_bound_allows) {
    Exchange from;
    Packing moved = from.state.packing;
    moved.q[20] += 0.5 * moved.min_radius();
    const auto next =
        required(IsostaticStructure::exchange(from.structure, moved, ContactId(5), Contact{ContactKind::held, 0, 0}));
    const ApproximateInverse approximate = from.factorisation.approximate().exchanged(5, next.matrix());
    BOOST_TEST(
        !carry_bound(from.structure, from.inverse, next, approximate, from.factorisation.approximate().mechanism(5))
             .has_value());
}
