#include "certificate/averages.hpp"
#include "contact/separation.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace isostat {

PerAxis<double> outward(const State& state, const Contact& contact) {
    if (contact.of_disks()) {
        return direction(separation(state.packing.layout(), state.packing.q, contact));
    }
    return wall_normal<double>(contact);
}

namespace {

std::string header(std::size_t axes) {
    std::string text = "contact,i,j";
    for (const char* const what : {"m", "", "n"}) {
        for (std::size_t a = 0; a < axes; ++a) {
            text += fmt::format(",{}{}", what, axis_names[a]);
        }
    }
    return text + ",gap,force,force_low,force_high,force_infinitesimal\n";
}

} // namespace

std::string contact_table(const State& state, const Certification& truth) {
    const Packing& packing = state.packing;
    std::string text = header(packing.axes());
    const auto& forces = truth.claims.forces;
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        const Contact& contact = state.contacts[l];
        if (!contact.is_unilateral()) {
            continue;
        }
        const std::string name = to_string(contact, packing.dimension);
        const PerAxis<double> normal = outward(state, contact);
        text += fmt::format("\"{}\",{},{}", name, contact.i,
                            contact.of_disks() ? std::to_string(contact.j) : name.substr(name.find('-') + 1));
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            text += fmt::format(",{}", static_cast<int>(contact.image.m[a]));
        }
        const double radius = packing.radius[static_cast<std::size_t>(contact.i)];
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            text += fmt::format(",{}", packing.coordinate(DiskId(contact.i), static_cast<int>(a)) + radius * normal[a]);
        }
        text += fmt::format(",{},{}", fmt::join(normal.begin(), normal.begin() + packing.dimension, ","),
                            gap(packing, contact));
        if (l < truth.finite.size()) {
            const Interval& f = truth.finite[l];
            // 0.5: exact: the middle of an interval, for people
            text += fmt::format(",{},{},{}", 0.5 * f.lower + 0.5 * f.upper, f.lower, f.upper);
        } else {
            text += ",,,";
        }
        text += ",";
        if (forces) {
            const auto& zeros = forces->structural_zeros;
            const auto place = std::ranges::lower_bound(zeros, static_cast<int>(l));
            if (place != zeros.end() && *place == static_cast<int>(l)) {
                const Interval& f = forces->infinitesimal[static_cast<std::size_t>(place - zeros.begin())];
                text += fmt::format("{}", 0.5 * f.lower + 0.5 * f.upper);
            }
        }
        text += "\n";
    }
    return text;
}

} // namespace isostat
