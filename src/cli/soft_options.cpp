#include "cli/ranges.hpp"
#include "cli/read_packing.hpp"
#include "core/refuse.hpp"

#include <algorithm>

namespace isostat::cli {

namespace {

PerAxis<double> positive(const std::string& text, std::size_t count, const char* option, const char* names) {
    const std::vector<std::string> words = parse_list(text);
    PerAxis<double> out{};
    bool good = words.size() == count;
    for (std::size_t k = 0; good && k < count; ++k) {
        const auto value = ranges::number_in(words[k], ranges::smallest);
        good = value.has_value();
        out[k] = value.value_or(0);
    }
    if (!good) {
        refuse(ErrorKind::usage, "{} is '{}': expected {}, {} positive numbers", option, text, names,
               count == 2 ? "two" : "three");
    }
    return out;
}

} // namespace

PerAxis<double> parse_stress(const std::string& text, int dimension) {
    PerAxis<double> ones{};
    std::fill_n(ones.begin(), dimension, 1);
    return text.empty()
               ? ones
               : positive(text, static_cast<std::size_t>(dimension), "--stress", dimension == 2 ? "S1,S2" : "S1,S2,S3");
}

PerAxis<double> parse_lengths(const std::string& text, const char* option, int dimension) {
    return positive(text, static_cast<std::size_t>(dimension), option, dimension == 2 ? "L1,L2" : "L1,L2,L3");
}

void take_cell(const CellStatement& statement, Packing& packing) {
    const auto& [file, cell] = statement;
    if (!packing.cell.any() && !cell.empty()) {
        refuse(ErrorKind::usage,
               "--cell is '{}' and {} is not periodic: expected no --cell (--periodic says so where the file leaves it "
               "open)",
               cell, file);
    }
    if (!packing.cell.any()) {
        return;
    }
    if (!packing.cell.all() && !cell.empty()) {
        const bool one = packing.cell.periodic_axes() == 1;
        refuse(ErrorKind::usage,
               "--cell is '{}' and {} is periodic along {}, whose period{} move{}: expected no --cell", cell, file,
               one ? "one axis only" : "two axes only", one ? "" : "s", one ? "s" : "");
    }
    if (cell == "isotropic") {
        packing.cell.keep_shape();
        return;
    }
    packing.cell.keeps_shape = false;
    if (cell == "fixed") {
        packing.cell.move(false, false);
        return;
    }
    packing.cell.period_moves = packing.cell.periodic;
    const auto tilts = packing.q.begin() + static_cast<std::ptrdiff_t>(packing.length_at(packing.axes()));
    const bool tilted = std::any_of(tilts, packing.q.end(), [](double tilt) { return tilt != 0; });
    for (std::size_t b = 1; b < packing.axes(); ++b) {
        for (std::size_t a = 0; a < b; ++a) {
            packing.cell.tilt_moves[Cell::tilt(a, b)] =
                packing.cell.periodic[a] && packing.cell.periodic[b] && (cell == "tilted" || (cell.empty() && tilted));
        }
    }
}

compare::SoftList stated_list(const std::string& file, const ForeignPacking& packing, const std::string& frame,
                              const std::string& contacts, const std::string& columns) {
    const std::vector<std::string> names = parse_list(columns);
    if (names.size() != 3 && names.size() != 2 + packing.packing.axes() && names.size() != 2 + most_axes) {
        refuse(ErrorKind::usage, "--contact-columns is '{}': expected I,J,FORCE or I,J,FX,FY, names of columns of {}",
               columns, contacts);
    }
    const auto number = frame == "last" ? std::nullopt : std::optional(std::stol(frame)); // was checked before
    return compare::list_by_forces(file, packing.packing, packing.ids, number, contacts,
                                   {names[0], names[1], {names.begin() + 2, names.end()}});
}

} // namespace isostat::cli
