#include "compare/report.hpp"
#include "core/refuse.hpp"
#include "io/files.hpp"
#include "snap/backbone.hpp"

#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat::compare {

namespace {

namespace fs = std::filesystem;

struct Row {
    int number = 0;
    const char* end = "";
    double exact = NAN, soft = NAN, needed = NAN;
};

/// Adds a row for each finite end of one equilibrium.
void add_rows(std::vector<Row>& rows, const EquilibriumRow& equilibrium, const State& state, double stiffness) {
    if (!std::isfinite(equilibrium.stress_high) || !(equilibrium.stress_low > 0)) {
        return;
    }
    const State backbone = backbone_of(state, carrying(state));
    for (const int direction : {-1, +1}) {
        const ExactInterval exact{equilibrium.stress_low, equilibrium.stress_high, direction};
        const auto soft = soft_limit(backbone, exact, stiffness);
        rows.push_back({equilibrium.number, direction > 0 ? "high" : "low", exact.end(), soft ? soft->stress : NAN,
                        stiffness_needed(backbone, exact).value_or(NAN)});
    }
}

std::string shown(double value, const char* format) {
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

} // namespace

std::string soft_limits(const fs::path& run, const fs::path& output, double stiffness) {
    std::vector<Row> rows;
    int left_out = 0;
    for (const EquilibriumRow& equilibrium : read_equilibria(run / "equilibria.csv")) {
        const fs::path file = run / "states" / fmt::format("eq_{:06}.json", equilibrium.number);
        if (!fs::exists(file)) {
            ++left_out;
            continue;
        }
        const State state = read_any_state(file, Dimensions::any).state;
        const Walls box = Walls::box(state.packing.dimension);
        if (!state.packing.cell.any() && !(state.packing.walls == box)) {
            refuse(file.string(), "expected a box with a fixed lower and a movable upper wall along each axis, or a "
                                  "periodic cell, for --stiffness");
        }
        add_rows(rows, equilibrium, state, stiffness);
    }
    std::string csv = "equilibrium,end,exact,soft,stiffness_needed\n";
    std::string text =
        fmt::format("ends of the supported intervals for stiffness {:g} (predictions)\n{:>11} {:>5} {:>12} "
                    "{:>12} {:>11}\n",
                    stiffness, "equilibrium", "end", "exact", "soft", "K for 1e-3");
    for (const Row& row : rows) {
        csv += fmt::format("{},{},{},{},{}\n", row.number, row.end, row.exact, row.soft, row.needed);
        text += fmt::format("{:>11} {:>5} {:>12.7f} {:>12} {:>11}\n", row.number, row.end, row.exact,
                            shown(row.soft, "{:.7f}"), shown(row.needed, "{:.1e}"));
    }
    make_directory(output);
    write_atomically(output / "soft_limits.csv", csv);
    text += "-: soft grains have a force that is not positive in the middle of the interval already\n";
    return text + (left_out == 0
                       ? ""
                       : fmt::format("{} equilibria have no stored state (states_every = 1 stores all)\n", left_out));
}

} // namespace isostat::compare
