// Events (where an arc ends) and stresses (loads at which equilibria end) of a fixed trajectory: tolerance, arithmetic,
// predictor step, integration without correction, number of loads.
#include "bench/work_precision/report.hpp"
#include "oracle/reference_path.hpp"
#include "verified/force_ladder.hpp"

#include <fmt/format.h>
#include <qd/dd_real.h>

using namespace isostat;
using oracle::Reference;
using oracle::ReferenceArc;
using oracle::ReferencePath;

namespace work_precision {

namespace {

template <class T> Reference raised(const T& x) {
    if constexpr (requires { x.x[0]; }) { // libqd
        return Reference(x.x[0]) + Reference(x.x[1]);
    } else {
        return Reference(x);
    }
}

/// Largest distance of a coordinate from the reference / smallest radius.
template <class T> double distance(const std::vector<T>& q, const ReferenceArc& arc) {
    Reference worst = 0;
    for (std::size_t c = 0; c < q.size(); ++c) {
        worst = std::max(worst, Reference(abs(raised(q[c]) - arc.end[c])));
    }
    return static_cast<double>(worst) / arc.start.min_radius();
}

/// Velocity that opens the contact of an arc; empty when the factors are unusable.
std::vector<double> velocity(const ReferenceArc& arc, const std::vector<double>& q) {
    return oracle::opening_velocity(arc.start, q, arc.contacts, arc.opened.index(), 1);
}

double gap_rate(const Packing& packing, const Contact& contact, const std::vector<double>& v) {
    return gap_gradient(packing, contact).rate(v).value;
}

/// Where constant velocities close the contact that is known to close: what Newton starts from. Half of the way at most
/// when the gap does not fall at the start.
std::vector<double> predicted_end(const ReferenceArc& arc) {
    const std::vector<double> v = velocity(arc, arc.start.q);
    const double rate = gap_rate(arc.start, arc.closed, v);
    const double s = rate < 0 ? gap(arc.start, arc.closed) / -rate : 0;
    std::vector<double> q = arc.start.q;
    for (std::size_t c = 0; c < q.size(); ++c) {
        q[c] += s * v[c];
    }
    return q;
}

/// Newton at one tolerance in one arithmetic, over all events.
template <class T>
void at_tolerance(const std::string& arithmetic, int refinements, double tolerance, const ReferencePath& path, int n,
                  Table& table) {
    Sample position, stress;
    double iterations = 0;
    double event_time = 0, limit_time = 0;
    int elsewhere = 0, open = 0;
    for (const ReferenceArc& arc : path.arcs) {
        const std::vector<double> guess = predicted_end(arc);
        std::vector<T> start;
        for (const double c : guess) {
            start.push_back(T(c));
        }
        double begin = cpu_seconds();
        const auto polished = oracle::polish(arc.start, std::move(start), arc.end_contacts, tolerance, 40);
        event_time += cpu_seconds() - begin;
        if (!polished.converged) {
            ++open;
            continue;
        }
        const double error = distance(polished.q, arc);
        if (error > 0.1) { // another solution of the same contacts
            ++elsewhere;
            continue;
        }
        iterations += polished.iterations;
        position.add(error);
        if (arc.limit >= 0) {
            const auto& limit = path.limits[static_cast<std::size_t>(arc.limit)];
            const auto fixed = arc.load.fixed_force(arc.start);
            const auto unit = arc.load.unit_force(arc.start);
            const std::size_t opened = arc.limit_contact.index();
            begin = cpu_seconds();
            const auto f = oracle::affine_forces(arc.start, polished.q, arc.end_contacts, fixed, unit, refinements);
            limit_time += cpu_seconds() - begin;
            const T sigma = -f.fixed[opened] / f.unit[opened];
            stress.add(static_cast<double>(Reference(abs(raised(sigma) - limit.stress) / limit.stress)));
        }
    }
    const auto events = static_cast<long>(path.arcs.size());
    table.add({n, arithmetic, tolerance, events, open, elsewhere,
               iterations / static_cast<double>(position.values().size()),
               1e3 * event_time / static_cast<double>(events), position.median(), position.high(),
               1e3 * limit_time / static_cast<double>(stress.values().size()), stress.median(), stress.high()});
}

void newton_tolerances(const ReferencePath& path, int n, Table& table) {
    for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13}) {
        at_tolerance<double>("double", tolerance < 1e-7 ? 1 : 0, tolerance, path, n, table);
    }
    for (const double tolerance : {1e-16, 1e-20, 1e-26}) {
        at_tolerance<dd_real>("double-double", 3, tolerance, path, n, table);
    }
    at_tolerance<oracle::Decimal<39>>("MPFR 128", 4, 1e-34, path, n, table);
    at_tolerance<oracle::Decimal<77>>("MPFR 256", 8, 1e-70, path, n, table);
}

