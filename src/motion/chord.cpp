#include "motion/chord.hpp"

#include "core/dot.hpp"
#include "core/roundoff.hpp"
#include "motion/geometry.hpp"
#include "verified/corrected_configuration.hpp"

#include <algorithm>

// guess: all other numbers of this file: of the path follower (arcs.md, status.md 1)

namespace isostat {

namespace {

using roundoff::infinity;

/// Rate of a gap along v (on coordinates).
double precise_rate(const CorrectedConfiguration<dd_real>& place, const Contact& contact,
                    const std::vector<double>& v) {
    PerAxis<dd_real> normal;
    normal.fill(1.0); // walls, and coordinates
    if (contact.of_disks()) {
        normal = place.separation(contact);
        const dd_real length = place.gap(contact) + place.length(contact);
        for (dd_real& component : normal) {
            component /= length;
        }
    }
    dd_real rate = 0.0;
    Separation(contact, place.packing().layout())
        .for_each_coordinate([&](std::size_t coordinate, std::size_t component, int multiple) {
            rate += multiple * normal[component] * v[coordinate];
        });
    return rate.x[0];
}

} // namespace

Chord::Chord(const IsostaticStructure& structure, const Factorisation& factorisation, std::size_t slot)
    : structure_(&structure), factorisation_(&factorisation), slot_(slot),
      size_(static_cast<std::size_t>(structure.size())), approach_(size_),
      y_(static_cast<std::size_t>(structure.dofs().coordinate_count()), 0.0) {
    make_mechanism();
}

void Chord::make_mechanism() {
    mechanism_.assign(y_.size(), 0.0);
    to_coordinates(factorisation().approximate().mechanism(static_cast<int>(slot_)), mechanism_);
}

void Chord::to_coordinates(const Vector& on_dofs, Vector& on_coordinates) const {
    const DofMap& dofs = structure().dofs();
    for (std::size_t mu = 0; mu < size_; ++mu) {
        on_coordinates[dofs.coordinate_of(mu)] = on_dofs[mu];
    }
}

bool Chord::converge(Packing& at, const Contact& row) {
    if (precise_) {
        return iterate_precisely(at, row);
    }
    const Packing guess = at;
    if (iterate(at, row, true)) {
        return true;
    }
    at = guess; // acceleration may have followed rounding
    return iterate(at, row, false);
}

bool Chord::iterate(Packing& at, const Contact& row, bool accelerated) {
    const auto& contacts = structure().contacts();
    const double rounding = 2 * grid_step(at);
    double previous = infinity;
    double rate = infinity;
    iterations_ = 0;
    acceleration_.clear();
    for (int k = 0; k < 60; ++k) {
        for (std::size_t l = 0; l < size_; ++l) {
            approach_[l] = l == slot_ ? 0.0 : quick_gap(at, contacts[l]);
        }
        solve([&](const Vector& v) { return gap_rate(at, row, v); }, -quick_gap(at, row));
        const double size = largest(y_);
        if (!(size < infinity)) {
            return false;
        }
        // Nearly linear convergence: the next change is this one times the worse of the last two ratios.
        const double ratio = size / previous;
        const bool last = size <= rounding || (k > 1 && size * std::max(ratio, rate) <= 0.1 * rounding);
        rate = ratio;
        if (accelerated && size > rounding) { // the last change too: the ratios are those of accelerated ones
            acceleration_.improve(y_);
        }
        for (std::size_t i = 0; i < y_.size(); ++i) {
            at.q[i] += y_[i];
        }
        ++iterations_;
        if (last) {
            return largest(at.q) < infinity;
        }
        // A change that no longer shrinks is rounding, or the factors are stale; with reused factors it shrinks slowly.
        if (k > 3 && size > (is_fresh() ? 0.5 : 0.9) * previous) {
            return size <= (accelerated ? 64 * rounding : 1e-9 * at.min_radius());
        }
        previous = size;
    }
    return false;
}

/// Uses factors of a point on the curve: of two roots that a nearly singular list has the iteration converges to the
/// one on that branch, or to none.
bool Chord::iterate_precisely(Packing& at, const Contact& row) {
    constexpr double converged = 1e-19; // of a radius; coordinates are rounded to doubles afterwards
    CorrectedConfiguration<dd_real> place(Arithmetic<dd_real>(), at);
    double previous = infinity;
    for (iterations_ = 1; iterations_ <= 60; ++iterations_) {
        for (std::size_t l = 0; l < size_; ++l) {
            approach_[l] = l == slot_ ? 0.0 : place.gap(contacts()[l]).x[0];
        }
        solve([&](const Vector& v) { return gap_rate(at, row, v); }, -place.gap(row).x[0]);
        const double size = largest(y_);
        if (!(size < infinity) || (iterations_ > 3 && size > 0.5 * previous)) {
            return false;
        }
        for (std::size_t i = 0; i < y_.size(); ++i) {
            place.correction(static_cast<int>(i)) += y_[i];
        }
        if (size <= converged * at.min_radius()) {
            rest_ = place.correction();
            for (std::size_t i = 0; i < y_.size(); ++i) {
                const dd_real sum = dd_real(at.q[i]) + rest_[i];
                at.q[i] = sum.x[0];
                rest_[i] = sum.x[1];
            }
            return true;
        }
        previous = size;
    }
    return false;
}

void Chord::rates_at(const Packing& at, const Vector& v) {
    const auto& contacts = structure().contacts();
    for (std::size_t l = 0; l < size_; ++l) {
        approach_[l] = gap_rate(at, contacts[l], v);
    }
}

/// The rates are minus the approach velocities G v, and the matrix has G.
void Chord::rates_from_matrix(const Vector& v) {
    const sparse::Matrix<double>& h = structure().matrix();
    const Vector velocity = on_dofs(v, structure().dofs());
    for (std::size_t l = 0; l < size_; ++l) {
        double rate = 0;
        for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
            rate -= h.value[e] * velocity[static_cast<std::size_t>(h.row[e])];
        }
        approach_[l] = rate;
    }
}

