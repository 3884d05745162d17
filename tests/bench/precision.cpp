// Error against run time: contact forces on every rung of the ladder, n = 100 to 5000, condition 1e3 to 1e12. Error
// against a reference of 1400 bits that is made apart from the library (Eigen's LU and MPFR), the proved bound, CPU
// time (median and range; also in units of one KLU analysis + factorisation). Writes error-time.csv and, with gnuplot,
// error-time.svg into the folder. The status is 1 when a bound is below an error. Usage:
//   bench_precision [--json FILE] [--repeats R] [folder [n ...]]        default: . 100 400 1936 4900, 3 repeats

#include "bench/shared/references.hpp"
#include "bench/shared/report.hpp"
#include "oracle/refined.hpp"
#include "oracle/structures.hpp"
#include "oracle/truth.hpp"
#include "verified/force_ladder.hpp"
#include "verified/inverse_bound.hpp"

#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <fstream>

using namespace isostat;

namespace {

constexpr int reference_bits = 1400;
using Digits = oracle::Decimal<422>;

struct Line {
    std::string family;
    int disks, size;
    double condition;
    std::string rung;
    int bits;
    bench::Sample milliseconds; ///< from the factors on, lower rungs included
    double klu;                 ///< one analysis + factorisation, milliseconds
    double error;               ///< log10 of max |f - exact| / max |f|
    double bound;               ///< log10 of the proved bound / max |f|
};

/// log10 of a float of any size; -infinity for 0.
double log10_of(const Digits& x) {
    return static_cast<double>(log10(Digits(abs(x))));
}

/// All rungs of one structure; returns false when a bound is below an error.
bool measure(const std::string& family, const Packing& packing, const std::vector<Contact>& contacts,
             const std::vector<double>& force, int repeats, std::vector<Line>& lines) {
    const auto proved = IsostaticStructure::prove(packing, contacts);
    if (!proved.ok()) {
        fmt::print("{}: {}\n", family, proved.failure().message());
        return true;
    }
    const auto reference = oracle::refined_forces<Digits>(packing, contacts, force, reference_bits - 64);
    if (reference.empty()) {
        fmt::print("{}: the reference does not converge\n", family);
        return true;
    }
    const double scale = log10_of(oracle::largest_of(reference));
    const double before = bench::cpu_milliseconds();
    const Factorisation factorisation(proved.value());
    const double factor_time = bench::cpu_milliseconds() - before;
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(proved.value(), factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        inverse = bound_inverse_multiprecision(packing, proved.value());
    }
    const double inverse_time = bench::cpu_milliseconds() - before - factor_time;
    fmt::print("<!-- {}, N = {}: LU {:.2f} ms, bound of the inverse {:.1f} ms ({}) -->\n", family, contacts.size(),
               factor_time, inverse_time, inverse.verdict == Verdict::proved ? "proved" : "none");
    LadderOptions options{.max_bits = 1024, .exact_size = 1000};
    const double klu = bench::milliseconds([&] { bench::klu(proved.value().matrix()); }).median();
    const std::size_t first = lines.size();
    bool holds = true;
    const auto line = [&](const ForceLadder& ladder, int part) {
        Digits worst = 0;
        for (std::size_t l = 0; l < reference.size(); ++l) {
            const auto f = oracle::from_hexadecimal<Digits>(ladder.digits(part, ContactId(l), reference_bits));
            worst = std::max(worst, Digits(abs(f - reference[l])));
        }
        const double error = log10_of(worst) - scale;
        const double bound = ladder.bound_exponent(part) * std::log10(2.0) - scale;
        // The reference itself errs by about 2^-(bits - 64) cond: nothing is said below.
        const double known = -(reference_bits - 64.0) * std::log10(2.0) -
                             (inverse.sigma_min > 0 ? std::log10(inverse.sigma_min) : 0.0) - scale + 2;
        if (error > std::max(bound + 1e-9, known)) {
            fmt::print(stderr, "{}: rung {} with {} bits: error 1e{:.3f} above the bound 1e{:.3f}\n", family,
                       to_string(ladder.rung()), ladder.bits(), error, bound);
            holds = false;
        }
        return Line{family,
                    static_cast<int>(packing.radius.size()),
                    static_cast<int>(contacts.size()),
                    2 / inverse.sigma_min,
                    std::string(to_string(ladder.rung())),
                    ladder.bits(),
                    {},
                    klu,
                    error,
                    bound};
    };
    for (int repeat = 0; repeat < repeats; ++repeat) {
        ForceLadder ladder(packing, proved.value(), factorisation, inverse, options);
        const int part = ladder.add(force);
        double spent = 0;
        std::size_t rung = first;
        bool higher = true;
        while (higher) {
            spent += bench::milliseconds([&] { (void)ladder.solution(part); }, 1).median();
            if (repeat == 0) {
                lines.push_back(line(ladder, part));
            }
            lines[rung++].milliseconds.add(spent);
            spent += bench::milliseconds([&] { higher = ladder.climb(); }, 1).median();
        }
    }
    return holds;
}

std::string power(double log10) {
    return std::isfinite(log10) ? fmt::format("1e{:.1f}", log10) : std::string("0");
}

void write(const std::filesystem::path& folder, const std::vector<Line>& lines) {
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "error-time.csv");
    csv << "family,disks,size,condition,rung,bits,milliseconds,log10_error,log10_bound\n";
    for (const Line& l : lines) {
        const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.4f}", x) : std::string("null"); };
        csv << fmt::format("{},{},{},{:.3e},{},{},{:.4f},{},{}\n", l.family, l.disks, l.size, l.condition, l.rung,
                           l.bits, l.milliseconds.median(), number(l.error), number(l.bound));
    }
    // One curve per structure, correct digits: proved (line) and true (points) against time; the packings and the worst
    // conditioned rows of every size.
    std::ofstream data(folder / "error-time.dat");
    std::vector<std::string> titles;
    std::string before;
    for (const Line& l : lines) {
        const bool packing = l.family == "compressed packing";
        if (!std::isfinite(l.bound) || (!packing && l.family != lines.back().family)) {
            continue; // exact numbers have no place on this axis
        }
        const std::string structure = fmt::format("{} {}", l.family, l.size);
        if (structure != before) {
            data << (before.empty() ? "" : "\n\n");
            before = structure;
            titles.push_back(
                fmt::format("{}, n = {}, cond {:.0e}", packing ? "packing" : "flat rows", l.disks, l.condition));
        }
        data << fmt::format("{:.4f} {:.4f} {:.4f}\n", l.milliseconds.median(), -l.error, -l.bound);
    }
    data.close();
    std::string plot =
        "set terminal svg size 760,520 font 'sans,13' background 'white'\nset output 'error-time.svg'\n"
        "set logscale xy\nset xlabel 'CPU time from the LU factors on (ms)'\n"
        "set ylabel 'correct digits of the forces: proved (lines) and true (points)'\nset yrange [0.9:500]\n"
        "set key bottom right font ',10'\nset grid\nplot \\\n";
    for (std::size_t k = 0; k < titles.size(); ++k) {
        plot += fmt::format("  'error-time.dat' index {0} using 1:3 with lines lw 1.5 dt {3} lc {1} title '{2}', \\\n"
                            "  '' index {0} using 1:2 with points pt 7 ps 0.5 lc {1} notitle{4}\n",
                            k, k / 2 + 1, titles[k], k % 2 + 1, k + 1 == titles.size() ? "" : ", \\");
    }
    bench::draw(folder, "error-time", plot);
}

} // namespace

