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
    Load load; ///< as stored
    std::shared_ptr<const LoadShift> shift =
        nullptr;                 ///< exact stress minus the stored one; null: the stored one is meant
    double error = 0;            ///< bound of the error of `shift`
    Enclosure stress_rate{0, 0}; ///< first-order term of the stress

    [[nodiscard]] double stress() const { return load.loaded_stress(); }
    void set_stress(double stress) { load.set_loaded_stress(stress); }
};

/// Here a tie ends the run; the subclass `FirstOrderSide` settles ties.
class TieSettling {
  public:
    TieSettling() = default;
    TieSettling(const TieSettling&) = delete;
    TieSettling& operator=(const TieSettling&) = delete;
    virtual ~TieSettling() = default;

    [[nodiscard]] virtual bool settles() const { return false; }
    /// Gives a vertex its first-order terms; to be called before its statics are used.
    virtual void attach(Vertex& /*vertex*/, const LimitLoad& /*at*/) const {}
    /// Among the contacts of a hyperstatic start, chooses those that carry the load for small eps > 0.
    [[nodiscard]] virtual std::optional<Failure> choose_contacts() const { return std::nullopt; }
    /// At a start: fixes the load that the state means, and the pairs that touch.
    [[nodiscard]] virtual std::optional<Failure> resume(Vertex& /*vertex*/, const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// Sets `at`, whose stress is known to `error`, to the load at which the force in a contact of the vertex vanishes.
    virtual void set_limit(LimitLoad& /*at*/, Vertex& /*vertex*/, ContactId /*opens*/, double /*error*/) const {}
    /// At an equilibrium reached at a limit: fixes the load that is stored,
    /// and the pairs that touch. `zeros`: forces that vanish in the base.
    [[nodiscard]] virtual std::optional<Failure> settle_end(Vertex& /*vertex*/, const LimitLoad& /*limit*/,
                                                            const std::vector<ContactId>& /*zeros*/,
                                                            const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// From now on the stored stress is the exact one.
    virtual void load_is_stored() const {}
    /// Writes the first-order results at an equilibrium into its record and its state.
    virtual void store(const Vertex& /*vertex*/, EquilibriumRecord& /*record*/) const {}
};

/// The object for `options.ties`. The state must outlive it.
std::unique_ptr<const TieSettling> tie_settling(State& state, const RunOptions& options);

} // namespace isostat
