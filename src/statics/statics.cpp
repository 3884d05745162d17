#include <isostat/statics/statics.hpp>

#include <qd/dd_real.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

template <int Dim> std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap<Dim>& dofs) {
    std::vector<double> force(static_cast<std::size_t>(dofs.dof_count()), 0.0);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        const auto k = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)));
        force[mu] = k < on_coordinates.size() ? on_coordinates[k] : 0.0;
    }
    return force;
}

std::vector<int> nonzero_rows(const std::vector<double>& force) {
    std::vector<int> rows;
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        if (force[mu] != 0) {
            rows.push_back(static_cast<int>(mu));
        }
    }
    return rows;
}

bool is_zero(const std::vector<double>& x) {
    return std::all_of(x.begin(), x.end(), [](double c) { return c == 0; });
}

} // namespace

template <int Dim>
Statics<Dim>::Statics(const Packing<Dim>& packing, const Load<Dim>& load, const IsostaticStructure<Dim>& structure,
                      const Factorisation& factorisation, const InverseBound& inverse)
    : packing_(&packing), structure_(&structure), factorisation_(&factorisation), inverse_(&inverse) {
    const DofMap<Dim>& dofs = structure.dofs();
    right_hand_side_ = {on_dofs(load.fixed_force(packing), dofs), on_dofs(load.unit_force(packing), dofs),
                        on_dofs(load.infinitesimal, dofs)};
    for (std::size_t k = 0; k < 3; ++k) {
        if (is_zero(right_hand_side_[k])) {
            solution_[k].value.assign(right_hand_side_[k].size(), 0.0); // exact, nothing to solve
        } else {
            solution_[k] = solve_forces(structure, factorisation, inverse, right_hand_side_[k]);
        }
    }
    loaded_rows_ = nonzero_rows(right_hand_side_[0]);
    const std::vector<int> wall = nonzero_rows(right_hand_side_[1]);
    std::vector<int> all = loaded_rows_;
    all.insert(all.end(), wall.begin(), wall.end());
    loaded_wall_row_ = wall.empty() ? -1 : wall.front();
    const sparse::Matrix<double>& h = structure.matrix();
    backbone_ = sparse::structural_nonzeros(h.start, h.row, structure.ordering(), all);
    sloped_ = sparse::structural_nonzeros(h.start, h.row, structure.ordering(), wall);
}

template <int Dim> Enclosure Statics<Dim>::force(ContactId contact, double sigma) const {
    const std::size_t l = contact.index();
    if (backbone_[l] == 0) {
        return {0, 0};
    }
    const ForceSolution& a = solution_[0];
    const ForceSolution& b = solution_[1];
    const double propagated = (a.bound + std::abs(sigma) * b.bound) * (1 + 4 * u);
    if (a.low.empty() && b.low.empty()) {
        const double product = sigma * b.value[l];
        const double value = a.value[l] + product;
        return {value, propagated + 2 * u * (std::abs(product) + std::abs(value))};
    }
    const auto get = [l](const ForceSolution& s) { return dd_real(s.value[l], s.low.empty() ? 0.0 : s.low[l]); };
    const dd_real sum = get(a) + get(b) * sigma;
    const double value = sum.x[0];
    const double size = std::abs(a.value[l]) + std::abs(sigma * b.value[l]);
    return {value, propagated + 0x1p-97 * size + 2 * u * std::abs(value)};
}

template <int Dim> Enclosure Statics<Dim>::slope(ContactId contact) const {
    const std::size_t l = contact.index();
    if (sloped_[l] == 0) {
        return {0, 0};
    }
    const ForceSolution& b = solution_[1];
    return {b.value[l], b.bound + (b.low.empty() ? 0.0 : std::abs(b.low[l]) * (1 + 2 * u))};
}

template <int Dim> Enclosure Statics<Dim>::fixed(ContactId contact) const { return force(contact, 0); }

template <int Dim> Enclosure Statics<Dim>::infinitesimal(ContactId contact) const {
    const ForceSolution& g = solution_[2];
    const std::size_t l = contact.index();
    return {g.value[l], g.bound + (g.low.empty() ? 0.0 : std::abs(g.low[l]) * (1 + 2 * u))};
}

template <int Dim> int Statics<Dim>::backbone_count() const {
    return static_cast<int>(std::count_if(backbone_.begin(), backbone_.end(), [](unsigned char c) { return c != 0; }));
}

template <int Dim> bool Statics<Dim>::climb() {
    if (rung_ != Rung::double_bound) {
        return false;
    }
    const ExtendedMatrix matrix = extended_contact_matrix(*packing_, *structure_);
    for (std::size_t k = 0; k < 3; ++k) {
        if (!is_zero(right_hand_side_[k])) {
            refine_double_double(solution_[k], matrix, *structure_, *factorisation_, *inverse_, right_hand_side_[k]);
        }
    }
    rung_ = Rung::double_double;
    return true;
}

template <int Dim> double Statics<Dim>::bound(double sigma) const {
    return solution_[0].bound + std::abs(sigma) * solution_[1].bound;
}

template <int Dim> double Statics<Dim>::residual(double sigma) const {
    return solution_[0].residual + std::abs(sigma) * solution_[1].residual;
}

template <int Dim> std::vector<double> Statics<Dim>::external_force(double sigma) const {
    std::vector<double> force = right_hand_side_[0];
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        force[mu] += sigma * right_hand_side_[1][mu];
    }
    return force;
}

template class Statics<2>;

} // namespace isostat
