#include "motion/moving_part.hpp"

#include "contact/candidates.hpp"
#include "contact/contact_set.hpp"
#include "motion/common_grid.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

MovingPart::MovingPart(const ArcVertex& start, const ArcVertex& end, std::size_t slot, double start_uncertainty,
                       double end_uncertainty)
    : start_(start), end_(end), slot_(slot), start_packing_(start.packing), end_packing_(end.packing) {
    whole_ = !restrict_to(Factorisation::moving(start.structure, static_cast<int>(slot)));
    if (whole_) {
        disk_moves_.assign(start_packing_.radius.size(), 1);
        wall_moves_.assign(start_packing_.coordinate_count() - start_packing_.length_at(0), 1);
        curve_ = std::make_unique<KeptCurve>(start_packing_, start.structure.contacts(), slot, 0.0);
        bring_end_back();
        return;
    }
    std::vector<Contact> contacts = with_row(start.structure.contacts()[slot]);
    curve_ = std::make_unique<KeptCurve>(start_packing_, std::move(contacts), 0, start_uncertainty);
    check_rest(start_uncertainty + end_uncertainty);
    bring_end_back();
}

double MovingPart::shift_of_end(const ArcVertex& start, const ArcVertex& end) {
    double square = 0;
    for (std::size_t k = 0; k < start.packing.q.size(); ++k) {
        if (start.structure.dofs().dof_of(k) < 0) { // of a pinned disk: all disks move with it
            const double d = end.packing.q[k] - start.packing.q[k];
            square += d * d * static_cast<double>(start.packing.radius.size());
        }
    }
    return square > 0 ? std::sqrt(square) * upward : 0;
}

/// A coarser grid has moved the pinned disk by a rounding, and all others with it by a translation: undoes this.
void MovingPart::bring_end_back() {
    const DofMap& dofs = start_.structure.dofs();
    for (std::size_t k = 0; k < end_packing_.q.size(); ++k) {
        end_moved_ = end_moved_ || (dofs.dof_of(k) < 0 && end_.packing.q[k] != start_.packing.q[k]);
        end_packing_.q[k] = dofs.dof_of(k) < 0 ? start_.packing.q[k] : end_packing_.q[k];
    }
    const std::vector<Contact>& contacts = start_.structure.contacts();
    const auto held = [](const Contact& c) { return c.kind == ContactKind::held; };
    if (end_moved_ && std::any_of(contacts.begin(), contacts.end(), held)) {
        trouble_ = "the pinned disk was moved by a rounding, and coordinates are held";
    } else if (end_moved_ && !fits_grid(end_packing_, grid_step(start_.packing))) {
        trouble_ = "the end is too far away for the grid of the start";
    }
}

bool MovingPart::coordinate_moves(std::size_t coordinate) const {
    const std::size_t walls = start_packing_.length_at(0);
    return (coordinate < walls ? disk_moves_[coordinate / start_packing_.axes()] : wall_moves_[coordinate - walls]) !=
           0;
}

bool MovingPart::moves(const Contact& contact) const {
    const auto i = static_cast<std::size_t>(contact.i);
    if (contact.kind == ContactKind::held) {
        return coordinate_moves(i);
    }
    if (contact.of_disks()) {
        return disk_moves_[i] != 0 || disk_moves_[static_cast<std::size_t>(contact.j)] != 0;
    }
    return disk_moves_[i] != 0 || (contact.wall().at_length && wall_moves_[static_cast<std::size_t>(contact.j)] != 0);
}

/// The free row first, then the kept contacts that touch a moving grain.
std::vector<Contact> MovingPart::with_row(const Contact& row) const {
    std::vector<Contact> contacts = start_.structure.contacts();
    contacts[slot_] = row;
    if (whole_) {
        return contacts;
    }
    std::vector<Contact> list{row};
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (l != slot_ && moves(contacts[l])) {
            list.push_back(contacts[l]);
        }
    }
    return list;
}

