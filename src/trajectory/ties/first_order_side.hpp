#pragma once
/// \file
/// A run under `ties = "choose"`: what it knows of its radii R_i + eps rho_i besides the base. Private
/// to the room.

#include "trajectory/ties/settling.hpp"
#include "trajectory/ties/ties.hpp"

#include <cstdint>

namespace isostat {

/// The first-order side of a run. What of it outlives a vertex is in the state: rho, and what its load means.
class FirstOrderSide final : public TieSettling {
  public:
    /// rho is made from `seed` unless the state has one. The state must outlive the side. `choose`: see
    /// `RunOptions::chooses`.
    FirstOrderSide(State& state, std::uint64_t seed, bool choose);

    [[nodiscard]] bool settles() const override { return true; }
    void attach(Vertex& vertex, const LimitLoad& at) const override;
    [[nodiscard]] std::optional<Failure> choose_contacts() const override;
    [[nodiscard]] std::optional<Failure> resume(Vertex& vertex, const ZeroGaps& touching) const override;
    void set_limit(LimitLoad& at, Vertex& vertex, ContactId opens, double error) const override;
    /// The load is the stored stress, when every force is positive there as at the exact one; otherwise the stress at
    /// which one of the forces that vanish does so.
    [[nodiscard]] std::optional<Failure> settle_end(Vertex& vertex, const LimitLoad& limit,
                                                    const std::vector<ContactId>& zeros,
                                                    const ZeroGaps& touching) const override;
    void load_is_stored() const override;
    void store(const Vertex& vertex, EquilibriumRecord& record) const override;

  private:
    [[nodiscard]] std::optional<Failure> settle_load(Vertex& vertex, const LimitLoad& limit,
                                                     const std::vector<ContactId>& zeros) const;

    State& state_;
    bool choose_;
};

} // namespace isostat
