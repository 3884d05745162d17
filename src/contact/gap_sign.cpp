#include "contact/separation.hpp"

#include <CGAL/Exact_rational.h>
#include <CGAL/Interval_nt.h>

#include <cassert>

namespace isostat {

namespace {

/// A number with the sign of gap + allowance. Two disks: |d|^2 - t |t| with t = R_i + R_j - allowance, which has the
/// sign of |d| - t for every t.
template <class Number> Number with_sign_of_gap(const Packing& packing, const Contact& contact, double allowance) {
    const auto at = [&](std::size_t k) { return Number(packing.q[k]); };
    const auto minus = [](const Number& a, const Number& b) -> Number { return a - b; };
    const Separation separation(contact, packing.layout());
    const Number radius(packing.radius[static_cast<std::size_t>(contact.i)]);
    if (!contact.of_disks()) {
        return separation.of_wall(at, minus) - radius + Number(allowance);
    }
    const Number touching = contact.kind == ContactKind::bar
                                ? Number(packing.bar_length(contact.i, contact.j))
                                : Number(radius + Number(packing.radius[static_cast<std::size_t>(contact.j)]));
    const Number least = touching - Number(allowance);
    Number square(0);
    for (const Number& component : separation.of_disks(at, minus)) {
        square += CGAL::square(component);
    }
    return square - least * CGAL::abs(least);
}

} // namespace

int gap_sign(const Packing& packing, const Contact& contact, double allowance) {
    assert(contact.kind != ContactKind::held);
    {
        using Interval = CGAL::Interval_nt<false>;
        const Interval::Protector upward;
        const auto sign = CGAL::sign(with_sign_of_gap<Interval>(packing, contact, allowance));
        if (sign.is_certain()) {
            return sign.make_certain();
        }
    }
    return CGAL::sign(with_sign_of_gap<CGAL::Exact_rational>(packing, contact, allowance));
}

} // namespace isostat
