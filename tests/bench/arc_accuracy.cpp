// Accuracy against time of the arcs of a trajectory: what each level of proof costs per arc and how far from the truth
// its arcs end; and what would be lost, or gained, by other choices for the linear algebra, with the same arcs followed
// again with fresh factors at every arc, or with factors that serve for a number of arcs, refined to a given accuracy.
// The truth: the vertex at each end polished in double-double, its forces and velocities refined there, in code apart
// from the library (tests/oracle). CPU time of one thread in units of one KLU analysis + factorisation. Writes
// arc_levels.csv, arc_factors.csv and, with gnuplot, arc-accuracy.svg into the folder. The status is 1 when an arc ends
// at another contact than in the run at level `decisions`, or when a run records something more than 100 times as wrong
// as fresh factors at every arc make it (and above 1e-12 smallest radii, 1e-7 of the largest force): speed must not be
// paid for in digits. Usage:
//   bench_arc_accuracy [--json FILE] [--equilibria E] [--repeats R] [folder [n | n:seed | state file]]
// default: . 1936, 4 equilibria, 3 repeats
#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "motion/arc.hpp"
#include "oracle/reference_vertex.hpp"
#include "rigidity/isostatic.hpp"

#include <fmt/format.h>
#include <qd/dd_real.h>

using namespace isostat;
using bench::Sample;

