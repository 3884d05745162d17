#include "answers/genericity.hpp"

#include "contact/words.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "io/vertex_text.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"

#include <isostat/crafted/exact_packing.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace isostat::answers {

using crafted::Genericity;
using crafted::GenericitySample;

namespace {

/// Smallest, median and largest value of a quantity over the proved samples.
template <class Get> std::array<double, 3> spread(const Genericity& result, Get get) {
    std::vector<double> values;
    for (const GenericitySample& sample : result.samples) {
        if (!sample.failure) {
            values.push_back(get(sample));
        }
    }
    if (values.empty()) {
        return {HUGE_VAL, HUGE_VAL, HUGE_VAL};
    }
    std::ranges::sort(values);
    return {values.front(), values[values.size() / 2], values.back()};
}

std::string list_text(const std::vector<Contact>& list, const std::vector<Contact>& original, int dimension) {
    std::string missing, added;
    int lost = 0, gained = 0;
    constexpr int most = 8;
    for (const Contact& c : original) {
        if (!std::ranges::binary_search(list, c) && ++lost <= most) {
            missing += " " + to_string(c, dimension);
        }
    }
    for (const Contact& c : list) {
        if (!std::ranges::binary_search(original, c) && ++gained <= most) {
            added += " " + to_string(c, dimension);
        }
    }
    return fmt::format("{}{}, {}{}", lost == 0 ? "with all contacts of the packing" : "without" + missing,
                       lost > most ? fmt::format(" and {} more", lost - most) : "",
                       gained == 0 ? "no new contact" : "with" + added,
                       gained > most ? fmt::format(" and {} more", gained - most) : "");
}

Json sample_json(const GenericitySample& sample, int dimension) {
    Json out;
    out["seed"] = sample.seed;
    if (sample.failure) {
        out["failure"] = to_string(sample.failure->kind);
        out["reason"] = sample.failure->message(dimension);
        return out;
    }
    out["h"] = 0;
    out["k"] = sample.mechanisms;
    out["N"] = sample.contacts.size();
    out["carrying"] = sample.carrying.size();
    out["rattlers"] = sample.rattlers;
    out["turns"] = sample.turns;
    out["min_force"] = or_null(sample.min_force);
    out["min_gap"] = or_null(sample.min_gap);
    out["sigma_min"] = or_null(sample.sigma_min);
    out["rung"] = to_string(sample.rung);
    out["within_original"] = sample.within_original;
    return out;
}

/// Prints the most frequent contact lists of one size.
void print_lists(std::string& out, const GenericityAnswer& a, const Genericity& result, double size) {
    for (std::size_t k = 0;
         k < result.lists.size() && k < a.lists && result.lists[k].samples > std::max(1, a.options.samples / 20); ++k) {
        say(out, "size {:.0e}: {} samples {}\n", size, result.lists[k].samples,
            list_text(result.lists[k].contacts, a.original.contacts, a.original.packing.dimension));
    }
}

/// Prints why samples of one size failed: the number of each kind, and its first reason.
void print_failures(std::string& out, const Genericity& result, double size, int dimension) {
    std::map<std::string, std::pair<int, std::string>> reasons;
    for (const GenericitySample& sample : result.samples) {
        if (sample.failure) {
            auto& reason = reasons[to_string(sample.failure->kind)];
            if (reason.first++ == 0) {
                reason.second = fmt::format("seed {}: {}", sample.seed, sample.failure->message(dimension));
            }
        }
    }
    for (const auto& [kind, reason] : reasons) {
        say(out, "size {:.0e}: {} times {}, first {}\n", size, reason.first, kind, reason.second);
    }
}

} // namespace

GenericityOriginal read_original(const std::string& file) {
    const std::string text = read_text(file);
    const std::string format = recognise_format(text);
    GenericityOriginal out;
    if (format == "packing") {
        const crafted::PackingFile crafted = crafted::parse_packing(text, file);
        const auto inspection = crafted::inspect_file(crafted, file);
        if (!inspection.ok()) {
            refuse(file, inspection.failure().message(crafted.packing.dimension()));
        }
        out.packing = crafted::approximate(crafted.packing);
        out.contacts = unilateral(inspection.value().contacts);
        out.hyperstaticity = inspection.value().hyperstaticity;
        out.mechanisms = inspection.value().mechanisms;
        out.exact = inspection.value().rank_exact;
        out.with_radii = crafted::count_with_radii(crafted.packing, out.contacts);
        out.title = "exact contacts of the crafted packing";
    } else if (format == "state" || format == "vertex") {
        State state = format == "state" ? parse_any_state(text, file, Dimensions::any_clumps).state
                                        : parse_vertex_text(text, file);
        const Counting counting = count_contacts(state.packing, state.contacts);
        out.hyperstaticity = counting.hyperstaticity;
        out.mechanisms = counting.mechanisms;
        out.exact = counting.rank_exact;
        out.packing = std::move(state.packing);
        out.contacts = unilateral(std::move(state.contacts));
        out.with_radii = crafted::count_with_radii(crafted::exact_copy(out.packing), out.contacts);
        out.title = "contacts of the state, stored coordinates";
    } else {
        refuse(file, "not a file of this program: expected a crafted packing (TOML), a state or a vertex text; isostat "
                     "import makes a state of a packing of another program");
    }
    std::ranges::sort(out.contacts);
    return out;
}

