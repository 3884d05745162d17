#pragma once
// Exact signs of gaps with GMP rationals, written apart from the library.

#include <isostat/contact/state.hpp>

#include <gmpxx.h>

#include <stdexcept>

namespace isostat::oracle {

/// Sign of gap - bound, over the rationals (bound >= -(R_i + R_j) for disk pairs).
inline int gap_minus_bound_sign(const Packing& packing, const Contact& contact, double bound) {
    const auto i = static_cast<std::size_t>(contact.i);
    const auto j = static_cast<std::size_t>(contact.j);
    switch (contact.kind) {
    case ContactKind::lower_wall:
        return sgn(mpq_class(packing.q[2 * i + j]) - mpq_class(packing.radius[i]) - mpq_class(bound));
    case ContactKind::upper_wall:
        return sgn(mpq_class(packing.length(contact.j)) - mpq_class(packing.q[2 * i + j]) -
                   mpq_class(packing.radius[i]) - mpq_class(bound));
    case ContactKind::disk_disk:
    case ContactKind::bar: {
        const mpq_class x = mpq_class(packing.q[2 * i]) - mpq_class(packing.q[2 * j]);
        const mpq_class y = mpq_class(packing.q[2 * i + 1]) - mpq_class(packing.q[2 * j + 1]);
        const mpq_class d = mpq_class(packing.radius[i]) + mpq_class(packing.radius[j]) + mpq_class(bound);
        if (sgn(d) < 0) {
            return 1;
        }
        return sgn(mpq_class(x * x + y * y - d * d));
    }
    case ContactKind::held: break;
    }
    throw std::logic_error("a held coordinate has no gap");
}

} // namespace isostat::oracle
