#include "crafted/genericity.hpp"

#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/read_packing.hpp"
#include "cli/terminal.hpp"
#include "io/files.hpp"
#include "io/vertex_text.hpp"
#include "packing/words.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/io/foreign.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/rigidity/counting.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace isostat::cli {

namespace {

using crafted::Genericity;
using crafted::GenericitySample;

/// The unperturbed packing: its contacts, and what is known of h and k.
constexpr const char* genericity_head =
    "size,seed,result,h,k,carrying,rattlers,min_force,min_gap,sigma_min,within_original\n";

struct Original {
    Packing packing;
    std::vector<Contact> contacts;
    int hyperstaticity = 0;
    int mechanisms = 0;
    Counting with_radii;
    Verdict exact = Verdict::undecided;
    std::string title;
};

Original read_original(const std::string& file) {
    const std::string text = read_text(file);
    const std::string format = recognise_format(text);
    Original out;
    if (format == "packing") {
        const crafted::PackingFile crafted = crafted::parse_packing(text, file);
        const auto inspection = crafted::inspect(crafted.packing);
        if (!inspection.ok()) {
            throw Error(ErrorKind::bad_input, fmt::format("{}: {}", file, inspection.failure().message()));
        }
        out.packing = crafted::approximate(crafted.packing);
        out.contacts = inspection.value().contacts;
        out.hyperstaticity = inspection.value().hyperstaticity;
        out.mechanisms = inspection.value().mechanisms;
        out.with_radii = inspection.value().with_radii;
        out.exact = inspection.value().rank_exact;
        out.title = "exact contacts of the crafted packing";
    } else if (format == "state" || format == "vertex") {
        State state =
            format == "state" ? parse_any_state(text, file, Dimensions::any).state : parse_vertex_text(text, file);
        const Counting counting = count_contacts(state.packing, state.contacts);
        out.hyperstaticity = counting.hyperstaticity;
        out.mechanisms = counting.mechanisms;
        out.with_radii = crafted::count_with_radii(crafted::exact_copy(state.packing), state.contacts);
        out.exact = counting.rank_exact;
        out.packing = std::move(state.packing);
        out.contacts = std::move(state.contacts);
        out.title = "contacts of the state, stored coordinates";
    } else {
        throw Error(
            ErrorKind::bad_input,
            fmt::format("{}: not a file of this program: expected a crafted packing (TOML), a state or a vertex "
                        "text; isostat import makes a state of a packing of another program",
                        file));
    }
    return out;
}

/// Smallest, median, largest of a figure over the proved samples.
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
    std::sort(values.begin(), values.end());
    return {values.front(), values[values.size() / 2], values.back()};
}

std::string list_text(const std::vector<Contact>& list, const std::vector<Contact>& original, int dimension) {
    std::string missing, added;
    int lost = 0, gained = 0;
    constexpr int most = 8;
    for (const Contact& c : original) {
        if (!std::binary_search(list.begin(), list.end(), c) && ++lost <= most) {
            missing += " " + to_string(c, dimension);
        }
    }
    for (const Contact& c : list) {
        if (!std::binary_search(original.begin(), original.end(), c) && ++gained <= most) {
            added += " " + to_string(c, dimension);
        }
    }
    return fmt::format("without{}{}, with{}{}", lost == 0 ? " nothing less" : missing,
                       lost > most ? fmt::format(" and {} more", lost - most) : "",
                       gained == 0 ? " nothing new" : added,
                       gained > most ? fmt::format(" and {} more", gained - most) : "");
}

Json sample_json(const GenericitySample& sample) {
    Json out;
    out["seed"] = sample.seed;
    if (sample.failure) {
        out["failure"] = to_string(sample.failure->kind);
        out["reason"] = sample.failure->message();
        return out;
    }
    out["h"] = 0;
    out["k"] = 0;
    out["N"] = sample.contacts.size();
    out["carrying"] = sample.carrying.size();
    out["rattlers"] = sample.rattlers;
    out["min_force"] = number(sample.min_force);
    out["min_gap"] = number(sample.min_gap);
    out["sigma_min"] = number(sample.sigma_min);
    out["rung"] = to_string(sample.rung);
    out["within_original"] = sample.within_original;
    return out;
}

