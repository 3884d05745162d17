#pragma once
// Steering at the level `plain`: private to the room.

#include "trajectory/renewal.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/motion/arc.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace isostat {

/// A configuration and its contacts, of which nothing is proved.
template <int Dim> struct PlainEnd {
    Packing<Dim> packing;
    std::vector<Contact> contacts;
    ContactId fresh_hold; ///< valid: the last arc ended at a power turn, and holds this coordinate
};

/// The end of an arc: what a proof of it starts from. Nothing is proved of any of it.
template <int Dim> struct PlainArrival {
    ArcRecord<Dim> record;
    Opening opening; ///< that the arc started with
    Packing<Dim> packing;
    ExchangedContacts<Dim> contacts;
    ApproximateInverse approximate;
    std::vector<double> tangent;
    std::vector<double> forces; ///< finite, as the choice of the next opening needs them
};

template <int Dim> class PlainVertex;

/// What steering needs from the run, and tells it.
template <int Dim> struct PlainCalls {
    /// Before each arc: counts it, or says why the run stops here.
    std::function<std::optional<Failure>(ArcRecord<Dim>&)> begin;
    /// After each arc.
    std::function<std::optional<Failure>(ArcRecord<Dim>&, const Packing<Dim>&)> end;
    /// After each arc too, if it is set.
    std::function<void(PlainArrival<Dim>)> arrived;
    /// For the rule `random`.
    std::function<std::uint64_t()> random_bits;
};

/// Arc after arc from a vertex whose opening was decided, until no force is negative. Forces, events and the choice of
/// what opens are those of refined double precision: *no rank, no sign and no order along the way is proved or even
/// bounded*, and a run that took a wrong turn does not know. The caller proves the end.
/// Failures: those of `follow_arc`; `undecided` when the new contact of an arc carries no compression, or W grew.
/// Cost: 12 triangular solves or so per arc, and new factors every 20 arcs at n = 1936, every 40 at 4900.
template <int Dim> class PlainSteering {
  public:
    /// All that is referred to must outlive the steering; the vertex only its first arc.
    PlainSteering(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                  const Factorisation& factorisation, Opening opening, std::string kind, const Load<Dim>& load,
                  const RunOptions& options, CandidateList<Dim>& candidates);
    PlainSteering(const PlainSteering&) = delete;
    PlainSteering& operator=(const PlainSteering&) = delete;
    ~PlainSteering();

    /// One more arc; nothing: there is another to do. What `calls` fails with is returned; when that was before the
    /// arc, another step does it.
    std::optional<Result<PlainEnd<Dim>>> step(const PlainCalls<Dim>& calls);

  private:
    const Packing<Dim>* packing_;
    const IsostaticStructure<Dim>* structure_;
    const Factorisation* factorisation_;
    Opening opening_;
    std::string kind_;
    const Load<Dim>& load_;
    const RunOptions& options_;
    CandidateList<Dim>& candidates_;
    ArcOptions arc_options_;
    std::unique_ptr<PlainVertex<Dim>> here_; ///< null: at the start
    Wear wear_;
    Renewal renewal_;
    bool at_limit_;
};

extern template class PlainSteering<2>;

} // namespace isostat
