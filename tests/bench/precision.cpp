// Error against run time: contact forces on every rung of the ladder, n = 100 to 5000, condition 1e3 to 1e12. Error
// against a reference of 1400 bits that is made apart from the library (UMFPACK and GMP floats), the proved bound, CPU
// milliseconds. Prints a table (Markdown); writes error-time.csv, error-time.json and, with gnuplot, error-time.svg.
// The status is 1 when a bound is below an error. Usage:
//   bench_precision [folder [n ...]]        default: . 100 400 1936 4900

#include "oracle/reference.hpp"
#include "oracle/structures.hpp"

#include <isostat/preparation/preparation.hpp>
#include <isostat/verified/force_ladder.hpp>
#include <isostat/verified/inverse_bound_multiprecision.hpp>

#include <fmt/format.h>
#include <mpfr.h>

#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace isostat;

namespace {

constexpr unsigned reference_bits = 1400;

double cpu_milliseconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

struct Line {
    std::string family;
    int disks;
    int size;
    double condition;
    std::string rung;
    int bits;
    double milliseconds; ///< from the factors on, lower rungs included
    double error;        ///< log10 of max |f - exact| / max |f|
    double bound;        ///< log10 of the proved bound / max |f|
};

mpf_class read(const std::string& hexadecimal) {
    mpfr_t x;
    mpfr_init2(x, reference_bits);
    mpfr_set_str(x, hexadecimal.c_str(), 16, MPFR_RNDN);
    mpf_class result(0, reference_bits);
    mpfr_get_f(result.get_mpf_t(), x, MPFR_RNDN);
    mpfr_clear(x);
    return result;
}

/// log10 of a float of any size; -infinity for 0.
double log10_of(const mpf_class& x) {
    long exponent = 0;
    const double mantissa = mpf_get_d_2exp(&exponent, x.get_mpf_t());
    return std::log10(std::abs(mantissa)) + static_cast<double>(exponent) * std::log10(2.0);
}

/// All rungs of one structure; returns false when a bound is below an error.
bool measure(const std::string& family, const Packing<2>& packing, const std::vector<Contact>& contacts,
             const std::vector<double>& force, std::vector<Line>& lines) {
    const auto proved = IsostaticStructure<2>::prove(packing, contacts);
    if (!proved.ok()) {
        fmt::print("{}: {}\n", family, proved.failure().message);
        return true;
    }
    const std::vector<mpf_class> reference = oracle::refined_forces(packing, contacts, force, reference_bits);
    if (reference.empty()) {
        fmt::print("{}: the reference does not converge\n", family);
        return true;
    }
    mpf_class largest(0, reference_bits);
    for (const mpf_class& f : reference) {
        largest = std::max(largest, mpf_class(abs(f)));
    }
    const double scale = log10_of(largest);
    const double before = cpu_milliseconds();
    const Factorisation factorisation(proved.value());
    const double factor_time = cpu_milliseconds() - before;
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(proved.value(), factorisation, cache);
    if (inverse.verdict != Verdict::proved) {
        inverse = bound_inverse_multiprecision(packing, proved.value());
    }
    const double inverse_time = cpu_milliseconds() - before - factor_time;
    fmt::print("<!-- {}, N = {}: LU {:.2f} ms, bound of the inverse {:.1f} ms ({}) -->\n", family, contacts.size(),
               factor_time, inverse_time, inverse.verdict == Verdict::proved ? "proved" : "none");
    LadderOptions options;
    options.max_bits = 1024;
    options.exact_size = 1000;
    ForceLadder<2> ladder(packing, proved.value(), factorisation, inverse, options);
    const int part = ladder.add(force);
    double spent = 0;
    bool holds = true;
    while (true) {
        double begin = cpu_milliseconds();
        (void)ladder.solution(part);
        spent += cpu_milliseconds() - begin;
        mpf_class worst(0, reference_bits);
        for (std::size_t l = 0; l < reference.size(); ++l) {
            const mpf_class f = read(ladder.digits(part, ContactId(l), static_cast<int>(reference_bits)));
            const mpf_class error = abs(mpf_class(f - reference[l]));
            worst = std::max(worst, error);
        }
        const double error = log10_of(worst) - scale;
        const double bound = ladder.bound_exponent(part) * std::log10(2.0) - scale;
        // The reference itself errs by about 2^-(bits - 64) cond: nothing is said below.
        const double known = -(static_cast<double>(reference_bits) - 64) * std::log10(2.0) -
                             (inverse.sigma_min > 0 ? std::log10(inverse.sigma_min) : 0.0) - scale + 2;
        if (error > std::max(bound + 1e-9, known)) {
            fmt::print(stderr, "{}: rung {} with {} bits: error 1e{:.3f} above the bound 1e{:.3f}\n", family,
                       to_string(ladder.rung()), ladder.bits(), error, bound);
            holds = false;
        }
        lines.push_back({family, static_cast<int>(packing.radius.size()), static_cast<int>(contacts.size()),
                         2 / inverse.sigma_min, std::string(to_string(ladder.rung())), ladder.bits(), spent, error,
                         bound});
        begin = cpu_milliseconds();
        if (!ladder.climb()) {
            return holds;
        }
        spent += cpu_milliseconds() - begin;
    }
}

std::string power(double log10) {
    return std::isfinite(log10) ? fmt::format("1e{:.1f}", log10) : std::string("0");
}

void write(const std::filesystem::path& folder, const std::vector<Line>& lines) {
    std::filesystem::create_directories(folder);
    std::ofstream csv(folder / "error-time.csv");
    std::ofstream json(folder / "error-time.json");
    csv << "family,disks,size,condition,rung,bits,milliseconds,log10_error,log10_bound\n";
    json << "[";
    bool first = true;
    for (const Line& l : lines) {
        const auto number = [](double x) { return std::isfinite(x) ? fmt::format("{:.4f}", x) : std::string("null"); };
        csv << fmt::format("{},{},{},{:.3e},{},{},{:.4f},{},{}\n", l.family, l.disks, l.size, l.condition, l.rung,
                           l.bits, l.milliseconds, number(l.error), number(l.bound));
        json << fmt::format(
            "{}\n {{\"family\": \"{}\", \"disks\": {}, \"size\": {}, \"condition\": {:.3e}, \"rung\": "
            "\"{}\", \"bits\": {}, \"milliseconds\": {:.4f}, \"log10_error\": {}, \"log10_bound\": {}}}",
            first ? "" : ",", l.family, l.disks, l.size, l.condition, l.rung, l.bits, l.milliseconds, number(l.error),
            number(l.bound));
        first = false;
    }
    json << "\n]\n";
    // One curve per structure: proved bound (line) and error (points) against time.
    std::ofstream data(folder / "error-time.dat");
    std::vector<std::string> titles;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        if (k == 0 || lines[k].family != lines[k - 1].family || lines[k].size != lines[k - 1].size) {
            data << (k == 0 ? "" : "\n\n");
            titles.push_back(
                fmt::format("{}, n = {}, cond {:.0e}", lines[k].family, lines[k].disks, lines[k].condition));
        }
        if (std::isfinite(lines[k].bound)) { // exact numbers have no place on this axis
            data << fmt::format("{:.4f} {:.4f} {:.4f}\n", lines[k].milliseconds, lines[k].error, lines[k].bound);
        }
    }
    data.close();
    std::ofstream plot(folder / "error-time.gp");
    plot << "set terminal svg size 860,560 font 'sans,13'\nset output 'error-time.svg'\nset logscale x\n"
            "set xlabel 'CPU time from the LU factors on (ms)'\n"
            "set ylabel 'log_{10} of error and proved bound, relative to the largest force'\n"
            "set key outside right font ',9'\nset grid\nplot \\\n";
    for (std::size_t k = 0; k < titles.size(); ++k) {
        plot << fmt::format("  'error-time.dat' index {0} using 1:3 with lines lc {1} title '{2}', \\\n"
                            "  '' index {0} using 1:2 with points pt 7 ps 0.5 lc {1} notitle{3}\n",
                            k, k + 1, titles[k], k + 1 == titles.size() ? "" : ", \\");
    }
    plot.close();
    const auto here = std::filesystem::current_path();
    std::filesystem::current_path(folder);
    if (std::system("gnuplot error-time.gp") != 0) {
        fmt::print(stderr, "no figure: gnuplot failed\n");
    }
    std::filesystem::current_path(here);
}

} // namespace

