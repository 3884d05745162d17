// The claim of a minimum along mechanisms whose coordinates are held (K28).
#include "checker/arcs.hpp"
#include "checker/bounds.hpp"
#include "checker/first_order.hpp"
#include "checker/forces.hpp"
#include "checker/index.hpp"
#include "checker/vertex.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

namespace isostat::checker {

namespace {

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

using Motions = std::vector<std::vector<Bounds>>;

/// Velocities of the coordinates at which one held coordinate moves at the rate 1 and all other rows stay.
Motions motions_of(const Evidence& e, const std::vector<std::size_t>& acting) {
    const Velocities velocities(e);
    Motions motions;
    for (const std::size_t l : acting) {
        const Velocities::Solution motion = velocities.opening(l, 1);
        std::vector<Bounds>& of = motions.emplace_back();
        for (std::size_t k = 0; k < motion.middle.size(); ++k) {
            of.push_back(e.problem.dof_of[k] < 0 ? Bounds(0)
                                                 : bounds_of(Range::around(motion.middle[k], motion.radius)));
        }
    }
    return motions;
}

/// A coordinate at all vertices of the evidence.
Bounds place(const Evidence& e, std::size_t k) {
    return bounds_of(coordinate_at(e.problem, e.vertex, k));
}

/// form += factor times the products of all changes.
void add_products(Form& form, const Bounds& factor, const std::vector<Bounds>& change) {
    for (std::size_t i = 0; i < form.size(); ++i) {
        for (std::size_t j = 0; j < form.size(); ++j) {
            form[i][j] = form[i][j] + factor * change[i] * change[j];
        }
    }
}

bool follows(const Evidence& e) {
    return e.state.load.kind == LoadKind::true_stress;
}

/// d2W on the held coordinates: - sum f_l D_l v_i . D_l v_j / D_l; under true stresses the second derivative of the
/// area times their potential, with F_a / L_a on the lengths besides.
Form second_variation(const Evidence& e, const Motions& v) {
    const Layout& layout = e.problem.layout;
    Form form(v.size(), std::vector<Bounds>(v.size(), Bounds(0)));
    std::vector<Bounds> change(v.size());
    for (std::size_t l = 0; l < e.forces.size(); ++l) {
        const Row& row = e.problem.rows[l];
        const auto [one, other] = closed_at(e.state.packing, e.state.contacts[l]);
        for (std::size_t a = 0; row.quadratic && a < layout.axes(); ++a) {
            for (std::size_t m = 0; m < v.size(); ++m) {
                change[m] = Bounds(0);
                for (std::size_t k = 0; k < static_cast<std::size_t>(row.count); ++k) {
                    const Bounds& part = v[m][static_cast<std::size_t>(row.coordinate[k])];
                    change[m] = row.axis[k] == a ? change[m] + part * row.sign[k] : change[m];
                }
            }
            add_products(form, -bounds_of(e.forces[l] / Range(Rational(one) + Rational(other))), change);
        }
    }
    for (std::size_t a = 0; follows(e) && a < layout.axes(); ++a) {
        const std::size_t k = layout.of_length(a);
        if (const int dof = e.problem.dof_of[k]; dof >= 0) {
            std::transform(v.begin(), v.end(), change.begin(), [k](const auto& motion) { return motion[k]; });
            const Bounds length = place(e, k);
            add_products(form, bounds_of(e.finite_load[at(dof)]) * Bounds::outwards(1 / length.upper, 1 / length.lower),
                         change);
        }
    }
    return form;
}

/// By how much the product of the lengths changes at most, from vertex to vertex.
double growth(const Evidence& e) {
    double most = 1;
    for (std::size_t a = 0; follows(e) && a < e.problem.layout.axes(); ++a) {
        const Bounds length = place(e, e.problem.layout.of_length(a));
        most = length.positive() ? product_above(most, quotient_above(length.upper, length.lower))
                                 : std::numeric_limits<double>::infinity();
    }
    return most;
}

Eigen::MatrixXd middle_of(const Form& form) {
    const auto k = static_cast<Eigen::Index>(form.size());
    return Eigen::MatrixXd::NullaryExpr(k, k, [&](Eigen::Index i, Eigen::Index j) {
        return form[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)].middle();
    });
}

/// A number that no eigenvalue is below: in a basis that is nearly that of the eigenvectors, by Gershgorin's discs.
double least_eigenvalue(const Form& form) {
    const auto k = static_cast<Eigen::Index>(form.size());
    const Eigen::MatrixXd q = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(middle_of(form)).eigenvectors();
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

/// 2-norm of what the inverse makes of the multipliers of the held rows, at most.
double newton_step_above(const Evidence& e, const std::vector<std::size_t>& acting, const Eigen::MatrixXd& inverse) {
    double square = 0;
    for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
        Bounds sum(0);
        for (Eigen::Index j = 0; j < inverse.cols(); ++j) {
            sum = sum + bounds_of(e.forces[acting[static_cast<std::size_t>(j)]]) * inverse(i, j);
        }
        square = sum_above(square, product_above(sum.size(), sum.size()));
    }
    return root_above(square);
}

/// Frobenius norm of 1 - inverse M, at most, whatever matrix of the form M is.
double defect_above(const Eigen::MatrixXd& inverse, const Form& form) {
    double square = 0;
    for (Eigen::Index i = 0; i < inverse.rows(); ++i) {
        for (std::size_t j = 0; j < form.size(); ++j) {
            Bounds entry(static_cast<std::size_t>(i) == j ? 1 : 0);
            for (std::size_t m = 0; m < form.size(); ++m) {
                entry = entry - form[m][j] * inverse(i, static_cast<Eigen::Index>(m));
            }
            square = sum_above(square, product_above(entry.size(), entry.size()));
        }
    }
    return root_above(square);
}

/// The claimed form: of what it should be, and positive definite whatever matrix of it is the true one.
std::pair<Verdict, std::string> judge_form(const Evidence& e, const MinimumClaim& claim,
                                           const std::vector<std::size_t>& acting, const Form& found) {
    const std::size_t k = acting.size();
    const auto of_claim = [&](std::size_t l, const Contact& held) { return e.state.contacts[l] == held; };
    if (!std::equal(acting.begin(), acting.end(), claim.held.begin(), claim.held.end(), of_claim) ||
        claim.form.size() != k * (k + 1) / 2) {
        return {Verdict::undecided, fmt::format("the load reaches {} held coordinates, and the form is of {}, or of "
                                                "others, or in another order",
                                                k, claim.held.size())};
    }
    Form claimed = found;
    std::pair<Verdict, std::string> answer{Verdict::proved, {}};
    auto entry = claim.form.begin();
    for (std::size_t i = 0; i < k; ++i) {
        for (std::size_t j = i; j < k; ++j, ++entry) {
            claimed[i][j] = claimed[j][i] = {entry->lower, entry->upper};
            const bool apart = found[i][j].lower > entry->upper || found[i][j].upper < entry->lower;
            const bool inside = found[i][j].lower >= entry->lower && found[i][j].upper <= entry->upper;
            if (apart || (!inside && answer.first == Verdict::proved)) {
                answer = {apart ? Verdict::refuted : Verdict::undecided,
                          fmt::format("entry {} {} of the form is in [{:.17g}, {:.17g}], claimed {}", i, j,
                                      found[i][j].lower, found[i][j].upper, shown(*entry))};
            }
        }
    }
    if (answer.first == Verdict::proved && !(least_eigenvalue(claimed) >= claim.curvature)) {
        return {Verdict::undecided, "the claimed form does not have the claimed curvature"};
    }
    return answer;
}

/// The most that a coordinate moves to first order where the held ones do by 1 in the 2-norm.
double swing_above(const Motions& motions) {
    double most = 0;
    for (std::size_t k = 0; k < motions.front().size(); ++k) {
        double square = 0;
        for (const std::vector<Bounds>& motion : motions) {
            square = sum_above(square, product_above(motion[k].size(), motion[k].size()));
        }
        most = std::max(most, square);
    }
    return root_above(most);
}

Evidence evidence_around(const Evidence& e, double swing, double reach) {
    return Evidence(e.state, CheckerArithmetic::rows, true, {}, usual_digits, Rational(product_above(swing, reach)));
}

/// How far the held coordinates may move. The narrower, the sharper all enclosures; below twice the step the minimum
/// might be outside.
double reach_of(const Evidence& e, double step) {
    // 0x1p-40: choice: held coordinates move by that share of the smallest radius at least; 2.01: checker.md K28, above
    // the 2 of clumps.md U8
    return std::max(0x1p-40 * e.state.packing.min_radius(), 2.01 * step);
}

} // namespace

