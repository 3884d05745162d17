#include "crafted/inspection_parts.hpp"

namespace isostat::crafted {

namespace {

using Vectors = std::vector<std::vector<Number>>;

/// The largest t, by the dual: least f y with y >= 0, change y = -1, stresses y = 0. Empty: t is not bounded.
std::optional<Number> largest(const std::vector<Number>& forces, const Vectors& rows) {
    std::vector<Number> b(rows.size());
    b[0] = -1;
    return exact::least(rows, b, forces);
}

/// The contacts whose force vanishes at f + t change.
std::vector<int> zeros(const std::vector<Number>& forces, const std::vector<Number>& change, const Number& t) {
    std::vector<int> out;
    for (std::size_t l = 0; l < forces.size(); ++l) {
        if (!change[l].is_zero() && (forces[l] + t * change[l]).is_zero()) {
            out.push_back(static_cast<int>(l));
        }
    }
    return out;
}

} // namespace

std::optional<LoadRange> load_range(const std::vector<Number>& forces, const std::vector<Number>& change,
                                    const Vectors& stresses) {
    // Farkas: no t is supported exactly when some y >= 0 has f y = -1, change y = 0 and stresses y = 0.
    Vectors rows{change};
    rows.insert(rows.end(), stresses.begin(), stresses.end());
    for (std::vector<Number>& row : rows) { // the forces after these may have any sign
        row.resize(forces.size());
    }
    Vectors all = rows;
    all.push_back(forces);
    std::vector<Number> b(all.size());
    b.back() = -1;
    if (exact::feasible_point(all, b, static_cast<int>(forces.size())).feasible) {
        return std::nullopt;
    }
    LoadRange out;
    out.most = largest(forces, rows);
    for (Number& x : rows[0]) {
        x = -x;
    }
    if (const auto back = largest(forces, rows)) {
        out.least = -*back;
    }
    if (stresses.empty()) {
        out.zero_at_least = out.least ? zeros(forces, change, *out.least) : std::vector<int>{};
        out.zero_at_most = out.most ? zeros(forces, change, *out.most) : std::vector<int>{};
    }
    return out;
}

} // namespace isostat::crafted
