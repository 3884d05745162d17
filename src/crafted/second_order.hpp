#pragma once
// Second-order quantities of mechanisms.

#include <isostat/crafted/exact_packing.hpp>

namespace isostat::crafted {

/// Numbers of positive, negative and zero squares of a quadratic form.
struct Inertia {
    int positive = 0, negative = 0, zero = 0;
};

/// Computed by congruence in the field, exactly.
Inertia inertia(std::vector<std::vector<Number>> symmetric);

/// Q_ab = sum over disk-disk contacts of f_l (dv_a . dv_b) / (R_i + R_j), dv = relative velocity: the work of forces f
/// on the second-order opening of the motions (their relative velocities are tangential). Rigid motions are in its
/// kernel when f is a self-stress.
std::vector<std::vector<Number>> stress_form(const ExactPacking& packing, const DofMap& dofs,
                                             const std::vector<Contact>& contacts, const std::vector<Number>& forces,
                                             const std::vector<std::vector<Number>>& motions);

/// Sets `second_order`. \pre bases_exact is proved
SecondOrder second_order_test(const Inspection& inspection, const ExactPacking& packing, const DofMap& dofs);

} // namespace isostat::crafted