ClaimCheck judge_minimum(const Evidence& e, const MinimumClaim& claim) {
    ClaimCheck check{.claim = "minimum", .claimed = true};
    const Load& load = e.state.load;
    const auto any = [](const std::vector<double>& forces) {
        return std::any_of(forces.begin(), forces.end(), [](double f) { return f != 0; });
    };
    if (!load.infinitesimal.empty() || (follows(e) && any(load.disk_force)) || e.state.packing.cell.keeps_shape) {
        return answer(check, Verdict::undecided,
                      "asked of loads with a potential, without infinitesimal ones, and not of the size of a cell");
    }
    if (!e.vertex.found) {
        return answer(check, Verdict::undecided, "no true vertex is proved: " + e.why_no_vertex());
    }
    if (const auto overlap = fixed_overlap(e.problem, e.state)) {
        return answer(check, Verdict::refuted, e.named(*overlap) + " overlap, and cannot move");
    }
    const std::vector<std::size_t> acting = acting_rows(e);
    if (acting.empty() || !(claim.curvature > 0)) {
        return answer(check, Verdict::undecided,
                      "no coordinate is held that the load reaches, or no curvature is claimed");
    }
    const Motions motions = motions_of(e, acting);
    const Form stored = second_variation(e, motions);
    if (const auto [verdict, why] = judge_form(e, claim, acting, stored); verdict != Verdict::proved) {
        return answer(check, verdict, why);
    }
    const Eigen::MatrixXd inverse = middle_of(stored).inverse();
    const double step = newton_step_above(e, acting, inverse);
    const double reach = reach_of(e, step);
    if (!(reach < 0.125 * e.state.packing.min_radius())) { // cost: wider ones are given up as undecided
        return answer(check, Verdict::undecided, fmt::format("Newton's step is up to {:.3g}, too long", step));
    }
    const double swing = swing_above(motions);
    if (!std::isfinite(product_above(swing, reach))) { // levers beyond the range of double
        return answer(check, Verdict::undecided, "velocities are beyond the range of double");
    }
    const Evidence wide = evidence_around(e, swing, reach);
    if (!wide.vertex.found) {
        return answer(check, Verdict::undecided, "no vertices around the stored place are proved");
    }
    // checker.md K28, what the product of the lengths changes by
    if (const std::string why = not_positive(wide); !why.empty() || !(growth(wide) < 1.1)) {
        return answer(check, Verdict::undecided, why.empty() ? "the lengths are not known well enough" : why);
    }
    const Form form = second_variation(wide, motions_of(wide, acting));
    const double curvature = least_eigenvalue(form);
    const double defect = defect_above(inverse, form);
    const std::string found = fmt::format("d2W is at least {:.6g} times |dc|^2, claimed {:.6g}; Newton's step up to "
                                          "{:.3g}, defect of the inverse {:.3g}",
                                          curvature, claim.curvature, step, defect);
    if (!(curvature >= claim.curvature) || !(defect < 0.25)) { // clumps.md U8, the defect of the inverse
        return answer(check, Verdict::undecided, found);
    }
    const Evidence nearer = evidence_around(e, swing, product_above(2, step));
    const double away =
        nearer.vertex.found ? rounded_up(nearer.vertex.moved_most) : std::numeric_limits<double>::infinity();
    check.numbers = {{"away", away}, {"curvature", curvature}};
    return answer(check, away <= claim.away ? Verdict::proved : Verdict::undecided,
                  fmt::format("a strict local minimum within {:.3g} per coordinate (claimed {:.3g}): {}", away,
                              claim.away, found));
}

} // namespace isostat::checker
