#include "cli/cell_text.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "cli/terminal.hpp"
#include "compare/soft_list.hpp"
#include "contact/names.hpp"
#include "core/words.hpp"
#include "crafted/told_ranges.hpp"
#include "io/files.hpp"
#include "packing/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/plateau.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace isostat::cli {

namespace {

using crafted::PlateauCounts;
using crafted::PlateauRange;
using crafted::PlateauStep;

/// The backbone of the widest range, or at the largest threshold.
std::vector<Contact> shown_backbone(const ReadPacking& file, const crafted::Plateau& plateau, double& threshold) {
    threshold = plateau.widest ? plateau.widest->range.first : threshold;
    return crafted::backbone_at(file.packing, threshold);
}

StrainCounts strains_of(const ReadPacking& file, const std::vector<Contact>& backbone) {
    const std::vector<int> rattlers = untouched(file.packing.disk_count(), backbone);
    return count_strains(without_disks(file.packing, rattlers), backbone);
}

void print_strains(const ReadPacking& file, const crafted::Plateau& plateau, double threshold) {
    const std::vector<Contact> backbone = shown_backbone(file, plateau, threshold);
    const int disks =
        file.packing.disk_count() - static_cast<int>(untouched(file.packing.disk_count(), backbone).size());
    say("\nbackbone at the threshold {:.17g}, for every way to strain the cell\n", threshold);
    print_counts(fmt::format("{} {}s", disks, grain_word(file.packing.dimension)), strains_of(file, backbone));
    say("contacts needed          {} for a bulk modulus, {} for all moduli (Goodrich et al., by counting)\n",
        contacts_for_bulk_modulus(disks, file.packing.dimension),
        contacts_for_all_moduli(disks, file.packing.dimension));
    say("jammed                   undecided: that asks for forces; counts alone do not tell\n");
}

/// The pair or wall with the smallest gap; empty where none is near.
std::string deepest_of(const ReadPacking& file) {
    std::string out;
    double smallest = HUGE_VAL;
    const Walls& walls = file.packing.walls;
    for (const Contact& c : compare::near_contacts(file.packing)) {
        const auto& sides = c.kind == ContactKind::lower_wall ? walls.lower : walls.upper;
        const bool there = c.kind == ContactKind::disk_disk || sides[static_cast<std::size_t>(c.j)] != WallKind::absent;
        if (const double g = gap(file.packing, c); there && g < smallest) {
            smallest = g;
            out = to_string(c, file.packing.dimension);
        }
    }
    return out;
}

std::string word(Verdict verdict) {
    return std::string(to_string(verdict));
}

/// A bound is marked: h and k are exact only where the rank is.
std::string bound(int value, const PlateauCounts& counts) {
    return fmt::format("{}{}", counts.rank_exact == Verdict::proved ? "" : "<=", value);
}

std::string range_text(const PlateauRange& range) {
    return fmt::format("{:.17g} <= threshold {} {:.17g}{}", range.first, range.open ? "<=" : "<", range.last,
                       range.open ? " (and perhaps beyond)" : "");
}

void print_ranges(const std::string& title, const std::vector<PlateauRange>& ranges, const std::string& none) {
    constexpr std::size_t longest = 8;
    if (ranges.empty()) {
        say("{:<28}{}\n", title, none);
    }
    for (std::size_t k = 0; k < ranges.size() && k < longest; ++k) {
        say("{:<28}{}\n", k == 0 ? title : "", range_text(ranges[k]));
        say("{:<28}  from N = {} with {} rattlers, {} candidates\n", "", ranges[k].contacts, ranges[k].rattlers,
            ranges[k].candidates);
    }
    if (ranges.size() > longest) {
        say("{:<28}and {} more ranges\n", "", ranges.size() - longest);
    }
}

std::string noise_text(const crafted::Told& told, double rounding) {
    return told.noise == 0
               ? ""
               : fmt::format(
                     "the order of gaps that differ by less than 2 x {} is not known: {} range{} that rest{} on "
                     "it {} left out",
                     rounded_up(rounding, 2), told.noise, told.noise == 1 ? "" : "s", told.noise == 1 ? "s" : "",
                     told.noise == 1 ? "is" : "are");
}

/// Where there is none, as far as the rounding of gaps leaves it open.
std::string self_stress_text(const crafted::Plateau& plateau) {
    const double end = plateau.no_self_stress_below;
    if (plateau.no_self_stress_open) {
        return fmt::format("up to the largest threshold {:.17g}, proved", end);
    }
    return plateau.widest && plateau.widest->range.first >= end
               ? fmt::format("below the widest range, at {:.17g} of the stored doubles", end)
               : fmt::format("below {:.17g}, proved", end);
}

/// What the packing says: the widest range.
void print_headline(const crafted::Plateau& plateau, const crafted::Told& told,
                    const std::array<double, 2>& thresholds) {
    const std::string none = fmt::format("at no threshold of [{:.6g}, {:.6g}]", thresholds[0], thresholds[1]);
    if (plateau.widest) {
        const auto& [range, counts] = *plateau.widest;
        say("{:<28}{}\n", "widest range (in log)", range_text(range));
        say("{:<28}  from N = {} with {} rattlers; h = {}, k = {} {}{}\n", "", range.contacts, range.rattlers,
            bound(counts.hyperstaticity, counts), bound(counts.mechanisms, counts),
            range.open ? "at its end" : "up to its end", range.told ? "" : "; below the rounding of gaps");
    }
    print_ranges("backbone isostatic, proved", told.backbone, none);
    print_ranges("all isostatic, proved", told.all, none);
    if (!told.elsewhere.empty()) {
        print_ranges("isostatic in less wide ones", told.elsewhere, "");
    }
    if (const std::string noise = noise_text(told, plateau.rounding); !noise.empty()) {
        say("{:<28}{}\n", "rounding", noise);
    }
}

void print_text(const PlateauArguments& a, const ReadPacking& file, const crafted::Plateau& plateau,
                const crafted::Told& told, const std::array<double, 2>& thresholds) {
    say("file                        {} ({})\n", a.file, file.format);
    for (const std::string& note : file.notes) {
        say("                            {}\n", note);
    }
    say("{:<28}{}, radii {:.6g} to {:.6g}\n", fmt::format("{}s", grain_word(file.packing.dimension)),
        file.packing.disk_count(), file.packing.min_radius(), file.packing.max_radius());
    say("thresholds                  {:.6g} to {:.6g} (unit of the file)\n", thresholds[0], thresholds[1]);
    const std::string deepest = plateau.candidates > 0 ? deepest_of(file) : "";
    say("candidates                  {}, smallest gap {:.6g}{}; the contact list changes at {} thresholds\n",
        plateau.candidates, plateau.deepest_overlap, deepest.empty() ? "" : ", of " + deepest, plateau.changes);
    say("gaps known to               {}: digits of the file, doubles, shifts\n", rounded_up(plateau.rounding, 2));
    say("rows                        {} of these, {} ranks computed, the rest follows from monotony\n\n",
        plateau.steps.size(), plateau.ranks_computed);
    say("{:>14} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7} {:<10}| {:>8} {:>7} {:>7}\n", "threshold", "candidates",
        "rattlers", "N_f", "N", "rank", "h", "k", " isostatic", "all N_f", "h", "k");
    for (const PlateauStep& s : plateau.steps) {
        say("{:>14.6g} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7}  {:<9} | {:>8} {:>7} {:>7}\n", s.threshold,
            s.candidate_count, s.rattlers, s.backbone.dof_count, s.backbone.contact_count, s.backbone.rank,
            bound(s.backbone.hyperstaticity, s.backbone), bound(s.backbone.mechanisms, s.backbone),
            word(s.backbone.isostatic), s.all.dof_count, bound(s.all.hyperstaticity, s.all),
            bound(s.all.mechanisms, s.all));
    }
    const int rigid = plateau.steps.empty() ? 0 : plateau.steps.back().all.rigid_motions;
    say("\nN_f, N, rank, h, k: backbone, that is without disks and contacts that can carry no force by the "
        "position of the normals;\nall: every {}. k includes {} common rigid motions. <=: proved bound.\n\n",
        grain_word(file.packing.dimension), rigid);
    print_headline(plateau, told, thresholds);
    if (told.special) {
        print_ranges("N = N_f but rank deficient", plateau.special, "");
    }
    say("no self-stress (h = 0)      {}\n", self_stress_text(plateau));
    if (file.packing.cell.all()) {
        say("cell                        {}, as --cell says: its strains are among the N_f above\n", a.strain);
        print_strains(file, plateau, thresholds[1]);
    }
}

Json counts_json(const PlateauCounts& c) {
    return {{"N_f", c.dof_count},
            {"N", c.contact_count},
            {"rank", c.rank},
            {"h", c.hyperstaticity},
            {"k", c.mechanisms},
            {"rigid_motions", c.rigid_motions},
            {"rank_exact", word(c.rank_exact)},
            {"isostatic", word(c.isostatic)}};
}

Json ranges_json(const std::vector<PlateauRange>& ranges) {
    Json out = Json::array();
    for (const PlateauRange& r : ranges) {
        out.push_back({{"first", number(r.first)},
                       {"last", number(r.last)},
                       {"open", r.open},
                       {"told", r.told},
                       {"N", r.contacts},
                       {"rattlers", r.rattlers},
                       {"candidates", r.candidates}});
    }
    return out;
}

Json to_json(const PlateauArguments& a, const ReadPacking& file, const crafted::Plateau& plateau,
             const crafted::Told& told, const std::array<double, 2>& thresholds) {
    Json out;
    out["format"] = "isostat-plateau 1";
    out["program"] = program_name();
    out["command"] = a.common.command;
    out["file"] = a.file;
    out["file_format"] = file.format;
    out["notes"] = file.notes;
    out["disks"] = file.packing.disk_count();
    out["thresholds"] = {thresholds[0], thresholds[1]};
    out["smallest_gap"] = number(plateau.deepest_overlap);
    out["smallest_gap_of"] = plateau.candidates > 0 ? deepest_of(file) : "";
    out["candidates"] = plateau.candidates;
    out["changes"] = plateau.changes;
    out["ranks_computed"] = plateau.ranks_computed;
    out["rounding"] = number(plateau.rounding);
    out["widest"] = nullptr;
    if (plateau.widest) {
        out["widest"] = ranges_json({plateau.widest->range})[0];
        out["widest"]["counts"] = counts_json(plateau.widest->counts);
        out["widest"]["contacts"] =
            contact_names(crafted::backbone_at(file.packing, plateau.widest->range.first), file.packing.dimension);
    }
    out["isostatic"] = ranges_json(told.backbone);
    out["isostatic_all_disks"] = ranges_json(told.all);
    out["isostatic_elsewhere"] = ranges_json(told.elsewhere);
    out["isostatic_by_rounding"] = told.noise;
    out["rank_deficient"] = ranges_json(plateau.special);
    out["no_self_stress_below"] = number(plateau.no_self_stress_below);
    out["no_self_stress_open"] = plateau.no_self_stress_open;
    Json steps = Json::array();
    for (const PlateauStep& s : plateau.steps) {
        steps.push_back({{"threshold", number(s.threshold)},
                         {"candidates", s.candidate_count},
                         {"rattlers", s.rattlers},
                         {"backbone", counts_json(s.backbone)},
                         {"all", counts_json(s.all)}});
    }
    out["steps"] = std::move(steps);
    if (file.packing.cell.all()) {
        double threshold = thresholds[1];
        const std::vector<Contact> backbone = shown_backbone(file, plateau, threshold);
        out["cell"] = {{"strain", a.strain},
                       {"threshold", number(threshold)},
                       {"backbone", strains_json(strains_of(file, backbone))}};
    }
    return out;
}

constexpr const char* plateau_head = "threshold,candidates,rattlers,N_f,N,rank,h,k,rank_exact,isostatic,all_N_f,all_N,"
                                     "all_rank,all_h,all_k,all_rank_exact,all_isostatic\n";

std::string to_csv(const crafted::Plateau& plateau) {
    std::string out = plateau_head;
    const auto counts = [](const PlateauCounts& c) {
        return fmt::format("{},{},{},{},{},{},{}", c.dof_count, c.contact_count, c.rank, c.hyperstaticity, c.mechanisms,
                           c.rank_exact == Verdict::proved ? 1 : 0, word(c.isostatic));
    };
    for (const PlateauStep& s : plateau.steps) {
        out += fmt::format("{},{},{},{},{}\n", s.threshold, s.candidate_count, s.rattlers, counts(s.backbone),
                           counts(s.all));
    }
    return out;
}

/// Half a unit of the last digit of the roundest position in --box; 0 where it has none to lose.
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

/// What about the walls may hide the range that was looked for.
void note_walls(const PlateauArguments& a, const crafted::Plateau& plateau, ReadPacking& file) {
    const double rounding = rounding_of(a.foreign.box);
    const bool wide = std::any_of(plateau.ranges.begin(), plateau.ranges.end(),
                                  [&](const PlateauRange& range) { return range.last - range.first > rounding; });
    if (const std::string far = compare::far_wall(file.packing); !far.empty()) {
        file.notes.push_back(far);
    } else if (rounding > 0 && !wide) {
        file.notes.push_back(fmt::format("--box has digits down to {:.2g}: were the walls rounded there, contacts with "
                                         "walls come at wrong thresholds; expected every digit",
                                         2 * rounding));
    }
}

} // namespace

