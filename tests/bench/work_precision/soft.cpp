// Soft grains against the rigid states that they approximate: contacts, forces, strain, the next rearrangement.
#include "bench/work_precision/report.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"
#include "support/shortcuts/soft_grains.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

using namespace isostat;

namespace work_precision {

namespace {

constexpr int load_steps = 8; ///< from the middle of one interval of loads to the middle of the next

/// The rigid answer at a load: force-carrying contacts.
std::map<Contact, double> rigid_forces(State state, double stress) {
    state.load.stress[1] = stress;
    const auto inspection = inspect_vertex(state);
    std::map<Contact, double> carrying;
    if (inspection.ok() && inspection.value().record.verdict == Verdict::proved) {
        for (std::size_t l = 0; l < inspection.value().contacts.size(); ++l) {
            if (inspection.value().structural_zero[l] == 0) {
                carrying[inspection.value().contacts[l]] = inspection.value().forces[l];
            }
        }
    }
    return carrying;
}

struct Difference {
    int missed = 0;   ///< rigid contacts that do not overlap
    int extra = 0;    ///< overlapping pairs that are no rigid contact
    double force = 0; ///< 2-norm of the difference of the forces / 2-norm of the rigid ones
};

Difference compare(const std::vector<SoftContact>& soft, const std::map<Contact, double>& rigid) {
    Difference d;
    double square = 0;
    double size = 0;
    std::map<Contact, double> rest = rigid;
    for (const auto& [contact, force] : rigid) {
        size += force * force;
    }
    for (const SoftContact& c : soft) {
        const auto at = rest.find(c.contact);
        const double exact = at == rest.end() ? 0.0 : at->second;
        d.extra += at == rest.end() ? 1 : 0;
        square += (c.force - exact) * (c.force - exact);
        if (at != rest.end()) {
            rest.erase(at);
        }
    }
    for (const auto& [contact, force] : rest) {
        ++d.missed;
        square += force * force;
    }
    d.force = std::sqrt(square / size);
    return d;
}

struct Sums {
    int states = 0, unrelaxed = 0, exact_contacts = 0, next_right = 0, next_tried = 0, early = 0, late = 0;
    std::vector<double> missed, extra, force, strain, stress, next_strain, steps, time, time_step;
};

} // namespace

bool soft_grains(const Settings& settings) {
    Table table(
        "soft_grains",
        fmt::format(
            "Damped dynamics with springs of stiffness K = kappa P from the exact state, at the middle of its interval "
            "of "
            "loads, then {} loads to the middle of the next one. Medians over states but for counts; forces: 2-norm of "
            "the difference / 2-norm; strain error absolute, and relative to the jump; stress of the rearrangement: "
            "error / "
            "length of the interval",
            load_steps),
        {"n", "kappa", "states", "not relaxed", "all contacts right", "missed per state", "in excess per state",
         "force error", "strain error", "next state right", "of", "stress of the rearrangement", "too early",
         "error of the strain jump", "time step", "steps per state", "CPU s per state"});
    for (const int n : settings.sizes) {
        if (n > settings.soft_disks_limit) {
            continue;
        }
        std::map<double, Sums> sums;
        double exact_time = 0;
        int exact_states = 0;
        for (const std::uint64_t seed : settings.seeds) {
            if (n >= 200 && seed != settings.seeds.front()) {
                continue;
            }
            crafted::Recorder exact;
            State state = prepared(n, seed);
            const State start = state;
            RunCounters counters;
            const double run_begin = cpu_seconds();
            (void)run_segment(state, towards(settings.soft_equilibria + 1), 0, {}, counters, exact);
            exact_time += cpu_seconds() - run_begin;
            exact_states += static_cast<int>(exact.equilibria.size()) - 1;
            const double reference = start.load.reference_length[1];
            for (std::size_t k = 1; k + 1 < exact.equilibria.size(); ++k) {
                const EquilibriumRecord& here = exact.equilibria[k];
                const EquilibriumRecord& next = exact.equilibria[k + 1];
                const double sigma = 0.5 * (here.stress + here.stress_high);
                const double sigma_next = 0.5 * (next.stress + next.stress_high);
                const auto rigid = rigid_forces(exact.states[k], sigma);
                const auto rigid_next = rigid_forces(exact.states[k + 1], sigma_next);
                if (rigid.empty() || rigid_next.empty()) {
                    continue;
                }
                for (const double kappa : settings.stiffness_ratios) {
                    Sums& sum = sums[kappa];
                    ++sum.states;
                    Load load = exact.states[k].load;
                    load.stress[1] = sigma;
                    SoftGrainOptions options{.stiffness_ratio = kappa, .max_steps = 3'000'000};
                    double begin = cpu_seconds();
                    SoftGrains soft(exact.states[k].packing, load, options);
                    const bool relaxed = soft.relax();
                    sum.time.push_back(cpu_seconds() - begin);
                    sum.steps.push_back(static_cast<double>(soft.steps()));
                    sum.time_step.push_back(soft.time_step());
                    if (!relaxed) {
                        ++sum.unrelaxed;
                        continue;
                    }
                    const Difference d = compare(soft.contacts(), rigid);
                    sum.exact_contacts += d.missed == 0 && d.extra == 0 ? 1 : 0;
                    sum.missed.push_back(d.missed);
                    sum.extra.push_back(d.extra);
                    sum.force.push_back(d.force);
                    const double strain = (reference - soft.packing().length(1)) / reference;
                    sum.strain.push_back(std::abs(strain - here.strain[1]));
                    // Loads up to the next interval; the contact that should open is watched.
                    ++sum.next_tried;
                    double lost = std::numeric_limits<double>::quiet_NaN();
                    double load_before = sigma;
                    double force_before = 0;
                    bool watched = true;
                    const auto force_of = [&](const Contact& c) {
                        for (const SoftContact& s : soft.contacts()) {
                            if (s.contact == c) {
                                return s.force;
                            }
                        }
                        return 0.0;
                    };
                    force_before = force_of(here.opens_high);
                    watched = force_before > 0;
                    bool all = true;
                    for (int step = 1; step <= load_steps && all; ++step) {
                        load.stress[1] = sigma + (sigma_next - sigma) * step / load_steps;
                        soft.set_load(load);
                        all = soft.relax();
                        const double force = force_of(here.opens_high);
                        if (watched && std::isnan(lost)) {
                            if (force <= 0) {
                                lost = 0.5 * (load_before + load.stress[1]);
                            }
                            load_before = load.stress[1];
                        }
                    }
                    if (!all) {
                        ++sum.unrelaxed;
                        continue;
                    }
                    const Difference after = compare(soft.contacts(), rigid_next);
                    sum.next_right += after.missed == 0 && after.extra == 0 ? 1 : 0;
                    if (!watched) {
                        ++sum.early; // gone before the load was raised
                    } else if (std::isnan(lost)) {
                        ++sum.late;
                    } else {
                        sum.stress.push_back(std::abs(lost - next.stress) / (here.stress_high - here.stress));
                    }
                    const double jump = next.strain[1] - here.strain[1];
                    const double soft_jump = (reference - soft.packing().length(1)) / reference - strain;
                    sum.next_strain.push_back(std::abs(soft_jump / jump - 1));
                }
            }
        }
        for (const auto& [kappa, s] : sums) {
            table.add({std::to_string(n), fmt::format("{:.0e}", kappa), std::to_string(s.states),
                       std::to_string(s.unrelaxed), std::to_string(s.exact_contacts), plain(mean(s.missed)),
                       plain(mean(s.extra)), number(median(s.force)), number(median(s.strain)),
                       std::to_string(s.next_right), std::to_string(s.next_tried), number(median(s.stress)),
                       std::to_string(s.early), number(median(s.next_strain)), plain(median(s.time_step)),
                       plain(median(s.steps)), plain(median(s.time))});
        }
        fmt::print("n = {}: the exact run takes {:.3g} CPU s per equilibrium, all proofs included\n", n,
                   exact_time / std::max(1, exact_states));
    }
    table.write(settings);
    draw(
        settings.folder, "soft",
        "set logscale xy\nset format '10^{%T}'\nset xlabel 'CPU s per state'\nset ylabel 'median error of the "
        "forces'\nset yrange [1e-4:4]\nset key top "
        "right\nplot " +
            [&] {
                std::string text;
                for (const int n : settings.sizes) {
                    text += fmt::format(
                        "{0}'<grep \"^{1},\" soft_grains.csv' using 17:8 with linespoints pt {2} ps 0.8 title "
                        "'n = {1}', '' using "
                        "17:8:2 with labels left offset 0.8,0.5 font ',9' notitle",
                        text.empty() ? "" : ", ", n, text.empty() ? 7 : 5);
                }
                return text + "\n";
            }());
    return true;
}

} // namespace work_precision