/// `rates` sets `approach_` to the rates of the kept gaps along a velocity, which the next pass removes.
template <class Rates>
std::optional<std::vector<double>> Chord::refined_tangent(const Vector& guess, std::size_t fastest, double accuracy,
                                                          Rates rates) {
    Vector t = guess;
    double previous = infinity;
    tangent_error_ = infinity;
    for (int k = 0; k < 40; ++k) {
        rates(t);
        approach_[slot_] = 0;
        solve([&](const Vector& v) { return v[fastest]; }, 0.0);
        const double size = largest(y_);
        for (std::size_t i = 0; i < t.size(); ++i) {
            t[i] += y_[i];
        }
        if (!(size < previous)) {
            break;
        }
        tangent_error_ = size / largest(t);
        // Linear convergence: the remaining change is about size^2 / previous.
        if (size < accuracy * largest(t) || (k > 0 && size * size < 0.1 * accuracy * largest(t) * previous)) {
            return t;
        }
        previous = size;
    }
    return previous < 1e-4 * largest(t) ? std::optional<Vector>(t) : std::nullopt;
}

std::optional<std::vector<double>> Chord::tangent(const Packing& at, const Vector& guess, std::size_t fastest,
                                                  double accuracy) {
    if (!precise_) {
        return refined_tangent(guess, fastest, accuracy, [&](const Vector& t) { rates_at(at, t); });
    }
    constexpr double sharp = 1e-13; // for the rounding of the coordinates
    Packing there = at;
    if (!iterate_precisely(there, Contact{ContactKind::held, static_cast<int>(fastest), 0})) {
        return std::nullopt;
    }
    const CorrectedConfiguration<dd_real> place(Arithmetic<dd_real>(), there, rest_);
    return refined_tangent(guess, fastest, std::min(accuracy, sharp), [&](const Vector& t) {
        for (std::size_t l = 0; l < size_; ++l) {
            approach_[l] = precise_rate(place, contacts()[l], t);
        }
    });
}

std::optional<std::vector<double>> Chord::tangent(const Vector& guess, std::size_t fastest, double accuracy) {
    return refined_tangent(guess, fastest, accuracy, [&](const Vector& t) { rates_from_matrix(t); });
}

std::optional<Failure> Chord::renew(const Packing& at, std::size_t held) {
    std::vector<Contact> with_held = contacts();
    with_held[slot_] = Contact{ContactKind::held, static_cast<int>(held), 0};
    auto proved = IsostaticStructure::prove(at, std::move(with_held));
    if (!proved.ok()) {
        return proved.failure();
    }
    own_ = std::make_unique<FactorisedStructure>(std::move(proved.value()));
    ++factorisations_;
    make_mechanism();
    return std::nullopt;
}

} // namespace isostat
