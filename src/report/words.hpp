#pragma once
/// \file
/// Names of the loaded quantity in tables and figures.

#include <isostat/packing/load.hpp>

#include <string>

namespace isostat {

struct LoadWords {
    std::string ratio;      ///< as `Load::ratio_name`
    std::string strain;     ///< as `Load::strain_name`
    std::string rising;     ///< words for a rising ratio
    std::string falling;    ///< words for a falling ratio
    std::string ratio_axis; ///< labels of axes, UTF-8
    std::string strain_axis;
    std::string ratio_step; ///< labels of distributions of increments
    std::string strain_step;
    std::string ratio_sign; ///< short, UTF-8
    std::string strain_sign;
    std::string other_strain; ///< strain of the axis of the denominator of the ratio
    std::string stress_sign;
};

inline const LoadWords biaxial_words{"sigma2/sigma1",
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
inline const LoadWords shear_words{"shear/sigma2",
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

/// The words for a load; in space they name the loaded axis or tilt.
LoadWords load_words(const Load& load);

} // namespace isostat