bool MovingPart::restrict_to(const std::vector<unsigned char>& mechanism) {
    const DofMap& dofs = start_.structure.dofs();
    const std::size_t disks = start_packing_.radius.size();
    disk_moves_.assign(disks, 0);
    const std::size_t walls = start_packing_.length_at(0);
    wall_moves_.assign(start_packing_.coordinate_count() - walls, 0);
    for (std::size_t mu = 0; mu < mechanism.size(); ++mu) {
        if (mechanism[mu] != 0) {
            const std::size_t k = dofs.coordinate_of(mu);
            (k < walls ? disk_moves_[k / start_packing_.axes()] : wall_moves_[k - walls]) = 1;
        }
    }
    std::size_t degrees = 0;
    for (std::size_t mu = 0; mu < mechanism.size(); ++mu) {
        degrees += coordinate_moves(dofs.coordinate_of(mu)) ? 1 : 0;
    }
    whole_ = false;
    const Contact& row = start_.structure.contacts()[slot_];
    if (2 * degrees >= mechanism.size() || moves_pin_or_cell() || !moves(row) ||
        !moves(end_.structure.contacts()[slot_]) || with_row(row).size() != degrees) {
        whole_ = true;
        return false;
    }
    let_rest();
    end_packing_ = start_packing_;
    const DofMap moving(start_packing_);
    for (int mu = 0; mu < moving.dof_count(); ++mu) {
        const auto k = static_cast<std::size_t>(moving.coordinate_of(mu));
        end_packing_.q[k] = end_.packing.q[k];
    }
    return true;
}

/// Marks what does not move; a cell at rest needs no pin.
void MovingPart::let_rest() {
    const std::size_t disks = start_packing_.radius.size();
    std::vector<unsigned char> fixed(disks, 0);
    for (std::size_t i = 0; i < disks; ++i) {
        fixed[i] = disk_moves_[i] == 0 ? 1 : 0;
        disk_moves_[i] = disk_moves_[i] != 0 && !start_packing_.is_fixed(DiskId(i)) ? 1 : 0;
    }
    start_packing_.fixed = fixed;
    for (std::size_t a = 0; a < start_packing_.axes(); ++a) {
        if (wall_moves_[a] == 0 && start_packing_.walls.upper[a] == WallKind::movable) {
            start_packing_.walls.upper[a] = WallKind::fixed;
        }
    }
    if (start_packing_.cell.any()) {
        start_packing_.cell.period_moves = {};
        start_packing_.cell.tilt_moves = {};
        start_packing_.cell.pin = -1;
    }
}

/// Then everything takes part, because A7 is for disks alone.
bool MovingPart::moves_pin_or_cell() const {
    const Cell& cell = start_packing_.cell;
    if (!cell.any()) {
        return false;
    }
    bool moves = disk_moves_[static_cast<std::size_t>(cell.pin)] != 0;
    for (std::size_t a = 0; a < wall_moves_.size(); ++a) {
        moves = moves || (wall_moves_[a] != 0 && (a >= start_packing_.axes() || cell.periodic[a]));
    }
    return moves;
}

/// The grains at rest have the same true place at both ends: their equations have one root near the stored start.
void MovingPart::check_rest(double uncertainty) {
    double square = 0;
    for (std::size_t i = 0; i < disk_moves_.size(); ++i) {
        for (std::size_t a = 0; a < start_packing_.axes() && disk_moves_[i] == 0; ++a) {
            const double d =
                end_.packing.q[start_packing_.axes() * i + a] - start_.packing.q[start_packing_.axes() * i + a];
            square += d * d;
        }
    }
    for (std::size_t a = 0; a < wall_moves_.size(); ++a) {
        if (wall_moves_[a] == 0) {
            const std::size_t k = start_.packing.length_at(a);
            const double d = end_.packing.q[k] - start_.packing.q[k];
            square += d * d;
        }
    }
    const KeptCurve all(start_.packing, start_.structure.contacts(), slot_, 0.0);
    const double inverse = 1.003 / start_.inverse.sigma_min; // precision.md B13
    if (!((std::sqrt(square) + uncertainty) * inverse * all.lipschitz * upward < 1)) {
        trouble_ = "grains that do not move are not proved to be at the same place at both ends";
    }
}

std::unique_ptr<ArcCentre> MovingPart::at_start(InverseBoundCache& cache) const {
    return whole_ ? ArcCentre::of(start_)
                  : ArcCentre::make(start_packing_, with_row(start_.structure.contacts()[slot_]), cache);
}

