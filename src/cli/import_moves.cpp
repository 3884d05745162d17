#include "cli/import_moves.hpp"

#include "cli/common.hpp"
#include "cli/import_contacts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::cli {

Moves moves_of(const Imported& found) {
    const Packing<2>& packing = found.state.packing;
    const double radius = found.truth.claims.vertex ? found.truth.claims.vertex->radius : HUGE_VAL;
    constexpr double up = 1 + 0x1p-49; // of a difference, a sum and a hypotenuse, each rounded
    const auto way = [&](std::size_t k) { return (std::abs(packing.q[k] - found.from[k]) + radius) * up; };
    Moves moves;
    const std::size_t n = packing.radius.size();
    moves.rattler.assign(n, 1);
    for (const Contact& c : carrying(found.state, found.truth)) {
        moves.rattler[static_cast<std::size_t>(c.i)] = 0;
        if (c.kind == ContactKind::disk_disk) {
            moves.rattler[static_cast<std::size_t>(c.j)] = 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        moves.disk.push_back(std::hypot(way(2 * i), way(2 * i + 1)) * up);
        double& largest = moves.rattler[i] != 0 ? moves.rattlers : moves.backbone;
        largest = std::max(largest, moves.disk[i]);
    }
    moves.walls = std::max(way(2 * n), way(2 * n + 1));
    return moves;
}

std::string moves_csv(const Imported& found, const Moves& moves) {
    std::string text = "disk,x,y,moved,rattler\n";
    for (std::size_t i = 0; i < moves.disk.size(); ++i) {
        text += fmt::format("{},{},{},{},{}\n", i, found.state.packing.q[2 * i], found.state.packing.q[2 * i + 1],
                            rounded_up(moves.disk[i], 6), moves.rattler[i]);
    }
    return text;
}

} // namespace isostat::cli
