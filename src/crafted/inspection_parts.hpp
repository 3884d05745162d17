#pragma once
/// \file
/// The parts of an inspection in exact numbers: what is held, what is jammed, what a load may change by, second order.

#include <isostat/crafted/exact_packing.hpp>
#include <isostat/exact/number.hpp>
#include <isostat/packing/packing.hpp>

#include <functional>

namespace isostat::crafted {

/// Dimension of the common rigid motions of the grains that take part: those that no fixed grain and no wall prevents
/// and that move some grain. For spheres without walls 6, for collinear ones 5, for one 3. Along periodic axes a grain
/// is pinned. `at`: the exact value of a coordinate, unused where walls and periods prevent all motions. Cost O(1),
/// unless the grains are on one line.
int rigid_motions(const Packing& packing, const std::function<bool(int)>& takes_part,
                  const std::function<exact::Number(std::size_t)>& at);

/// Fills `hold` and `carrying` of an inspection whose contacts are set.
void judge_holds(Inspection& inspection, const ExactPacking& packing);

/// \pre every axis is periodic, nothing overlaps; `hold` of `judge_holds` for this packing
Jamming judge_jamming(const ExactPacking& packing, const std::vector<DiskHold>& hold, const InspectionLimits& limits);

/// Ends of {t : f + t change + sum of c_s stresses_s >= 0 for some c}, exact; nothing
/// when this set is empty. Each end is proved by an optimum of the linear programme
/// and of its dual. Contacts of `LoadRange` are set where there are no self-stresses.
std::optional<LoadRange> load_range(const std::vector<Number>& forces, const std::vector<Number>& change,
                                    const std::vector<std::vector<Number>>& stresses);

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
