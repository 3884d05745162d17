#include "certificate/jammed_box.hpp"
#include "contact/candidates.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/inverse_bound.hpp"
#include "verified/vertex_bounds.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <utility>

namespace isostat {

namespace {

// cells.md C14
constexpr double slack = 1e-9; ///< rounding of the few operations that bounds are put together by
// cells.md C14
constexpr double of_products = 0x1p-40; ///< of v with a column or with the load: up to twelve terms, entries up to 3

/// Contacts, how they turn with the coordinates, and what the load is. Nothing here moves but by the strain asked for.
struct ClosedList {
    Packing packing;
    std::vector<Contact> contacts;
    sparse::Matrix<double> h;
    std::vector<double> load; ///< 0, or a pressure, on the degrees of freedom
    double load_rate = 0;     ///< |load(q') - load(q)| <= load_rate |q' - q|
    double normal_rate = 0;   ///< |H(q') - H(q)| <= normal_rate |q' - q|
    double most = 0;          ///< |q' - q| for which the rates hold
};

/// \p strains: all of the cell; else the disks alone.
ClosedList list_of(const Packing& packing, const std::vector<Contact>& contacts, bool strains) {
    // cells.md C14
    ClosedList list{packing, contacts, {}, {}, 0, normal_rate(packing, contacts), 1e-3 * packing.min_radius()};
    list.packing.cell.keeps_shape = false;
    list.packing.cell.move(strains, strains);
    const DofMap dofs(list.packing);
    list.h = contact_matrix(list.packing, dofs, contacts);
    list.load.assign(static_cast<std::size_t>(list.h.rows), 0);
    if (strains) {
        Load load;
        load.dimension = packing.dimension;
        double volume = packing.dimension, work = 0, longest = 0;
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            volume *= packing.lattice(a, a);
            longest = std::max(longest, packing.lattice(a, a));
        }
        for (const Contact& c : contacts) {
            work += target(packing, c);
        }
        const double pressure = work / volume; // forces are about 1
        std::fill_n(load.stress.begin(), packing.dimension, pressure);
        load.refer_to(list.packing);
        list.load = on_dofs(load.external_force(list.packing), dofs);
        list.load_rate = pressure * (packing.dimension == plane ? 1 : 4 * longest) * (1 + slack); // cells.md C14
    }
    return list;
}

using Sparse = Eigen::SparseMatrix<double>;

/// Forces f = exp(-H^T v), and v.
struct EntropicBalance {
    Eigen::VectorXd force, motion, approach; ///< approach = H^T v
};

/// Along -v all contacts open, and the load does not resist, at every q' (C14 (b)): how far q' may be. Not positive:
/// nothing is known.
double radius_of_opening(const ClosedList& list, const EntropicBalance& b) {
    const double length = b.motion.norm() * (1 + slack);
    const Eigen::Map<const Eigen::VectorXd> load(list.load.data(), list.h.rows);
    const double of_gaps = (b.approach.minCoeff() / length - of_products) / list.normal_rate;
    const double of_load = (-load.dot(b.motion) / length - of_products * load.norm()) / list.load_rate;
    return (list.load_rate > 0 && !(of_load >= of_gaps) ? of_load : of_gaps) * (1 - slack);
}

/// H(q') has positive forces under the load, and no mechanism, at every q' (C14 (a)): as above.
double radius_of_balance(const ClosedList& list, const EntropicBalance& b) {
    const std::vector<double> force(b.force.begin(), b.force.end());
    std::vector<double> rest, size(list.load.size());
    std::vector<int> terms(list.load.size());
    const double residual = residual_of_forces(list.h, list.load, force, rest, size, terms);
    const double sigma = smallest_row_singular_value(list.h, list.packing.dimension);
    const double smallest = b.force.minCoeff();
    const double turn = turn_of_forces(list.packing, list.contacts, force);
    return (sigma * smallest - residual) / (list.normal_rate * smallest + turn + list.load_rate) * (1 - slack);
}

/// By Newton's method for the smallest sum of f plus load.v, where H f is the load; where there is none v runs off, and
/// `radius_of_opening` is asked. Nothing of it is proved.
EntropicBalance balance_of(const ClosedList& list) {
    constexpr int most_steps = 100;   // cost: steps before nothing is said
    constexpr double settled = 1e-13; // guess: when Newton's method has converged
    const Eigen::Map<const Sparse> h(list.h.rows, list.h.cols, list.h.entries(), list.h.start.data(), list.h.row.data(),
                                     list.h.value.data());
    const Eigen::Map<const Eigen::VectorXd> load(list.load.data(), list.h.rows);
    EntropicBalance b{Eigen::VectorXd::Ones(list.h.cols), Eigen::VectorXd::Zero(list.h.rows), {}};
    Eigen::SimplicialLDLT<Sparse> factors;
    for (int step = 0; step < most_steps; ++step) {
        factors.compute(Sparse(h * b.force.asDiagonal() * h.transpose()));
        const Eigen::VectorXd change = factors.solve(h * b.force - load);
        const double fastest = (h.transpose() * change).cwiseAbs().maxCoeff();
        if (factors.info() != Eigen::Success || !std::isfinite(fastest)) {
            break;
        }
        b.motion += change / std::max(1.0, fastest); // no exponential changes by more than a factor e: the sum falls
        b.approach = h.transpose() * b.motion;
        b.force = (-b.approach).array().exp();
        if (fastest < settled || radius_of_opening(list, b) > 0) {
            break;
        }
    }
    return b;
}

/// \p moved: the stored coordinates are within it.
std::optional<JammedIfClosed> judge_list(const ClosedList& list, double moved) {
    JammedIfClosed out{Verdict::refuted, list.h.cols, list.most};
    if (list.h.cols >= list.h.rows) { // else some motion keeps all of them, whatever their directions
        const EntropicBalance b = balance_of(list);
        double radius = b.approach.size() > 0 ? radius_of_opening(list, b) : 0;
        if (!(radius > 0)) {
            out.verdict = Verdict::proved;
            radius = radius_of_balance(list, b);
        }
        if (!(radius > 0)) {
            return std::nullopt;
        }
        out.within = std::min(out.within, radius / 2);
    }
    out.within -= moved;
    const bool near = std::ranges::all_of(
        list.contacts, [&](const Contact& c) { return std::abs(gap(list.packing, c)) <= out.within; });
    return near && out.within > 0 && certify_admissible(list.packing, out.within).verdict == Verdict::proved
               ? std::optional(out)
               : std::nullopt;
}

} // namespace

IfClosed jammed_if_closed(Packing packing, std::vector<Contact> contacts) {
    constexpr int farthest_image = 3; // cells.md C2, C14
    const std::vector<int> rattlers = rattlers_by_coordination(packing, contacts);
    const auto rattles = [&](int i) { return std::ranges::binary_search(rattlers, i); };
    std::erase_if(contacts, [&](const Contact& c) { return rattles(c.i) || (c.of_disks() && rattles(c.j)); });
    const bool held = std::ranges::any_of(contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    if (contacts.empty() || held || !in_range_of_products(packing) || largest_multiple(contacts) > farthest_image) {
        return {};
    }
    packing = without_disks(std::move(packing), rattlers);
    const double moved = snap_to_grid(packing) * std::sqrt(static_cast<double>(packing.q.size())) * (1 + slack);
    IfClosed out;
    const ClosedList fixed = list_of(packing, contacts, false);
    if (fixed.h.rows > 0) {
        out.collective = judge_list(fixed, moved);
    }
    if (packing.cell.all()) {
        out.strict = judge_list(list_of(packing, contacts, true), moved);
    }
    return out;
}

} // namespace isostat
