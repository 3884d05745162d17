#pragma once
/// \file
/// Signs of the gaps of candidates along a chain of proved pieces: private to the room (statement A5, proofs/arcs.md).

#include "motion/curve_piece.hpp"

#include <map>
#include <set>
#include <string>

namespace isostat {

/// How a gap was proved positive on a stretch: bounded away from 0, or growing from a left end where it is not
/// negative, or falling to a right end where it is not negative. `zero`: not yet proved, the gap is 0 at the left end.
enum class GapTrend : unsigned char { above, rising, falling, zero };

/// Follows every candidate from piece to piece. A stretch on which a gap rises must not follow one on which it falls,
/// unless the gap is bounded away from 0 where the two meet.
class GapWatch {
  public:
    /// The gap of a contact (the opened one) is 0 at the start of the arc and has to rise there.
    void starts_at_zero(const Contact& contact) { last_[contact] = GapTrend::zero; }
    /// Before the candidates of a piece are tested for s in [from, to], within its reach.
    void begin(const CurvePiece& piece, double from, double to);
    /// Tests one candidate there. False: near `where()` neither the sign of the gap nor that of its rate was proved.
    bool look(const CurvePiece& piece, const Contact& contact, double from, double to);
    /// Whether the gap of a contact falls on the last stretch: it must then be proved not negative at the right end.
    [[nodiscard]] bool falls(const Contact& contact) const {
        const auto found = last_.find(contact);
        return found != last_.end() && found->second == GapTrend::falling;
    }
    /// Whether the gap of a contact was proved to fall on every stretch of the last tested piece.
    [[nodiscard]] bool fell_all_along(const Contact& contact) const { return fell_.count(contact) != 0; }
    /// Proved sign of the rate of a gap at s: +1, -1, or 0 = not proved.
    static int rate_sign(const CurvePiece& piece, const Contact& contact, double s);
    /// Smallest |quantity| / (its uncertainty from the tube and from rounding) over all that was proved.
    [[nodiscard]] double margin() const { return margin_; }
    [[nodiscard]] double where() const { return where_; }

  private:
    struct Motion;
    [[nodiscard]] bool is_far(const CurvePiece& piece, const Contact& contact) const;
    bool walk(const Motion& motion, double from, double to, int depth, GapTrend& last, bool& only_falls);

    std::map<Contact, GapTrend> last_; ///< candidates that are not `above`
    std::set<Contact> fell_;
    double margin_ = 1e308; // message: largest margin
    double moved_ = 0;      ///< bound of what `Motion::view` takes off a gap for the motion of two grains
    double where_ = 0;
};

} // namespace isostat
