// T10 under the approximation of small displacements: gaps linear in the displacement, generic; the method is then the
// primal simplex method. Written out here with dense matrices, independent of the program's own path following.
#include "contact/candidates.hpp"
#include "families.hpp"
#include "rigidity/isostatic.hpp"
#include "support/prepared.hpp"

#include <eigen3/Eigen/Dense>

using namespace isostat;

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Gaps g - A u >= 0, load F, maximise F.u.
struct LinearPacking {
    MatrixXd approach; // one row per pair
    VectorXd gap;
    VectorXd base; // load at sigma2 = 0
    VectorXd unit; // per unit of sigma2
    std::vector<int> start;
};

struct Path {
    std::vector<int> basis; // sorted
    VectorXd u;
    int pivots = 0;
    bool optimal = false;
    double least_gain = std::numeric_limits<double>::infinity();
};

enum class Rule { most_negative, first_negative };

Path simplex(const LinearPacking& p, std::vector<int> basis, const VectorXd& u0, double sigma, Rule rule) {
    const VectorXd load = p.base + sigma * p.unit;
    const auto n = static_cast<Eigen::Index>(basis.size());
    Path path{std::move(basis), u0, 0, false, std::numeric_limits<double>::infinity()};
    for (; path.pivots < 2000; ++path.pivots) {
        MatrixXd g(n, n);
        for (Eigen::Index l = 0; l < n; ++l) {
            g.row(l) = p.approach.row(path.basis[static_cast<std::size_t>(l)]);
        }
        const Eigen::PartialPivLU<MatrixXd> lu(g);
        const VectorXd force = g.transpose().partialPivLu().solve(load);
        Eigen::Index open = 0;
        force.minCoeff(&open);
        if (force[open] > 0) {
            path.optimal = true;
            break;
        }
        for (Eigen::Index l = 0; rule == Rule::first_negative && l < n; ++l) {
            if (force[l] < 0) {
                open = l;
                break;
            }
        }
        const VectorXd v = lu.solve(-VectorXd::Unit(n, open)); // opens at unit rate, the others stay closed
        const VectorXd rate = p.approach * v;
        const VectorXd gaps = p.gap - p.approach * path.u;
        double step = std::numeric_limits<double>::infinity();
        int closes = -1;
        for (Eigen::Index l = 0; l < rate.size(); ++l) {
            const bool kept = std::ranges::find(path.basis, static_cast<int>(l)) != path.basis.end();
            if (!kept && rate[l] > 1e-12 && gaps[l] / rate[l] < step) {
                step = gaps[l] / rate[l];
                closes = static_cast<int>(l);
            }
        }
        if (closes < 0) {
            break; // unbounded
        }
        path.u += step * v;
        path.least_gain = std::min(path.least_gain, -force[open] * step);
        path.basis[static_cast<std::size_t>(open)] = closes;
    }
    std::ranges::sort(path.basis);
    return path;
}

LinearPacking linearised(const State& state) {
    LinearPacking p;
    const DofMap dofs(state.packing);
    const auto pairs = find_candidates(state.packing, 0.82).contacts;
    const auto h = contact_matrix(state.packing, dofs, pairs);
    p.approach = MatrixXd::Zero(h.cols, h.rows);
    p.gap = VectorXd(h.cols);
    for (int l = 0; l < h.cols; ++l) {
        const auto c = static_cast<std::size_t>(l);
        for (int e = h.start[c]; e < h.start[c + 1]; ++e) {
            p.approach(l, h.row[static_cast<std::size_t>(e)]) = h.value[static_cast<std::size_t>(e)];
        }
        const bool contact = std::ranges::find(state.contacts, pairs[c]) != state.contacts.end();
        p.gap[l] = contact ? 0.0 : gap(state.packing, pairs[c]);
        if (contact) {
            p.start.push_back(l);
        }
    }
    const auto fixed = state.load.fixed_force(state.packing);
    const auto unit = state.load.unit_force(state.packing);
    p.base = Eigen::Map<const VectorXd>(fixed.data(), h.rows);
    p.unit = Eigen::Map<const VectorXd>(unit.data(), h.rows);
    // Small finite loads on the disks in place of the infinitesimal ones: no force is zero then.
    for (std::size_t k = 0; k < state.load.infinitesimal.size(); ++k) {
        p.base[static_cast<Eigen::Index>(k)] += 1e-3 * state.load.infinitesimal[k];
    }
    return p;
}

} // namespace

