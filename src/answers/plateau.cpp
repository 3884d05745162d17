#include "answers/plateau.hpp"

#include "answers/state.hpp"
#include "contact/words.hpp"
#include "core/decimal.hpp"
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

/// Whether two ranges begin at the same list or overlap.
bool meet(const PlateauRange& a, const PlateauRange& b) {
    return a.candidates == b.candidates || std::max(a.first, b.first) < std::min(a.last, b.last);
}

/// Counts the backbone of the widest range, without such a range that of the largest threshold, for every strain.
void add_strains(Answer& out, const PlateauAnswer& answer) {
    const Packing& packing = answer.file.packing;
    const auto& widest = answer.plateau.widest;
    const double threshold = widest ? widest->range.first : answer.thresholds[1];
    const std::vector<Contact> backbone = crafted::backbone_at(packing, threshold);
    const std::vector<int> rattlers = untouched(packing.disk_count(), backbone);
    const int disks = packing.disk_count() - static_cast<int>(rattlers.size());
    say(out.text, "\nbackbone at the threshold {:.17g}, for every way to strain the cell\n", threshold);
    Answer table;
    Json counts = add_counts(table, fmt::format("{} {}s", disks, grain_word(packing.dimension)),
                             count_strains(without_disks(packing, rattlers), backbone));
    table.json = {{"strain", answer.strain}, {"threshold", or_null(threshold)}, {"backbone", std::move(counts)}};
    table.line("contacts needed", "{} for a bulk modulus, {} for all moduli (Goodrich et al., by counting)",
               contacts_for_bulk_modulus(disks, packing.dimension), contacts_for_all_moduli(disks, packing.dimension));
    table.line("jammed", "undecided: that asks for forces; counts alone do not tell");
    out.part("cell", std::move(table));
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

Json range_json(const PlateauRange& r) {
    return {
        {"first", or_null(r.first)}, {"last", or_null(r.last)},   {"open", r.open}, {"told", r.told}, {"N", r.contacts},
        {"rattlers", r.rattlers},    {"candidates", r.candidates}};
}

/// The first few ranges; `none` where there are none.
void add_lines(Answer& out, const std::string& title, const std::vector<PlateauRange>& ranges,
               const std::string& none = "") {
    constexpr std::size_t longest = 8;
    if (ranges.empty() && !none.empty()) {
        out.line(title, "{}", none);
    }
    for (std::size_t k = 0; k < ranges.size() && k < longest; ++k) {
        out.line(k == 0 ? title : "", "{}", range_text(ranges[k]));
        out.line("", "  from N = {} with {} rattlers, {} candidates", ranges[k].contacts, ranges[k].rattlers,
                 ranges[k].candidates);
    }
    if (ranges.size() > longest) {
        out.line("", "and {} more ranges", ranges.size() - longest);
    }
}

void add_ranges(Answer& out, const char* key, const std::string& title, const std::vector<PlateauRange>& ranges,
                const std::string& none = "") {
    out.item(key, json::array_of(ranges, range_json));
    add_lines(out, title, ranges, none);
}

std::string noise_text(int ranges, double rounding) {
    const bool one = ranges == 1;
    return fmt::format("the order of gaps that differ by less than 2 x {} is not known: {} {} on it {} left out",
                       rounded_up(rounding, 2), ranges, one ? "range that rests" : "ranges that rest",
                       one ? "is" : "are");
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

/// The main result, the widest range.
void add_headline(Answer& out, const PlateauAnswer& answer) {
    const auto& [name, strain, file, plateau, told, thresholds] = answer;
    out.item("widest", nullptr);
    if (plateau.widest) {
        const auto& [range, counts] = *plateau.widest;
        Json widest = range_json(range);
        widest["counts"] = counts_json(counts);
        if (out.lists) {
            widest["contacts"] = contact_names(crafted::backbone_at(file.packing, range.first), file.packing.dimension);
        }
        out.item("widest", std::move(widest), "widest range (in log)", "{}", range_text(range));
        out.line("", "  from N = {} with {} rattlers; h = {}, k = {}{} {}{}", range.contacts, range.rattlers,
                 bound(counts.hyperstaticity, counts), bound(counts.mechanisms, counts),
                 counts.turns == 0 ? "" : fmt::format(" ({} turns)", counts.turns),
                 range.open ? "at its end" : "up to its end", range.told ? "" : "; below the rounding of gaps");
    }
    const std::string none = fmt::format("at no threshold of [{:.6g}, {:.6g}]", thresholds[0], thresholds[1]);
    add_ranges(out, "isostatic", "backbone isostatic, proved", told.backbone, none);
    add_ranges(out, "isostatic_all_disks", "all isostatic, proved", told.all, none);
    add_ranges(out, "isostatic_elsewhere", "isostatic in less wide ones", told.elsewhere);
    out.item("isostatic_by_rounding", told.noise);
    if (told.noise > 0) {
        out.line("rounding", "{}", noise_text(told.noise, plateau.rounding));
    }
}

/// One row per threshold.
void add_steps(Answer& out, const crafted::Plateau& plateau, bool clumps) {
    say(out.text, "{:>14} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7} {:<10}| {:>8} {:>7} {:>7}{}\n", "threshold",
        "candidates", "rattlers", "N_f", "N", "rank", "h", "k", " isostatic", "all N_f", "h", "k",
        clumps ? " |  turns" : "");
    Json steps = Json::array();
    for (const PlateauStep& s : plateau.steps) {
        if (out.lists) {
            steps.push_back({{"threshold", or_null(s.threshold)},
                             {"candidates", s.candidate_count},
                             {"rattlers", s.rattlers},
                             {"backbone", counts_json(s.backbone)},
                             {"all", counts_json(s.all)}});
        }
        say(out.text, "{:>14.6g} {:>10} | {:>8} {:>8} {:>8} {:>8} {:>7} {:>7}  {:<9} | {:>8} {:>7} {:>7}{}\n",
            s.threshold, s.candidate_count, s.rattlers, s.backbone.dof_count, s.backbone.contact_count, s.backbone.rank,
            bound(s.backbone.hyperstaticity, s.backbone), bound(s.backbone.mechanisms, s.backbone),
            word(s.backbone.isostatic), s.all.dof_count, bound(s.all.hyperstaticity, s.all),
            bound(s.all.mechanisms, s.all), clumps ? fmt::format(" | {:>6}", s.backbone.turns) : "");
    }
    out.item("steps", std::move(steps));
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

Answer to_answer(const PlateauAnswer& answer, bool lists) {
    const auto& [name, strain, file, plateau, told, thresholds] = answer;
    const Packing& packing = file.packing;
    const char* const grain = grain_word(packing.dimension);
    const bool clumps = !packing.bars.empty();
    const int bodies = Bodies(packing).count();
    Answer out{.width = 27, .lists = lists};
    out.item("file_format", file.format);
    out.item("file", name, "file", "{} ({})", name, file.format);
    out.item("notes", file.notes);
    for (const std::string& note : file.notes) {
        out.line("", "{}", note);
    }
    out.item("bodies", bodies);
    out.item("disks", packing.disk_count(), fmt::format("{}s", grain), "{}{}, radii {:.6g} to {:.6g}",
             packing.disk_count(), clumps ? fmt::format(" in {} bodies", bodies) : "", packing.min_radius(),
             packing.max_radius());
    out.item("thresholds", {thresholds[0], thresholds[1]}, "thresholds", "{:.6g} to {:.6g} (unit of the file)",
             thresholds[0], thresholds[1]);
    const std::string deepest = plateau.candidates > 0 ? deepest_of(packing) : "";
    out.item("smallest_gap", or_null(plateau.deepest_overlap));
    out.item("smallest_gap_of", deepest);
    out.item("changes", plateau.changes);
    out.item("candidates", plateau.candidates, "candidates",
             "{}, smallest gap {:.6g}{}; the contact list changes at {} thresholds", plateau.candidates,
             plateau.deepest_overlap, deepest.empty() ? "" : ", of " + deepest, plateau.changes);
    out.item("rounding", or_null(plateau.rounding), "gaps known to", "{}: digits of the file, doubles, shifts",
             rounded_up(plateau.rounding, 2));
    out.item("ranks_computed", plateau.ranks_computed, "rows",
             "{} of these, {} ranks computed, the rest follows from monotony", plateau.steps.size(),
             plateau.ranks_computed);
    say(out.text, "\n");
    add_steps(out, plateau, clumps);
    const int rigid = plateau.steps.empty() ? 0 : plateau.steps.back().all.rigid_motions;
    say(out.text,
        "\nN_f, N, rank, h, k: backbone, that is without disks and contacts that can carry no force by the "
        "position of the normals;\nall: every {}. k includes {} common rigid motions. <=: proved bound.\n",
        grain, rigid);
    if (clumps) {
        say(out.text,
            "turns, among k: of rotational rattlers, bodies that turn about the one member (in space also two) that "
            "has all of their\ncontacts, and are isostatic all the same.\n");
    }
    say(out.text, "\n");
    add_headline(out, answer);
    out.item("rank_deficient", json::array_of(plateau.special, range_json));
    if (told.special) {
        add_lines(out, "N = N_f but rank deficient", plateau.special);
    }
    out.item("no_self_stress_open", plateau.no_self_stress_open);
    out.item("no_self_stress_below", or_null(plateau.no_self_stress_below), "no self-stress (h = 0)", "{}",
             self_stress_text(plateau));
    if (packing.cell.all()) {
        out.item("strain", strain, "cell", "{}, as --cell says: its strains are among the N_f above", strain);
    }
    if (packing.cell.all() && !clumps) {
        add_strains(out, answer);
    }
    return out;
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
