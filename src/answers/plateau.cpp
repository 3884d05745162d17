#include "answers/plateau.hpp"

#include "answers/state.hpp"
#include "contact/words.hpp"
#include "core/decimal.hpp"
#include "io/text.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"
#include "snap/soft_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace isostat::answers {

namespace {

using crafted::PlateauCounts;
using crafted::PlateauRange;
using crafted::PlateauStep;
using json::Json;
using json::or_null;
using text::say;

/// Whether two ranges begin at the same list or overlap.
bool meet(const PlateauRange& a, const PlateauRange& b) {
    return a.candidates == b.candidates || std::max(a.first, b.first) < std::min(a.last, b.last);
}

/// The backbone of the widest range; without such a range, at the largest threshold.
std::vector<Contact> shown_backbone(const Packing& packing, const crafted::Plateau& plateau, double& threshold) {
    threshold = plateau.widest ? plateau.widest->range.first : threshold;
    return crafted::backbone_at(packing, threshold);
}

StrainCounts strains_of(const Packing& packing, const std::vector<Contact>& backbone) {
    const std::vector<int> rattlers = untouched(packing.disk_count(), backbone);
    return count_strains(without_disks(packing, rattlers), backbone);
}

void print_strains(std::string& out, const Packing& packing, const crafted::Plateau& plateau, double threshold) {
    const std::vector<Contact> backbone = shown_backbone(packing, plateau, threshold);
    const int disks = packing.disk_count() - static_cast<int>(untouched(packing.disk_count(), backbone).size());
    say(out, "\nbackbone at the threshold {:.17g}, for every way to strain the cell\n", threshold);
    print_counts(out, fmt::format("{} {}s", disks, grain_word(packing.dimension)), strains_of(packing, backbone));
    say(out, "contacts needed          {} for a bulk modulus, {} for all moduli (Goodrich et al., by counting)\n",
        contacts_for_bulk_modulus(disks, packing.dimension), contacts_for_all_moduli(disks, packing.dimension));
    say(out, "jammed                   undecided: that asks for forces; counts alone do not tell\n");
}

/// The pair or wall with the smallest gap; empty when no pair is near.
std::string deepest_of(const Packing& packing) {
    std::string out;
    double smallest = HUGE_VAL;
    for (const Contact& c : compare::near_contacts(packing)) {
        if (const double g = gap(packing, c); g < smallest) {
            smallest = g;
            out = to_string(c, packing.dimension);
        }
    }
    return out;
}

std::string word(Verdict verdict) {
    return std::string(to_string(verdict));
}

/// The text of a count, marked when it is a bound: h and k are exact only when the rank is.
std::string bound(int value, const PlateauCounts& counts) {
    return fmt::format("{}{}", counts.rank_exact == Verdict::proved ? "" : "<=", value);
}

std::string range_text(const PlateauRange& range) {
    return fmt::format("{:.17g} <= threshold {} {:.17g}{}", range.first, range.open ? "<=" : "<", range.last,
                       range.open ? " (and perhaps beyond)" : "");
}

void print_ranges(std::string& out, const std::string& title, const std::vector<PlateauRange>& ranges,
                  const std::string& none) {
    constexpr std::size_t longest = 8;
    if (ranges.empty()) {
        say(out, "{:<28}{}\n", title, none);
    }
    for (std::size_t k = 0; k < ranges.size() && k < longest; ++k) {
        say(out, "{:<28}{}\n", k == 0 ? title : "", range_text(ranges[k]));
        say(out, "{:<28}  from N = {} with {} rattlers, {} candidates\n", "", ranges[k].contacts, ranges[k].rattlers,
            ranges[k].candidates);
    }
    if (ranges.size() > longest) {
        say(out, "{:<28}and {} more ranges\n", "", ranges.size() - longest);
    }
}

std::string noise_text(const Told& told, double rounding) {
    return told.noise == 0
               ? ""
               : fmt::format(
                     "the order of gaps that differ by less than 2 x {} is not known: {} range{} that rest{} on "
                     "it {} left out",
                     rounded_up(rounding, 2), told.noise, told.noise == 1 ? "" : "s", told.noise == 1 ? "s" : "",
                     told.noise == 1 ? "is" : "are");
}

/// Names the thresholds without self-stress, as far as the rounding of gaps decides them.
std::string self_stress_text(const crafted::Plateau& plateau) {
    const double end = plateau.no_self_stress_below;
    if (plateau.no_self_stress_open) {
        return fmt::format("up to the largest threshold {:.17g}, proved", end);
    }
    return plateau.widest && plateau.widest->range.first >= end
               ? fmt::format("below the widest range, at {:.17g} of the stored doubles", end)
               : fmt::format("below {:.17g}, proved", end);
}

/// Prints the main result, the widest range.
void print_headline(std::string& out, const crafted::Plateau& plateau, const Told& told,
                    const std::array<double, 2>& thresholds) {
    const std::string none = fmt::format("at no threshold of [{:.6g}, {:.6g}]", thresholds[0], thresholds[1]);
    if (plateau.widest) {
        const auto& [range, counts] = *plateau.widest;
        say(out, "{:<28}{}\n", "widest range (in log)", range_text(range));
        say(out, "{:<28}  from N = {} with {} rattlers; h = {}, k = {}{} {}{}\n", "", range.contacts, range.rattlers,
            bound(counts.hyperstaticity, counts), bound(counts.mechanisms, counts),
            counts.turns == 0 ? "" : fmt::format(" ({} turns)", counts.turns),
            range.open ? "at its end" : "up to its end", range.told ? "" : "; below the rounding of gaps");
    }
    print_ranges(out, "backbone isostatic, proved", told.backbone, none);
    print_ranges(out, "all isostatic, proved", told.all, none);
    if (!told.elsewhere.empty()) {
        print_ranges(out, "isostatic in less wide ones", told.elsewhere, "");
    }
    if (const std::string noise = noise_text(told, plateau.rounding); !noise.empty()) {
        say(out, "{:<28}{}\n", "rounding", noise);
    }
}

Json counts_json(const PlateauCounts& c) {
    return {{"N_f", c.dof_count},
            {"N", c.contact_count},
            {"rank", c.rank},
            {"h", c.hyperstaticity},
            {"k", c.mechanisms},
            {"rigid_motions", c.rigid_motions},
            {"turns", c.turns},
            {"rank_exact", word(c.rank_exact)},
            {"isostatic", word(c.isostatic)}};
}

Json ranges_json(const std::vector<PlateauRange>& ranges) {
    return json::array_of(ranges, [](const PlateauRange& r) {
        return Json{{"first", or_null(r.first)},
                    {"last", or_null(r.last)},
                    {"open", r.open},
                    {"told", r.told},
                    {"N", r.contacts},
                    {"rattlers", r.rattlers},
                    {"candidates", r.candidates}};
    });
}

} // namespace

