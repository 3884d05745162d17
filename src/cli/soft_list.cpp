#include "cli/soft_list.hpp"

#include "cli/ranges.hpp"
#include "compare/backbone.hpp"
#include "compare/pair_images.hpp"
#include "contact/candidates.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/io/foreign.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace isostat::cli {

namespace {

/// The disk that is nearest to a wall, and its gap.
std::pair<int, double> nearest_to(const Packing<2>& packing, ContactKind wall, int axis) {
    std::pair<int, double> out{-1, HUGE_VAL};
    for (int i = 0; i < packing.disk_count(); ++i) {
        if (const double g = gap<2>(packing, {wall, i, axis}); g < out.second) {
            out = {i, g};
        }
    }
    return out;
}

/// Walls that a disk overlaps.
std::vector<Contact> walls_of(const Packing<2>& packing) {
    std::vector<Contact> out;
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int i = 0; i < packing.disk_count(); ++i) {
            for (int axis = 0; axis < 2; ++axis) {
                if (!packing.cell.periodic[static_cast<std::size_t>(axis)] && gap<2>(packing, {kind, i, axis}) <= 0) {
                    out.emplace_back(kind, i, axis);
                }
            }
        }
    }
    return out;
}

/// Empty, or the walls that no disk overlaps: soft grains press on each, so digits of its position are missing.
std::string walls_apart(const Packing<2>& packing) {
    std::string out;
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (int axis = 0; axis < 2 && !packing.cell.any(); ++axis) {
            if (const auto [disk, distance] = nearest_to(packing, kind, axis); distance > 0) {
                out += fmt::format("; none with the {} wall, which is {:.3g} from disk {} (are digits of its position "
                                   "rounded?)",
                                   to_string<2>({kind, 0, axis}).substr(2), distance, disk);
            }
        }
    }
    return out;
}

} // namespace

void refuse(const std::string& file, const std::string& what) {
    throw Error(ErrorKind::bad_input, file + ": " + what);
}

std::array<double, 2> parse_stress(const std::string& text) {
    return text.empty() ? std::array<double, 2>{1, 1} : parse_pair(text, "--stress", "S1,S2");
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

void take_cell(const CellStatement& statement, Packing<2>& packing) {
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
    packing.cell.tilt_moves.fill(cell == "tilted" || (cell.empty() && packing.lattice(0, 1) != 0));
}

std::string far_wall(const Packing<2>& packing) {
    for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
        for (const int axis : {0, 1}) {
            const auto a = static_cast<std::size_t>(axis);
            const WallKind wall = kind == ContactKind::lower_wall ? packing.walls.lower[a] : packing.walls.upper[a];
            const auto [nearest, distance] = nearest_to(packing, kind, axis);
            if (wall != WallKind::absent && nearest >= 0 && distance > nearly_touching * packing.min_radius()) {
                return fmt::format("no disk is near the {} wall, the nearest gap is {:.3g} (disk {}): expected the "
                                   "positions of the walls, --box XLO:XHI,YLO:YHI (bounds of a file often are not "
                                   "those)",
                                   to_string<2>({kind, 0, axis}).substr(2), distance, nearest);
            }
        }
    }
    return "";
}

void check_nearness(const std::string& file, const Packing<2>& packing) {
    const double near = nearly_touching * packing.min_radius();
    if (const std::string words = far_wall(packing); !words.empty()) {
        refuse(file, words);
    }
    const double deepest = crafted::plateau(packing, {near}).deepest_overlap;
    if (deepest < -near) {
        refuse(file, fmt::format("two grains overlap by {:.3g}: expected at most {:.3g}, {} of the smallest radius",
                                 -deepest, near, nearly_touching));
    }
}

SoftList list_by_forces(const std::string& file, const ReadPacking& packing, const std::string& frame,
                        const std::string& contacts, const std::string& columns) {
    const std::vector<std::string> names = parse_list(columns);
    if (names.size() != 3) {
        throw Error(
            ErrorKind::usage,
            fmt::format("--contact-columns is '{}': expected I,J,FORCE, names of columns of {}", columns, contacts));
    }
    if (packing.ids.empty()) {
        refuse(file, "has no column id: expected one, the contacts speak of ids");
    }
    std::optional<long> number;
    if (frame != "last") {
        number = std::stol(frame); // read once already
    }
    SoftList out;
    compare::PairImages images(packing.packing);
    std::map<Contact, double> forces;
    for (const PairForce& row : read_local_dump(contacts, {names[0], names[1], names[2]}, packing.ids, number)) {
        const Contact pair = images.next(row.i, row.j);
        if (!forces.emplace(pair, row.force).second) {
            refuse(fmt::format("{}:{}", contacts, row.line),
                   fmt::format("disks {} and {} come twice: expected each pair once",
                               packing.ids[static_cast<std::size_t>(row.i)],
                               packing.ids[static_cast<std::size_t>(row.j)]));
        }
    }
    const std::size_t pairs = forces.size();
    const std::vector<Contact> walls = walls_of(packing.packing);
    for (const Contact& wall : walls) {
        forces.emplace(wall, NAN);
    }
    const std::string beside = packing.packing.cell.any() ? "" : fmt::format(", {} overlaps with walls", walls.size());
    out.words = fmt::format("{} pairs with a force in {}{}, without rattlers{}", pairs, contacts, beside,
                            walls_apart(packing.packing));
    for (const auto& [contact, force] : forces) {
        out.contacts.push_back(contact);
    }
    out.contacts = compare::able_to_carry(packing.packing, out.contacts);
    for (const Contact& contact : out.contacts) {
        out.forces.push_back(forces.at(contact));
    }
    return out;
}

SoftList list_by_overlaps(const Packing<2>& packing) {
    constexpr double reach = 0.5; // of the smallest radius
    SoftList out;
    for (const Contact& c : find_candidates(packing, reach).contacts) {
        if (gap(packing, c) < 0) {
            out.contacts.push_back(c);
        }
    }
    out.words = fmt::format("{} overlaps, without rattlers{}", out.contacts.size(), walls_apart(packing));
    out.contacts = compare::able_to_carry(packing, out.contacts);
    return out;
}

} // namespace isostat::cli
