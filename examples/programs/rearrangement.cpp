// One rearrangement: two disks unloaded until disk 1 leaves the bottom, rolls over disk 0 and ends on the left wall;
// then back. The two jumps come at different loads: a complete hysteresis loop without friction.
#include <isostat/trajectory/trajectory.hpp>

#include <cmath>
#include <cstdio>

namespace {

using namespace isostat;

class Printer final : public RunObserver {
  public:
    void on_arc(const ArcRecord& arc) override {
        std::printf("  arc: opens %s, closes %s, work %.6f, largest displacement %.6f\n", to_string(arc.opened).c_str(),
                    to_string(arc.closed).c_str(), arc.work, arc.displacement);
    }
    void on_equilibrium(const EquilibriumRecord& record, const State&, const std::vector<double>&) override {
        std::printf("equilibrium %d at sigma2 = %.12f: Lx = %.12f, Ly = %.12f\n", record.number, record.stress,
                    record.length[0], record.length[1]);
    }
};

State two_disks() {
    State state;
    const double dx = 2 * std::sqrt(2.0);
    state.packing.radius = {1, 2};
    state.packing.q = {1, 1, 1 + dx, 2, 3 + dx, 4};
    snap_to_grid(state.packing);
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1}; // forces and stresses have the same numbers
    state.load.infinitesimal = generic_infinitesimal(state.packing.radius, 1);
    state.contacts = {{ContactKind::disk_disk, 0, 1},  {ContactKind::lower_wall, 0, 0},
                      {ContactKind::lower_wall, 0, 1}, {ContactKind::lower_wall, 1, 1},
                      {ContactKind::upper_wall, 1, 0}, {ContactKind::upper_wall, 1, 1}};
    return state;
}

} // namespace

int main() {
    State state = two_disks();
    Printer printer;
    RunCounters counters;
    RunOptions options;
    options.max_strain = 10; // strains are in units of the reference length, 1
    int number = 0;
    for (const int direction : {-1, +1}) {
        Segment segment;
        segment.direction = direction;
        segment.equilibria = 1;
        const SegmentOutcome outcome = run_segment(state, segment, number++, options, counters, printer);
        if (!outcome.completed) {
            std::printf("%s\n", outcome.failure->message().c_str());
            return 1;
        }
        // Closed form: down at 1 / (2 sqrt 2), up at 2 sqrt 2.
        const double expected = std::pow(2 * std::sqrt(2.0), direction);
        if (std::abs(state.load.stress[1] - expected) > 1e-12 * expected) {
            return 1;
        }
    }
    return 0;
}
