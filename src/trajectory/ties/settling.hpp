#pragma once
/// \file
/// What a run does about ties: private to the room.

#include "trajectory/vertex.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// The load of an equilibrium or of a rearrangement.
struct LimitLoad {
    Load load; ///< as it is stored
    std::shared_ptr<const LoadShift> shift =
        nullptr;                 ///< the exact stress less the stored one; null: it is meant as it is stored
    double error = 0;            ///< bound of that
    Enclosure stress_rate{0, 0}; ///< first-order term of the stress

    [[nodiscard]] double stress() const { return load.loaded_stress(); }
    void set_stress(double stress) { load.set_loaded_stress(stress); }
};

/// A tie ends the run, and there is nothing to do about it: `FirstOrderSide` settles ties.
class TieSettling {
  public:
    TieSettling() = default;
    TieSettling(const TieSettling&) = delete;
    TieSettling& operator=(const TieSettling&) = delete;
    virtual ~TieSettling() = default;

    [[nodiscard]] virtual bool settles() const { return false; }
    /// Gives a vertex its first-order terms. Before any question to its statics.
    virtual void attach(Vertex& /*vertex*/, const LimitLoad& /*at*/) const {}
    /// Of the contacts of a hyperstatic start, those that carry the load for small eps > 0.
    [[nodiscard]] virtual std::optional<Failure> choose_contacts() const { return std::nullopt; }
    /// At a start: the load that its state means, and the pairs that touch.
    [[nodiscard]] virtual std::optional<Failure> resume(Vertex& /*vertex*/, const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// `at`, whose stress is known to `error`, is the load at which the force in a contact of the vertex vanishes.
    virtual void set_limit(LimitLoad& /*at*/, Vertex& /*vertex*/, ContactId /*opens*/, double /*error*/) const {}
    /// At an equilibrium that was reached at a limit: the load that is stored, and the pairs that touch. `zeros`:
    /// forces that vanish in the base.
    [[nodiscard]] virtual std::optional<Failure> settle_end(Vertex& /*vertex*/, const LimitLoad& /*limit*/,
                                                            const std::vector<ContactId>& /*zeros*/,
                                                            const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// From now on the load is meant as it is stored.
    virtual void load_is_stored() const {}
    /// The results at an equilibrium go with its record and its state.
    virtual void store(const Vertex& /*vertex*/, EquilibriumRecord& /*record*/) const {}
};

/// By `options.ties`. The state must outlive it.
std::unique_ptr<const TieSettling> tie_settling(State& state, const RunOptions& options);

} // namespace isostat
