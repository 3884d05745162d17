#pragma once
/// \file
/// The contacts of a hyperstatic packing that carry the load when the radii change a little.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/load.hpp>

#include <vector>

namespace isostat {

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
