#include "cli/soft_options.hpp"

#include "cli/ranges.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

namespace isostat::cli {

PerAxis<double> parse_stress(const std::string& text) {
    const auto [s1, s2] = text.empty() ? std::array<double, 2>{1, 1} : parse_pair(text, "--stress", "S1,S2");
    return {s1, s2};
}

std::array<double, 2> parse_pair(const std::string& text, const char* option, const char* names) {
    const std::vector<std::string> words = parse_list(text);
    std::array<double, 2> pair{};
    bool good = words.size() == 2;
    for (std::size_t k = 0; good && k < 2; ++k) {
        const auto value = ranges::number_in(words[k], ranges::smallest);
        good = value.has_value();
        pair[k] = value.value_or(0);
    }
    if (!good) {
        throw Error(ErrorKind::usage,
                    fmt::format("{} is '{}': expected {}, two positive numbers", option, text, names));
    }
    return pair;
}

void take_cell(const CellStatement& statement, Packing& packing) {
    const auto& [file, cell] = statement;
    if (!packing.cell.any() && !cell.empty()) {
        throw Error(ErrorKind::usage, fmt::format("--cell is '{}' and {} is not periodic: expected no --cell "
                                                  "(--periodic says so where the file leaves it open)",
                                                  cell, file));
    }
    if (!packing.cell.any()) {
        return;
    }
    if (!packing.cell.all() && !cell.empty()) {
        throw Error(ErrorKind::usage, fmt::format("--cell is '{}' and {} is periodic along one axis only, whose period "
                                                  "moves: expected no --cell",
                                                  cell, file));
    }
    if (cell == "isotropic") {
        packing.cell.keep_shape();
        return;
    }
    packing.cell.keeps_shape = false;
    packing.cell.period_moves = packing.cell.periodic;
    std::fill_n(packing.cell.tilt_moves.begin(), packing.tilts(),
                cell == "tilted" || (cell.empty() && packing.lattice(0, 1) != 0));
}

compare::SoftList stated_list(const std::string& file, const ReadPacking& packing, const std::string& frame,
                              const std::string& contacts, const std::string& columns) {
    const std::vector<std::string> names = parse_list(columns);
    if (names.size() != 3) {
        throw Error(
            ErrorKind::usage,
            fmt::format("--contact-columns is '{}': expected I,J,FORCE, names of columns of {}", columns, contacts));
    }
    const auto number = frame == "last" ? std::nullopt : std::optional(std::stol(frame)); // read once already
    return compare::list_by_forces(file, packing.packing, packing.ids, number, contacts,
                                   {names[0], names[1], names[2]});
}

} // namespace isostat::cli
