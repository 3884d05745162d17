// Forces and supported load interval of two disks in a box, and the closed form beside them.
//
// Disk 0 in the bottom left corner, disk 1 on the bottom, the right and the top wall. With t = (R1 - R0) / (2 sqrt(R0
// R1)) the structure carries every sigma2 >= t sigma1: below, disk 1 leaves the bottom.
#include <isostat/certificate/certify.hpp>

#include <cmath>
#include <cstdio>

int main() {
    using namespace isostat;
    const double r0 = 1;
    const double r1 = 2;
    State state;
    const double dx = 2 * std::sqrt(r0 * r1);
    state.packing.radius = {r0, r1};
    state.packing.q = {r0, r0, r0 + dx, r1, r0 + dx + r1, 2 * r1};
    snap_to_grid(state.packing);
    state.load.stress = {1, 1};
    state.load.reference_length = {1, 1}; // forces and stresses have the same numbers
    state.load.infinitesimal = generic_infinitesimal(state.packing.radius, 1);
    state.contacts = {{ContactKind::disk_disk, 0, 1},  {ContactKind::lower_wall, 0, 0},
                      {ContactKind::lower_wall, 0, 1}, {ContactKind::lower_wall, 1, 1},
                      {ContactKind::upper_wall, 1, 0}, {ContactKind::upper_wall, 1, 1}};

    const Result<Inspection> result = inspect_vertex(state);
    if (!result.ok()) {
        std::printf("%s\n", result.failure().message().c_str());
        return 1;
    }
    const Inspection& inspection = result.value();
    for (std::size_t l = 0; l < state.contacts.size(); ++l) {
        std::printf("%-10s force %.15f\n", to_string(state.contacts[l]).c_str(), inspection.forces[l]);
    }
    const EquilibriumRecord& record = inspection.record;
    const double t = (r1 - r0) / (2 * std::sqrt(r0 * r1));
    std::printf("N_f = %d, N = %d, h = %d, k = %d, isostatic equilibrium: %s\n", record.dof_count, record.contact_count,
                record.hyperstaticity, record.mechanisms, std::string(to_string(record.verdict)).c_str());
    std::printf("sigma2 from %.15f (opens %s; closed form %.15f) to %g\n", record.stress_low,
                to_string(record.opens_low).c_str(), t, record.stress_high);
    return inspection.equilibrium && std::abs(record.stress_low - t) < 1e-12 && std::isinf(record.stress_high) ? 0 : 1;
}
