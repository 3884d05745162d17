// The claim of a minimum along mechanisms whose coordinates are held (K28).
#include "checker/arcs.hpp"
#include "checker/bounds.hpp"
#include "checker/first_order.hpp"
#include "checker/gaps.hpp"
#include "checker/index.hpp"
#include "checker/structural_zeros.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

namespace isostat::checker {

namespace {

Bounds bounds_of(const Range& range) {
    return {rounded_down(range.lower), rounded_up(range.upper)};
}

/// Held rows that the load may reach.
std::vector<std::size_t> acting_rows(const Evidence& e) {
    const auto zeros = structural_zeros(e.problem, e.finite_load);
    std::vector<std::size_t> acting;
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (e.state.contacts[l].kind == ContactKind::held && !(zeros && contains(*zeros, l))) {
            acting.push_back(l);
        }
    }
    return acting;
}

/// 2-norm of the multipliers, at most.
double multiplier_above(const Evidence& e, const std::vector<std::size_t>& acting) {
    double square = 0;
    for (const std::size_t l : acting) {
        const double size = bounds_of(e.forces[l]).size();
        square = sum_above(square, product_above(size, size));
    }
    return root_above(square);
}

/// What is not positive at every vertex of the evidence, in words; empty: nothing.
std::string not_positive(const Evidence& e) {
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        if (e.state.contacts[l].is_unilateral() && !e.forces[l].positive()) {
            return fmt::format("the force of {} is in {}", e.name(l), shown(e.forces[l]));
        }
    }
    if (std::string unfit = unfit_arcs(e.problem, e.state, e.vertex); !unfit.empty()) {
        return unfit;
    }
    for (const Gap& gap : smallest_gaps(e.problem, e.state, e.vertex)) {
        if (gap.pair.i < 0 || !gap.value.positive()) {
            return fmt::format("the gap of {} is in {}", e.named(gap.pair), shown(gap.value));
        }
    }
    return {};
}

using Form = std::vector<std::vector<Bounds>>;

/// d2W on the held coordinates: - sum f_l D_l v_i . D_l v_j / D_l, v_i the velocities at which one of them moves at the
/// rate 1 and all other rows stay.
Form second_variation(const Evidence& e, const std::vector<std::size_t>& acting) {
    const Layout& layout = e.problem.layout;
    const Velocities velocities(e);
    std::vector<std::vector<Bounds>> v;
    for (const std::size_t l : acting) {
        const Velocities::Solution motion = velocities.opening(l, 1);
        std::vector<Bounds>& of = v.emplace_back();
        for (std::size_t k = 0; k < motion.middle.size(); ++k) {
            of.push_back(e.problem.dof_of[k] < 0 ? Bounds(0)
                                                 : bounds_of(Range::around(motion.middle[k], motion.radius)));
        }
    }
    Form form(acting.size(), std::vector<Bounds>(acting.size(), Bounds(0)));
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const Contact& c = e.state.contacts[l];
        if (!c.of_disks()) {
            continue;
        }
        const auto [one, other] = closed_at(e.state.packing, c);
        const Bounds per_length = bounds_of(e.forces[l] / Range(Rational(one) + Rational(other)));
        for (std::size_t a = 0; a < layout.axes(); ++a) {
            const auto change = [&](std::size_t m) {
                return v[m][layout.of_disk(c.i) + a] - v[m][layout.of_disk(c.j) + a];
            };
            for (std::size_t i = 0; i < acting.size(); ++i) {
                for (std::size_t j = 0; j < acting.size(); ++j) {
                    form[i][j] = form[i][j] - per_length * change(i) * change(j);
                }
            }
        }
    }
    return form;
}