/// The program's path follower: cost and answers against the longest predictor step.
bool predictor_steps(const ReferencePath& path, int n, Table& table) {
    bool holds = true;
    for (const double fraction : {1.0, 0.3, 0.1, 0.03, 0.01, 0.003}) {
        Sample error;
        double time = 0;
        long steps = 0, factorisations = 0;
        int wrong = 0, failed = 0;
        for (const ReferenceArc& arc : path.arcs) {
            const auto structure = IsostaticStructure::prove(arc.start, arc.contacts);
            CandidateList candidates = find_candidates(arc.start, candidate_fraction);
            ArcOptions options;
            options.step_fraction = fraction;
            const PowerLoad power{&arc.load, arc.infinitesimal, arc.at_limit};
            const double begin = cpu_seconds();
            const Factorisation factorisation(structure.value());
            const auto followed = follow_arc(ArcOrigin{arc.start, structure.value(), factorisation, arc.opened}, power,
                                             candidates, options);
            time += cpu_seconds() - begin;
            if (!followed.ok()) {
                ++failed;
                continue;
            }
            steps += followed.value().steps;
            factorisations += 1 + followed.value().factorisations;
            if (followed.value().closed != arc.closed) {
                ++wrong; // the proved gaps at its end would send the run back
                continue;
            }
            error.add(distance(followed.value().end.q, arc));
        }
        const auto arcs = static_cast<double>(path.arcs.size());
        table.add({n, fraction, static_cast<long>(path.arcs.size()), failed, wrong, static_cast<double>(steps) / arcs,
                   static_cast<double>(factorisations) / arcs, 1e3 * time / arcs, error.median(), error.high()});
        holds = holds && error.high() < 1e-6;
    }
    return holds;
}

enum class Scheme { euler, midpoint, runge_kutta };

/// One step of dq/ds = v(q) of length h; `sign` keeps the direction. Empty when a matrix is unusable.
std::vector<double> stepped(const ReferenceArc& arc, const std::vector<double>& q, double h, Scheme scheme,
                            long& solves) {
    const auto moved = [&](const std::vector<double>& v, double s) {
        std::vector<double> to = q;
        for (std::size_t c = 0; c < q.size(); ++c) {
            to[c] += s * v[c];
        }
        return to;
    };
    // Parameter: the opening of the contact would turn back on some arcs, the coordinate that is fastest at the start
    // of the arc hardly ever does.
    const std::vector<double> v1 = velocity(arc, q);
    ++solves;
    if (v1.empty() || scheme == Scheme::euler) {
        return v1.empty() ? v1 : moved(v1, h);
    }
    std::size_t pilot = 0;
    for (std::size_t c = 0; c < v1.size(); ++c) {
        pilot = std::abs(v1[c]) > std::abs(v1[pilot]) ? c : pilot;
    }
    const auto scaled = [&](const std::vector<double>& at) {
        std::vector<double> v = velocity(arc, at);
        ++solves;
        if (!v.empty()) {
            const double factor = v1[pilot] / v[pilot];
            for (double& c : v) {
                c *= factor;
            }
        }
        return v;
    };
    const std::vector<double> v2 = scaled(moved(v1, h / 2));
    if (v2.empty() || scheme == Scheme::midpoint) {
        return v2.empty() ? v2 : moved(v2, h);
    }
    const std::vector<double> v3 = scaled(moved(v2, h / 2));
    const std::vector<double> v4 = v3.empty() ? v3 : scaled(moved(v3, h));
    if (v4.empty()) {
        return {};
    }
    std::vector<double> v(q.size());
    for (std::size_t c = 0; c < q.size(); ++c) {
        v[c] = (v1[c] + 2 * v2[c] + 2 * v3[c] + v4[c]) / 6;
    }
    return moved(v, h);
}

