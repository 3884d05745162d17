// A fixed piece of work to count instructions on: count VERTEX_FILE EQUILIBRIA decisions|arcs. Prints the number of
// arcs.

#include "support/segments.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <string>

// CGAL refuses to start where the rounding mode cannot be changed, as under valgrind. This program is for counting
// only: in place of that check it does nothing (the filters of the predicates are then wrong in principle, and no
// result is used).
extern "C" {
void no_check_of_intervals() asm("_ZN4CGAL11Interval_ntILb0EE27Test_runtime_rounding_modesC1Ev");
void no_check_of_intervals() {}
void no_check_of_protected_intervals() asm("_ZN4CGAL11Interval_ntILb1EE27Test_runtime_rounding_modesC1Ev");
void no_check_of_protected_intervals() {}
}

int main(int argc, char** argv) {
    using namespace isostat;
    const std::string level = argc == 4 ? argv[3] : "";
    if (level != "decisions" && level != "arcs") {
        return 64;
    }
    struct : RunObserver {
    } observer;
    State state = read_state(argv[1]).state;
    RunCounters counters;
    RunOptions options{.certify = level == "arcs" ? CertifyLevel::arcs : CertifyLevel::decisions};
    const auto outcome = run_segment(state, towards(std::atoi(argv[2])), 0, options, counters, observer);
    fmt::print("{}\n", counters.steps);
    return outcome.completed ? 0 : 1;
}