Answer head_of(const GenericityAnswer& a) {
    Answer out;
    const GenericityOriginal& original = a.original;
    const bool exact = original.exact == Verdict::proved;
    const bool clumps = !original.packing.bars.empty();
    out.json = {{"file", a.file},
                {"seed", a.options.seed},
                {"samples", a.options.samples},
                {"stress", or_null(a.options.stress)},
                {"keep_equal", a.options.keep_equal},
                {"tilt", a.options.tilt}};
    out.item("original", {{"N", original.contacts.size()},
                          {"h", original.hyperstaticity},
                          {"k", original.mechanisms},
                          {"rank_exact", to_string(original.exact)},
                          {"rank_with_radii", original.with_radii.rank},
                          {"rank_with_radii_exact", to_string(original.with_radii.rank_exact)}});
    out.item("sizes", Json::array());
    say(out.text, "{}: {} {}s, N = {} ({}), h {} {}, k {} {}, rank with radii{} {} {}\n", a.file,
        original.packing.disk_count(), grain_word(original.packing.dimension), original.contacts.size(), original.title,
        exact ? "=" : "<=", original.hyperstaticity, exact ? "=" : "<=", original.mechanisms,
        clumps ? " and places of members" : "",
        original.with_radii.rank_exact == Verdict::proved ? "=" : ">=", original.with_radii.rank);
    say(out.text, "radius times 1 + size u, u uniform in [-1, 1){}{}; {} samples, seeds {} to {}{}\n\n",
        a.options.keep_equal ? ", the same u for equal radii" : "",
        a.options.tilt ? "; tilt plus size u times the first period" : "", a.options.samples, a.options.seed,
        a.options.seed + static_cast<std::uint64_t>(a.options.samples) - 1,
        clumps && !a.options.keep_equal ? "; members move by their radii times size u" : "");
    say(out.text, "{:>8} {:>7} {:>5} {:>9} {:>6} | {:>6} {:>7} {:>9} {:>8} | {:>9} {:>9} {:>9} {:>9} {:>9} | {}\n",
        "size", "h=k=0", "tie", "undecided", "failed", "lists", "largest", "within", "rattlers", "min force", "median",
        "min gap", "median", "min sigma", "arithmetic");
    return out;
}

Answer row_of(const GenericityAnswer& a, const Genericity& result, double size) {
    Answer out;
    out.json = {{"size", size},
                {"proved_isostatic", result.proved},
                {"ties", result.ties},
                {"undecided", result.undecided},
                {"failed", result.failed},
                {"within_original", result.within()},
                {"rungs", result.rungs()},
                {"distinct_networks", result.lists.size()},
                {"networks", Json::array()},
                {"samples", json::array_of(result.samples, [&](const GenericitySample& sample) {
                     return sample_json(sample, a.original.packing.dimension);
                 })}};
    for (std::size_t k = 0; k < result.lists.size() && k < a.lists; ++k) {
        out.json["networks"].push_back(
            {{"samples", result.lists[k].samples},
             {"contacts", contact_names(result.lists[k].contacts, a.original.packing.dimension)}});
    }
    say(out.text, "{:>8.1e} {:>7} {:>5} {:>9} {:>6}", size, result.proved, result.ties, result.undecided,
        result.failed);
    if (result.proved > 0) {
        const auto force = spread(result, [](const GenericitySample& s) { return s.min_force; });
        const auto gap = spread(result, [](const GenericitySample& s) { return s.min_gap; });
        const auto sigma = spread(result, [](const GenericitySample& s) { return s.sigma_min; });
        const auto rattlers = spread(result, [](const GenericitySample& s) { return s.rattlers; });
        const auto turns = spread(result, [](const GenericitySample& s) { return s.turns; });
        std::string used;
        for (const auto& [rung, count] : result.rungs()) {
            used += fmt::format("{}{} {}", used.empty() ? "" : ", ", rung, count);
        }
        say(out.text, " | {:>6} {:>7} {:>9} {:>8} | {:>9.2e} {:>9.2e} {:>9.2e} {:>9.2e} {:>9.2e} | {}{}",
            result.lists.size(), result.lists.front().samples, result.within(),
            fmt::format("{}..{}", rattlers[0], rattlers[2]), force[0], force[1], gap[0], gap[1], sigma[0], used,
            turns[2] > 0 ? fmt::format("; rotational rattlers turn: {}..{}", turns[0], turns[2]) : "");
    }
    out.text += "\n";
    return out;
}

std::string closing_text(const GenericityAnswer& a, const std::vector<Genericity>& results,
                         std::span<const double> sizes) {
    std::string out = text::filled(
        "\nh=k=0: proved of the true vertex, with every force > 0 and every other gap > 0; tie: more gaps are 0 "
        "than "
        "N_f, to double-double;\nlists: distinct networks of force-carrying contacts, and samples in the most "
        "frequent; within: the force "
        "network is part of the unperturbed contacts;\nmargins: proved lower bounds, smallest and median over "
        "the samples.\n");
    for (std::size_t s = 0; s < results.size(); ++s) {
        print_lists(out, a, results[s], sizes[s]);
        print_failures(out, results[s], sizes[s], a.original.packing.dimension);
    }
    return out;
}

std::string csv_rows(const Genericity& result, double size) {
    std::string out;
    for (const GenericitySample& s : result.samples) {
        const bool ok = !s.failure;
        out +=
            fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", size, s.seed, ok ? "proved" : to_string(s.failure->kind),
                        ok ? "0" : "", ok ? std::to_string(s.mechanisms) : "",
                        ok ? std::to_string(s.carrying.size()) : "", ok ? std::to_string(s.rattlers) : "",
                        ok ? fmt::format("{}", s.min_force) : "", ok ? fmt::format("{}", s.min_gap) : "",
                        ok ? fmt::format("{}", s.sigma_min) : "", ok ? (s.within_original ? "1" : "0") : "");
    }
    return out;
}

} // namespace isostat::answers
