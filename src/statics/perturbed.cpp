#include "statics/perturbed.hpp"

#include "core/roundoff.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace isostat {

namespace {

using roundoff::u;

Enclosure product(const Enclosure& a, const Enclosure& b) {
    const double value = a.value * b.value;
    // precision.md B9
    return {value, (std::abs(a.value) * b.radius + a.radius * std::abs(b.value) + a.radius * b.radius) * (1 + 8 * u) +
                       2 * u * std::abs(value)};
}

Enclosure sum(const Enclosure& a, const Enclosure& b) {
    return a - Enclosure{-b.value, b.radius};
}

} // namespace

PerturbedStatics::PerturbedStatics(const FirstOrder& first, Statics& statics, Load load, Enclosure stress_rate,
                                   bool choose)
    : first_(&first), statics_(&statics), load_(std::move(load)), stress_rate_(stress_rate), choose_(choose) {}

std::vector<Enclosure> PerturbedStatics::terms(double sigma, double sigma_error) const {
    const auto n = static_cast<std::size_t>(statics_->structure().size());
    std::vector<Enclosure> f0(n);
    std::vector<unsigned char> zero(n);
    for (std::size_t l = 0; l < n; ++l) {
        const ContactId id(l);
        zero[l] = statics_->is_structural_zero(id) ? 1 : 0;
        f0[l] = statics_->force(id, sigma);
        if (sigma_error > 0 && zero[l] == 0) {
            const Enclosure slope = statics_->slope(id);
            f0[l].radius += sigma_error * (std::abs(slope.value) + slope.radius) * (1 + 8 * u); // precision.md B9
        }
    }
    Load load = load_;
    load.set_loaded_stress(sigma);
    return first_->forces(f0, zero, load, sigma_error);
}

Enclosure PerturbedStatics::force(ContactId contact) {
    if (present_rung_ != statics_->rung()) { // better forces
        present_ = terms(load_.loaded_stress(), 0);
        present_rung_ = statics_->rung();
        if (stress_rate_.value != 0 || stress_rate_.radius != 0) {
            for (std::size_t l = 0; l < present_.size(); ++l) {
                if (!statics_->is_structural_zero(ContactId(l))) {
                    present_[l] = sum(present_[l], product(stress_rate_, statics_->slope(ContactId(l))));
                }
            }
        }
    }
    return present_[contact.index()];
}

Enclosure PerturbedStatics::force_at(ContactId contact, double sigma, double sigma_error) {
    if (elsewhere_.empty() || elsewhere_sigma_ != sigma || elsewhere_error_ != sigma_error) {
        elsewhere_ = terms(sigma, sigma_error);
        elsewhere_sigma_ = sigma;
        elsewhere_error_ = sigma_error;
    }
    return elsewhere_[contact.index()];
}

Enclosure PerturbedStatics::limit_rate(ContactId contact, double sigma, double sigma_error) {
    const Enclosure f = force_at(contact, sigma, sigma_error);
    const Enclosure b = statics_->slope(contact);
    const double smallest = std::abs(b.value) - b.radius;
    if (!(smallest > 0)) {
        return {0, std::numeric_limits<double>::infinity()};
    }
    const double value = -f.value / b.value;
    // precision.md B9
    return {value, (f.radius + std::abs(value) * b.radius) / smallest * (1 + 16 * u) + 4 * u * std::abs(value)};
}

double PerturbedStatics::size() {
    if (size_ == 0) {
        size_ = statics_->largest_force(load_.loaded_stress());
    }
    return size_;
}

} // namespace isostat
