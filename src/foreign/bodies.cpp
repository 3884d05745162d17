// Rigid bodies of several grains.
#include "packing/bodies.hpp"

#include "foreign/source.hpp"
#include "packing/words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::foreign {

namespace {

/// Moves a member by periods to the image nearest to the first of its body; returns the rounding of a coordinate.
double put_beside(Packing& packing, int first, int member, const std::string& source) {
    constexpr double told = 0.375; // periods; at half a period another image is as near
    double worst = 0;
    const std::size_t d = packing.axes();
    double* const x = &packing.q[d * static_cast<std::size_t>(member)];
    const double* const from = &packing.q[d * static_cast<std::size_t>(first)];
    for (std::size_t a = d; a-- > 0;) { // a step along a period also moves the coordinates before it
        const double periods = packing.cell.periodic[a] ? std::round((x[a] - from[a]) / packing.lattice(a, a)) : 0;
        for (std::size_t b = 0; b <= a && periods != 0; ++b) {
            const double before = x[b];
            x[b] -= periods * packing.lattice(b, a);
            worst = std::max(worst, 0x1p-51 * (std::abs(before) + std::abs(x[b])));
        }
        if (const double apart = std::abs(x[a] - from[a]) / packing.lattice(a, a);
            packing.cell.periodic[a] && apart > told) {
            refuse(source,
                   "{} {} of the body of {} {} is {:.3g} periods beside it: expected at most {}, as else its images "
                   "are not told apart",
                   grain_word(packing.dimension), member, grain_word(packing.dimension), first, apart, told);
        }
    }
    return worst;
}

} // namespace

std::vector<std::vector<int>> bodies_of(const std::vector<long>& ids) {
    std::map<long, std::vector<int>> rows;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        rows[ids[i]].push_back(static_cast<int>(i));
    }
    std::vector<std::vector<int>> out;
    for (auto& [id, members] : rows) {
        if (id > 0 && members.size() > 1) {
            out.push_back(std::move(members));
        }
    }
    return out;
}

void add_bodies(ForeignPacking& out, const std::vector<long>& ids, const std::string& source) {
    Packing& packing = out.packing;
    const std::vector<std::vector<int>> bodies = bodies_of(ids);
    double moved = 0;
    for (const std::vector<int>& body : bodies) {
        for (std::size_t k = 1; k < body.size() && packing.cell.any(); ++k) {
            moved = std::max(moved, put_beside(packing, body.front(), body[k], source));
        }
    }
    out.rounding += rounding_of_gaps(moved, 0, 0, {packing.dimension});
    constexpr double roundoff = 64; // grid steps, for distances in double
    packing.bars = bars_of_bodies(packing, bodies, source, std::max(out.rounding, roundoff * grid_step(packing)));
    out.notes.push_back(
        fmt::format("{} rigid bodies of several {}s; what has a number of its own, 0 or -1 is by itself", bodies.size(),
                    grain_word(packing.dimension)));
}

} // namespace isostat::foreign
