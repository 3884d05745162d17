#pragma once
/// \file
/// On which arc of the exact run a frame in motion is: a diagnosis.

#include "compare/frame.hpp"

#include <isostat/trajectory/records.hpp>

#include <vector>

namespace isostat::compare {

/// Receives every arc of a run, and keeps for each frame in motion the arc whose
/// kept contacts differ least from those of the frame. Contacts of rattlers do not
/// count if they touch at the previous equilibrium or come to rest during the arcs.
class NearestArcs {
  public:
    explicit NearestArcs(const std::vector<JudgedFrame>& frames);
    void start(const State& equilibrium);
    /// \p equilibrium: of the path, to which the rearrangement of the arc leads.
    void add(const ArcRecord& arc, int equilibrium);
    /// Sets `nearest_arc` of these frames.
    void tell(std::vector<JudgedFrame>& frames, int dimension) const;

  private:
    struct Found {
        std::size_t frame = 0;
        std::vector<Contact> pressed;
        int equilibrium = -1, arc = 0;
        std::vector<Contact> lacking, beside; ///< contacts of the arc without the frame, and the reverse
    };
    std::vector<Found> frames_;
    std::vector<Contact> contacts_;
};

} // namespace isostat::compare
