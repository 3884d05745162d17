// Sequential linear programming from a given start to the proved vertex, timed; the start as a file for other programs.
//
//   bench_linear_programmes start N SEED FILE    the relaxed soft packing that `prepare` hands to the programmes
//   bench_linear_programmes solve FILE [RUNS]    JSON: processor seconds of each run, programmes, pivots, contacts,
//                                                coordinates
//
// bench/highs_chain.py runs both and compares with scipy's HiGHS on the same programmes.

#include <isostat/packing/load.hpp>
#include <isostat/preparation/preparation.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <string>

namespace {

using namespace isostat;

int fail(const std::string& what) {
    fmt::print(stderr, "bench_linear_programmes: {}\n", what);
    return 64;
}

/// First line: disks, seed, eps; then radius, x, y, gx, gy of each disk; then the lengths.
int write_start(int disks, std::uint64_t seed, const std::string& file) {
    PreparationOptions options{.disks = disks, .seed = seed};
    options.max_programmes = 0; // only the dynamics
    PreparationReport report;
    (void)prepare(options, report);
    if (!report.last) {
        return fail("the dynamics left nothing");
    }
    const Packing& packing = *report.last;
    const std::vector<double> g = generic_infinitesimal(packing.radius, report.infinitesimal_seed);
    std::ofstream out(file);
    out << fmt::format("{} {} {:a}\n", disks, seed, options.infinitesimal_weight);
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        out << fmt::format("{:a} {:a} {:a} {:a} {:a}\n", packing.radius[i], packing.q[2 * i], packing.q[2 * i + 1],
                           g[2 * i], g[2 * i + 1]);
    }
    out << fmt::format("{:a} {:a}\n", packing.length(0), packing.length(1));
    return out.flush() ? 0 : fail("cannot write " + file);
}

int solve(const std::string& file, int runs) {
    std::ifstream in(file);
    const auto number = [&in] { // streams do not read hexadecimal floats
        std::string word;
        in >> word;
        return std::strtod(word.c_str(), nullptr);
    };
    std::size_t disks = 0;
    PreparationOptions options;
    in >> disks >> options.seed;
    options.infinitesimal_weight = number();
    Packing start;
    for (std::size_t i = 0; i < disks; ++i) {
        start.radius.push_back(number());
        for (int k = 0; k < 2; ++k) {
            start.q.push_back(number());
        }
        for (int k = 0; k < 2; ++k) {
            number(); // made again from the seed
        }
    }
    for (int k = 0; k < 2; ++k) {
        start.q.push_back(number());
    }
    if (!in) {
        return fail("cannot read " + file);
    }
    std::vector<double> seconds;
    for (int run = 0; run < runs; ++run) {
        PreparationReport report;
        const std::clock_t before = std::clock();
        const auto vertex = find_vertex(start, options, report);
        seconds.push_back(static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
        if (!vertex.ok()) {
            return fail(vertex.failure().message());
        }
        if (run + 1 == runs) {
            std::vector<std::string> contacts;
            for (const Contact& contact : vertex.value().contacts) {
                contacts.push_back(fmt::format("\"{}\"", to_string(contact)));
            }
            fmt::print("{{\"disks\": {}, \"seconds\": [{}], \"programmes\": {}, \"pivots\": {}, \"contacts\": [{}], "
                       "\"coordinates\": [{:.17g}]}}\n",
                       disks, fmt::join(seconds, ", "), report.programmes, report.pivots, fmt::join(contacts, ", "),
                       fmt::join(vertex.value().packing.q, ", "));
        }
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    const std::string what = argc > 1 ? argv[1] : "";
    if (what == "start" && argc == 5) {
        return write_start(std::atoi(argv[2]), std::strtoull(argv[3], nullptr, 10), argv[4]);
    }
    if (what == "solve" && argc >= 3) {
        return solve(argv[2], argc > 3 ? std::atoi(argv[3]) : 1);
    }
    return fail("start N SEED FILE, or solve FILE [RUNS]");
}
