#pragma once
/// \file
/// Contact forces of a vertex as functions of the load, with signs that are proved or undecided.

#include "rigidity/contact_pattern.hpp"
#include "verified/force_ladder.hpp"

#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <memory>
#include <vector>

namespace isostat {

class Statics;

/// Optional knowledge about the vertex for its statics.
struct StaticsHints {
    LadderOptions ladder{};
    /// Every answer is about the enclosed true vertex; null: about the stored configuration (ForceLadder).
    const VertexEnclosure* vertex = nullptr;
    /// Statics of a neighbouring vertex with the contacts in the same slots: its forces are the first guess of the
    /// solves. Not used afterwards.
    const Statics* near = nullptr;
    std::vector<double> forces{}; ///< empty, or a better first guess of the finite parts
};

/// f_l(sigma) = f_l(sigma_0) + (sigma - sigma_0) * unit_l, plus eps * infinitesimal_l, sigma_0 the present loaded
/// stress (paper: alpha_l sigma_1 + beta_l (sigma_2 - sigma_1), unit_l = beta_l), for the exact matrix of the stored
/// configuration and eps > 0 infinitesimal. sigma is the loaded stress (sigma_2). Forces: stress x
/// length; positive in compression.
class Statics {

  public:
    /// Solves for the present load; slopes and infinitesimal parts are solved on first use, because most vertices of a
    /// rearrangement need neither. The arguments must outlive the object. Cost: 2 solves, and 2 for each part used.
    Statics(const Packing& packing, const Load& load, const IsostaticStructure& structure,
            const Factorisation& factorisation, const InverseBound& inverse, StaticsHints hints = {});

    /// Finite part at the loaded stress sigma (taken as exact).
    [[nodiscard]] Enclosure force(ContactId contact, double sigma) const;
    /// df/dsigma.
    [[nodiscard]] Enclosure slope(ContactId contact) const;
    /// Infinitesimal part: decides the sign where the finite part is a structural zero.
    [[nodiscard]] Enclosure infinitesimal(ContactId contact) const;
    /// The finite part vanishes exactly for every load on the same
    /// degrees of freedom (statement T11): the contacts of rattlers.
    [[nodiscard]] bool is_structural_zero(ContactId contact) const { return backbone_[contact.index()] == 0; }
    /// The slope vanishes exactly, so this force does not depend on sigma.
    [[nodiscard]] bool slope_is_zero(ContactId contact) const { return sloped_[contact.index()] == 0; }
    /// The same by the balance of all along an axis besides (T11 (d)): costs a matching, once.
    [[nodiscard]] bool slope_cancels(ContactId contact);
    /// The contacts whose finite forces are no structural zeros.
    [[nodiscard]] std::vector<Contact> carrying() const;

    /// From now on structural zeros are those with radii R_i + eps rho_i. To be called before any other function.
    void perturb_radii();
    /// The exact stress is the stored one plus `shift` (|shift| <= bound): forces at the stored stress, their signs and
    /// their order are from now on those at the exact stress.
    void set_shift(std::shared_ptr<const LoadShift> shift, double bound);
    /// The shift at which the force of a contact vanishes near `sigma`, see `ForceLadder::zero_of`. \pre slope proved.
    [[nodiscard]] std::shared_ptr<const LoadShift> zero_of(ContactId contact, double sigma);
    /// Contacts whose forces vanish at the same load as that of `opens`, for structural reasons (D3), in the order of
    /// their numbers, without `opens` and the structural zeros. \pre slope of `opens` proved not zero.
    [[nodiscard]] std::vector<ContactId> vanish_with(ContactId opens) const;

    /// Goes to the next rung of precision (ForceLadder); false when there is none. Then every enclosure above has the
    /// precision of the new rung.
    bool climb() { return ladder_.climb(); }
    [[nodiscard]] Rung rung() const { return ladder_.rung(); }
    [[nodiscard]] int bits() const { return ladder_.bits(); }

    /// A bound of |H - H*|_2, H of the stored configuration, H* of the configuration that the answers are about.
    [[nodiscard]] double normal_uncertainty() const { return ladder_.normal_uncertainty(); }

    /// Expressions for comparisons: the finite part at sigma, the slope, the infinitesimal part, and the distance to
    /// the limit, force / |slope|. \pre of the last: slope proved not zero.
    [[nodiscard]] ForceExpression force_expression(ContactId contact, double sigma) const;
    [[nodiscard]] ForceExpression slope_expression(ContactId contact) const;
    [[nodiscard]] ForceExpression infinitesimal_expression(ContactId contact) const;
    [[nodiscard]] ForceExpression distance_expression(ContactId contact, double sigma) const;
    /// Sign of a quantity, and of a - b, on the lowest rung from the present one that decides; the object stays on that
    /// rung. Undecided only when the ladder has ended: then `bits` are those of the last rung.
    Order sign(const ForceExpression& a);
    Order compare(const ForceExpression& a, const ForceExpression& b);

    /// Largest magnitude of a force at sigma, and largest bound of the error of one.
    [[nodiscard]] double largest_force(double sigma) const;
    [[nodiscard]] double bound(double sigma) const;
    /// max |H f - F| as computed for the finite part at sigma.
    [[nodiscard]] double residual(double sigma) const;

    [[nodiscard]] const Packing& packing() const { return *packing_; }
    [[nodiscard]] const IsostaticStructure& structure() const { return *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return *factorisation_; }
    [[nodiscard]] const InverseBound& inverse() const { return *inverse_; }
    /// Rows with a finite load at any loaded stress, and rows whose load changes with the loaded stress.
    [[nodiscard]] const std::vector<int>& loaded_rows() const { return loaded_rows_; }
    [[nodiscard]] const std::vector<int>& changing_rows() const { return changing_rows_; }
    /// Finite external force on the degrees of freedom at sigma, and the infinitesimal external force.
    [[nodiscard]] std::vector<double> external_force(double sigma) const;
    [[nodiscard]] const std::vector<double>& infinitesimal_force() const { return ladder_.force(infinitesimal_part); }

  private:
    enum Part : int { present, unit, infinitesimal_part };
    [[nodiscard]] std::vector<double> guess(double sigma) const;
    void find_backbone();

    const Packing* packing_;
    const IsostaticStructure* structure_;
    const Factorisation* factorisation_;
    const InverseBound* inverse_;
    double sigma_;       ///< sigma_0
    ForceLadder ladder_; ///< right-hand sides: at sigma_0, unit, infinitesimal
    std::vector<int> loaded_rows_;
    std::vector<int> changing_rows_;
    std::vector<unsigned char> backbone_;
    ContactPattern pattern_;
    std::shared_ptr<const LoadShift> shift_;
    double shift_bound_ = 0;
    std::vector<unsigned char> sloped_; ///< forces that depend on the loaded stress, by the pattern
    std::vector<unsigned char> sloped_by_sums_;
};

} // namespace isostat
