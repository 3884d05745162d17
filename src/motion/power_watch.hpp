#pragma once
/// \file
/// Sign of the power of dead loads along a chain of proved pieces: private to the room (statement A6, proofs/arcs.md).

#include "motion/curve_piece.hpp"

#include <isostat/motion/arc_certificate.hpp>

#include <string>
#include <utility>
#include <vector>

namespace isostat {

/// The power F . q'(s) of a constant load, piece by piece.
class PowerWatch {
  public:
    explicit PowerWatch(const PowerLoad& power) : power_(power) {}
    void look(const CurvePiece& piece, double from, double to);
    /// Fills the fields of the power in `certificate`. `turns`: the arc ends at a power turn.
    void conclude(ArcCertificate& certificate, bool turns) const;

  private:
    struct Power;
    struct Balance {
        std::vector<double> f; ///< per contact
        double residual = 0;   ///< bound of |load - H f| (2-norm)
    };
    [[nodiscard]] Balance balance(const CurvePiece& piece) const;
    [[nodiscard]] Power power_along(const CurvePiece& piece) const;
    static double add_row(const CurvePiece& piece, double force, Power& power);
    static void add_contact(const CurvePiece& piece, std::size_t l, double force, Power& power);
    /// Finds the longest end [s, to] and start [from, s] on which the power is proved positive.
    void walk(const Power& power, double from, double to, int depth);

    const PowerLoad& power_;
    std::string reason_;
    int pieces_ = 0;
    double first_open_ = 0;   ///< share of the first piece, from its start
    double last_open_ = 0;    ///< share of the last piece, to its end
    bool inner_open_ = false; ///< not proved positive somewhere else
    std::vector<std::pair<double, double>> open_;
};

} // namespace isostat
