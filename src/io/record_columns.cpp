#include "io/record_columns.hpp"

#include "packing/words.hpp"

namespace isostat {

RecordColumns record_columns(const Load& load, bool tilts) {
    RecordColumns columns;
    columns.dimension = load.dimension;
    const auto loaded = static_cast<std::size_t>(load.loaded_axis);
    const auto other = static_cast<std::size_t>(load.other_axis());
    const Layout layout{load.dimension, 0};
    const bool by_role = load.dimension == plane;
    columns.of_path = load.path.has_value();
    columns.stress = by_role ? "sigma2" : load.stress_name();
    for (std::size_t k = 0; k < layout.axes() + (tilts ? layout.tilts() : 0); ++k) {
        const std::size_t axis = !by_role ? k : k == 0 ? other : k == 1 ? loaded : 3 - other - loaded;
        const bool numbered = by_role || k < layout.axes();
        const std::string name = numbered ? std::to_string(k + 1) : tilt_names[k - layout.axes()];
        columns.measures.push_back({(numbered ? "eps" : "eps_") + name, (numbered ? "L" : "") + name, axis});
        if (axis == loaded) {
            columns.strain = columns.measures.back().strain;
        } else if (axis == other) {
            columns.other_strain = columns.measures.back().strain;
        }
    }
    return columns;
}

} // namespace isostat
