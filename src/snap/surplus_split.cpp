#include "core/roundoff.hpp"
#include "rigidity/isostatic.hpp"
#include "snap/backbone.hpp"
#include "snap/force_split.hpp"
#include "verified/force_solution.hpp"
#include "verified/norm.hpp"
#include "verified/proved_structure.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <random>

namespace isostat::compare {

namespace {

using Vector = Eigen::VectorXd;

/// H of a list with more contacts than degrees of freedom, and its self-stresses, in doubles.
class Surplus {
  public:
    Surplus(const Packing& packing, const std::vector<Contact>& contacts) : dofs_(packing) {
        const sparse::Matrix<double> h = contact_matrix(packing, dofs_, contacts);
        h_ = Eigen::Map<const Eigen::SparseMatrix<double>>(h.rows, h.cols, h.entries(), h.start.data(), h.row.data(),
                                                           h.value.data());
        normal_.compute(Eigen::SparseMatrix<double>(h_ * h_.transpose()));
    }
    [[nodiscard]] bool good() const { return normal_.info() == Eigen::Success; }
    [[nodiscard]] const Eigen::SparseMatrix<double>& matrix() const { return h_; }

    Vector load(const Load& load, const Packing& packing) const {
        const std::vector<double> force = on_dofs(load.external_force(packing), dofs_);
        return Eigen::Map<const Vector>(force.data(), dofs_.dof_count());
    }
    /// The smallest change of forces that balances a load.
    [[nodiscard]] Vector smallest(const Vector& load) const { return h_.transpose() * normal_.solve(load); }
    /// The projection on the self-stresses.
    [[nodiscard]] Vector along_self_stresses(const Vector& f) const {
        const Vector once = f - smallest(h_ * f);
        return once - smallest(h_ * once); // removes rounding
    }
    /// h contacts without which no self-stress exists: in turn, those with the largest part in random self-stresses.
    [[nodiscard]] std::vector<Eigen::Index> surplus() const {
        const Eigen::Index count = h_.cols() - h_.rows();
        std::mt19937_64 random(1);
        Eigen::MatrixXd basis(h_.cols(), count);
        for (Eigen::Index k = 0; k < count; ++k) {
            Vector draw(h_.cols());
            std::generate(draw.begin(), draw.end(),
                          [&] { return std::ldexp(static_cast<double>(random()), -64) - 0.5; });
            basis.col(k) = along_self_stresses(draw);
        }
        std::vector<Eigen::Index> out;
        for (Eigen::Index k = 0; k < count; ++k) {
            Eigen::Index row = 0, column = 0;
            basis.rightCols(count - k).cwiseAbs().maxCoeff(&row, &column);
            basis.col(k).swap(basis.col(k + column));
            for (Eigen::Index other = k + 1; other < count; ++other) {
                basis.col(other) -= basis.col(k) * (basis(row, other) / basis(row, k));
            }
            out.push_back(row);
        }
        std::ranges::sort(out);
        return out;
    }