/// Integration of the velocities without any correction, the event from the last step by the secant rule.
void integration(const ReferencePath& path, int n, bool quick, Table& table) {
    const std::size_t most = quick ? 8 : n > 200 ? 15 : 40;
    std::vector<const ReferenceArc*> arcs;
    for (const ReferenceArc& arc : path.arcs) {
        // Arcs long enough to need a path at all.
        double farthest = 0;
        for (std::size_t c = 0; c < arc.end.size(); ++c) {
            farthest = std::max(farthest, std::abs(static_cast<double>(arc.end[c]) - arc.start.q[c]));
        }
        if (farthest > 1e-2 * arc.start.min_radius() && farthest < 0.5 * arc.start.min_radius() && arcs.size() < most) {
            arcs.push_back(&arc);
        }
    }
    const auto name = [](Scheme s) {
        return s == Scheme::euler ? "Euler" : s == Scheme::midpoint ? "midpoint" : "Runge-Kutta 4";
    };
    for (const Scheme scheme : {Scheme::euler, Scheme::midpoint, Scheme::runge_kutta}) {
        for (const double step : {0.1, 0.03, 0.01, 0.003}) {
            Sample error;
            double time = 0;
            long solves = 0;
            int lost = 0, wrong = 0;
            for (const ReferenceArc* arc : arcs) {
                const double begin = cpu_seconds();
                Packing here = arc->start;
                const double h = step * here.min_radius();
                bool reached = false;
                for (int k = 0; k < 4000 && !reached; ++k) {
                    Packing next = here;
                    next.q = stepped(*arc, here.q, h, scheme, solves);
                    if (next.q.empty()) {
                        break;
                    }
                    if (gap(next, arc->closed) > 0) {
                        here = std::move(next);
                        continue;
                    }
                    double low = 0;
                    double high = h;
                    double at_low = gap(here, arc->closed);
                    double at_high = gap(next, arc->closed);
                    for (int secant = 0; secant < 8 && std::abs(at_high) > 1e-14; ++secant) {
                        const double s = low + (high - low) * at_low / (at_low - at_high);
                        Packing trial = here;
                        trial.q = stepped(*arc, here.q, s, scheme, solves);
                        if (trial.q.empty()) {
                            break;
                        }
                        low = high;
                        at_low = at_high;
                        high = s;
                        at_high = gap(trial, arc->closed);
                        next = std::move(trial);
                        if (at_low == at_high) {
                            break;
                        }
                    }
                    here = std::move(next);
                    reached = true;
                }
                time += cpu_seconds() - begin;
                if (!reached) {
                    ++lost;
                    continue;
                }
                error.add(distance(here.q, *arc));
                // Would it have stopped at another contact before?
                for (const Contact& c : find_candidates(here, 0.3).contacts) {
                    if (gap(here, c) < -1e-12 && std::ranges::find(arc->end_contacts, c) == arc->end_contacts.end()) {
                        ++wrong;
                        break;
                    }
                }
            }
            const auto count = static_cast<double>(arcs.size());
            table.add({n, name(scheme), step, static_cast<long>(arcs.size()), lost, wrong,
                       static_cast<double>(solves) / count, 1e3 * time / count, error.median(), error.high()});
        }
    }
}

