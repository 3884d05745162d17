#pragma once
/// \file
/// Newton steps for soft disks in a box under isotropic pressure: for
/// packings so large that damped dynamics would relax them too slowly.

#include "preparation/clique_matrix.hpp"
#include "preparation/soft.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <atomic>
#include <functional>
#include <optional>
#include <vector>

namespace isostat::preparation {

/// Minimises E = sum of overlap^2 / 2 + pressure x volume over disks and walls, in the units of `SoftDynamics`.
///
/// Steps -(sum n n^T + lambda)^-1 grad E: the second derivative without its negative part, which is of the order of the
/// overlaps, and with a damping that follows from the steps (K. Levenberg, Quart. Appl. Math. 2, 164 (1944)); then a
/// search for a point with a small slope of E (its slope: values of E differ by less than their rounding). That E falls
/// is not checked: this affects how far the packing relaxes, and nothing that is reported.
///
/// Why: one sample of 100 000 disks keeps losing energy for 340 000 steps of the dynamics at the pressure 1e-5, and the
/// interior descent from there does not end in 500 steps; after relaxations at 1e-5 to 1e-7 it ends after 385.
class SoftNewton {
  public:
    /// Takes the packing as it is, with the overlaps that it needs; keeps the packing up to date.
    SoftNewton(Packing& packing, const std::atomic<bool>* stop);

    /// Relaxes until residual (largest unbalanced force) and pressure error are below
    /// `tolerance`. The damping is kept between calls. Cost of a step: a factorisation
    /// and about 5 sums over the pairs, 0.25 s for 100 000 disks on two cores.
    SoftMeasures relax(double pressure, double tolerance, long max_steps, const std::function<void(double)>& progress);

  private:
    void collect();
    void evaluate();
    [[nodiscard]] bool left_the_list() const;
    /// The gradient of E, per coordinate.
    void gradient(double pressure, std::vector<double>& slope) const;
    [[nodiscard]] SoftMeasures measure(double pressure, const std::vector<double>& slope) const;
    bool direction(const std::vector<double>& slope, std::vector<double>& step);
    double search(double pressure, const std::vector<double>& slope, const std::vector<double>& step);
    [[nodiscard]] bool stopped() const { return stop_ != nullptr && stop_->load(std::memory_order_relaxed); }

    Packing& packing_;
    double mean_diameter_ = 0;
    double damping_;
    std::vector<Contact> pairs_; ///< all near pairs, walls included
    std::vector<int> start_, column_;
    std::vector<double> value_, gap_; ///< gradients of the gaps; gaps
    std::vector<double> anchor_;      ///< coordinates when the list was made
    std::optional<CliqueMatrix> matrix_;
    const std::atomic<bool>* stop_;
};

} // namespace isostat::preparation
