#pragma once
/// \file
/// Packings of spheres by an independent program (tests/data/spheres/README.md), as states.

#include <isostat/contact/state.hpp>

#include <gmpxx.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <string>

namespace isostat::test {

/// "1.25", "2e-31" or "27/40", exactly.
inline mpq_class exactly(std::string text) {
    long exponent = 0;
    if (const std::size_t e = text.find('e'); e != std::string::npos) {
        exponent = std::stol(text.substr(e + 1));
        text.erase(e);
    }
    if (const std::size_t point = text.find('.'); point != std::string::npos) {
        exponent -= static_cast<long>(text.size() - point - 1);
        text.erase(point, 1);
    }
    mpq_class value(text, 10);
    value.canonicalize();
    mpz_class power;
    mpz_ui_pow_ui(power.get_mpz_t(), 10, static_cast<unsigned long>(std::abs(exponent)));
    return exponent < 0 ? mpq_class(value / power) : mpq_class(value * power);
}

inline Contact contact_of(const nlohmann::json& c) {
    if (c[0] == "pair") {
        Image image;
        for (std::size_t a = 0; a < 3; ++a) {
            image.m[a] = static_cast<std::int8_t>(c[3][a].get<int>());
        }
        return pair_of(c[1], c[2], image);
    }
    return {c[3] == "lower" ? ContactKind::lower_wall : ContactKind::upper_wall, c[1], c[2]};
}

inline nlohmann::json read_spheres(const std::string& name) {
    std::ifstream file(std::string(ISOSTAT_TEST_DATA) + "/spheres/" + name + ".json");
    return nlohmann::json::parse(file);
}

/// Dead loads on reference lengths of 1: the stresses are the forces, exactly.
inline State state_of_spheres(const nlohmann::json& file) {
    const auto number = [](const nlohmann::json& text) { return std::stod(text.get<std::string>()); };
    State state;
    Packing& p = state.packing;
    p.dimension = p.cell.dimension = 3;
    p.walls = Walls::none();
    for (const nlohmann::json& r : file["radius"]) {
        p.radius.push_back(number(r));
    }
    for (const nlohmann::json& x : file["position"]) {
        std::ranges::transform(x, std::back_inserter(p.q), number);
    }
    std::ranges::transform(file["cell"], std::back_inserter(p.q), number);
    for (std::size_t a = 0; a < 3; ++a) {
        p.cell.periodic[a] = file["axes"][a] == "periodic";
        p.cell.period_moves[a] = p.cell.periodic[a];
        p.walls.lower[a] = p.cell.periodic[a] ? WallKind::absent : WallKind::fixed;
        p.walls.upper[a] = p.cell.periodic[a] ? WallKind::absent : WallKind::movable;
    }
    p.cell.pin = file["pinned"].is_null() ? 0 : file["pinned"].get<int>();
    p.cell.tilt_moves.fill(file["tilted"].get<bool>());
    p.q.resize(p.coordinate_count(), 0);
    state.load.dimension = 3;
    state.load.loaded_axis = 2;
    state.load.stress.fill(1);
    state.load.reference_length.fill(1);
    for (std::size_t a = 0; a < 3 && file.contains("dead_load_on_cell"); ++a) {
        state.load.stress[a] = number(file["dead_load_on_cell"][a]);
    }
    if (file.contains("infinitesimal_load")) {
        for (const nlohmann::json& g : file["infinitesimal_load"]) {
            std::ranges::transform(g, std::back_inserter(state.load.infinitesimal), number);
        }
    }
    std::ranges::transform(file["contacts"], std::back_inserter(state.contacts), contact_of);
    return state;
}

/// The same forces, as stresses on the lengths that it has, the last one 1.
inline State on_its_lengths(State state) {
    state.load.refer_to(state.packing);
    PerAxis<double> stress{};
    for (std::size_t a = 0; a < 3; ++a) {
        stress[a] = state.load.stress[a] * state.packing.length(static_cast<int>(a));
    }
    for (std::size_t a = 0; a < 3; ++a) {
        state.load.stress[a] = stress[a] / stress[2];
    }
    return state;
}

} // namespace isostat::test