/// Stress at the end of an equilibrium: the affine law on every rung, of the stored coordinates and of the true vertex,
/// and loads raised and halved until the limit is bracketed.
bool stresses(const ReferencePath& path, int n, Table& table) {
    struct Sum {
        Sample error, bound;
        double time = 0;
        int solves = 0;
    };
    std::vector<std::pair<std::string, Sum>> rows;
    const auto row = [&](const std::string& name) -> Sum& {
        for (auto& [known, sum] : rows) {
            if (known == name) {
                return sum;
            }
        }
        rows.emplace_back(name, Sum{});
        return rows.back().second;
    };
    bool holds = true;
    for (const ReferenceArc& arc : path.arcs) {
        if (arc.limit < 0) {
            continue;
        }
        const auto& limit = path.limits[static_cast<std::size_t>(arc.limit)];
        const State& state = path.states[static_cast<std::size_t>(arc.equilibrium)];
        const ContactId opened = arc.limit_contact;
        const auto structure = IsostaticStructure::prove(state.packing, state.contacts);
        const Factorisation factorisation(structure.value());
        InverseBoundCache cache;
        const InverseBound inverse = bound_inverse(structure.value(), factorisation, cache);
        const VertexEnclosure vertex = enclose_vertex(state.packing, structure.value(), inverse);
        const auto fixed = state.load.fixed_force(state.packing);
        const auto unit = state.load.unit_force(state.packing);
        const auto relative = [&](const Reference& sigma) {
            return static_cast<double>(Reference(abs(sigma - limit.stress) / limit.stress));
        };
        for (const bool truth : {false, true}) {
            LadderOptions options{.max_bits = 256, .exact_size = 0};
            const double begin = cpu_seconds();
            ForceLadder ladder(state.packing, structure.value(), factorisation, inverse, options,
                               truth ? &vertex : nullptr);
            const int f0 = ladder.add(fixed);
            const int f1 = ladder.add(unit);
            double spent = cpu_seconds() - begin;
            while (true) {
                const double start = cpu_seconds();
                (void)ladder.solution(f0);
                (void)ladder.solution(f1);
                spent += cpu_seconds() - start;
                const Reference a = oracle::from_hexadecimal<Reference>(ladder.digits(f0, opened, 1024));
                const Reference b = oracle::from_hexadecimal<Reference>(ladder.digits(f1, opened, 1024));
                Sum& sum =
                    row(fmt::format("{}, {}", truth ? "true vertex" : "stored coordinates",
                                    ladder.rung() == Rung::multiprecision ? fmt::format("MPFR {}", ladder.bits())
                                                                          : std::string(to_string(ladder.rung()))));
                const double e0 = std::exp2(ladder.bound_exponent(f0));
                const double e1 = std::exp2(ladder.bound_exponent(f1));
                const double slope = std::abs(static_cast<double>(b));
                const double sigma = static_cast<double>(limit.stress);
                const double bound = (e0 + std::abs(sigma) * e1) / (slope - e1) / std::abs(sigma);
                const double error = relative(-a / b);
                sum.error.add(error);
                sum.bound.add(bound);
                sum.time += spent;
                sum.solves = 2;
                // The bound is of the true vertex; what the reference itself leaves open is added.
                holds = holds && (!truth || error <= 1.01 * bound + 2 * limit.bound / sigma);
                const double climb = cpu_seconds();
                if (!ladder.climb()) {
                    break;
                }
                spent += cpu_seconds() - climb;
            }
        }
        // One load, one right-hand side, one look at all forces: the limit is bracketed and halved.
        const double first_step = 1e-3 * std::abs(state.load.stress[1]);
        for (const int loads : {8, 16, 32, 56}) {
            const double begin = cpu_seconds();
            double low = state.load.stress[1];
            double high = std::numeric_limits<double>::infinity();
            double step = first_step;
            std::vector<double> f(fixed.size());
            // Contacts of rattlers, and the one that closed last, carry nothing at `low`: the forces that count are
            // those that fall by more than rounding.
            double least = 0;
            for (int k = 0; k < loads; ++k) {
                const double sigma = std::isfinite(high) ? 0.5 * (low + high) : low + step;
                for (std::size_t c = 0; c < f.size(); ++c) {
                    f[c] = fixed[c] + sigma * unit[c];
                }
                factorisation.solve_forces(f);
                least = *std::ranges::min_element(f);
                const double scale = *std::ranges::max_element(f);
                (least < -1e-13 * scale ? high : low) = sigma;
                step *= 2;
            }
            Sum& sum = row(fmt::format("loads raised, then halved: {}", loads));
            sum.time += cpu_seconds() - begin;
            sum.solves = loads;
            sum.error.add(relative(Reference(std::isfinite(high) ? 0.5 * (low + high) : low)));
            sum.bound.add(nan);
        }
    }
    for (const auto& [name, sum] : rows) {
        const auto count = static_cast<long>(sum.error.values().size());
        table.add({n, name, sum.solves, count, 1e3 * sum.time / static_cast<double>(count), sum.error.median(),
                   sum.error.high(), sum.bound.high()});
    }
    return holds;
}

} // namespace

