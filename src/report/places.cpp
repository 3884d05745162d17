#include "packing/cell_wrap.hpp"
#include "report/picture.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace isostat {

State in_cell(State state) {
    if (!state.packing.cell.any()) {
        return state;
    }
    const Wrapped wrapped = wrap_into_cell(state.packing);
    for (Contact& contact : state.contacts) {
        for (std::size_t a = 0; a < state.packing.axes() && contact.of_disks(); ++a) {
            const double m = contact.image.m[a] + wrapped.periods[static_cast<std::size_t>(contact.j)][a] -
                             wrapped.periods[static_cast<std::size_t>(contact.i)][a];
            contact.image.m[a] = static_cast<std::int8_t>(std::clamp(m, -100.0, 100.0)); // a contact has fewer
        }
    }
    return state;
}

PerAxis<double> centre_of(const Packing& packing, int grain) {
    PerAxis<double> at{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        at[a] = packing.coordinate(DiskId(grain), static_cast<int>(a));
    }
    return at;
}

PerAxis<double> end_of(const Packing& packing, const Contact& contact) {
    PerAxis<double> at = centre_of(packing, contact.of_disks() ? contact.j : contact.i);
    if (contact.of_disks()) {
        add_periods(at, packing, contact.image.m);
    } else {
        const auto wall = wall_coordinate(contact, packing.layout());
        at[static_cast<std::size_t>(contact.j)] = wall ? packing.q[*wall] : 0;
    }
    return at;
}

PerAxis<double> corner(const Packing& packing, unsigned bits) {
    PerAxis<double> at{};
    PerAxis<int> whole{};
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        whole[a] = static_cast<int>(bits >> a & 1U);
        at[a] = packing.cell.any() ? 0 : whole[a] * packing.length(static_cast<int>(a));
    }
    if (packing.cell.any()) {
        add_periods(at, packing, whole);
    }
    return at;
}

double mean_force(std::span<const double> forces) {
    double sum = 0;
    int count = 0;
    for (const double f : forces) {
        sum += std::abs(f);
        count += f != 0 ? 1 : 0;
    }
    return count > 0 ? sum / count : 1;
}

} // namespace isostat
