#pragma once
/// \file
/// A run under `ties = "choose"`: what it knows of its radii R_i + eps rho_i besides the base. Private
/// to the room.

#include "trajectory/ties/settling.hpp"
#include "trajectory/ties/ties.hpp"

#include <cstdint>

namespace isostat {

/// The first-order side of a run. What of it outlives a vertex is in the state: rho, and what its load means.
template <int Dim> class FirstOrderSide final : public TieSettling<Dim> {
  public:
    /// rho is made from `seed` unless the state has one. The state must outlive the side. `choose`: see
    /// `RunOptions::chooses`.
    FirstOrderSide(State<Dim>& state, std::uint64_t seed, bool choose);

    [[nodiscard]] bool settles() const override { return true; }
    void attach(Vertex<Dim>& vertex, const LimitLoad<Dim>& at) const override;
    [[nodiscard]] std::optional<Failure> choose_contacts() const override;
    [[nodiscard]] std::optional<Failure> resume(Vertex<Dim>& vertex, const ZeroGaps& touching) const override;
    void set_limit(LimitLoad<Dim>& at, Vertex<Dim>& vertex, ContactId opens, double error) const override;
    /// The load is the stored stress, when every force is positive there as at the exact one; otherwise the stress at
    /// which one of the forces that vanish does so.
    [[nodiscard]] std::optional<Failure> settle_end(Vertex<Dim>& vertex, const LimitLoad<Dim>& limit,
                                                    const std::vector<ContactId>& zeros,
                                                    const ZeroGaps& touching) const override;
    void load_is_stored() const override;
    void store(const Vertex<Dim>& vertex, EquilibriumRecord<Dim>& record) const override;

  private:
    [[nodiscard]] std::optional<Failure> settle_load(Vertex<Dim>& vertex, const LimitLoad<Dim>& limit,
                                                     const std::vector<ContactId>& zeros) const;

    State<Dim>& state_;
    bool choose_;
};

extern template class FirstOrderSide<2>;

} // namespace isostat
