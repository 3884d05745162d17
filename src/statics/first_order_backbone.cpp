#include "contact/separation.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "core/work.hpp"
#include "statics/perturbed.hpp"

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

namespace isostat {

namespace {

/// Weight of the infinitesimal loads: small against the forces, large against Clp's dual tolerance.
// guess: a weight of a linear programme, whose answer is proved afterwards
constexpr double infinitesimal_weight = 1e-5;
constexpr double tolerance = 1e-9; // guess: a tolerance of Clp, whose answer is proved afterwards

double scale_of(const std::vector<double>& x) {
    const double size = largest(x);
    return size > 0 ? size : 1;
}

/// The programme: variables are the velocities of the degrees of freedom, a row per contact says that its first-order
/// gap is not negative.
void load_programme(ClpSimplex& simplex, const Packing& packing, const DofMap& dofs, const Load& load,
                    const std::vector<Contact>& contacts, const std::vector<double>& rho) {
    const std::vector<double> force = load.external_force(packing);
    const double force_size = scale_of(force);
    const double small_size = scale_of(load.infinitesimal) / infinitesimal_weight;
    const double rho_size = scale_of(rho);
    const auto columns = static_cast<std::size_t>(dofs.dof_count());
    std::vector<double> cost(columns, 0.0);
    for (std::size_t mu = 0; mu < columns; ++mu) {
        const std::size_t k = dofs.coordinate_of(mu);
        cost[mu] = -(force[k] / force_size + (k < load.infinitesimal.size() ? load.infinitesimal[k] / small_size : 0));
    }
    std::vector<int> row;
    std::vector<int> column;
    std::vector<double> value;
    std::vector<double> lower; // gradient . v >= rho_i + rho_j
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        gap_gradient(packing, c).for_each_dof(dofs, [&](std::size_t dof, double component) {
            row.push_back(static_cast<int>(l));
            column.push_back(static_cast<int>(dof));
            value.push_back(component);
        });
        lower.push_back(touching_distance(rho, c) / rho_size);
    }
    const std::vector<double> free_low(columns, -COIN_DBL_MAX);
    const std::vector<double> free_high(columns, COIN_DBL_MAX);
    CoinPackedMatrix matrix(true, row.data(), column.data(), value.data(), static_cast<CoinBigIndex>(row.size()));
    matrix.setDimensions(static_cast<int>(contacts.size()), static_cast<int>(columns));
    simplex.setLogLevel(0);
    simplex.loadProblem(matrix, free_low.data(), free_high.data(), cost.data(), lower.data(), nullptr);
}

} // namespace

Result<std::vector<Contact>> first_order_backbone(const Packing& packing, const Load& load,
                                                  const std::vector<Contact>& contacts,
                                                  const std::vector<double>& rho) {
    const DofMap dofs(packing);
    ClpSimplex simplex;
    load_programme(simplex, packing, dofs, load, contacts, rho);
    simplex.setPrimalTolerance(tolerance);
    simplex.setDualTolerance(tolerance);
    // guess: an option of Clp, whose answer is proved afterwards
    simplex.setPerturbation(100); // no perturbation: the basis is the result
    count_work(Work::linear_programmes);
    simplex.primal();
    if (simplex.status() == 2) {
        return Failure{FailureKind::undecided, "no support of the load by these contacts was found (a linear programme "
                                               "in double precision, not a proof that there is none)"};
    }
    if (simplex.status() != 0) {
        return failed(FailureKind::not_converged, "the linear programme of the perturbed start ended with status {}",
                      simplex.status());
    }
    std::vector<Contact> kept;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (simplex.getRowStatus(static_cast<int>(l)) != ClpSimplex::basic) {
            kept.push_back(contacts[l]);
        }
    }
    if (static_cast<int>(kept.size()) != dofs.dof_count()) {
        return failed(FailureKind::undecided,
                      "the linear programme of the perturbed start kept {} of {} contacts, expected N_f = "
                      "{}: no isostatic choice was found (there may be mechanisms)",
                      kept.size(), contacts.size(), dofs.dof_count());
    }
    return kept;
}

} // namespace isostat