int main(int argc, char** argv) {
    std::string where = ".";
    std::vector<std::string> sizes{"100", "400", "1936", "4900"};
    int repeats = 3;
    bench::Program program("bench_precision", "error, bound and time of the forces on every rung");
    program.option("--repeats", repeats, "of each time");
    program.option("folder", where, "for error-time.csv and the figure");
    program.words("sizes", sizes, "numbers of disks");
    program.parse(argc, argv);
    const std::filesystem::path folder = where;
    std::vector<Line> lines;
    bool holds = true;
    for (const std::string& word : sizes) {
        const int n = std::atoi(word.c_str());
        PreparationOptions options{.disks = n};
        PreparationReport report;
        auto state = prepare(options, report);
        if (state.ok()) {
            const Packing& packing = state.value().packing;
            std::vector<double> force = on_dofs(state.value().load.external_force(packing), DofMap(packing));
            // Rattlers carry nothing under the walls' load alone: a weight on every disk.
            for (std::size_t i = 1; i + 2 < force.size(); i += 2) {
                force[i] -= 1e-3;
            }
            holds = measure("compressed packing", packing, state.value().contacts, force, repeats, lines) && holds;
        }
        for (const double height : {1e-2, 1e-5, 1e-8, 1e-10}) {
            oracle::Random random(3);
            const int rows = std::max(2, static_cast<int>(std::sqrt(n)));
            const oracle::Structure s = oracle::layers(rows, std::max(1, rows / 2 + 1), height, random);
            std::vector<double> force;
            for (std::size_t i = 0; i < s.contacts.size(); ++i) {
                force.push_back(i % 2 == 0 ? random.real(-0.1, 0.1) : -1);
            }
            holds = measure(fmt::format("rows at {:g}", height), s.packing, s.contacts, force, repeats, lines) && holds;
        }
    }
    bench::Table table("precision", "Forces from the LU factors on, lower rungs included:",
                       {{"structure", "structure", ""},
                        {"n", "n", ""},
                        {"size", "N", ""},
                        {"condition", "cond <=", "", "{:.0e}"},
                        {"rung", "rung", ""},
                        {"time", "time, ms", "ms", "{:.2f}"},
                        {"klu", "time / KLU analysis + factorisation", "KLU", "{:.2f}"},
                        {"error", "error", ""},
                        {"bound", "proved bound", ""}});
    for (const Line& l : lines) {
        table.add({l.family, static_cast<long>(l.disks), static_cast<long>(l.size), l.condition,
                   l.rung == "mpfr" ? fmt::format("mpfr {}", l.bits) : l.rung, l.milliseconds,
                   l.milliseconds.over(l.klu), power(l.error), power(l.bound)});
    }
    program.show(table);
    write(folder, lines);
    return program.finish(holds);
}
