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
    : packing_(&packing), structure_(&structure), factorisation_(&factorisation), inverse_(&inverse),
      sigma_(load.stress[static_cast<std::size_t>(load.loaded_axis)]) {
    const DofMap<Dim>& dofs = structure.dofs();
    right_hand_side_ = {on_dofs(load.external_force(packing), dofs), on_dofs(load.unit_force(packing), dofs),
                        on_dofs(load.infinitesimal, dofs)};
    loaded_rows_ = nonzero_rows(on_dofs(load.fixed_force(packing), dofs));
    const std::vector<int> wall = nonzero_rows(right_hand_side_[unit]);
    std::vector<int> all = loaded_rows_;
    all.insert(all.end(), wall.begin(), wall.end());
    loaded_wall_row_ = wall.empty() ? -1 : wall.front();
    const sparse::Matrix<double>& h = structure.matrix();
    backbone_ = sparse::structural_nonzeros(h.start, h.row, structure.matching(), all);
}

template <int Dim> const ForceSolution& Statics<Dim>::solution(Part part) const {
    std::optional<ForceSolution>& slot = solution_[part];
    if (!slot) {
        const std::vector<double>& force = right_hand_side_[part];
        if (is_zero(force)) {
            slot.emplace(); // exact, nothing to solve
            slot->value.assign(force.size(), 0.0);
        } else {
            slot = solve_forces(*structure_, *factorisation_, *inverse_, force);
            if (rung_ == Rung::double_double) {
                refine_double_double(*slot, *extended_, *structure_, *factorisation_, *inverse_, force);
            }
        }
    }
    return *slot;
}

template <int Dim> Enclosure Statics<Dim>::force(ContactId contact, double sigma) const {
    const std::size_t l = contact.index();
    if (backbone_[l] == 0) {
        return {0, 0};
    }
    const ForceSolution& a = solution(present);
    if (sigma == sigma_) {
        const double low = a.low.empty() ? 0.0 : a.low[l];
        return {a.value[l], a.bound + std::abs(low) * (1 + 2 * u)};
    }
    const ForceSolution& b = solution(unit);
    const dd_real distance = dd_real(sigma) - sigma_;
    const auto get = [l](const ForceSolution& s) { return dd_real(s.value[l], s.low.empty() ? 0.0 : s.low[l]); };
    const dd_real sum = get(a) + get(b) * distance;
    const double value = sum.x[0];
    const double size = std::abs(a.value[l]) + std::abs(distance.x[0] * b.value[l]);
    return {value,
            (a.bound + std::abs(distance.x[0]) * b.bound) * (1 + 4 * u) + 0x1p-96 * size + 2 * u * std::abs(value)};
}

template <int Dim> bool Statics<Dim>::slope_is_zero(ContactId contact) const {
    if (sloped_.empty()) {
        const sparse::Matrix<double>& h = structure_->matrix();
        sloped_ = loaded_wall_row_ < 0
                      ? std::vector<unsigned char>(static_cast<std::size_t>(h.cols), 0)
                      : sparse::structural_nonzeros(h.start, h.row, structure_->matching(), {&loaded_wall_row_, 1});
    }
    return sloped_[contact.index()] == 0;
}

template <int Dim> Enclosure Statics<Dim>::slope(ContactId contact) const {
    const std::size_t l = contact.index();
    if (slope_is_zero(contact)) {
        return {0, 0};
    }
    const ForceSolution& b = solution(unit);
    return {b.value[l], b.bound + (b.low.empty() ? 0.0 : std::abs(b.low[l]) * (1 + 2 * u))};
}

template <int Dim> Enclosure Statics<Dim>::infinitesimal(ContactId contact) const {
    const ForceSolution& g = solution(infinitesimal_part);
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
    extended_ = extended_contact_matrix(*packing_, *structure_);
    for (std::size_t k = 0; k < 3; ++k) {
        if (solution_[k] && !is_zero(right_hand_side_[k])) {
            refine_double_double(*solution_[k], *extended_, *structure_, *factorisation_, *inverse_,
                                 right_hand_side_[k]);
        }
    }
    rung_ = Rung::double_double;
    return true;
}

template <int Dim> double Statics<Dim>::bound(double sigma) const {
    return solution(present).bound + (sigma == sigma_ ? 0.0 : std::abs(sigma - sigma_) * solution(unit).bound);
}

template <int Dim> double Statics<Dim>::residual(double sigma) const {
    return solution(present).residual + (sigma == sigma_ ? 0.0 : std::abs(sigma - sigma_) * solution(unit).residual);
}

template <int Dim> std::vector<double> Statics<Dim>::external_force(double sigma) const {
    std::vector<double> force = right_hand_side_[present];
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        force[mu] += (sigma - sigma_) * right_hand_side_[unit][mu];
    }
    return force;
}

template class Statics<2>;

} // namespace isostat
