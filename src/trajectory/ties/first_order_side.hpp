#pragma once
/// \file
/// The first-order part of a run under `ties = "choose"`,
/// whose radii are R_i + eps rho_i. Private to the room.

#include "trajectory/ties/settling.hpp"
#include "trajectory/ties/ties.hpp"

#include <cstdint>

namespace isostat {

/// The first-order part of a run. The state stores what outlives a vertex: rho, and the exact load that is meant.
class FirstOrderSide final : public TieSettling {
  public:
    /// rho is made from `seed` unless the state has it. The state
    /// must outlive this object. `choose`: see `RunOptions::chooses`.
    FirstOrderSide(State& state, std::uint64_t seed, bool choose);

    [[nodiscard]] bool settles() const override { return true; }
    void attach(Vertex& vertex, const LimitLoad& at) const override;
    [[nodiscard]] std::optional<Failure> choose_contacts() const override;
    [[nodiscard]] std::optional<Failure> resume(Vertex& vertex, const ZeroGaps& touching) const override;
    void set_limit(LimitLoad& at, Vertex& vertex, ContactId opens, double error) const override;
    /// The load is the stress at which a force of `zeros` vanishes, where the slope of one is decided; otherwise the
    /// stored stress, at which every other force has to be positive.
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