int plateau(const PlateauArguments& a) {
    check_output(a.csv, plateau_head, {a.file});
    std::array<double, 2> thresholds{};
    if (!a.thresholds.empty()) {
        thresholds = parse_range(a.thresholds, "--thresholds");
    }
    ForeignArguments foreign = a.foreign;
    foreign.cells = foreign.spheres = foreign.fixes = true;
    ReadPacking file = read_any_packing(a.file, foreign);
    const Strain strain = value_of<Strain>(a.strain, std::array{"fixed", "isotropic", "diagonal", "full"}).value();
    if (a.thresholds.empty()) {
        constexpr double share = 0.1; // of the smallest radius
        thresholds[1] = share * file.packing.min_radius();
        thresholds[0] =
            std::min(crafted::plateau(file.packing, {thresholds[1]}, strain).deepest_overlap, thresholds[1]);
    }
    const crafted::Plateau result =
        crafted::plateau(file.packing, thresholds[0], thresholds[1], a.rows, strain, file.rounding);
    const crafted::Told told = crafted::told_of(result);
    note_walls(a, result, file);
    if (const std::string sizes = compare::far_disks(file.packing, thresholds[1], result); !sizes.empty()) {
        file.notes.push_back(sizes);
    }
    if (!a.csv.empty()) {
        write_output(a.csv, to_csv(result), plateau_head);
    }
    if (a.common.json) {
        print_json(to_json(a, file, result, told, thresholds));
    } else {
        print_text(a, file, result, told, thresholds);
    }
    if (!told.backbone.empty()) {
        return done;
    }
    // Nothing is known of the list where no range is wider than the rounding.
    const bool known = result.widest ? result.widest->range.told : thresholds[1] - thresholds[0] > 2 * result.rounding;
    return told.special || !known ? undecided : failed;
}

} // namespace isostat::cli
