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
template <int Dim> struct LimitLoad {
    Load<Dim> load; ///< as it is stored
    std::shared_ptr<const LoadShift> shift =
        nullptr;                 ///< the exact stress less the stored one; null: it is meant as it is stored
    double error = 0;            ///< bound of that
    Enclosure stress_rate{0, 0}; ///< first-order term of the stress

    [[nodiscard]] double stress() const { return load.loaded_stress(); }
    void set_stress(double stress) { load.loaded_stress() = stress; }
};

/// A tie ends the run, and there is nothing to do about it: `FirstOrderSide` settles ties.
template <int Dim> class TieSettling {
  public:
    TieSettling() = default;
    TieSettling(const TieSettling&) = delete;
    TieSettling& operator=(const TieSettling&) = delete;
    virtual ~TieSettling() = default;

    [[nodiscard]] virtual bool settles() const { return false; }
    /// Gives a vertex its first-order terms. Before any question to its statics.
    virtual void attach(Vertex<Dim>& /*vertex*/, const LimitLoad<Dim>& /*at*/) const {}
    /// Of the contacts of a hyperstatic start, those that carry the load for small eps > 0.
    [[nodiscard]] virtual std::optional<Failure> choose_contacts() const { return std::nullopt; }
    /// At a start: the load that its state means, and the pairs that touch.
    [[nodiscard]] virtual std::optional<Failure> resume(Vertex<Dim>& /*vertex*/, const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// `at`, whose stress is known to `error`, is the load at which the force in a contact of the vertex vanishes.
    virtual void set_limit(LimitLoad<Dim>& /*at*/, Vertex<Dim>& /*vertex*/, ContactId /*opens*/,
                           double /*error*/) const {}
    /// At an equilibrium that was reached at a limit: the load that is stored, and the pairs that touch. `zeros`:
    /// forces that vanish in the base.
    [[nodiscard]] virtual std::optional<Failure> settle_end(Vertex<Dim>& /*vertex*/, const LimitLoad<Dim>& /*limit*/,
                                                            const std::vector<ContactId>& /*zeros*/,
                                                            const ZeroGaps& /*touching*/) const {
        return std::nullopt;
    }
    /// From now on the load is meant as it is stored.
    virtual void load_is_stored() const {}
    /// The results at an equilibrium go with its record and its state.
    virtual void store(const Vertex<Dim>& /*vertex*/, EquilibriumRecord<Dim>& /*record*/) const {}
};

/// By `options.ties`. The state must outlive it.
template <int Dim> std::unique_ptr<const TieSettling<Dim>> tie_settling(State<Dim>& state, const RunOptions& options);

extern template std::unique_ptr<const TieSettling<2>> tie_settling<2>(State<2>&, const RunOptions&);

} // namespace isostat
