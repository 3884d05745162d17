#include "packing/words.hpp"

#include "report/charts.hpp"

#include <fmt/format.h>

#include <array>

namespace isostat {

LoadWords load_words(const Load& load) {
    if (load.path) {
        return {"t/p0",
                load.strain_name(),
                "t rises",
                "t falls",
                "way in stress space t/p_0",
                "axial strain ε_3",
                "increment of Δt/p_0",
                "strain increment Δε_3",
                "t/p₀",
                "ε₃",
                "ε₁",
                "t"};
    }
    constexpr std::array numbers{"₁", "₂", "₃"};
    const bool in_plane = load.dimension == plane, shear = load.loads_tilt();
    // In the plane the loaded axis is the second one by name, and there is one tilt.
    const auto axis = static_cast<std::size_t>(in_plane ? 1 : load.loaded_axis);
    const auto other = static_cast<std::size_t>(in_plane && !shear ? 0 : load.other_axis());
    const std::string of = !shear     ? fmt::format("_{}", axis + 1)
                           : in_plane ? ""
                                      : fmt::format("_{}", tilt_names[load.loaded_tilt()]);
    const std::string sign = shear ? of : numbers[axis];
    LoadWords words;
    words.ratio = load.ratio_name();
    words.strain = load.strain_name();
    words.rising = shear ? "shear up" : "loading";
    words.falling = shear ? "shear down" : "unloading";
    words.ratio_axis =
        fmt::format("{}{}/σ_{}", shear ? "shear stress over normal stress τ" : "stress ratio σ", of, other + 1);
    words.strain_axis = (shear ? "shear strain γ" : "axial strain ε") + of;
    words.ratio_step = fmt::format(
        "{}{}/σ_{}", shear ? "increment of the shear stress Δτ" : "increment of the stress ratio Δσ", of, other + 1);
    words.strain_step = (shear ? "increment of the shear strain Δγ" : "strain increment Δε") + of;
    words.stress_sign = (shear ? "τ" : "σ") + sign;
    words.ratio_sign = fmt::format("{}/σ{}", words.stress_sign, numbers[other]);
    words.strain_sign = (shear ? "γ" : "ε") + sign;
    words.other_strain = shear && in_plane ? "strain of the height" : fmt::format("ε{}", numbers[other]);
    return words;
}

} // namespace isostat
