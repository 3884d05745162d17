#pragma once
// A straight strut that a grain without force joins to the rest.

#include "support/crafted.hpp"

namespace crafted {

/// Infinitesimal loads: along x on the strut, and on the grain along the directions of its two contacts.
struct StrutLoad {
    double on_strut, towards_strut, towards_rest;
    bool to_the_right; ///< where the strut is pushed to
};

inline std::vector<StrutLoad> strut_loads() {
    return {{1, 0, 0, true},     {-1, 0, 0, false}, {0.1, 1, 0, false},
            {-0.1, -1, 0, true}, {0.1, 0, 1, true}, {0.6, 1, 1, true}};
}

/// Disk 0 between the side walls, which pull; the grain, disk 1, lies on it and on disk 2 between bottom and top, -120
/// degrees and `angle` from it. The last contact holds x of the grain. No load on the strut is left across it.
inline State strut_with_a_grain(double angle, const StrutLoad& load) {
    const std::array<double, 2> to_strut{-0.5, -std::sqrt(0.75)};
    const std::array<double, 2> to_rest{std::cos(angle), std::sin(angle)};
    const double y = 4.5 - 5.5 * to_rest[1];
    State state = in_box({{1, 1, y + 2 * to_strut[1]}, {1, 2, y}, {4.5, 2 + 5.5 * to_rest[0], 4.5}}, 2, 9, -1, 1,
                         {left(0),
                          right(0),
                          pair(0, 1),
                          pair(1, 2),
                          bottom(2),
                          top(2),
                          {ContactKind::held, 4, 0},
                          {ContactKind::held, 2, 0}});
    state.load.infinitesimal[0] = load.on_strut;
    state.load.infinitesimal[1] = -load.towards_strut * to_strut[1];
    for (std::size_t k = 0; k < 2; ++k) {
        state.load.infinitesimal[2 + k] = load.towards_strut * to_strut[k] + load.towards_rest * to_rest[k];
    }
    return state;
}

} // namespace crafted
