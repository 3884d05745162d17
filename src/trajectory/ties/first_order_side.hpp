#pragma once
/// \file
/// A run under `ties = "choose"`: what it knows of its radii R_i + eps rho_i besides the base. Private
/// to the room.

#include "trajectory/ties/ties.hpp"

#include <isostat/contact/state.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
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

/// The first-order side of a run. What of it outlives a vertex is in the state: rho, and what its load means.
template <int Dim> class FirstOrderSide {
  public:
    /// rho is made from `seed` unless the state has one. The state must outlive the side. `choose`: see
    /// `RunOptions::chooses`.
    FirstOrderSide(State<Dim>& state, std::uint64_t seed, bool choose);

    /// Gives a vertex its first-order terms. Before any question to its statics.
    void attach(Vertex<Dim>& vertex, const LimitLoad<Dim>& at) const;
    /// Of the contacts of a hyperstatic start, those that carry the load for small eps > 0.
    [[nodiscard]] std::optional<Failure> choose_contacts() const;
    /// The load of an equilibrium that was reached at a limit: the stored stress, when every force is positive there as
    /// at the exact one; otherwise the stress at which one of the forces that vanish (`zeros`) does so.
    [[nodiscard]] std::optional<Failure> settle_load(Vertex<Dim>& vertex, const LimitLoad<Dim>& limit,
                                                     const std::vector<ContactId>& zeros) const;
    /// From now on the load is meant as it is stored.
    void load_is_stored() const;
    /// At a start: the load that its state means, and the pairs that touch.
    [[nodiscard]] std::optional<Failure> resume(Vertex<Dim>& vertex, const ZeroGaps& touching) const;
    /// The results at an equilibrium go with its state.
    void store(const Vertex<Dim>& vertex) const;

  private:
    State<Dim>& state_;
    bool choose_;
};

extern template class FirstOrderSide<2>;

} // namespace isostat