namespace {

/// One arc, and the truth at its end and of the motion that starts it.
struct True {
    bool known = false;               ///< false from a power turn to the next equilibrium: coordinates are held there
    std::vector<dd_real> end;         ///< coordinates
    std::vector<dd_real> fixed, unit; ///< forces: fixed + sigma unit
    double largest = 0;               ///< force
    std::vector<double> velocity;     ///< at the true start, opening the contact; fastest coordinate 1
    double residual = 0;              ///< largest gap left / smallest radius
};

double length_of(const dd_real& x) {
    return std::abs(x.x[0] + x.x[1]);
}

True truth_of(const Packing& start, const std::vector<Contact>& contacts, std::size_t opened, const Packing& end,
              const std::vector<Contact>& end_contacts, const Load& load) {
    True out;
    const auto polished = [&](const Packing& near, const std::vector<Contact>& list) {
        return oracle::polish<dd_real>(near, std::vector<dd_real>(near.q.begin(), near.q.end()), list, 1e-27, 12);
    };
    const auto from = polished(start, contacts);
    const auto to = polished(end, end_contacts);
    const auto forces =
        oracle::affine_forces<dd_real>(end, to.q, end_contacts, load.fixed_force(end), load.unit_force(end), 4);
    out.known = from.residual < 1e-24 && to.residual < 1e-24 && !forces.fixed.empty();
    out.residual = std::max(from.residual, to.residual);
    out.end = to.q;
    out.fixed = forces.fixed;
    out.unit = forces.unit;
    for (std::size_t l = 0; l < out.fixed.size(); ++l) {
        out.largest = std::max(out.largest, length_of(out.fixed[l] + load.stress[1] * out.unit[l]));
    }
    const auto velocity = oracle::opening_velocity(start, from.q, contacts, opened, 4);
    std::transform(velocity.begin(), velocity.end(), std::back_inserter(out.velocity), oracle::as_double<dd_real>);
    return out;
}

double position_error(const Packing& packing, const True& truth) {
    double worst = 0;
    for (std::size_t c = 0; c < packing.q.size(); ++c) {
        worst = std::max(worst, length_of(truth.end[c] - packing.q[c]));
    }
    return worst / packing.min_radius();
}

double force_error(const std::vector<double>& force, const True& truth, double sigma) {
    double worst = 0;
    for (std::size_t l = 0; l < force.size(); ++l) {
        worst = std::max(worst, length_of(truth.fixed[l] + sigma * truth.unit[l] - force[l]));
    }
    return worst / truth.largest;
}

double velocity_error(std::vector<double> v, const True& truth) {
    std::size_t fastest = 0;
    for (std::size_t c = 0; c < v.size(); ++c) {
        fastest = std::abs(truth.velocity[c]) > std::abs(truth.velocity[fastest]) ? c : fastest;
    }
    double worst = 0;
    const double scale = truth.velocity[fastest] / v[fastest];
    for (std::size_t c = 0; c < v.size(); ++c) {
        worst = std::max(worst, std::abs(v[c] * scale - truth.velocity[c]));
    }
    return worst;
}

/// An error is a loss when it is more than so many times that with fresh factors, unless it is small by itself:
/// positions in smallest radii, forces in units of the largest.
constexpr double times_fresh = 100;
constexpr double small_position = 1e-12;
constexpr double small_force = 1e-7; // to which `verify` compares recorded forces

/// How the arcs are followed again.
struct Choice {
    std::string name;
    int serves;      ///< arcs that factors serve for; 1: fresh at every arc
    double accuracy; ///< of the forces, relative, estimated
};

struct Errors {
    Sample position, force, velocity, equilibria;
};

struct Followed {
    double milliseconds = 0; ///< per arc
    double passes = 0;       ///< per arc
    int arcs = 0;
    int elsewhere = 0; ///< other contact, or not followed
    Errors errors;
};

/// The arcs of `run` from the equilibria on the way; fills `truth` when it is empty.
Followed follow_again(const bench::Stretch& run, const std::vector<State>& equilibria, const Choice& choice,
                      std::vector<True>& truth) {
    Followed out;
    const bool first_time = truth.empty();
    truth.resize(run.arcs.size());
    std::size_t equilibrium = 0;
    std::unique_ptr<IsostaticStructure> structure;
    std::optional<ApproximateInverse> inverse;
    Packing packing;
    Load load;
    std::vector<double> force;
    CandidateList candidates;
    double spent = 0;
    for (std::size_t a = 0; a < run.arcs.size(); ++a) {
        const ArcRecord& record = run.arcs[a];
        if (record.kind == ArcKind::limit) {
            const State& state = equilibria[equilibrium++];
            packing = state.packing;
            load = state.load;
            auto proved = IsostaticStructure::prove(packing, state.contacts);
            structure = std::make_unique<IsostaticStructure>(std::move(proved.value()));
            inverse.emplace(structure->matrix());
            force.clear();
            candidates = find_candidates(packing, candidate_fraction);
        }
        if (record.power_turn) {
            structure = nullptr; // nothing until the next equilibrium
        }
        if (!structure) {
            continue;
        }
        load.stress[1] = record.stress;
        const auto& contacts = structure->contacts();
        const auto place = std::find(contacts.begin(), contacts.end(), record.opened);
        if (place == contacts.end()) {
            ++out.elsewhere;
            structure = nullptr;
            continue;
        }
        const auto slot = static_cast<std::size_t>(place - contacts.begin());
        const Packing start = packing;
        const std::vector<Contact> at_start = contacts;
        const PowerLoad power{&load, record.kind == ArcKind::rattler, record.kind == ArcKind::limit};
        ArcOptions options;
        const double begin = bench::cpu_milliseconds();
        const Factorisation factors(*structure, *inverse);
        std::optional<Factorisation> block;
        if (power.infinitesimal) {
            block = Factorisation::of_moving_block(*structure, static_cast<int>(slot));
        }
        auto arc = follow_arc(ArcOrigin{packing, *structure, block ? *block : factors, ContactId(slot)}, power,
                              candidates, options);
        if (!arc.ok() || arc.value().closed != record.closed) {
            arc = follow_arc(ArcOrigin{packing, *structure, Factorisation(*structure), ContactId(slot)}, power,
                             candidates, options);
        }
        if (!arc.ok() || arc.value().closed != record.closed) {
            ++out.elsewhere;
            structure = nullptr;
            continue;
        }
        packing = arc.value().end;
        auto next = IsostaticStructure::exchange(*structure, packing, ContactId(slot), record.closed);
        inverse = inverse->exchanges() + 1 < choice.serves ? inverse->exchanged(next->slot(), next->matrix())
                                                           : ApproximateInverse(next->matrix());
        structure = std::make_unique<IsostaticStructure>(IsostaticStructure::without_proof(std::move(*next)));
        const Factorisation there(*structure, *inverse);
        const std::vector<double> guess = force;
        force = load.external_force(packing);
        there.solve_forces_from(force, guess, choice.accuracy);
        spent += bench::cpu_milliseconds() - begin;
        out.passes += arc.value().passes + there.passes();
        ++out.arcs;
        if (first_time) {
            truth[a] = truth_of(start, at_start, slot, packing, structure->contacts(), load);
        }
        if (truth[a].known) {
            out.errors.position.add(position_error(packing, truth[a]));
            out.errors.force.add(force_error(force, truth[a], record.stress));
            std::vector<double> v(start.q.size(), 0.0);
            v[slot] = 1;
            if (!power.infinitesimal) {
                factors.solve_velocities(v);
                out.errors.velocity.add(velocity_error(v, truth[a]));
            }
        }
    }
    out.milliseconds = spent / std::max(out.arcs, 1);
    out.passes /= std::max(out.arcs, 1);
    return out;
}

/// Errors of what a run records: the wall that moves at the end of each arc, the force that opens the next one, and all
/// coordinates at equilibria.
Errors recorded(const bench::Stretch& run, const std::vector<State>& equilibria, const std::vector<True>& truth) {
    Errors out;
    std::size_t equilibrium = 0;
    const double unit = equilibria[0].packing.min_radius();
    const std::size_t wall = equilibria[0].packing.q.size() - 1;
    const double reference = equilibria[0].load.reference_length[1];
    const True* before = nullptr;
    for (std::size_t a = 0; a < std::min(run.arcs.size(), truth.size()); ++a) {
        const ArcRecord& record = run.arcs[a];
        if (record.kind == ArcKind::limit) {
            if (before != nullptr && before->known) {
                out.equilibria.add(position_error(equilibria[equilibrium].packing, *before));
            }
            ++equilibrium;
        } else if (record.kind == ArcKind::tension && before != nullptr && before->known) {
            double error = std::numeric_limits<double>::infinity();
            for (std::size_t l = 0; l < before->fixed.size(); ++l) { // the slot is not recorded: its force tells
                error = std::min(error, length_of(before->fixed[l] + record.stress * before->unit[l] - record.force));
            }
            out.force.add(error / before->largest);
        }
        if (truth[a].known) {
            out.position.add(length_of(truth[a].end[wall] - reference * (dd_real(1.0) - record.strain)) / unit);
        }
        before = &truth[a];
    }
    return out;
}

} // namespace

