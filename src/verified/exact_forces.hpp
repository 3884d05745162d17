#pragma once
// Forces as exact numbers: private to the room.

#include "exact/rational_solver.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/force_solution.hpp"

#include <gmpxx.h>

#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// The scaled system: column l of H times the distance of the centres and times a power of two has integer entries
/// (stored doubles are dyadic), so f_l = unknown_l sqrt(square_l) with a rational unknown and an integer square.
/// Signs are those of the unknowns, ratios of two right-hand sides in one contact are ratios of the unknowns.
class ExactForces {
  public:
    ExactForces(const Packing& packing, const IsostaticStructure& structure);
    /// \pre of the other members
    [[nodiscard]] bool regular() const { return solver_.regular(); }
    /// The unknowns of H f = force, the doubles taken as exact except in the rows of `products`.
    [[nodiscard]] std::vector<mpq_class> solve(const std::vector<double>& force,
                                               std::span<const ExactProduct> products = {}) const;
    [[nodiscard]] const mpz_class& square(ContactId contact) const { return square_[contact.index()]; }

  private:
    static sparse::Matrix<mpz_class> scaled(const Packing& packing, const IsostaticStructure& structure,
                                            std::vector<mpz_class>& square);
    std::vector<mpz_class> square_;
    exact::RationalSolver solver_;
};

} // namespace isostat
