#include "rigidity/rigid_group.hpp"

#include <algorithm>
#include <array>

namespace isostat {

namespace {

using Periods = std::array<int, 3>;

/// a + sign m
Periods moved(Periods a, const Image& m, int sign) {
    for (std::size_t k = 0; k < a.size(); ++k) {
        a[k] += sign * m.m[k];
    }
    return a;
}

} // namespace

std::optional<std::vector<Contact>> unwound(int disks, std::vector<Contact> contacts) {
    const auto any = [&](auto what) { return std::any_of(contacts.begin(), contacts.end(), what); };
    if (any([](const Contact& c) { return c.kind == ContactKind::held || c.kind == ContactKind::bar; })) {
        return std::nullopt;
    }
    if (!any([](const Contact& c) { return !c.image.is_here(); })) {
        return contacts;
    }
    std::vector<std::vector<std::size_t>> at(static_cast<std::size_t>(disks));
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts[l].of_disks()) {
            at[static_cast<std::size_t>(contacts[l].i)].push_back(l);
            at[static_cast<std::size_t>(contacts[l].j)].push_back(l);
        }
    }
    std::vector<std::optional<Periods>> by(at.size()); // how far each disk is moved; empty: not reached
    std::vector<std::size_t> next;
    for (std::size_t first = 0; first < at.size(); ++first) {
        if (by[first] || at[first].empty()) {
            continue;
        }
        by[first] = Periods{};
        next.push_back(first);
        while (!next.empty()) {
            const std::size_t disk = next.back();
            next.pop_back();
            for (const std::size_t l : at[disk]) {
                const Contact& c = contacts[l];
                const bool forwards = static_cast<std::size_t>(c.i) == disk;
                const auto other = static_cast<std::size_t>(forwards ? c.j : c.i);
                const Periods there = moved(*by[disk], c.image, forwards ? 1 : -1);
                if (!by[other]) {
                    by[other] = there;
                    next.push_back(other);
                } else if (*by[other] != there) {
                    return std::nullopt;
                }
            }
        }
    }
    for (Contact& c : contacts) {
        c.image = {};
    }
    return contacts;
}

} // namespace isostat
