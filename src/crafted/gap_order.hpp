#pragma once
// Gaps of stored doubles compared exactly with each other and with thresholds.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <memory>

namespace isostat::crafted {

/// Order of the real gaps |x_j - x_i| - (R_i + R_j), x_i - R_i, L - x_i - R_i of one packing. Nothing is rounded: the
/// sign of sqrt(A) - sqrt(B) - c is decided in integers, after a double filter with an error bound.
class GapOrder {
  public:
    /// The packing must outlive the order. \pre finite coordinates and radii
    explicit GapOrder(const Packing& packing);
    ~GapOrder();
    GapOrder(GapOrder&&) noexcept;
    GapOrder& operator=(GapOrder&&) = delete;
    GapOrder(const GapOrder&) = delete;
    GapOrder& operator=(const GapOrder&) = delete;

    /// A candidate with its rounded gap, and a bound of the rounding.
    struct Item {
        Contact contact;
        double gap = 0;
        double error = 0;
    };
    [[nodiscard]] Item item(const Contact& contact) const;

    /// Sign of gap(a) - gap(b).
    [[nodiscard]] int compare(const Item& a, const Item& b) const;
    /// Sign of gap(a) - threshold. \pre finite
    [[nodiscard]] int compare(const Item& a, double threshold) const;
    /// The smallest double that is at least the gap.
    [[nodiscard]] double threshold_of(const Item& a) const;

  private:
    struct Exact;
    const Packing* packing_;
    std::unique_ptr<Exact> exact_;
};

} // namespace isostat::crafted
