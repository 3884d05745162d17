#pragma once
/// \file
/// Systems of linear inequalities decided exactly, with a certificate for either answer.

#include <isostat/exact/number.hpp>

#include <vector>

namespace isostat::exact {

/// Answer to: is there z >= 0 with A z = b? Exactly one certificate is filled, and it was checked by substitution.
/// - feasible: `solution` = z;
/// - not feasible: `farkas` = u with u A <= 0 in every column and u b > 0 (Farkas' lemma).
struct Feasibility {
    bool feasible = false;
    std::vector<Number> solution;
    std::vector<Number> farkas;
};

/// `rows[i]` is row i of A (all of size `cols`). First phase of the primal simplex method with Bland's rule (it ends),
/// dense, in exact arithmetic. Cost: pivots * rows * (rows + cols) exact operations; for some ten rows and a hundred
/// columns.
Feasibility feasible_point(const std::vector<std::vector<Number>>& rows, const std::vector<Number>& b, int cols);

/// Signs of the combinations of a few vectors.
enum class OneSign {
    strict,  ///< some combination is > 0 in every component
    partial, ///< not strict, but some combination is >= 0 everywhere and > 0 somewhere
    none     ///< every combination that is not zero has components of both signs
};

/// What the span of `vectors` (all of size `size`) contains; `combination` is such a vector (empty for `none`). An
/// empty list spans 0: none. Gordan's and Stiemke's alternatives, each answer with its certificate checked.
struct OneSignAnswer {
    OneSign kind = OneSign::none;
    std::vector<Number> combination;
};
OneSignAnswer one_sign(const std::vector<std::vector<Number>>& vectors, int size);

} // namespace isostat::exact