Json result_json(const Genericity& result, double size, std::size_t longest, int dimension) {
    Json out;
    out["size"] = size;
    out["proved_isostatic"] = result.proved;
    out["ties"] = result.ties;
    out["undecided"] = result.undecided;
    out["failed"] = result.failed;
    out["within_original"] = result.within();
    out["rungs"] = result.rungs();
    out["distinct_networks"] = result.lists.size();
    Json lists = Json::array();
    for (std::size_t k = 0; k < result.lists.size() && k < longest; ++k) {
        lists.push_back(
            {{"samples", result.lists[k].samples}, {"contacts", contact_names(result.lists[k].contacts, dimension)}});
    }
    out["networks"] = std::move(lists);
    Json samples = Json::array();
    for (const GenericitySample& sample : result.samples) {
        samples.push_back(sample_json(sample));
    }
    out["samples"] = std::move(samples);
    return out;
}

std::string csv_rows(const Genericity& result, double size) {
    std::string out;
    for (const GenericitySample& s : result.samples) {
        const bool ok = !s.failure;
        out += fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", size, s.seed,
                           ok ? "proved" : to_string(s.failure->kind), ok ? "0" : "", ok ? "0" : "",
                           ok ? std::to_string(s.carrying.size()) : "", ok ? std::to_string(s.rattlers) : "",
                           ok ? fmt::format("{}", s.min_force) : "", ok ? fmt::format("{}", s.min_gap) : "",
                           ok ? fmt::format("{}", s.sigma_min) : "", ok ? (s.within_original ? "1" : "0") : "");
    }
    return out;
}

void print_row(const Genericity& result, double size) {
    const auto force = spread(result, [](const GenericitySample& s) { return s.min_force; });
    const auto gap = spread(result, [](const GenericitySample& s) { return s.min_gap; });
    const auto sigma = spread(result, [](const GenericitySample& s) { return s.sigma_min; });
    const auto rattlers = spread(result, [](const GenericitySample& s) { return s.rattlers; });
    std::string used;
    for (const auto& [rung, count] : result.rungs()) {
        used += fmt::format("{}{} {}", used.empty() ? "" : ", ", rung, count);
    }
    if (result.proved == 0) {
        say("{:>8.1e} {:>7} {:>5} {:>9} {:>6}\n", size, 0, result.ties, result.undecided, result.failed);
        return;
    }
    say("{:>8.1e} {:>7} {:>5} {:>9} {:>6} | {:>6} {:>7} {:>9} {:>8} | {:>9.2e} {:>9.2e} {:>9.2e} {:>9.2e} "
        "{:>9.2e} | {}\n",
        size, result.proved, result.ties, result.undecided, result.failed, result.lists.size(),
        result.lists.front().samples, result.within(), fmt::format("{}..{}", rattlers[0], rattlers[2]), force[0],
        force[1], gap[0], gap[1], sigma[0], used);
}

void print_head(const GenericityArguments& a, const Original& original) {
    const char* bound = original.exact == Verdict::proved ? "=" : "<=";
    say("{}: {} {}s, N = {} ({}), h {} {}, k {} {}, rank with radii {} {}\n", a.file, original.packing.disk_count(),
        grain_word(original.packing.dimension), original.contacts.size(), original.title, bound,
        original.hyperstaticity, bound, original.mechanisms,
        original.with_radii.rank_exact == Verdict::proved ? "=" : ">=", original.with_radii.rank);
    say("radius times 1 + size u, u uniform in [-1, 1){}{}; {} samples, seeds {} to {}\n\n",
        a.keep_equal ? ", the same u for equal radii" : "", a.tilt ? "; tilt plus size u times the first period" : "",
        a.samples, a.seed, a.seed + static_cast<std::uint64_t>(a.samples) - 1);
    say("{:>8} {:>7} {:>5} {:>9} {:>6} | {:>6} {:>7} {:>9} {:>8} | {:>9} {:>9} {:>9} {:>9} {:>9} | {}\n", "size",
        "h=k=0", "tie", "undecided", "failed", "lists", "largest", "within", "rattlers", "min force", "median",
        "min gap", "median", "min sigma", "arithmetic");
}