bool events_and_stresses(const Settings& settings) {
    Table reference(
        "reference",
        "The trajectories that errors refer to (seed 1, loading): every event polished to 320 bits and certified "
        "(Newton-Kantorovich); distances in units of the smallest radius",
        columns({"n", "equilibria", "arcs", "arcs certified by the program", "arcs left out (power turns)",
                 "~largest bound of a position", "~largest bound of a stress", "~smallest other gap",
                 "~smallest force at a limit", "CPU s"}));
    Table newton(
        "events_tolerance",
        "End of an arc from constant velocities and Newton with fresh factors, against tolerance (largest gap "
        "/ smallest "
        "radius) and arithmetic; errors in units of the smallest radius, of the stress relative",
        columns({"n", "arithmetic", "~tolerance", "events", "not converged", "elsewhere", "iterations", "ms per event",
                 "~position median", "~position largest", "ms per stress", "~stress median", "~stress largest"}));
    Table steps(
        "events_predictor",
        "The program's path follower against its longest predictor step (in smallest radii): factorisations and event "
        "solves included, proofs not",
        columns({"n", "step", "arcs", "failed", "other contact", "steps per arc", "factorisations per arc",
                 "ms per arc", "~position median", "~position largest"}));
    Table integrated(
        "events_integration",
        "Integration of the velocities without correction, on arcs of 0.01 to 0.5 smallest radii, event by the "
        "secant rule: error against step",
        columns({"n", "scheme", "step", "arcs", "lost", "overlaps another", "factorisations per arc", "ms per arc",
                 "~position median", "~position largest"}));
    Table stress(
        "stresses",
        "Load at which an equilibrium ends, from the factors on: the affine law (two right-hand sides) on every rung, "
        "and loads raised (steps of 0.1 %, doubled) until a force is negative, then halved",
        columns({"n", "method", "right-hand sides", "stresses", "ms", "~error median", "~error largest",
                 "~largest proved bound"}));
    bool holds = true;
    for (const int n : settings.sizes) {
        const double begin = cpu_seconds();
        const ReferencePath path = oracle::reference_path(prepared(n, settings.seeds.front()), settings.equilibria);
        reference.add({n, static_cast<long>(path.equilibria.size()) - 1, static_cast<long>(path.arcs.size()),
                       path.certified, path.skipped, path.worst_bound, path.worst_limit_bound, path.lowest_gap,
                       path.lowest_force, cpu_seconds() - begin});
        if (!path.stopped.empty()) {
            fmt::print("n = {}: {}\n", n, path.stopped);
        }
        holds = holds && path.worst_bound < 1e-80 && path.worst_limit_bound < 1e-70 && path.lowest_gap > 0 &&
                path.lowest_force > -1e-70 && !path.arcs.empty();
        newton_tolerances(path, n, newton);
        holds = predictor_steps(path, n, steps) && holds;
        integration(path, n, settings.quick, integrated);
        holds = stresses(path, n, stress) && holds;
    }
    for (const Table* table : {&reference, &newton, &steps, &integrated, &stress}) {
        write(*table, settings);
    }
    const int n = settings.sizes.back();
    draw(
        settings.folder, "events",
        fmt::format(
            "set logscale xy\nset format '10^{{%T}}'\nset xlabel 'CPU ms per event'\nset ylabel 'median error of the "
            "position / smallest radius'\nset key outside right\nset yrange [1e-80:1]\n"
            "plot '<grep \"^{0},double,\" events_tolerance.csv' using 8:9 with linespoints pt 7 title 'Newton, "
            "double', "
            "\\\n '<grep \"^{0},\" events_tolerance.csv | grep -v \",double,\"' using 8:9 with linespoints pt 5 title "
            "'Newton, more bits', \\\n '<grep \"^{0},Euler\" events_integration.csv' using 8:9 with linespoints title "
            "'Euler', \\\n '<grep \"^{0},midpoint\" events_integration.csv' using 8:9 with linespoints title "
            "'midpoint', "
            "\\\n '<grep \"^{0},Runge\" events_integration.csv' using 8:9 with linespoints title 'Runge-Kutta 4', \\\n "
            "'<grep \"^{0},\" events_predictor.csv' using 8:9 with points pt 9 title 'path follower'\n",
            n));
    return holds;
}

} // namespace work_precision
