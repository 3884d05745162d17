#pragma once
// Exact packings with as many contacts as possible, and the derivative of their gaps with respect to coordinates and
// radii.

#include "support/exact_lattices.hpp"
#include "support/test.hpp"

#include <isostat/exact/number.hpp>

namespace families {

using isostat::Contact;
using isostat::ContactKind;

/// A row of `columns` unit disks between bottom and top wall, every hole between two of them and a wall filled with
/// mutually tangent disks (Apollonius) up to the curvature `largest`. Curvatures and centres are rational: the
/// reflections of a Descartes quadruple act linearly on (b, b x, b y), lines having b = 0 and a unit normal. Each new
/// disk brings three contacts, one more than a rigid structure needs.
inline ExactPacking apollonian_strip(int columns, int largest) {
    using Circle = std::array<long, 3>; // b, b x, b (y - 1)
    ExactPacking packing = empty_box(2 * columns, 2);
    std::set<Circle> known;
    const auto keep = [&](const Circle& c) {
        if (known.insert(c).second) {
            const Number b(c[0]);
            add(packing, Number(c[1]) / b, Number(1) + Number(c[2]) / b, b.inverse());
        }
    };
    std::vector<std::array<Circle, 3>> holes;
    for (long i = 0; i < columns; ++i) {
        const Circle here{1, 2 * i + 1, 0};
        keep(here);
        if (i > 0) {
            const Circle before{1, 2 * i - 1, 0};
            holes.push_back({before, here, Circle{0, 0, 1}});
            holes.push_back({before, here, Circle{0, 0, -1}});
        }
    }
    std::vector<std::pair<std::array<Circle, 3>, Circle>> open; // a hole and the fourth circle on its other side
    for (const auto& hole : holes) {
        open.push_back({hole, Circle{0, 0, -hole[2][2]}});
    }
    while (!open.empty()) {
        const auto [hole, other] = open.back();
        open.pop_back();
        Circle inner{};
        for (std::size_t k = 0; k < 3; ++k) {
            inner[k] = 2 * (hole[0][k] + hole[1][k] + hole[2][k]) - other[k];
        }
        if (inner[0] > largest) {
            continue;
        }
        keep(inner);
        for (std::size_t k = 0; k < 3; ++k) {
            auto next = hole;
            next[k] = inner;
            open.push_back({next, hole[k]});
        }
    }
    return packing;
}

/// A column of disks with random rational radii, each tangent to the one below along a Pythagorean direction, each
/// second one against a fixed-height tower of the same kind: few contacts, extreme ratios of radii.
inline ExactPacking random_tower(int disks, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const std::array<std::array<int, 3>, 5> directions{{{3, 4, 5}, {-3, 4, 5}, {0, 1, 1}, {-20, 21, 29}, {20, 21, 29}}};
    ExactPacking packing = empty_box(0, 0);
    Number x = 0, y = 0, r = 0;
    for (int k = 0; k < disks; ++k) {
        const Number next(1 + static_cast<long>(random() % 1000));
        if (k > 0) {
            const auto& d = directions[random() % directions.size()];
            const Number s = (r + next) / Number(d[2]);
            x += s * Number(d[0]);
            y += s * Number(d[1]);
        }
        r = next;
        add(packing, x, y, r);
    }
    const auto least = [&](std::size_t axis) {
        Number low = packing.centre[0][axis] - packing.radius[0];
        for (std::size_t i = 1; i < packing.radius.size(); ++i) {
            const Number edge = packing.centre[i][axis] - packing.radius[i];
            low = edge < low ? edge : low;
        }
        return low;
    };
    for (std::size_t axis = 0; axis < 2; ++axis) {
        const Number shift = least(axis);
        Number high = 0;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            packing.centre[i][axis] -= shift;
            const Number edge = packing.centre[i][axis] + packing.radius[i];
            high = high < edge ? edge : high;
        }
        packing.length[axis] = high;
    }
    return packing;
}

/// Which radii are varied besides the coordinates.
enum class Radii { none, common, all };

/// One column per contact: minus the derivative of its gap; rows are the degrees of freedom and then the radii.
inline isostat::exact::NumberMatrix gap_derivative(const ExactPacking& packing, const std::vector<Contact>& contacts,
                                                   Radii radii) {
    const isostat::DofMap dofs(isostat::crafted::approximate(packing));
    auto matrix = isostat::crafted::exact_contact_matrix(packing, dofs, contacts);
    const int first = matrix.rows;
    matrix.rows += radii == Radii::all ? packing.disk_count() : radii == Radii::common ? 1 : 0;
    for (std::size_t l = 0; l < contacts.size() && radii != Radii::none; ++l) {
        const bool pair = contacts[l].kind == ContactKind::disk_disk;
        if (radii == Radii::common) {
            matrix.column[l].emplace_back(first, pair ? 2 : 1);
        } else {
            matrix.column[l].emplace_back(first + contacts[l].i, 1);
            if (pair) {
                matrix.column[l].emplace_back(first + contacts[l].j, 1);
            }
        }
    }
    return matrix;
}

/// Rank of that derivative: a proved lower bound, exact when it is N.
inline int rank_with(const ExactPacking& packing, const std::vector<Contact>& contacts, Radii radii) {
    return isostat::exact::rank_bound(gap_derivative(packing, contacts, radii)).rank;
}

inline ExactPacking counterexample(const std::string& name) {
    return isostat::crafted::read_packing(std::string(ISOSTAT_EXAMPLES) + "/packings/counterexample_" + name + ".toml")
        .packing;
}

} // namespace families
