#pragma once
/// \file
/// First order in a change of the radii R_i + eps rho_i (proofs/perturbation.md): ties of forces, and the contacts of a
/// hyperstatic packing that carry the load.

#include "statics/statics.hpp"
#include "verified/first_order.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/statics/rules.hpp>

#include <vector>

namespace isostat {

/// First-order terms of the forces of one vertex, at the present load with
/// the stress sigma + eps sigma1. The arguments must outlive the object.
class PerturbedStatics {
  public:
    /// `stress_rate`: sigma1 (0, radius 0, for a load that was given). `choose`: see `chooses`.
    PerturbedStatics(const FirstOrder& first, Statics& statics, Load load, Enclosure stress_rate, bool choose);

    /// f1 at the present load; {0, 0} for structural zeros. Cost: one solve, once per rung of `statics`.
    [[nodiscard]] Enclosure force(ContactId contact);
    /// f1 at another stress, which does not depend on eps.
    [[nodiscard]] Enclosure force_at(ContactId contact, double sigma, double sigma_error);
    /// sigma1 of the stress at which the force vanishes, sigma its base value: -f1 / slope.
    [[nodiscard]] Enclosure limit_rate(ContactId contact, double sigma, double sigma_error);
    /// Largest finite force, the scale for zeros.
    [[nodiscard]] double size();

    /// Under `ties = "choose"`: where first-order terms do not decide, the rule does (C1).
    [[nodiscard]] bool chooses() const { return choose_; }

    std::vector<TieDecision> log; ///< the settled ties, in order; whoever writes records takes them

  private:
    [[nodiscard]] std::vector<Enclosure> terms(double sigma, double sigma_error) const;

    const FirstOrder* first_;
    Statics* statics_;
    Load load_;
    Enclosure stress_rate_;
    bool choose_;
    std::vector<Enclosure> present_;
    Rung present_rung_ = Rung::none;
    std::vector<Enclosure> elsewhere_;
    double elsewhere_sigma_ = 0;
    double elsewhere_error_ = -1;
    double size_ = 0;
};

/// Among the contacts of a packing with more contacts than degrees of freedom, the N_f that stay closed in equilibrium
/// when the radii become R_i + eps rho_i, eps > 0 small: the basis of the linear programme of P2
/// (proofs/perturbation.md), maximise F.v with all first-order gaps >= 0, ties broken by the infinitesimal loads.
/// Clp, double: a proposal, not a proof. The caller must prove the signs of all forces and of the first-order gaps of
/// the other contacts, which make the proposal right. In the order of `contacts`.
/// Failure: `undecided` when Clp finds no support of the load or keeps another number of contacts than N_f (this does
/// not prove that no such contacts exist), `not_converged`.
Result<std::vector<Contact>> first_order_backbone(const Packing& packing, const Load& load,
                                                  const std::vector<Contact>& contacts, const std::vector<double>& rho);

} // namespace isostat
