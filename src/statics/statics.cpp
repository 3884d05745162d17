#include "statics/statics.hpp"

#include "core/roundoff.hpp"

#include <qd/dd_real.h>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

using roundoff::u;

/// |F(q) - F(q*)|_2 <= rate |q - q*|_2 for F_a = the product of the lengths of the other axes. In the plane F is
/// linear. In space F_a changes by at most (L + |q - q*|) (|dL_b| + |dL_c|), L the largest length, and the squares of
/// these sums add up to at most 4 |dL|^2: 4 L is enough while |q - q*| <= L, that is as long as there is a true vertex.
double rate_of_areas(const Packing& packing) {
    double longest = 0;
    for (int a = 0; a < packing.dimension; ++a) {
        longest = std::max(longest, packing.length(a));
    }
    // true_vertex.md V6 (rate_of_areas)
    return packing.dimension == plane ? 1 : 4 * longest;
}

} // namespace

Statics::Statics(const Packing& packing, const Load& load, const IsostaticStructure& structure,
                 const Factorisation& factorisation, const InverseBound& inverse, StaticsHints hints)
    : packing_(&packing), structure_(&structure), factorisation_(&factorisation), inverse_(&inverse),
      sigma_(load.loaded_stress()), ladder_(packing, structure, factorisation, inverse, hints.ladder, hints.vertex),
      pattern_(packing, structure) {
    const DofMap& dofs = structure.dofs();
    // Under true stresses the force on a wall depends on the lengths of the other axes.
    const bool follows = load.kind == LoadKind::true_stress;
    const double stress =
        std::abs(*std::ranges::max_element(load.stress, [](double a, double b) { return std::abs(a) < std::abs(b); }));
    const auto known = [near = hints.near](Part part) {
        const std::span<const double> x = near != nullptr ? near->ladder_.known(part) : std::span<const double>();
        return std::vector<double>(x.begin(), x.end());
    };
    const double rate = follows ? rate_of_areas(packing) : 0;
    // precision.md B1 (last operations)
    LoadTerms now{{}, rate * stress * (1 + 4 * u)};
    LoadTerms per_unit{{}, rate};
    double fastest = 1; // of the stresses, as the loaded one changes by 1
    for (const WallForce& wall : load.wall_forces(packing)) {
        const int row = dofs.dof_of(static_cast<std::size_t>(wall.coordinate));
        now.products.push_back({row, wall.stress, wall.length, wall.other, wall.rest});
        if (wall.rate != 0 && packing.dimension > plane) { // in the plane the double is the length itself
            per_unit.products.push_back({row, wall.rate, wall.length, wall.other});
            fastest = std::max(fastest, std::abs(wall.rate));
        }
    }
    ladder_.add(on_dofs(load.external_force(packing), dofs), std::move(now),
                hints.forces.empty() && hints.near != nullptr ? hints.near->guess(sigma_) : std::move(hints.forces));
    per_unit.rate *= fastest;
    ladder_.add(on_dofs(load.unit_force(packing), dofs), std::move(per_unit), known(unit));
    ladder_.add(on_dofs(load.infinitesimal, dofs), {}, known(infinitesimal_part));
    loaded_rows_ = load.loaded_rows(packing, dofs);
    changing_rows_ = load.changing_rows(packing, dofs);
    find_backbone();
}

/// The known forces at a stress; at another stress this needs the slopes.
std::vector<double> Statics::guess(double sigma) const {
    const std::span<const double> a = ladder_.known(present);
    std::vector<double> forces(a.begin(), a.end());
    if (sigma != sigma_ && !forces.empty()) {
        const std::span<const double> b = ladder_.known(unit);
        if (b.empty()) {
            return {};
        }
        for (std::size_t l = 0; l < forces.size(); ++l) {
            forces[l] += (sigma - sigma_) * b[l];
        }
    }
    return forces;
}

void Statics::find_backbone() {
    std::vector<int> loaded = loaded_rows_;
    loaded.insert(loaded.end(), changing_rows_.begin(), changing_rows_.end()); // also when their stress is 0 now
    sloped_ = changing_rows_.empty() ? std::vector<unsigned char>(static_cast<std::size_t>(structure_->size()), 0)
                                     : pattern_.carrying(changing_rows_);
    backbone_ = pattern_.carrying(loaded, sloped_);
}

void Statics::perturb_radii() {
    pattern_ = ContactPattern(*packing_, *structure_, true);
    sloped_by_sums_.clear();
    find_backbone();
}

std::vector<ContactId> Statics::vanish_with(ContactId opens) const {
    const std::vector<unsigned char> others = pattern_.carrying_without(opens, changing_rows_, loaded_rows_);
    std::vector<ContactId> members;
    for (std::size_t l = 0; l < others.size(); ++l) {
        if (l != opens.index() && others[l] == 0 && backbone_[l] != 0) {
            members.emplace_back(l);
        }
    }
    return members;
}

void Statics::set_shift(std::shared_ptr<const LoadShift> shift, double bound) {
    shift_ = std::move(shift);
    shift_bound_ = bound;
    ladder_.without_exact_numbers();
}