/// The most frequent contact lists of one size.
void print_lists(const GenericityArguments& a, const Original& original, const Genericity& result, double size) {
    for (std::size_t k = 0; k < result.lists.size() && k < static_cast<std::size_t>(a.lists) &&
                            result.lists[k].samples > std::max(1, a.samples / 20);
         ++k) {
        say("size {:.0e}: {} samples {}\n", size, result.lists[k].samples,
            list_text(result.lists[k].contacts, original.contacts, original.packing.dimension));
    }
}

/// Why samples of one size failed: how many of each kind, and the first of them.
void print_failures(const Genericity& result, double size) {
    std::map<std::string, std::pair<int, std::string>> reasons;
    for (const GenericitySample& sample : result.samples) {
        if (sample.failure) {
            auto& reason = reasons[to_string(sample.failure->kind)];
            if (reason.first++ == 0) {
                reason.second = fmt::format("seed {}: {}", sample.seed, sample.failure->message());
            }
        }
    }
    for (const auto& [kind, reason] : reasons) {
        say("size {:.0e}: {} times {}, first {}\n", size, reason.first, kind, reason.second);
    }
}

Json report(const GenericityArguments& a, const Original& original, Json results) {
    Json out;
    out["format"] = "isostat-genericity 1";
    out["program"] = program_name();
    out["command"] = a.common.command;
    out["file"] = a.file;
    out["seed"] = a.seed;
    out["samples"] = a.samples;
    out["stress"] = number(a.stress);
    out["keep_equal"] = a.keep_equal;
    out["tilt"] = a.tilt;
    out["original"] = {{"N", original.contacts.size()},
                       {"h", original.hyperstaticity},
                       {"k", original.mechanisms},
                       {"rank_exact", to_string(original.exact)},
                       {"rank_with_radii", original.with_radii.rank},
                       {"rank_with_radii_exact", to_string(original.with_radii.rank_exact)}};
    out["sizes"] = std::move(results);
    return out;
}

} // namespace

int genericity(const GenericityArguments& a) {
    check_output(a.csv, genericity_head, {a.file});
    const Original original = read_original(a.file);
    crafted::GenericityOptions options;
    options.samples = a.samples;
    options.seed = a.seed;
    options.stress = a.stress;
    options.keep_equal = a.keep_equal;
    options.tilt = a.tilt;
    const bool text = !a.common.json;
    if (text) {
        print_head(a, original);
    }
    Json results = Json::array();
    std::string csv = genericity_head;
    std::vector<Genericity> all;
    bool every = true;
    for (const double size : a.sizes) {
        options.size = size;
        all.push_back(crafted::genericity(original.packing, original.contacts, options));
        const Genericity& result = all.back();
        every = every && result.proved == a.samples;
        csv += csv_rows(result, size);
        if (text) {
            print_row(result, size);
        } else {
            results.push_back(result_json(result, size, static_cast<std::size_t>(a.lists), original.packing.dimension));
        }
    }
    if (!a.csv.empty()) {
        write_output(a.csv, csv, genericity_head);
    }
    if (text) {
        say("\nh=k=0: proved of the true vertex, with every force > 0 and every other gap > 0; tie: more gaps are 0 "
            "than "
            "N_f, to double-double;\nlists: distinct networks of force-carrying contacts, and samples in the most "
            "frequent; within: the force "
            "network is part of the unperturbed contacts;\nmargins: proved lower bounds, smallest and median over "
            "the samples.\n");
        for (std::size_t s = 0; s < all.size(); ++s) {
            print_lists(a, original, all[s], a.sizes[s]);
            print_failures(all[s], a.sizes[s]);
        }
    } else {
        print_json(report(a, original, std::move(results)));
    }
    return every ? done : undecided;
}

} // namespace isostat::cli