int main(int argc, char** argv) {
    std::string where = ".";
    std::string source = "1936";
    int equilibria = 4, repeats = 3;
    bench::Program program("bench_arc_accuracy", "errors of arc ends, forces and velocities against time per arc");
    program.option("--equilibria", equilibria, "equilibria of the runs");
    program.option("--repeats", repeats, "of each time");
    program.option("folder", where, "for CSV files and the figure");
    program.option("start", source, "number of disks or state file");
    program.parse(argc, argv);
    const std::filesystem::path folder = where;
    std::filesystem::create_directories(folder);
    const auto start = bench::start(source);
    if (!start) {
        return 1;
    }
    bool good = true;

    // The levels in turn, then the arcs of `decisions` again.
    const std::vector<CertifyLevel> levels{CertifyLevel::decisions, CertifyLevel::arcs};
    std::vector<bench::Stretches> runs(levels.size());
    std::vector<std::vector<State>> states(levels.size());
    for (int repeat = 0; repeat < repeats; ++repeat) {
        for (std::size_t k = 0; k < levels.size(); ++k) {
            bench::StretchOptions options{.level = levels[k], .equilibria = equilibria, .reference_every = 1};
            states[k].clear();
            options.visit = [&](const State& state) { states[k].push_back(state); };
            runs[k].runs.push_back(bench::run_stretch(*start, options));
            if (!runs[k].front().failure.empty()) {
                fmt::print(stderr, "{}: {}\n", to_string(levels[k]), runs[k].front().failure);
                return 1;
            }
        }
    }
    const bench::Stretch& decided = runs[0].front();
    const double klu = runs[0].klu().median();
    std::vector<True> truth;
    const std::vector<Choice> choices{
        {"fresh at every arc", 1, 0x1p-51}, {"serve 5 arcs", 5, 1e-6},    {"serve 5 arcs", 5, 1e-9},
        {"serve 5 arcs", 5, 1e-12},         {"serve 5 arcs", 5, 0x1p-51}, {"serve 20 arcs", 20, 1e-6},
        {"serve 20 arcs", 20, 1e-9},        {"serve 20 arcs", 20, 1e-12}, {"serve 20 arcs", 20, 0x1p-51},
        {"serve 80 arcs", 80, 1e-6},        {"serve 80 arcs", 80, 1e-9},  {"serve 80 arcs", 80, 1e-12},
        {"serve 80 arcs", 80, 0x1p-51}};
    bench::Table factors(
        "arc_factors",
        fmt::format("The {} arcs of {} disks followed again: path, event and forces at the end, without proofs; errors "
                    "of all coordinates in smallest radii, of forces and velocities relative to the largest; median, "
                    "then largest over the arcs (one KLU: {:.2f} ms):",
                    decided.arcs.size(), start->packing.disk_count(), klu),
        {{"factors", "factors", ""},
         {"accuracy", "forces refined to", "", "{:.0e}"},
         {"klu", "CPU per arc / KLU", "KLU", "{:.2f}"},
         {"passes", "passes per arc", "", "{:.1f}"},
         {"position", "arc end", "", "{:.1e}"},
         {"position_largest", "largest", "", "{:.1e}"},
         {"force", "forces", "", "{:.1e}"},
         {"force_largest", "largest", "", "{:.1e}"},
         {"velocity", "velocities", "", "{:.1e}"},
         {"velocity_largest", "largest", "", "{:.1e}"},
         {"elsewhere", "arcs that end elsewhere", ""}});
    double position_with_fresh = 0, force_with_fresh = 0;
    for (const Choice& choice : choices) {
        Followed last;
        Sample time;
        for (int repeat = 0; repeat < repeats; ++repeat) {
            last = follow_again(decided, states[0], choice, truth);
            time.add(last.milliseconds / klu);
        }
        good = good && last.elsewhere == 0;
        const Errors& e = last.errors;
        if (choice.serves == 1) {
            position_with_fresh = e.position.high();
            force_with_fresh = e.force.high();
        }
        factors.add({choice.name, choice.accuracy, time, last.passes, e.position.median(), e.position.high(),
                     e.force.median(), e.force.high(), e.velocity.median(), e.velocity.high(),
                     static_cast<long>(last.elsewhere)});
    }
    double residual = 0;
    long known = 0;
    for (const True& t : truth) {
        residual = std::max(residual, t.known ? t.residual : 0);
        known += t.known ? 1 : 0;
    }
    bench::Table table(
        "arc_levels",
        fmt::format(
            "Whole runs of {} disks, {} equilibria, {} arcs ({} with a known end, gaps left there at most {:.0e} "
            "smallest radii); errors of what the run records, in smallest radii and relative to the largest "
            "force; median, then largest:",
            start->packing.disk_count(), equilibria, decided.arcs.size(), known, residual),
        {{"level", "level", ""},
         {"klu", "CPU per arc / KLU", "KLU", "{:.2f}"},
         {"umfpack", "/ UMFPACK", "UMFPACK", "{:.2f}"},
         {"wall", "wall at arc ends", "", "{:.1e}"},
         {"wall_largest", "largest", "", "{:.1e}"},
         {"force", "force that opens", "", "{:.1e}"},
         {"force_largest", "largest", "", "{:.1e}"},
         {"equilibria", "all coordinates at equilibria", "", "{:.1e}"},
         {"equilibria_largest", "largest", "", "{:.1e}"},
         {"same_events", "same contacts open and close", ""}});
    for (std::size_t k = 0; k < levels.size(); ++k) {
        const bool same = bench::same_events(runs[k].front(), decided);
        good = good && same;
        const Errors e = recorded(runs[k].front(), states[k], truth);
        const double position = std::max(e.position.high(), e.equilibria.high());
        if (position > std::max(times_fresh * position_with_fresh, small_position) ||
            e.force.high() > std::max(times_fresh * force_with_fresh, small_force)) {
            fmt::print(stderr,
                       "level {}: errors up to {:.1e} (positions) and {:.1e} (forces), fresh factors {:.1e} and "
                       "{:.1e}\n",
                       to_string(levels[k]), position, e.force.high(), position_with_fresh, force_with_fresh);
            good = false;
        }
        table.add({std::string(to_string(levels[k])), runs[k].per_arc().over(runs[k].klu()),
                   runs[k].per_arc().over(runs[k].umfpack()), e.position.median(), e.position.high(), e.force.median(),
                   e.force.high(), e.equilibria.median(), e.equilibria.high(), same});
    }
    program.show(table);
    program.show(factors);
    table.write_csv(folder / "arc_levels.csv");
    factors.write_csv(folder / "arc_factors.csv");
    std::string plot = "set datafile separator ','\nset terminal svg size 760,600 font 'sans,13' background 'white'\n"
                       "set output 'arc-accuracy.svg'\nset grid\nset logscale xy\nset format y '10^{%T}'\n"
                       "set xrange [0.2:20]\nset xtics (0.2, 0.5, 1, 2, 5, 10, 20)\nset yrange [1e-14:1e-3]\n"
                       "set xlabel 'CPU time per arc / one KLU analysis + factorisation'\n"
                       "set ylabel 'largest error over the arcs'\nset key top right font ',11'\nplot \\\n";
    int colour = 1;
    for (const char* serve : {"fresh at every arc", "serve 5 arcs", "serve 20 arcs", "serve 80 arcs"}) {
        plot +=
            fmt::format("  '<grep \"{0}\" arc_factors.csv' using 3:6 with points pt {2} ps 0.9 lc {1} title 'factors "
                        "{0}: arc ends', \\\n  '' using 3:8 with linespoints pt {3} ps 0.9 lc {1} title 'forces, by "
                        "accuracy asked', \\\n",
                        serve, colour, 2 * colour + 3, 2 * colour + 2);
        ++colour;
    }
    plot += "  'arc_levels.csv' using 2:9 skip 1 with points pt 13 ps 1.4 lc 8 title 'whole runs with proofs: "
            "equilibria', \\\n  '' using 2:7 skip 1 with points pt 12 ps 1.4 lc 8 title 'force that opens', \\\n"
            "  '' using 2:9:1 skip 1 with labels offset 0,-0.9 font ',11' notitle\n";
    bench::draw(folder, "arc-accuracy", plot);
    return program.finish(good);
}