int main(int argc, char** argv) {
    const std::filesystem::path folder = argc > 1 ? argv[1] : ".";
    std::vector<int> sizes;
    for (int k = 2; k < argc; ++k) {
        sizes.push_back(std::atoi(argv[k]));
    }
    if (sizes.empty()) {
        sizes = {100, 400, 1936, 4900};
    }
    std::vector<Line> lines;
    bool holds = true;
    for (const int n : sizes) {
        PreparationOptions options;
        options.disks = n;
        PreparationReport<2> report;
        auto state = prepare<2>(options, report);
        if (state.ok()) {
            const Packing<2>& packing = state.value().packing;
            const std::vector<double> on_coordinates = state.value().load.external_force(packing);
            const DofMap<2> dofs(packing);
            std::vector<double> force;
            for (int mu = 0; mu < dofs.dof_count(); ++mu) {
                force.push_back(on_coordinates[static_cast<std::size_t>(dofs.coordinate_of(mu))]);
            }
            // Rattlers carry nothing under the walls' load alone: a weight on every disk.
            for (std::size_t i = 1; i + 2 < force.size(); i += 2) {
                force[i] -= 1e-3;
            }
            holds = measure("compressed packing", packing, state.value().contacts, force, lines) && holds;
        }
        for (const double height : {1e-2, 1e-5, 1e-8, 1e-10}) {
            oracle::Random random(3);
            const int rows = std::max(2, static_cast<int>(std::sqrt(n)));
            const oracle::Structure s = oracle::layers(rows, std::max(1, rows / 2 + 1), height, random);
            std::vector<double> force;
            for (std::size_t i = 0; i < s.contacts.size(); ++i) {
                force.push_back(i % 2 == 0 ? random.real(-0.1, 0.1) : -1);
            }
            holds = measure(fmt::format("rows at {:g}", height), s.packing, s.contacts, force, lines) && holds;
        }
    }
    fmt::print("| structure | n | N | cond <= | rung | time (ms) | error | proved bound "
               "|\n|---|---|---|---|---|---|---|---|\n");
    for (const Line& l : lines) {
        fmt::print("| {} | {} | {} | {:.0e} | {} | {:.2f} | {} | {} |\n", l.family, l.disks, l.size, l.condition,
                   l.rung == "mpfr" ? fmt::format("mpfr {}", l.bits) : l.rung, l.milliseconds, power(l.error),
                   power(l.bound));
    }
    write(folder, lines);
    return holds ? 0 : 1;
}