  private:
    DofMap dofs_;
    Eigen::SparseMatrix<double> h_;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> normal_;
};

/// Forces that balance exactly differ from `value` by at most `bound`.
struct Balanced {
    Vector value;
    double bound = 0;
};

/// Keeps the forces of the surplus contacts and solves for the others, with proof.
std::optional<Balanced> balanced(const Surplus& surplus, const Packing& packing, const Vector& load,
                                 const std::vector<Contact>& contacts, Vector f) {
    constexpr double roundings = 8; // roundings per term: the load, 5 of an entry, product, sum
    const std::vector<Eigen::Index> given = surplus.surplus();
    std::vector<Contact> others;
    std::vector<Eigen::Index> places;
    Vector rest = load, size = load.cwiseAbs(), terms = Vector::Ones(load.size());
    for (Eigen::Index l = 0; l < f.size(); ++l) {
        if (!std::ranges::binary_search(given, l)) {
            others.push_back(contacts[static_cast<std::size_t>(l)]);
            places.push_back(l);
            continue;
        }
        for (Eigen::SparseMatrix<double>::InnerIterator entry(surplus.matrix(), l); entry; ++entry) {
            rest[entry.row()] -= entry.value() * f[l];
            size[entry.row()] += std::abs(entry.value() * f[l]);
            terms[entry.row()] += 1;
        }
    }
    const auto made = ProvedStructure::make(packing, others);
    if (!made.ok() || made.value()->inverse.verdict != Verdict::proved) {
        return std::nullopt;
    }
    const ProvedStructure& at = *made.value();
    const ForceSolution solved =
        solve_forces(at.structure, at.factorisation, at.inverse, std::vector<double>(rest.begin(), rest.end()));
    for (std::size_t k = 0; k < places.size(); ++k) {
        f[places[k]] = solved.value[k];
    }
    const Vector lost = roundings * roundoff::u * terms.cwiseProduct(size);
    return Balanced{std::move(f), (solved.bound + norm_above({lost.data(), static_cast<std::size_t>(lost.size())}) /
                                                      at.inverse.sigma_min) *
                                      (1 + roundings * roundoff::u)};
}

/// Largest distance of the forces g from the forces of the vertex, over the contacts of both lists.
double distance_to(const Balanced& g, const std::vector<Contact>& list, const Exchanged& vertex, Vector& difference) {
    std::map<Contact, Interval> exact;
    for (std::size_t l = 0; l < vertex.state.contacts.size(); ++l) {
        if (vertex.truth.structural_zero.empty() || vertex.truth.structural_zero[l] == 0) {
            exact.emplace(vertex.state.contacts[l], vertex.truth.finite[l]);
        }
    }
    double largest = 0;
    difference = g.value;
    for (std::size_t l = 0; l < list.size(); ++l) {
        const auto i = static_cast<Eigen::Index>(l);
        const auto at = exact.find(list[l]);
        const Interval f = at == exact.end() ? Interval{0, 0} : at->second;
        difference[i] -= 0.5 * (f.lower + f.upper);
        largest = std::max({largest, std::abs(g.value[i] - f.lower), std::abs(g.value[i] - f.upper)});
        if (at != exact.end()) {
            exact.erase(at);
        }
    }
    for (const auto& [contact, f] : exact) { // only in the vertex's list: the soft grains have no such force
        largest = std::max({largest, std::abs(f.lower), std::abs(f.upper)});
    }
    return largest + g.bound;
}

} // namespace

SurplusSplit split_surplus(const SoftState& soft, const std::vector<double>& forces, double mean, const Snap& snap,
                           const Exchanged* downhill) {
    SurplusSplit out;
    if (!(mean > 0) || forces.size() != soft.contacts.size() ||
        !std::ranges::all_of(forces, [](double f) { return std::isfinite(f); })) {
        return out;
    }
    Packing packing = of_disks(soft.packing, snap.disks);
    (void)snap_to_grid(packing);
    const Surplus surplus(packing, snap.backbone.contacts);
    if (!surplus.good()) {
        return out;
    }
    const Vector load = surplus.load(snap.backbone.load, packing);
    const Vector file = Eigen::Map<const Vector>(forces.data(), static_cast<Eigen::Index>(forces.size()));
    const Vector nearest = file + surplus.smallest(load - surplus.matrix() * file);
    const auto g = balanced(surplus, packing, load, snap.backbone.contacts, nearest);
    if (!g) {
        return out;
    }
    out.rest = ((g->value - file).cwiseAbs().maxCoeff() + g->bound) / mean;
    if (downhill != nullptr && downhill->truth.finite.size() == downhill->state.contacts.size()) {
        Vector difference;
        out.downhill = distance_to(*g, soft.contacts, *downhill, difference) / mean;
        out.self_stress = surplus.along_self_stresses(difference).cwiseAbs().maxCoeff() / mean;
    }
    return out;
}

} // namespace isostat::compare
