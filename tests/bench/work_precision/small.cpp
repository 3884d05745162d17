// The approximation of small displacements against the exact path: one arc, and whole trajectories.
#include "bench/work_precision/report.hpp"
#include "motion/arc.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"
#include "support/shortcuts/small_displacements.hpp"

#include <fmt/format.h>

#include <cmath>

using namespace isostat;

namespace work_precision {

namespace {

/// One exact arc, followed again from the records, with its linear prediction.
struct Compared {
    double length = 0; ///< largest displacement / smallest radius
    bool same = false; ///< the linear event closes the same contact
    double position = 0;
    double relative_length = 0; ///< of the displacement of the coordinate that is fastest at the start
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double worst = 0;
    for (std::size_t c = 0; c < a.size(); ++c) {
        worst = std::max(worst, std::abs(a[c] - b[c]));
    }
    return worst;
}

} // namespace

bool small_displacements(const Settings& settings) {
    Table single("small_arcs",
                 "One arc from the exact vertex: event from constant velocities and linear gaps, against the exact "
                 "one, by length of "
                 "the arc (largest displacement / smallest radius); all "
                 "seeds; without factorisation and proofs, which both need",
                 columns({"n", "length of the arc", "arcs", "wrong next contact", "~position median",
                          "~position largest", "~relative error of the length", "linear ms", "exact ms"}));
    Table drift("small_drift",
                "Whole trajectories with linear gaps, never corrected: *moved* takes new normals at every arc, "
                "*frozen* keeps the "
                "matrix of the start. Drift: largest true gap of a contact / smallest radius; first other "
                "arc: that opens or closes another contact than the exact run",
                columns({"n", "seed", "geometry", "arcs", "equilibria", "stopped", "first other arc", "its stress",
                         "~position error before", "~drift after 100 arcs", "~at the end", "~strain", "~exact strain",
                         "ms per arc", "exact ms per arc (proofs included)"}));
    Table growth(
        "small_growth",
        "Drift against the number of arcs (seed 1); distance from the exact path while the contacts are the same",
        columns({"n", "geometry", "arcs", "~drift", "~position error"}));
    for (const int n : settings.sizes) {
        std::vector<Compared> compared; // over all seeds
        double linear_time[5] = {};
        double exact_time[5] = {};
        for (const std::uint64_t seed : settings.seeds) {
            const State start = prepared(n, seed);
            crafted::Recorder exact;
            State state = start;
            RunCounters counters;
            const double run_begin = cpu_seconds();
            (void)run_segment(state, towards(settings.drift_equilibria), 0, {}, counters, exact);
            const double run_time = cpu_seconds() - run_begin;
            // Exact ends of all arcs, and one linear step from every vertex.
            std::vector<std::vector<double>> ends;
            Packing here = start.packing;
            std::vector<Contact> contacts = start.contacts;
            std::size_t equilibrium = 0;
            bool skip = false;
            for (const ArcRecord& record : exact.arcs) {
                ends.emplace_back(); // stays empty after a power turn, up to the next equilibrium
                if (record.kind == ArcKind::limit) {
                    here = exact.states[equilibrium].packing;
                    contacts = exact.states[equilibrium].contacts;
                    ++equilibrium;
                    skip = false;
                }
                skip = skip || record.power_turn;
                if (skip) {
                    continue;
                }
                const auto structure = IsostaticStructure::prove(here, contacts);
                if (!structure.ok()) {
                    skip = true;
                    continue;
                }
                const Factorisation factorisation(structure.value());
                CandidateList candidates = find_candidates(here, candidate_fraction);
                const auto opened = static_cast<int>(std::ranges::find(contacts, record.opened) - contacts.begin());
                double begin = cpu_seconds();
                const auto event = find_linear_event(here, structure.value(), factorisation, ContactId(opened), +1,
                                                     candidates.contacts);
                const double linear = cpu_seconds() - begin;
                Load load = start.load;
                load.stress[1] = record.stress;
                ArcOptions options;
                options.closes = record.closed;
                const PowerLoad power{&load, record.kind == ArcKind::rattler, record.kind == ArcKind::limit};
                begin = cpu_seconds();
                const auto followed = follow_arc(ArcOrigin{here, structure.value(), factorisation, ContactId(opened)},
                                                 power, candidates, options);
                const double exactly = cpu_seconds() - begin;
                if (!followed.ok() || !event.ok() || followed.value().closed != record.closed) {
                    skip = true;
                    continue;
                }
                const std::vector<double>& end = followed.value().end.q;
                Compared c;
                const double radius = here.min_radius();
                c.length = largest_difference(end, here.q) / radius;
                c.same = event.value().closed == record.closed;
                std::vector<double> predicted = here.q;
                std::size_t pilot = 0;
                for (std::size_t k = 0; k < predicted.size(); ++k) {
                    predicted[k] += event.value().displacement[k];
                    pilot = std::abs(event.value().velocity[k]) > std::abs(event.value().velocity[pilot]) ? k : pilot;
                }
                c.position = largest_difference(predicted, end) / radius;
                const double travelled = std::abs(end[pilot] - here.q[pilot]);
                c.relative_length = std::abs(event.value().length - travelled) / travelled;
                const auto bin =
                    static_cast<std::size_t>(std::clamp(4 + std::floor(std::log10(c.length)) + 1, 0.0, 4.0));
                linear_time[bin] += linear;
                exact_time[bin] += exactly;
                compared.push_back(c);
                contacts[static_cast<std::size_t>(opened)] = record.closed;
                here = followed.value().end;
                ends.back() = end;
            }
            for (const LinearGeometry geometry : {LinearGeometry::moved, LinearGeometry::frozen}) {
                const auto run = load_with_linear_gaps(start, geometry, settings.drift_equilibria,
                                                       static_cast<long>(2 * exact.arcs.size() + 50));
                std::size_t first = 0;
                const char* const words = geometry == LinearGeometry::frozen ? "frozen" : "moved";
                double before = 0;
                std::vector<double> away;
                while (first < run.arcs.size() && first < exact.arcs.size() &&
                       run.arcs[first].opened == exact.arcs[first].opened &&
                       run.arcs[first].closed == exact.arcs[first].closed) {
                    away.push_back(nan);
                    if (!ends[first].empty()) {
                        before = largest_difference(run.coordinates[first], ends[first]) / start.packing.min_radius();
                        away.back() = before;
                    }
                    ++first;
                }
                for (std::size_t k = 1; seed == settings.seeds.front() && k <= run.arcs.size();
                     k = std::max(k + 1, k * 5 / 4)) {
                    growth.add(
                        {n, words, static_cast<long>(k), run.arcs[k - 1].drift, k <= away.size() ? away[k - 1] : nan});
                }
                const auto at = [&](std::size_t k) {
                    return k > 0 && run.arcs.size() >= k ? run.arcs[k - 1].drift : nan;
                };
                const bool diverged = first < run.arcs.size();
                // At the same number of equilibria.
                const std::size_t same = std::min(run.equilibria.size(), exact.equilibria.size());
                const auto arcs = static_cast<double>(std::max<std::size_t>(1, run.arcs.size()));
                drift.add({n, static_cast<long>(seed), words, static_cast<long>(run.arcs.size()),
                           static_cast<long>(run.equilibria.size()) - 1,
                           run.stopped.empty() ? "no" : run.stopped.substr(0, 60),
                           diverged ? std::to_string(first + 1) : "none", diverged ? run.arcs[first].stress : nan,
                           before, at(100), at(run.arcs.size()), run.equilibria[same - 1].strain,
                           exact.equilibria[same - 1].strain[1], 1e3 * run.seconds / arcs,
                           1e3 * run_time / static_cast<double>(exact.arcs.size())});
            }
        }
        const char* names[] = {"below 1e-4", "1e-4 to 1e-3", "1e-3 to 1e-2", "1e-2 to 1e-1", "above 1e-1"};
        for (std::size_t bin = 0; bin < 5; ++bin) {
            Sample position, length;
            int arcs = 0, wrong = 0;
            for (const Compared& c : compared) {
                if (static_cast<std::size_t>(std::clamp(4 + std::floor(std::log10(c.length)) + 1, 0.0, 4.0)) == bin) {
                    ++arcs;
                    wrong += c.same ? 0 : 1;
                    if (c.same) {
                        position.add(c.position);
                        length.add(c.relative_length);
                    }
                }
            }
            if (arcs > 0) {
                single.add({n, names[bin], arcs, wrong, position.median(), position.high(), length.median(),
                            1e3 * linear_time[bin] / arcs, 1e3 * exact_time[bin] / arcs});
            }
        }
    }
    write(single, settings);
    write(drift, settings);
    growth.write_csv(settings.folder / "small_growth.csv");
    draw(settings.folder, "small",
         fmt::format(
             "set logscale xy\nset format '10^{{%T}}'\nset xlabel 'arcs'\nset ylabel 'largest gap of a contact / "
             "smallest "
             "radius'\nset key bottom right\nplot '<grep \"^{0},moved\" small_growth.csv' using 3:4 with linespoints "
             "title 'n = {0}, normals of every arc', '<grep \"^{0},frozen\" small_growth.csv' using 3:4 with "
             "linespoints "
             "title 'n = {0}, matrix of the start', '<grep \"^{1},moved\" small_growth.csv' using 3:4 with linespoints "
             "title 'n = {1}, normals of every arc', '<grep \"^{1},frozen\" small_growth.csv' using 3:4 with "
             "linespoints "
             "title 'n = {1}, matrix of the start'\n",
             settings.sizes.front(), settings.sizes.back()));
    return true;
}

} // namespace work_precision
