#pragma once
/// \file
/// The exact run that a series is compared with: its path, the arcs that frames in motion are on, other runs from the
/// same start, and why the frames leave it.

#include "compare/frame.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

/// On which arc of the exact run a frame in motion is: a diagnosis. Receives every arc of a run, and keeps for each
/// frame in motion the arc whose kept contacts differ least from those of the frame. Contacts of rattlers do not count
/// if they touch at the previous equilibrium or come to rest during the arcs.
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
        std::vector<Contact> lacking, extra; ///< contacts of the arc without the frame, and the reverse
    };
    std::vector<Found> frames_;
    std::vector<Contact> contacts_;
};

struct Path {
    std::vector<PathEquilibrium> equilibria;
    std::vector<int> at_load; ///< per load: the equilibrium at that load, -1 beyond the end of the run
    std::string end;          ///< empty, or why the run ends before the last load
};

/// The run from `state` to each of the loads in turn.
Path follow(State state, const std::vector<double>& loads, const RunOptions& options);
/// As `follow`, then three equilibria more in the last direction; soft limits are added when `stiffness` > 0. \p arcs:
/// null, or receives all arcs.
Path follow_beyond(State state, const std::vector<double>& loads, const RunOptions& options, double stiffness,
                   NearestArcs* arcs);

/// The contacts that carry a force in the equilibrium at the loaded stress `sigma` that a run from `state` reaches:
/// step by step, or with `jump` after the whole change at once.
Result<std::vector<Contact>> list_after(State state, double sigma, bool jump, const RunOptions& options);

/// The reference bundle: equilibria that exact runs from one start share, and where the runs separate. `count` members:
/// `path` itself (the exact run from `start`), and others from the same list of contacts, in turn with the rules
/// most_negative, least_index, random (seed 1, 2, ...) and rattlers that rest down, up, left, right, for spheres first
/// back and front. They use the threads of `set_threads`. Cost: an exact run per member.
Bundle make_bundle(const State& start, const Path& path, const std::vector<double>& loads, int count,
                   const RunOptions& options);

/// The node with this list; -1: none.
int node_with(const Bundle& bundle, const std::vector<Contact>& list);

/// Why a series leaves the exact run, a diagnosis: the departure at the first frame that is not `same` (frames in
/// motion do not count). Nothing: no such frame.
std::optional<Departure> find_departure(const Series& series, const std::vector<JudgedFrame>& frames, const Path& path,
                                        const Bundle& bundle, const CompareOptions& options);

} // namespace isostat::compare
