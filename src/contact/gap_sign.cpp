#include "contact/gap_sign.hpp"

#include <gmpxx.h>

#include <cmath>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

/// Sign of |d|^2 - (Ri + Rj - allowance)^2 when Ri + Rj > allowance, else +1.
template <int Dim> int exact_pair_sign(const Packing<Dim>& packing, const Contact& contact, double allowance) {
    const mpq_class target = mpq_class(packing.radius[static_cast<std::size_t>(contact.i)]) +
                             mpq_class(packing.radius[static_cast<std::size_t>(contact.j)]) - mpq_class(allowance);
    if (sgn(target) < 0) {
        return 1;
    }
    mpq_class value = -target * target;
    for (int a = 0; a < Dim; ++a) {
        const mpq_class d =
            mpq_class(packing.coordinate(DiskId(contact.j), a)) - mpq_class(packing.coordinate(DiskId(contact.i), a));
        value += d * d;
    }
    return sgn(value);
}

} // namespace

template <int Dim> int sign_of_gap_plus(const Packing<Dim>& packing, const Contact& contact, double allowance) {
    const double r = packing.radius[static_cast<std::size_t>(contact.i)];
    if (contact.kind == ContactKind::held) {
        return allowance > 0 ? 1 : 0;
    }
    if (contact.kind == ContactKind::disk_disk) {
        const double target = r + packing.radius[static_cast<std::size_t>(contact.j)] - allowance;
        double square = 0;
        for (int a = 0; a < Dim; ++a) {
            const double d = packing.coordinate(DiskId(contact.j), a) - packing.coordinate(DiskId(contact.i), a);
            square += d * d;
        }
        // Relative errors: at most 5u in the sum of squares, 5u in target^2 when nothing cancels in `target`.
        const double value = square - target * target;
        const bool plain = target > 0.5 * (target + allowance) && square < 1e300 && square > 1e-280;
        if (plain && std::abs(value) > 16 * u * (square + target * target)) {
            return value > 0 ? 1 : -1;
        }
        return exact_pair_sign(packing, contact, allowance);
    }
    const double x = packing.coordinate(DiskId(contact.i), contact.j);
    const bool lower = contact.kind == ContactKind::lower_wall;
    const double wall = lower ? 0.0 : packing.length(contact.j);
    const double distance = lower ? x : wall - x;
    const double value = distance - r + allowance;
    if (std::abs(value) > 4 * u * (std::abs(wall) + std::abs(x) + r + std::abs(allowance))) {
        return value > 0 ? 1 : -1;
    }
    const mpq_class exact =
        (lower ? mpq_class(x) : mpq_class(wall) - mpq_class(x)) - mpq_class(r) + mpq_class(allowance);
    return sgn(exact);
}

template int sign_of_gap_plus<2>(const Packing<2>&, const Contact&, double);

} // namespace isostat
