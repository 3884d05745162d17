#pragma once
/// \file
/// How tables and figures call what a run loads.

namespace isostat {

struct LoadWords {
    const char* ratio;      ///< as `Load::ratio_name`
    const char* strain;     ///< as `Load::strain_name`
    const char* rising;     ///< the ratio goes up
    const char* falling;    ///< and down
    const char* ratio_axis; ///< labels of axes, UTF-8
    const char* strain_axis;
    const char* ratio_step; ///< of distributions of increments
    const char* strain_step;
    const char* ratio_sign; ///< short, UTF-8
    const char* strain_sign;
    const char* other_strain; ///< that of the axis whose stress the ratio is taken over
    const char* stress_sign;
};

constexpr LoadWords biaxial_words{"sigma2/sigma1",
                                  "eps2",
                                  "loading",
                                  "unloading",
                                  "stress ratio σ_2/σ_1",
                                  "axial strain ε_2",
                                  "increment of the stress ratio Δσ_2/σ_1",
                                  "strain increment Δε_2",
                                  "σ₂/σ₁",
                                  "ε₂",
                                  "ε₁",
                                  "σ₂"};
constexpr LoadWords shear_words{"shear/sigma2",
                                "shear strain",
                                "shear up",
                                "shear down",
                                "shear stress over normal stress τ/σ_2",
                                "shear strain γ",
                                "increment of the shear stress Δτ/σ_2",
                                "increment of the shear strain Δγ",
                                "τ/σ₂",
                                "γ",
                                "strain of the height",
                                "τ"};

/// `shear`: the tilt is loaded.
constexpr const LoadWords& load_words(bool shear) {
    return shear ? shear_words : biaxial_words;
}

} // namespace isostat
