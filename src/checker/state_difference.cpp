#include <isostat/checker/verify.hpp>

namespace isostat {

namespace {

bool same(const std::optional<RadiusPerturbation>& a, const std::optional<RadiusPerturbation>& b) {
    if (!a || !b) {
        return a.has_value() == b.has_value();
    }
    return a->rho == b->rho && a->load_zero == b->load_zero &&
           (a->load_zero.i < 0 ||
            (a->stress_rate.value == b->stress_rate.value && a->stress_rate.radius == b->stress_rate.radius));
}

} // namespace

std::string state_difference(const State& a, const State& b) {
    const std::vector<std::pair<const char*, bool>> fields{
        {"the list of radii", a.packing.radius == b.packing.radius},
        {"a coordinate", a.packing.q == b.packing.q},
        {"a wall", a.packing.walls == b.packing.walls},
        {"the cell", a.packing.cell == b.packing.cell},
        {"the list of fixed disks", a.packing.fixed == b.packing.fixed},
        {"a bar", a.packing.bars == b.packing.bars},
        {"a body bounded by arcs", a.packing.arcs == b.packing.arcs},
        {"the list of contacts", a.contacts == b.contacts},
        {"the kind of the load", a.load.kind == b.load.kind},
        {"a stress", a.load.stress == b.load.stress},
        {"a shear stress", a.load.shear == b.load.shear},
        {"a reference length", a.load.reference_length == b.load.reference_length},
        {"a reference tilt", a.load.reference_tilt == b.load.reference_tilt},
        {"the loaded axis", a.load.loaded_axis == b.load.loaded_axis},
        {"the path of the stresses", a.load.path == b.load.path},
        {"a force on a disk", a.load.disk_force == b.load.disk_force},
        {"an infinitesimal load", a.load.infinitesimal == b.load.infinitesimal},
        {"the direction of the radii", same(a.perturbation, b.perturbation)}};
    for (const auto& [name, equal] : fields) {
        if (!equal) {
            return name;
        }
    }
    return {};
}

} // namespace isostat
