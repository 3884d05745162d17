#pragma once
/// \file
/// On which arc of the exact run a frame in motion is: a diagnosis.

#include "compare/frame.hpp"

#include <isostat/trajectory/records.hpp>

#include <vector>

namespace isostat::compare {

/// Told of every arc of a run, it keeps for each frame in motion the arc whose kept contacts differ least from those of
/// the frame. Those of rattlers are left out of the arcs, as far as they touch at the equilibrium before or come to
/// rest on the way.
class NearestArcs {
  public:
    explicit NearestArcs(const std::vector<JudgedFrame>& frames);
    void start(const State& equilibrium);
    /// \p equilibrium: of the path, which its rearrangement leads to.
    void add(const ArcRecord& arc, int equilibrium);
    /// Sets `nearest_arc` of these frames.
    void tell(std::vector<JudgedFrame>& frames, int dimension) const;

  private:
    struct Found {
        std::size_t frame = 0;
        std::vector<Contact> pressed;
        int equilibrium = -1, arc = 0;
        std::vector<Contact> lacking, beside; ///< of the frame against the arc
    };
    std::vector<Found> frames_;
    std::vector<Contact> contacts_;
};

} // namespace isostat::compare
