#pragma once
/// \file
/// Whether the forces of a frame are those of the law and of dashpots.

#include <isostat/compare/compare.hpp>

#include <map>
#include <optional>
#include <string>

namespace isostat::compare {

/// A dashpot adds `constant` w v_n, v_n the speed of approach, w a function of the masses: m_i m_j / (m_i + m_j), at a
/// wall m_i, with m = R^`power`, or 1 with power 0.
struct Dashpot {
    double constant = 0;
    int power = 0;
    [[nodiscard]] std::string words() const;
};

/// The dashpot that explains `beyond`, the forces of the files minus those of the law: one constant for all contacts,
/// found by least squares, leaves at most `allowance` and a tenth of the largest; the best of several weights. Speeds
/// of walls, periods and tilt are not in the files and are fitted too. Nothing: no dashpot explains them, or the frame
/// has no velocities, or too few contacts. Diagnosis, in doubles. `law`: with a Hertzian law the dashpot may be
/// proportional to the root of the overlap.
std::optional<Dashpot> find_dashpot(const Frame& frame, const std::map<Contact, double>& beyond, ForceLaw law,
                                    double allowance);

} // namespace isostat::compare
