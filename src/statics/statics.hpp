#pragma once
/// \file
/// Contact forces of a vertex as functions of the load, with signs that are proved or undecided.

#include "rigidity/contact_pattern.hpp"
#include "verified/force_ladder.hpp"

#include <isostat/core/result.hpp>
#include <isostat/core/verdict.hpp>
#include <isostat/packing/load.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

class Statics;

/// What the statics of a vertex may be told besides.
struct StaticsHints {
    LadderOptions ladder{};
    /// Every answer is about the true vertex that it encloses; null: about the stored configuration (ForceLadder).
    const VertexEnclosure* vertex = nullptr;
    /// Of a neighbouring vertex with the contacts in the same places: its forces are where the solves start. Not used
    /// afterwards.
    const Statics* near = nullptr;
    std::vector<double> forces{}; ///< empty, or a better guess of the finite parts
};

/// f_l(sigma) = f_l(sigma_0) + (sigma - sigma_0) * unit_l, plus eps * infinitesimal_l, sigma_0 the present loaded
/// stress (paper: alpha_l sigma_1 + beta_l (sigma_2 - sigma_1), unit_l = beta_l), for the exact matrix of the stored
/// configuration and eps > 0 infinitesimal. sigma is the loaded stress (sigma_2). Forces: stress x length; positive in
/// compression.
class Statics {

  public:
    /// Solves for the present load; the slopes and the infinitesimal parts are solved when they are first asked for
    /// (most vertices of a rearrangement need neither). The arguments must outlive the object. Cost: 2 solves, and 2
    /// for each part asked for.
    Statics(const Packing& packing, const Load& load, const IsostaticStructure& structure,
            const Factorisation& factorisation, const InverseBound& inverse, StaticsHints hints = {});

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

    /// From now on structural zeros are those of grains with radii R_i + eps rho_i. Before the first question.
    void perturb_radii();
    /// The load that is meant is not the stored stress but `shift` more (|shift| <= bound): forces at the stored
    /// stress, their signs and their order are those at the exact one.
    void set_shift(std::shared_ptr<const LoadShift> shift, double bound);
    /// The shift at which the force of a contact vanishes near `sigma`, see `ForceLadder::zero_of`. \pre slope proved.
    [[nodiscard]] std::shared_ptr<const LoadShift> zero_of(ContactId contact, double sigma);
    /// Contacts whose forces vanish at the same load as that of `opens`, for structural reasons (D3), in the order of
    /// their numbers, without `opens` and the structural zeros. \pre slope of `opens` proved not zero.
    [[nodiscard]] std::vector<ContactId> vanish_with(ContactId opens) const;

    /// Goes to the next rung of precision (ForceLadder); false when there is none. Every enclosure above is then the
    /// better one.
    bool climb() { return ladder_.climb(); }
    [[nodiscard]] Rung rung() const { return ladder_.rung(); }
    [[nodiscard]] int bits() const { return ladder_.bits(); }

    /// A bound of |H - H*|_2, H of the stored configuration, H* of the one that is spoken of.
    [[nodiscard]] double normal_uncertainty() const { return ladder_.normal_uncertainty(); }

    /// The same quantities for comparisons: the finite part at sigma, the slope, the infinitesimal part, and what is
    /// left of the way to the limit, force / |slope|. \pre of the last: slope proved not zero.
    [[nodiscard]] ForceExpression force_expression(ContactId contact, double sigma) const;
    [[nodiscard]] ForceExpression slope_expression(ContactId contact) const;
    [[nodiscard]] ForceExpression infinitesimal_expression(ContactId contact) const;
    [[nodiscard]] ForceExpression distance_expression(ContactId contact, double sigma) const;
    /// Sign of a quantity, and of a - b, on the lowest rung from the present one that decides it; the object stays
    /// there. Undecided only when the ladder has ended: then `bits` are those of the last rung.
    Order sign(const ForceExpression& a);
    Order compare(const ForceExpression& a, const ForceExpression& b);

    /// Largest bound of the error of a force at sigma.
    [[nodiscard]] double bound(double sigma) const;
    /// max |H f - F| as computed for the finite part at sigma.
    [[nodiscard]] double residual(double sigma) const;

    [[nodiscard]] const IsostaticStructure& structure() const { return *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return *factorisation_; }
    [[nodiscard]] const InverseBound& inverse() const { return *inverse_; }
    /// Rows that carry a finite load whatever the loaded stress is, and those that this presses on.
    [[nodiscard]] const std::vector<int>& loaded_rows() const { return loaded_rows_; }
    [[nodiscard]] const std::vector<int>& changing_rows() const { return changing_rows_; }
    /// Finite external force on the degrees of freedom at sigma, and the infinitesimal one.
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
    std::vector<unsigned char> sloped_; ///< what the loaded stress can reach
};

} // namespace isostat
