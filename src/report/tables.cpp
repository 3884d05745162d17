#include "io/text.hpp"
#include "report/charts.hpp"
#include "report/statistics.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

namespace {

void add_segments(std::string& text, const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names) {
    text += fmt::format("\n{:>3} {:<36} {:>6} {:>6} {:>12} {:>12} {:>12} {:>12} {:>6}\n", "seg", "name", "from", "made",
                        "ratio from", "to", "strain from", "to", "arcs");
    const std::map<int, SegmentPath> paths = segment_paths(rows, names);
    for (std::size_t s = 0; s < names.size(); ++s) {
        const auto found = paths.find(static_cast<int>(s));
        if (found == paths.end()) {
            text += fmt::format("{:>3} {:<36} not run\n", s + 1, text::shown(names[s]));
            continue;
        }
        const std::vector<EquilibriumRow>& path = found->second.rows;
        int made = 0;
        long arcs = 0;
        for (auto row = path.begin() + (found->second.has_start ? 1 : 0); row != path.end(); ++row) {
            made += row->number != 0 ? 1 : 0;
            arcs += row->arcs;
        }
        const EquilibriumRow& start = path.front();
        const EquilibriumRow& last = path.back();
        text += fmt::format("{:>3} {:<36} {:>6} {:>6} {:>12.8f} {:>12.8f} {:>12.5e} {:>12.5e} {:>6}\n", s + 1,
                            text::shown(names[s]), start.number, made, start.ratio, last.ratio, start.strain2,
                            last.strain2, arcs);
    }
}

void add_increments(std::string& text, const char* what, const Increments& increments, const LoadWords& words) {
    for (const auto& [name, values] :
         {std::pair{words.rising, &increments.loading}, std::pair{words.falling, &increments.unloading}}) {
        if (!values->empty()) {
            const auto [low, high] = std::ranges::minmax_element(*values);
            text += fmt::format("{:<20} {:<10} {:>6} values, mean {:.4e}, from {:.4e} to {:.4e}\n", what, name,
                                values->size(), mean(*values), *low, *high);
        }
    }
}

void add_checks(std::string& text, const std::vector<EquilibriumRow>& rows) {
    const auto count = [&](auto&& test) { return std::ranges::count_if(rows, test); };
    const auto [fewest, most] =
        std::ranges::minmax_element(rows, [](auto& a, auto& b) { return a.rattlers < b.rattlers; });
    const auto margin = std::ranges::min_element(rows, [](auto& a, auto& b) { return a.margin < b.margin; });
    const auto [loose, dense] =
        std::ranges::minmax_element(rows, [](auto& a, auto& b) { return a.solid_fraction < b.solid_fraction; });
    text += fmt::format("equilibria proved    {} of {}\n", count([](auto& r) { return r.proved; }), rows.size());
    text += fmt::format("h = 0                {} of {}\n", count([](auto& r) { return r.hyperstaticity == 0; }),
                        rows.size());
    text += fmt::format("rattlers             from {} to {}\n", fewest->rattlers, most->rattlers);
    text += fmt::format("solid fraction       from {:.6f} to {:.6f}\n", loose->solid_fraction, dense->solid_fraction);
    text += fmt::format("smallest margin      {:.3g} (equilibrium {}): |quantity| / proved bound of its error\n",
                        margin->margin, margin->number);
}

void add_arcs(std::string& text, const std::vector<EquilibriumRow>& rows) {
    std::vector<int> arcs;
    for (const EquilibriumRow& row : rows) {
        if (row.arcs > 0) {
            arcs.push_back(row.arcs);
        }
    }
    if (arcs.empty()) {
        return;
    }
    std::ranges::sort(arcs);
    const auto single = std::ranges::count(arcs, 1);
    text += fmt::format("rearrangements       {}, single arcs {:.1f} %, median {} arcs, longest {}\n", arcs.size(),
                        100.0 * static_cast<double>(single) / static_cast<double>(arcs.size()), arcs[arcs.size() / 2],
                        arcs.back());
}

/// Adds the residual share of the largest strain when the path has returned to its initial ratio.
void add_irreversible(std::string& text, const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                      const LoadWords& words) {
    for (std::size_t s = 0; s < names.size(); ++s) {
        const auto last =
            std::find_if(rows.rbegin(), rows.rend(), [&](const auto& r) { return r.segment == static_cast<int>(s); });
        if (last == rows.rend() || last->number == 0) {
            continue;
        }
        const std::vector<EquilibriumRow> path = path_to(rows, last->number);
        const auto peak = std::ranges::max_element(path, [](auto& a, auto& b) { return a.strain2 < b.strain2; });
        if (last->ratio == path.front().ratio && peak->strain2 > 0) {
            text +=
                fmt::format("left of peak strain  {:.1f} % after \"{}\" (peak {} {:.5e}, back at {} = {:g}: {:.5e})\n",
                            100 * last->strain2 / peak->strain2, text::shown(names[s]), words.strain, peak->strain2,
                            words.ratio, last->ratio, last->strain2);
        }
    }
}

} // namespace

std::string run_tables(const std::vector<EquilibriumRow>& rows, const std::vector<std::string>& names,
                       const std::string& status, const LoadWords& words) {
    std::string text = fmt::format("status               {}\nratio, strain        {}, {}\nequilibria           {}\n",
                                   text::shown(status), words.ratio, words.strain, rows.size());
    if (rows.empty()) {
        return text;
    }
    add_checks(text, rows);
    add_arcs(text, rows);
    add_increments(text, "increments of ratio", stress_increments(rows), words);
    add_increments(text, "jumps of strain", strain_increments(rows), words);
    add_irreversible(text, rows, names, words);
    add_segments(text, rows, names);
    return text;
}

} // namespace isostat