BOOST_AUTO_TEST_CASE(linear_gaps_make_every_cycle_of_the_load_reversible) {
    int changes = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const LinearPacking p = linearised(prepared(10, seed));
        BOOST_REQUIRE(static_cast<Eigen::Index>(p.start.size()) == p.approach.cols());
        const VectorXd zero = VectorXd::Zero(p.approach.cols());
        Path here = simplex(p, p.start, zero, 1, Rule::most_negative);
        BOOST_REQUIRE(here.optimal);
        std::vector<Path> up{here};
        std::vector<double> loads{1};
        for (int k = 1; k <= 40; ++k) {
            const double sigma = 1 + 0.02 * k;
            here = simplex(p, here.basis, here.u, sigma, Rule::most_negative);
            if (!here.optimal) {
                break; // the packing gives way: no equilibrium at this load
            }
            BOOST_TEST((here.pivots == 0 || here.least_gain > 0));
            changes += here.pivots > 0 ? 1 : 0;
            up.push_back(here);
            loads.push_back(sigma);
        }
        BOOST_TEST_INFO_SCOPE("seed " << seed << ", up to sigma2 = " << loads.back());
        here = up.back();
        for (std::size_t k = up.size() - 1; k-- > 0;) {
            here = simplex(p, here.basis, here.u, loads[k], Rule::most_negative);
            BOOST_REQUIRE(here.optimal);
            BOOST_TEST((here.basis == up[k].basis));
            BOOST_TEST((here.u - up[k].u).norm() < 1e-9);
        }
    }
    BOOST_TEST(changes > 10); // a cycle without a rearrangement would prove nothing
}

BOOST_AUTO_TEST_CASE(linear_gaps_make_the_equilibrium_independent_of_the_way_to_it) {
    int different_ways = 0;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const LinearPacking p = linearised(prepared(10, seed));
        const VectorXd zero = VectorXd::Zero(p.approach.cols());
        for (const double sigma : {0.8, 0.9, 1.1, 1.2}) {
            const Path paper = simplex(p, p.start, zero, sigma, Rule::most_negative);
            const Path other = simplex(p, p.start, zero, sigma, Rule::first_negative);
            BOOST_TEST(paper.optimal == other.optimal); // or unbounded both
            if (paper.optimal && other.optimal) {
                BOOST_TEST((paper.basis == other.basis));
                different_ways += paper.pivots != other.pivots ? 1 : 0;
            }
        }
    }
    BOOST_TEST(different_ways > 0);
}

BOOST_AUTO_TEST_CASE(a_cluster_between_two_walls_has_no_unique_displacement) {
    // T10 (c) (iii) without k = 0: sliding along the walls changes no gap and does no work.
    const auto packing = families::counterexample("t8_one_pair_of_walls");
    const auto contacts = crafted::exact_contacts(packing).value();
    const DofMap dofs(crafted::approximate(packing));
    const auto g = exact::transposed(crafted::exact_contact_matrix(packing, dofs, contacts));
    const auto kernel = exact::kernel(g);
    BOOST_REQUIRE((kernel.exact == Verdict::proved));
    BOOST_REQUIRE(kernel.basis.size() == 1u);
    const auto force = crafted::external_force(packing, dofs);
    exact::Number work = 0;
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        work += force[mu] * kernel.basis[0][mu];
    }
    BOOST_TEST(work.is_zero());
}
