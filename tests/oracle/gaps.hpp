#pragma once
// Exact signs of gaps with GMP rationals, written apart from the library.

#include "oracle/geometry.hpp"

#include <gmpxx.h>

namespace isostat::oracle {

struct ExactGaps : Geometry<mpq_class> {
    using Geometry<mpq_class>::Geometry;
    /// Sign of gap - bound (bound >= -(R_i + R_j) for disk pairs).
    [[nodiscard]] int sign_beyond(const Contact& contact, double bound) const {
        if (!is_pair(contact)) {
            return cmp(linear_gap(contact), mpq_class(bound));
        }
        const mpq_class d = target(contact) + mpq_class(bound);
        return sgn(d) < 0 ? 1 : cmp(square(between(contact)), mpq_class(d * d));
    }
};

} // namespace isostat::oracle