std::unique_ptr<ArcCentre> MovingPart::at_end(InverseBoundCache& cache) const {
    return whole_ && !end_moved_ ? ArcCentre::of(end_)
                                 : ArcCentre::make(end_packing_, with_row(end_.structure.contacts()[slot_]), cache);
}

std::unique_ptr<ArcCentre> MovingPart::centre(Packing packing, int held, InverseBoundCache& cache) const {
    const Contact row{ContactKind::held, held, 0};
    return whole_ ? ArcCentre::near(start_, slot_, std::move(packing), row, cache)
                  : ArcCentre::make(std::move(packing), with_row(row), cache);
}

std::unique_ptr<ArcCentre> MovingPart::with_fastest(const ArcCentre& vertex, double& rate,
                                                    InverseBoundCache& cache) const {
    std::vector<double> mechanism(static_cast<std::size_t>(vertex.structure().size()), 0.0);
    mechanism[curve_->slot] = -rate; // approach velocity
    vertex.factorisation().solve_velocities(mechanism);
    const auto fastest = std::max_element(mechanism.begin(), mechanism.end(),
                                          [](double a, double b) { return std::abs(a) < std::abs(b); });
    rate = *fastest > 0 ? 1 : -1;
    return centre(vertex.packing(),
                  vertex.structure().dofs().coordinate_of(static_cast<int>(fastest - mechanism.begin())), cache);
}

std::vector<int> MovingPart::grains() const {
    std::vector<int> list;
    for (std::size_t g = 0; g < disk_moves_.size() + wall_moves_.size() && !whole_; ++g) {
        if (g < disk_moves_.size() ? disk_moves_[g] != 0 : wall_moves_[g - disk_moves_.size()] != 0) {
            list.push_back(static_cast<int>(g));
        }
    }
    return list;
}

std::vector<Contact> MovingPart::watched(const CandidateList& list) const {
    const Contact& opened = start_.structure.contacts()[slot_];
    const ContactSet kept(start_.structure.contacts(), start_.packing.disk_count());
    std::vector<Contact> contacts;
    for (const Contact& c : list.contacts) {
        if (c != opened && !kept.contains(c) && moves(c)) {
            contacts.push_back(c);
        }
    }
    if (opened.kind != ContactKind::held) {
        contacts.push_back(opened);
    }
    return contacts;
}

std::vector<Contact> MovingPart::all(const CandidateList& list) const {
    const ContactSet kept(start_.structure.contacts(), start_.packing.disk_count());
    std::vector<Contact> contacts;
    std::copy_if(list.contacts.begin(), list.contacts.end(), std::back_inserter(contacts),
                 [&](const Contact& c) { return !kept.contains(c); });
    return contacts;
}

bool MovingPart::complete(const CurvePiece& piece, double h, const CandidateList& list) const {
    const std::vector<double>& q = piece.centre().q;
    if (list.reference.size() != q.size()) {
        return false;
    }
    const double off = piece.radius() + piece.curve().rest_radius;
    if (piece.centre().cell.any()) { // the left-hand side of C8 is a norm of the displacement
        const CellDrift drift = cell_drift(list, piece.centre());
        double used = drift.used + drift.rate * off;
        double power = h;
        for (const auto& coefficient : piece.coefficients()) {
            used += power * drift_along(list, piece.centre(), coefficient);
            power *= h;
        }
        return used * upward < 0.5 * list.reach; // exact: a half (cells.md C8)
    }
    const std::size_t axes = piece.centre().axes();
    const double unit = 1 / list.reach; // squares then neither under- nor overflow in any unit
    for (std::size_t k = 0; k < q.size(); k += axes) {
        const auto length = [&](const auto& component) {
            double square = 0;
            for (std::size_t c = k; c < k + axes; ++c) {
                square += (unit * component(c)) * (unit * component(c));
            }
            return std::sqrt(square);
        };
        double moved = length([&](std::size_t c) { return q[c] - list.reference[c]; });
        double power = h;
        for (const auto& coefficient : piece.coefficients()) {
            moved += power * length([&](std::size_t c) { return coefficient[c]; });
            power *= h;
        }
        if (!(2 * (moved + unit * off) * upward < 1)) {
            return false;
        }
    }
    return true;
}

} // namespace isostat