/// A number that no eigenvalue is below: in a basis that is nearly that of the eigenvectors, by Gershgorin's discs.
double least_eigenvalue(const Form& form) {
    const auto k = static_cast<Eigen::Index>(form.size());
    Eigen::MatrixXd middle(k, k);
    for (Eigen::Index i = 0; i < k; ++i) {
        for (Eigen::Index j = 0; j < k; ++j) {
            middle(i, j) = form[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].middle();
        }
    }
    const Eigen::MatrixXd q = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(middle).eigenvectors();
    const auto in_basis = [&](const auto& entry, Eigen::Index i, Eigen::Index j) {
        Bounds sum(0);
        for (Eigen::Index a = 0; a < k; ++a) {
            for (Eigen::Index b = 0; b < k; ++b) {
                sum = sum + entry(a, b) * q(a, i) * q(b, j);
            }
        }
        return sum;
    };
    const auto of_form = [&](Eigen::Index a, Eigen::Index b) {
        return form[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
    };
    const auto of_unit = [](Eigen::Index a, Eigen::Index b) { return Bounds(a == b ? 1 : 0); };
    double least = std::numeric_limits<double>::infinity();
    double stretch = 0; // of |c|^2 by the basis
    for (Eigen::Index i = 0; i < k; ++i) {
        double row = in_basis(of_form, i, i).lower;
        double size = in_basis(of_unit, i, i).size();
        for (Eigen::Index j = 0; j < k; ++j) {
            if (j != i) {
                row = next_below(row - in_basis(of_form, i, j).size());
                size = sum_above(size, in_basis(of_unit, i, j).size());
            }
        }
        if (!std::isfinite(row) || !std::isfinite(size)) {
            return 0;
        }
        least = std::min(least, row);
        stretch = std::max(stretch, size);
    }
    return next_below(least / stretch);
}

/// The most that a coordinate moves to first order where the held ones do by 1 in the 2-norm.
double swing_above(const Evidence& e, const std::vector<std::size_t>& acting) {
    const Velocities velocities(e);
    std::vector<double> square(e.problem.dof_of.size(), 0.0);
    for (const std::size_t l : acting) {
        const Velocities::Solution motion = velocities.opening(l, 1);
        for (std::size_t k = 0; k < square.size(); ++k) {
            const double most = e.problem.dof_of[k] < 0 ? 0 : rounded_up(abs(motion.middle[k]) + motion.radius);
            square[k] = sum_above(square[k], product_above(most, most));
        }
    }
    return root_above(*std::max_element(square.begin(), square.end()));
}

Evidence evidence_around(const Evidence& e, double swing, double reach) {
    return Evidence(e.state, CheckerArithmetic::rows, true, {}, usual_digits, Rational(product_above(swing, reach)));
}

} // namespace

ClaimCheck judge_minimum(const Evidence& e, const MinimumClaim& claim) {
    ClaimCheck check{.claim = "minimum", .claimed = true};
    const Load& load = e.state.load;
    if (load.kind != LoadKind::nominal || !load.infinitesimal.empty() || e.state.packing.cell.any()) {
        return answer(check, Verdict::undecided, "asked of dead loads in a box, without infinitesimal ones");
    }
    if (!e.vertex.found) {
        return answer(check, Verdict::undecided, "no true vertex is proved: " + e.why_no_vertex());
    }
    if (const auto overlap = fixed_overlap(e.problem, e.state)) {
        return answer(check, Verdict::refuted, e.named(*overlap) + " overlap, and cannot move");
    }
    const std::vector<std::size_t> acting = acting_rows(e);
    const double multiplier = multiplier_above(e, acting);
    // The narrower, the sharper all enclosures; below this the multipliers might move the minimum out.
    const double reach = std::max(0x1p-40 * e.state.packing.min_radius(), 4.01 * multiplier / claim.curvature);
    if (acting.empty() || !(claim.curvature > 0) || !(reach < 0.125 * e.state.packing.min_radius())) {
        return answer(check, Verdict::undecided,
                      acting.empty() ? "no coordinate is held that the load reaches"
                                     : fmt::format("multipliers up to {:.3g} are too large for a curvature of {:.6g}",
                                                   multiplier, claim.curvature));
    }
    const double swing = swing_above(e, acting);
    if (!std::isfinite(product_above(swing, reach))) { // levers beyond the range of double
        return answer(check, Verdict::undecided, "velocities are beyond the range of double");
    }
    const Evidence wide = evidence_around(e, swing, reach);
    if (!wide.vertex.found) {
        return answer(check, Verdict::undecided, "no vertices around the stored place are proved");
    }
    if (const std::string why = not_positive(wide); !why.empty()) {
        return answer(check, Verdict::undecided, why);
    }
    const double curvature = least_eigenvalue(second_variation(wide, acting));
    const std::string found =
        fmt::format("d2W is at least {:.6g} times |dc|^2, claimed {:.6g}; multipliers up to {:.3g}", curvature,
                    claim.curvature, multiplier);
    if (!(curvature >= claim.curvature) || !(product_above(4, multiplier) < next_below(curvature * reach))) {
        return answer(check, Verdict::undecided, found);
    }
    const Evidence nearer = evidence_around(e, swing, next_above(multiplier / curvature));
    const double away =
        nearer.vertex.found ? rounded_up(nearer.vertex.moved_most) : std::numeric_limits<double>::infinity();
    check.numbers = {{"away", away}, {"curvature", curvature}};
    return answer(check, away <= claim.away ? Verdict::proved : Verdict::undecided,
                  fmt::format("a strict local minimum within {:.3g} per coordinate (claimed {:.3g}): {}", away,
                              claim.away, found));
}

} // namespace isostat::checker