std::shared_ptr<const LoadShift> Statics::zero_of(ContactId contact, double sigma) {
    ForceExpression e = force_expression(contact, sigma);
    e.shift = nullptr;
    return ladder_.zero_of(e);
}

Enclosure Statics::force(ContactId contact, double sigma) const {
    const std::size_t l = contact.index();
    if (backbone_[l] == 0) {
        return {0, 0};
    }
    const ForceSolution& a = ladder_.solution(present);
    if (sigma == sigma_) {
        const double low = a.low.empty() ? 0.0 : a.low[l];
        double radius = a.bound + std::abs(low) * (1 + 2 * u);
        if (shift_) {
            const Enclosure b = slope(contact);
            // 4: precision.md B1 (last operations)
            radius += shift_bound_ * (std::abs(b.value) + b.radius) * (1 + 4 * u);
        }
        return {a.value[l], radius};
    }
    const ForceSolution& b = ladder_.solution(unit);
    const dd_real distance = dd_real(sigma) - sigma_;
    const auto get = [l](const ForceSolution& s) { return dd_real(s.value[l], s.low.empty() ? 0.0 : s.low[l]); };
    const dd_real sum = get(a) + get(b) * distance;
    const double value = sum.x[0];
    const double size = std::abs(a.value[l]) + std::abs(distance.x[0] * b.value[l]);
    return {value,
            // 0x1p-96: precision.md B9; 4: precision.md B1 (last operations)
            (a.bound + std::abs(distance.x[0]) * b.bound) * (1 + 4 * u) + 0x1p-96 * size + 2 * u * std::abs(value)};
}

Enclosure Statics::slope(ContactId contact) const {
    const std::size_t l = contact.index();
    if (slope_is_zero(contact)) {
        return {0, 0};
    }
    const ForceSolution& b = ladder_.solution(unit);
    return {b.value[l], b.bound + (b.low.empty() ? 0.0 : std::abs(b.low[l]) * (1 + 2 * u))};
}

bool Statics::slope_cancels(ContactId contact) {
    if (sloped_by_sums_.empty()) {
        sloped_by_sums_ = pattern_.carrying_by_sums(structure_->dofs(), changing_rows_, ladder_.solution(unit).value);
    }
    return sloped_by_sums_[contact.index()] == 0;
}

Enclosure Statics::infinitesimal(ContactId contact) const {
    const ForceSolution& g = ladder_.solution(infinitesimal_part);
    const std::size_t l = contact.index();
    return {g.value[l], g.bound + (g.low.empty() ? 0.0 : std::abs(g.low[l]) * (1 + 2 * u))};
}

std::vector<Contact> Statics::carrying() const {
    std::vector<Contact> out;
    for (std::size_t l = 0; l < backbone_.size(); ++l) {
        if (backbone_[l] != 0) {
            out.push_back(structure_->contacts()[l]);
        }
    }
    return out;
}

ForceExpression Statics::force_expression(ContactId contact, double sigma) const {
    ForceExpression e;
    e.contact = contact;
    e.part = present;
    e.slope_part = unit;
    e.at = sigma;
    e.from = sigma_;
    e.shift = sigma == sigma_ ? shift_.get() : nullptr;
    return e;
}

ForceExpression Statics::slope_expression(ContactId contact) const {
    ForceExpression e;
    e.contact = contact;
    e.part = unit;
    return e;
}

ForceExpression Statics::infinitesimal_expression(ContactId contact) const {
    ForceExpression e;
    e.contact = contact;
    e.part = infinitesimal_part;
    return e;
}

ForceExpression Statics::distance_expression(ContactId contact, double sigma) const {
    ForceExpression e = force_expression(contact, sigma);
    e.shift = nullptr; // the same for all that are compared
    e.divisor_part = unit;
    return e;
}

Order Statics::sign(const ForceExpression& a) {
    Order order = ladder_.sign(a);
    while (!order.decided && ladder_.climb()) {
        order = ladder_.sign(a);
    }
    return order;
}

Order Statics::compare(const ForceExpression& a, const ForceExpression& b) {
    Order order = ladder_.compare(a, b);
    while (!order.decided && ladder_.climb()) {
        order = ladder_.compare(a, b);
    }
    return order;
}

double Statics::largest_force(double sigma) const {
    double largest = 0;
    for (std::size_t l = 0; l < backbone_.size(); ++l) {
        largest = std::max(largest, std::abs(force(ContactId(l), sigma).value));
    }
    return largest;
}

double Statics::bound(double sigma) const {
    double largest = 0;
    for (std::size_t l = 0; l < backbone_.size(); ++l) {
        largest = std::max(largest, force(ContactId(l), sigma).radius);
    }
    return largest;
}

double Statics::residual(double sigma) const {
    return ladder_.solution(present).residual +
           (sigma == sigma_ ? 0.0 : std::abs(sigma - sigma_) * ladder_.solution(unit).residual);
}

std::vector<double> Statics::external_force(double sigma) const {
    std::vector<double> force = ladder_.force(present);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        force[mu] += (sigma - sigma_) * ladder_.force(unit)[mu];
    }
    return force;
}

} // namespace isostat
