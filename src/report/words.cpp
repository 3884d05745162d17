#include "report/words.hpp"

#include "packing/words.hpp"

#include <fmt/format.h>

#include <array>

namespace isostat {

LoadWords load_words(const Load& load) {
    if (load.dimension == plane) {
        return load.loads_tilt() ? shear_words : biaxial_words;
    }
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
    const auto other = static_cast<std::size_t>(load.other_axis());
    const bool shear = load.loads_tilt();
    const std::string of = shear ? tilt_names[load.loaded_tilt()] : std::to_string(load.loaded_axis + 1);
    const std::string sign = shear ? "_" + of : numbers[static_cast<std::size_t>(load.loaded_axis)];
    LoadWords words = shear ? shear_words : biaxial_words;
    words.ratio = load.ratio_name();
    words.strain = load.strain_name();
    words.ratio_axis =
        fmt::format("{}_{}/σ_{}", shear ? "shear stress over normal stress τ" : "stress ratio σ", of, other + 1);
    words.strain_axis = fmt::format("{}_{}", shear ? "shear strain γ" : "axial strain ε", of);
    words.ratio_step = fmt::format(
        "{}_{}/σ_{}", shear ? "increment of the shear stress Δτ" : "increment of the stress ratio Δσ", of, other + 1);
    words.strain_step = fmt::format("{}_{}", shear ? "increment of the shear strain Δγ" : "strain increment Δε", of);
    words.stress_sign = (shear ? "τ" : "σ") + sign;
    words.ratio_sign = fmt::format("{}/σ{}", words.stress_sign, numbers[other]);
    words.strain_sign = (shear ? "γ" : "ε") + sign;
    words.other_strain = fmt::format("ε{}", numbers[other]);
    return words;
}

} // namespace isostat
