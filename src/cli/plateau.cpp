#include "answers/plateau.hpp"

#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "io/files.hpp"
#include "snap/soft_list.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::cli {

namespace {

/// Half a unit of the last digit of the roundest position in --box; 0 for exact ones.
double rounding_of(const std::string& box) {
    double worst = 0;
    for (const std::string& axis : parse_list(box)) {
        for (const std::string& word : {axis.substr(0, axis.find(':')), axis.substr(axis.find(':') + 1)}) {
            const std::size_t point = word.find('.');
            if (point != std::string::npos && word.find_first_of("eE") == std::string::npos) {
                worst = std::max(worst, 0.5 * std::pow(10.0, -static_cast<double>(word.size() - point - 1)));
            }
        }
    }
    return worst;
}

/// Notes on walls that may hide the range.
void note_walls(const PlateauArguments& a, const crafted::Plateau& plateau, ForeignPacking& file) {
    const double rounding = rounding_of(a.foreign.box);
    const bool wide = std::ranges::any_of(
        plateau.ranges, [&](const crafted::PlateauRange& range) { return range.last - range.first > rounding; });
    if (const std::string far = compare::far_wall(file.packing); !far.empty()) {
        file.notes.push_back(far);
    } else if (rounding > 0 && !wide) {
        file.notes.push_back(fmt::format("--box has digits down to {:.2g}: were the walls rounded there, contacts with "
                                         "walls come at wrong thresholds; expected every digit",
                                         2 * rounding));
    }
}

/// The counts, between thresholds that are found where none are named; a cell that is refused is that of the file.
crafted::Plateau counts_of(const ForeignPacking& file, const PlateauArguments& a, Strain strain,
                           std::array<double, 2>& thresholds) {
    try {
        if (a.thresholds.empty()) {
            constexpr double share = 0.1; // of the smallest radius
            thresholds[1] = share * file.packing.min_radius();
            thresholds[0] =
                std::min(crafted::plateau(file.packing, {thresholds[1]}, strain).deepest_overlap, thresholds[1]);
        }
        return crafted::plateau(file.packing, thresholds[0], thresholds[1], a.rows, strain, file.rounding);
    } catch (const Error& error) {
        throw Error(error.kind(), a.file + ": " + error.what());
    }
}

} // namespace

int plateau(const PlateauArguments& a) {
    check_output(a.csv, answers::plateau_head, {a.file});
    std::array<double, 2> thresholds{};
    if (!a.thresholds.empty()) {
        thresholds = parse_range(a.thresholds, "--thresholds");
    }
    ForeignArguments foreign = a.foreign;
    foreign.options.cells = foreign.spheres = foreign.fixes = foreign.clumps = true;
    ForeignPacking file = read_any_packing(a.file, foreign);
    const Strain strain = value_of(a.strain, words_of<Strain>("fixed", "isotropic", "diagonal", "full")).value();
    const crafted::Plateau result = counts_of(file, a, strain, thresholds);
    const answers::Told told = answers::told_of(result);
    note_walls(a, result, file);
    if (const std::string sizes = compare::far_disks(file.packing, thresholds[1], result); !sizes.empty()) {
        file.notes.push_back(sizes);
    }
    if (!a.csv.empty()) {
        write_output(a.csv, answers::to_csv(result), answers::plateau_head);
    }
    print(answers::to_answer({a.file, a.strain, file, result, told, thresholds}, a.common.json), a.common,
          "isostat-plateau 1");
    if (!told.backbone.empty()) {
        return done;
    }
    // The list is unknown where no range is wider than the rounding.
    const bool known = result.widest ? result.widest->range.told : thresholds[1] - thresholds[0] > 2 * result.rounding;
    return told.special || !known ? undecided : failed;
}

} // namespace isostat::cli
