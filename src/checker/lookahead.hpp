#pragma once
/// \file
/// The ends of arcs, followed in double and then proved. With several threads later arcs are followed early, and other
/// threads prove their ends.

#include "checker/recorded_arc.hpp"
#include "checker/replay.hpp"
#include "core/parallel.hpp"

#include <deque>

namespace isostat::checker {

/// The end of an arc.
struct Arrival {
    Followed followed;
    Objections open; ///< objections to the vertex there; only with followed.end
    Place place;
};

class Lookahead {
  public:
    /// The records must outlive the object.
    explicit Lookahead(const RunRecords& records) : records_(records) {}

    /// Follows arcs that come after a vertex, `event` the first of them, as if every record were right. Wrong or
    /// unusual records are left to the replay.
    void look_ahead(const Place& from, std::size_t event);
    /// The arc of a record. A result from `look_ahead` is used if it has the same opening and the same vertex.
    Arrival arrive(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load);
    /// As `arrive`, with steps a sixteenth as long, and shorter ones near the end.
    Arrival arrive_slowly(const Place& from, std::size_t event, const Opening& opening, const ExactLoad& load);
    /// To be called when the replay continues from another state.
    void forget() { ahead_.clear(); }

  private:
    struct Proved {
        Objections open;
        Place place;
    };
    struct Arc {
        std::size_t event = 0;
        Opening opening;
        Followed followed;
        State end;
        Future<Proved> proof;
    };
    struct Start {
        ArcStart at;
        ExactLoad load{};
    };
    static Start start_at(const Place& from, const ExactLoad& load);
    [[nodiscard]] Arc arc_of(const Start& from, std::size_t event, const Opening& opening, bool slowly = false) const;
    Arrival end_of(Arc arc);
    [[nodiscard]] bool in_order(std::size_t event) const;

    const RunRecords& records_;
    std::deque<Arc> ahead_;
};

} // namespace isostat::checker
