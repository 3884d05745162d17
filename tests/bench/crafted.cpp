// Seconds of `inspect` for triangular lattices in their box, coordinates in Q(sqrt 3), and of `plateau` for the same
// lattices with radii of 2 % polydispersity, as another program would store them: bench_crafted [m ...].

#include <isostat/crafted/inspection.hpp>
#include <isostat/crafted/plateau.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <random>

namespace {

using namespace isostat::crafted;

/// m rows of m disks of radius 1; rows are 2 wide and sqrt(3) high.
ExactPacking triangular(int m) {
    ExactPacking out;
    const Number root = Number::parse("sqrt(3)");
    for (int row = 0; row < m; ++row) {
        for (int column = 0; column < m; ++column) {
            out.centre.push_back({Number(1 + 2 * column + row % 2), Number(1) + Number(row) * root});
            out.radius.emplace_back(1);
        }
    }
    out.walls = isostat::Walls<2>::box();
    out.length = {Number(2 * m + 1), Number(2) + Number(m - 1) * root};
    return out;
}

template <class Work> double seconds(Work work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

int main(int argc, char** argv) {
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k) {
        sizes.push_back(std::atoi(argv[k]));
    }
    if (sizes.empty()) {
        sizes = {10, 30, 70, 100};
    }
    fmt::print("{:>5} {:>7} | {:>7} {:>7} {:>6} {:>9} | {:>10} {:>7} {:>9}\n", "m", "n", "N", "rank", "h", "inspect s",
               "candidates", "ranks", "plateau s");
    for (const int m : sizes) {
        const ExactPacking packing = triangular(m);
        Inspection inspection;
        const double inspecting = seconds([&] { inspection = inspect(packing).value(); });
        isostat::Packing<2> stored = approximate(packing);
        std::mt19937_64 random(1);
        for (double& r : stored.radius) {
            r *= 1 - 0.02 * static_cast<double>(random() >> 11) * 0x1p-53;
        }
        Plateau counts;
        const double counting = seconds([&] { counts = plateau(stored, -0.1, 0.1, 20); });
        fmt::print("{:>5} {:>7} | {:>7} {:>7} {:>6} {:>9.2f} | {:>10} {:>7} {:>9.2f}\n", m, m * m,
                   inspection.contacts.size(), inspection.rank, inspection.hyperstaticity, inspecting,
                   counts.candidates, counts.ranks_computed, counting);
    }
    return 0;
}