Told told_of(const crafted::Plateau& plateau) {
    Told out;
    const auto in_widest = [&plateau](const PlateauRange& range) { // no range is the widest where no contact can carry
        return plateau.widest && meet(range, plateau.widest->range);
    };
    for (const PlateauRange& range : plateau.ranges) {
        if (!range.told) {
            ++out.noise;
        } else {
            (in_widest(range) ? out.backbone : out.elsewhere).push_back(range);
        }
    }
    const auto counts = [&](const PlateauRange& range) { return range.told && in_widest(range); };
    std::ranges::copy_if(plateau.ranges_all, std::back_inserter(out.all), counts);
    out.special = std::ranges::any_of(plateau.special, counts);
    return out;
}

std::string to_text(const PlateauAnswer& answer) {
    const auto& [name, strain, file, plateau, told, thresholds] = answer;
    std::string out;
    say(out, "file                        {} ({})\n", name, file.format);
    for (const std::string& note : file.notes) {
        say(out, "                            {}\n", note);
    }
    const bool clumps = !file.packing.bars.empty();
    say(out, "{:<28}{}{}, radii {:.6g} to {:.6g}\n", fmt::format("{}s", grain_word(file.packing.dimension)),
        file.packing.disk_count(), clumps ? fmt::format(" in {} bodies", Bodies(file.packing).count()) : "",
        file.packing.min_radius(), file.packing.max_radius());
    say(out, "thresholds                  {:.6g} to {:.6g} (unit of the file)\n", thresholds[0], thresholds[1]);
    const std::string deepest = plateau.candidates > 0 ? deepest_of(file.packing) : "";
    say(out, "candidates                  {}, smallest gap {:.6g}{}; the contact list changes at {} thresholds\n",
        plateau.candidates, plateau.deepest_overlap, deepest.empty() ? "" : ", of " + deepest, plateau.changes);
    say(out, "gaps known to               {}: digits of the file, doubles, shifts\n", rounded_up(plateau.rounding, 2));
    say(out, "rows                        {} of these, {} ranks computed, the rest follows from monotony\n\n",
        plateau.steps.size(), plateau.ranks_computed);
    say(out, "{:>14} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7} {:<10}| {:>8} {:>7} {:>7}{}\n", "threshold",
        "candidates", "rattlers", "N_f", "N", "rank", "h", "k", " isostatic", "all N_f", "h", "k",
        clumps ? " |  turns" : "");
    for (const PlateauStep& s : plateau.steps) {
        say(out, "{:>14.6g} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7}  {:<9} | {:>8} {:>7} {:>7}{}\n", s.threshold,
            s.candidate_count, s.rattlers, s.backbone.dof_count, s.backbone.contact_count, s.backbone.rank,
            bound(s.backbone.hyperstaticity, s.backbone), bound(s.backbone.mechanisms, s.backbone),
            word(s.backbone.isostatic), s.all.dof_count, bound(s.all.hyperstaticity, s.all),
            bound(s.all.mechanisms, s.all), clumps ? fmt::format(" | {:>6}", s.backbone.turns) : "");
    }
    const int rigid = plateau.steps.empty() ? 0 : plateau.steps.back().all.rigid_motions;
    say(out,
        "\nN_f, N, rank, h, k: backbone, that is without disks and contacts that can carry no force by the "
        "position of the normals;\nall: every {}. k includes {} common rigid motions. <=: proved bound.\n",
        grain_word(file.packing.dimension), rigid);
    if (clumps) {
        say(out,
            "turns, among k: of rotational rattlers, bodies that turn about the one member (in space also two) that "
            "has all of their\ncontacts, and are isostatic all the same.\n");
    }
    say(out, "\n");
    print_headline(out, plateau, told, thresholds);
    if (told.special) {
        print_ranges(out, "N = N_f but rank deficient", plateau.special, "");
    }
    say(out, "no self-stress (h = 0)      {}\n", self_stress_text(plateau));
    if (file.packing.cell.all()) {
        say(out, "cell                        {}, as --cell says: its strains are among the N_f above\n", strain);
    }
    if (file.packing.cell.all() && !clumps) {
        print_strains(out, file.packing, plateau, thresholds[1]);
    }
    return out;
}

