// What is proved of a stored state: a true equilibrium nearby, its forces and gaps, the loads that it supports.
// Usage: example_certificate [STATE.json]
#include <isostat/certificate/certify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <cmath>
#include <cstdio>
#include <iostream>

namespace {

/// Two disks of radii 1 and 2: the first in a corner, the second on bottom, right and top.
isostat::State two_disks() {
    using isostat::ContactKind;
    const double x = 1 + 2 * std::sqrt(2.0);
    isostat::State state;
    state.packing.radius = {1, 2};
    state.packing.q = {1, 1, x, 2, x + 2, 4};
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1};
    state.contacts = {{ContactKind::lower_wall, 0, 0}, {ContactKind::lower_wall, 0, 1},
                      {ContactKind::disk_disk, 0, 1},  {ContactKind::upper_wall, 1, 0},
                      {ContactKind::upper_wall, 1, 1}, {ContactKind::lower_wall, 1, 1}};
    return state;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const isostat::State state = argc > 1 ? isostat::read_state(argv[1]).state : two_disks();
        const isostat::Certification proved = isostat::certify(state);
        if (const auto& vertex = proved.claims.vertex) {
            std::printf("a true vertex lies within %.3g, and no other one within %.3g\n", vertex->radius,
                        vertex->unique_radius);
        }
        if (const auto& forces = proved.claims.forces) {
            for (std::size_t l = 0; l < state.contacts.size(); ++l) {
                std::printf("force in %-10s from %.17g to %.17g\n", isostat::to_string(state.contacts[l]).c_str(),
                            forces->finite[l].lower, forces->finite[l].upper);
            }
        }
        if (const auto& interval = proved.claims.load_interval; interval && !interval->low.unbounded) {
            std::printf("contact %s opens at a loaded stress from %.17g to %.17g\n",
                        isostat::to_string(interval->low.opens).c_str(), interval->low.stress.lower,
                        interval->low.stress.upper);
        }
        for (const std::string& reason : proved.claims.undecided) {
            std::printf("not proved: %s\n", reason.c_str());
        }
        return proved.verdict == isostat::Verdict::proved ? 0 : proved.verdict == isostat::Verdict::refuted ? 1 : 2;
    } catch (const isostat::Error& error) {
        std::cerr << error.what() << '\n';
        return error.exit_status();
    }
}
