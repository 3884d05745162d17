#pragma once
/// \file
/// Signs of the gaps of candidates along a chain of proved pieces: private to the room (statement A5, proofs/arcs.md).

#include "motion/curve_piece.hpp"

#include <map>
#include <set>
#include <string>

namespace isostat {

/// How a gap was shown to be positive on a stretch: bounded away from 0, or growing from a left end where it is not
/// negative, or falling to a right end where it is not negative. `zero`: nothing yet, it is 0 at the left end.
enum class GapTrend : unsigned char { above, rising, falling, zero };

/// Follows every candidate from piece to piece. A stretch on which a gap falls must not be followed by one on which it
/// rises, unless the gap is bounded away from 0 where they meet.
class GapWatch {
  public:
    /// The gap of a contact is 0 at the start of the arc (the opened one): it must rise there.
    void starts_at_zero(const Contact& contact) { last_[contact] = GapTrend::zero; }
    /// Looks at one candidate for s in [from, to] (within the reach of the piece). False: neither a sign of the gap nor
    /// of its rate was proved near `where()`.
    bool look(const CurvePiece& piece, const Contact& contact, double from, double to);
    /// Whether the gap of a contact was last seen falling: its right end must be shown not to be negative.
    [[nodiscard]] bool falls(const Contact& contact) const {
        const auto found = last_.find(contact);
        return found != last_.end() && found->second == GapTrend::falling;
    }
    /// Whether the gap of a contact was shown to fall on every stretch of the piece looked at last.
    [[nodiscard]] bool fell_all_along(const Contact& contact) const { return fell_.count(contact) != 0; }
    /// Proved sign of the rate of a gap at s: +1, -1, or 0 = not proved.
    static int rate_sign(const CurvePiece& piece, const Contact& contact, double s);
    /// Smallest |quantity| / (share of it that the tube and the roundings leave open) over what was proved.
    [[nodiscard]] double margin() const { return margin_; }
    [[nodiscard]] double where() const { return where_; }
    [[nodiscard]] long tests() const { return tests_; }

  private:
    struct Motion;
    bool walk(const Motion& motion, double from, double to, int depth, GapTrend& last, bool& only_falls);

    std::map<Contact, GapTrend> last_; ///< those that are not `above`
    std::set<Contact> fell_;
    double margin_ = 1e308;
    double where_ = 0;
    long tests_ = 0;
};

} // namespace isostat
