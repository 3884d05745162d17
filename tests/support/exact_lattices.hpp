#pragma once
// Exact lattices between walls.

#include <isostat/crafted/exact_packing.hpp>

namespace families {

using isostat::crafted::ExactPacking;
using isostat::exact::Number;

inline ExactPacking empty_box(const Number& lx, const Number& ly) {
    ExactPacking packing;
    packing.walls = isostat::Walls::box();
    packing.length = {lx, ly};
    return packing;
}

inline void add(ExactPacking& packing, const Number& x, const Number& y, const Number& r) {
    packing.centre.push_back({x, y});
    packing.radius.push_back(r);
}

/// Equal disks on a square lattice that fills the box; every disk of `small` radius sqrt(2) - 1 in a hole when asked
/// for: it touches four disks.
inline ExactPacking square_lattice(int columns, int rows, bool fill_holes) {
    ExactPacking packing = empty_box(2 * columns, 2 * rows);
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            add(packing, 2 * i + 1, 2 * j + 1, 1);
        }
    }
    const Number small = Number::parse("sqrt(2) - 1");
    for (int j = 1; fill_holes && j < rows; ++j) {
        for (int i = 1; i < columns; ++i) {
            add(packing, 2 * i, 2 * j, small);
        }
    }
    return packing;
}

/// Equal disks on a triangular lattice: rows alternate between the left and the right wall.
inline ExactPacking triangular_lattice(int columns, int rows) {
    const Number step = Number::parse("sqrt(3)");
    ExactPacking packing = empty_box(2 * columns + 1, Number(2) + step * Number(rows - 1));
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            add(packing, 2 * i + 1 + j % 2, Number(1) + step * Number(j), 1);
        }
    }
    return packing;
}

} // namespace families