void add_plateau(Json& out, const PlateauAnswer& answer) {
    const auto& [name, strain, file, plateau, told, thresholds] = answer;
    out["file"] = name;
    out["file_format"] = file.format;
    out["notes"] = file.notes;
    out["disks"] = file.packing.disk_count();
    out["bodies"] = Bodies(file.packing).count();
    out["thresholds"] = {thresholds[0], thresholds[1]};
    out["smallest_gap"] = or_null(plateau.deepest_overlap);
    out["smallest_gap_of"] = plateau.candidates > 0 ? deepest_of(file.packing) : "";
    out["candidates"] = plateau.candidates;
    out["changes"] = plateau.changes;
    out["ranks_computed"] = plateau.ranks_computed;
    out["rounding"] = or_null(plateau.rounding);
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
    out["no_self_stress_below"] = or_null(plateau.no_self_stress_below);
    out["no_self_stress_open"] = plateau.no_self_stress_open;
    out["steps"] = json::array_of(plateau.steps, [](const PlateauStep& s) {
        return Json{{"threshold", or_null(s.threshold)},
                    {"candidates", s.candidate_count},
                    {"rattlers", s.rattlers},
                    {"backbone", counts_json(s.backbone)},
                    {"all", counts_json(s.all)}};
    });
    if (file.packing.cell.all() && file.packing.bars.empty()) {
        double threshold = thresholds[1];
        const std::vector<Contact> backbone = shown_backbone(file.packing, plateau, threshold);
        out["cell"] = {{"strain", strain},
                       {"threshold", or_null(threshold)},
                       {"backbone", json::counts(strains_of(file.packing, backbone))}};
    }
}

std::string to_csv(const crafted::Plateau& plateau) {
    std::string out = plateau_head;
    const auto counts = [](const PlateauCounts& c) {
        return fmt::format("{},{},{},{},{},{},{}", c.dof_count, c.contact_count, c.rank, c.hyperstaticity, c.mechanisms,
                           c.rank_exact == Verdict::proved ? 1 : 0, word(c.isostatic));
    };
    for (const PlateauStep& s : plateau.steps) {
        out += fmt::format("{},{},{},{},{},{},{}\n", s.threshold, s.candidate_count, s.rattlers, counts(s.backbone),
                           counts(s.all), s.backbone.turns, s.all.turns);
    }
    return out;
}

} // namespace isostat::answers
