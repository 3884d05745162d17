// Seconds of `inspect` for triangular lattices in their box, coordinates in Q(sqrt 3), and of `plateau` for the same
// lattices with radii of 2 % polydispersity, as another program would store them. CPU time, median and range; m by m
// disks. Usage:
//   bench_crafted [--json FILE] [--repeats R] [m ...]       default: 3 repeats, 10 30 70 100

#include "bench/shared/report.hpp"
#include "support/exact_lattices.hpp"

#include <isostat/crafted/exact_packing.hpp>
#include <isostat/crafted/plateau.hpp>

#include <fmt/format.h>

#include <cstdlib>
#include <random>

using namespace isostat::crafted;

int main(int argc, char** argv) {
    std::vector<std::string> sizes{"10", "30", "70", "100"};
    int repeats = 3;
    bench::Program program("bench_crafted", "cost of inspect and plateau for lattices");
    program.option("--repeats", repeats, "of each measurement");
    program.words("sizes", sizes, "rows of the lattices");
    if (const auto status = program.parse(argc, argv)) {
        return *status;
    }
    bench::Table table("crafted", "Triangular lattices in a box, CPU seconds, median (range):",
                       {{"m", "m", ""},
                        {"n", "n", ""},
                        {"contacts", "N", ""},
                        {"rank", "rank", ""},
                        {"hyperstaticity", "h", ""},
                        {"inspect", "inspect, s", "s", "{:.3f}"},
                        {"candidates", "candidates", ""},
                        {"ranks", "ranks", ""},
                        {"plateau", "plateau, s", "s", "{:.3f}"}});
    for (const std::string& word : sizes) {
        const int m = std::atoi(word.c_str());
        const ExactPacking packing = families::triangular_lattice(m, m);
        Inspection inspection;
        const bench::Sample inspecting =
            bench::milliseconds([&] { inspection = inspect(packing).value(); }, repeats).over(1e3);
        isostat::Packing stored = approximate(packing);
        std::mt19937_64 random(1);
        for (double& r : stored.radius) {
            r *= 1 - 0.02 * static_cast<double>(random() >> 11) * 0x1p-53;
        }
        Plateau counts;
        const bench::Sample counting =
            bench::milliseconds([&] { counts = plateau(stored, -0.1, 0.1, 20); }, repeats).over(1e3);
        table.add({static_cast<long>(m), static_cast<long>(m * m), static_cast<long>(inspection.contacts.size()),
                   static_cast<long>(inspection.rank), static_cast<long>(inspection.hyperstaticity), inspecting,
                   static_cast<long>(counts.candidates), static_cast<long>(counts.ranks_computed), counting});
    }
    program.show(table);
    return program.finish();
}
