#pragma once
/// \file
/// Contact forces of a vertex as functions of the load, with signs that are proved or undecided.

#include <isostat/core/enclosure.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/verified/force_solution.hpp>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// f_l(sigma) = f_l(sigma_0) + (sigma - sigma_0) * unit_l, plus eps * infinitesimal_l, sigma_0 the present loaded
/// stress (paper: alpha_l sigma_1 + beta_l (sigma_2 - sigma_1), unit_l = beta_l), for the exact matrix of the stored
/// configuration and eps > 0 infinitesimal. sigma is the loaded stress (sigma_2). Forces: stress x length; positive in
/// compression.
template <int Dim> class Statics {
  public:
    /// Solves for the present load; the slopes and the infinitesimal parts are solved when they are first asked for
    /// (most vertices of a rearrangement need neither). The arguments must outlive the object. Cost: 2 solves, and 2
    /// for each part asked for.
    Statics(const Packing<Dim>& packing, const Load<Dim>& load, const IsostaticStructure<Dim>& structure,
            const Factorisation& factorisation, const InverseBound& inverse);

    /// Finite part at the loaded stress sigma (taken as exact).
    [[nodiscard]] Enclosure force(ContactId contact, double sigma) const;
    /// df/dsigma.
    [[nodiscard]] Enclosure slope(ContactId contact) const;
    /// Infinitesimal part: decides the sign where the finite part is a structural zero.
    [[nodiscard]] Enclosure infinitesimal(ContactId contact) const;
    /// The finite part vanishes exactly for every load on the same degrees of freedom (statement T11): rattlers'
    /// contacts.
    [[nodiscard]] bool is_structural_zero(ContactId contact) const { return backbone_[contact.index()] == 0; }
    /// The slope vanishes exactly: this force does not depend on sigma.
    [[nodiscard]] bool slope_is_zero(ContactId contact) const;
    /// Contacts whose finite force is not a structural zero.
    [[nodiscard]] int backbone_count() const;

    /// Solves again with residuals in double-double; false when that was done already.
    bool climb();
    [[nodiscard]] Rung rung() const { return rung_; }
    /// Largest bound of the error of a force at sigma.
    [[nodiscard]] double bound(double sigma) const;
    /// max |H f - F| as computed for the finite part at sigma.
    [[nodiscard]] double residual(double sigma) const;

    [[nodiscard]] const IsostaticStructure<Dim>& structure() const { return *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return *factorisation_; }
    [[nodiscard]] const InverseBound& inverse() const { return *inverse_; }
    /// Rows that carry a finite load other than the loaded wall's, and the loaded wall's row (-1: it cannot move).
    [[nodiscard]] const std::vector<int>& loaded_rows() const { return loaded_rows_; }
    [[nodiscard]] int loaded_wall_row() const { return loaded_wall_row_; }
    /// Finite external force on the degrees of freedom at sigma, and the infinitesimal one.
    [[nodiscard]] std::vector<double> external_force(double sigma) const;
    [[nodiscard]] const std::vector<double>& infinitesimal_force() const { return right_hand_side_[2]; }

  private:
    enum Part : std::size_t { present, unit, infinitesimal_part };
    const ForceSolution& solution(Part part) const;

    const Packing<Dim>* packing_;
    const IsostaticStructure<Dim>* structure_;
    const Factorisation* factorisation_;
    const InverseBound* inverse_;
    double sigma_;                                       ///< sigma_0
    std::array<std::vector<double>, 3> right_hand_side_; ///< at sigma_0, unit, infinitesimal
    mutable std::array<std::optional<ForceSolution>, 3> solution_;
    mutable std::optional<ExtendedMatrix> extended_; ///< made by the first climb
    std::vector<int> loaded_rows_;
    int loaded_wall_row_ = -1;
    std::vector<unsigned char> backbone_;
    mutable std::vector<unsigned char> sloped_; ///< empty until asked for
    Rung rung_ = Rung::double_bound;
};

extern template class Statics<2>;

} // namespace isostat
