#include "preparation/force_face.hpp"

#include "core/dot.hpp"
#include "core/work.hpp"
#include "linear/factorisation.hpp"

#include <ClpSimplex.hpp>
#include <CoinPackedMatrix.hpp>

#include <cmath>

namespace isostat {

namespace {

/// Balance: the forces of the pairs on every degree of freedom equal minus the load, in units of the largest load.
void load_balance(ClpSimplex& simplex, const Packing& packing, const std::vector<Contact>& pairs,
                  const std::vector<double>& force, double size) {
    const DofMap dofs(packing);
    std::vector<int> row;
    std::vector<int> column;
    std::vector<double> value;
    for (std::size_t l = 0; l < pairs.size(); ++l) {
        gap_gradient(packing, pairs[l]).for_each_dof(dofs, [&](std::size_t dof, double push) {
            row.push_back(static_cast<int>(dof));
            column.push_back(static_cast<int>(l));
            value.push_back(push);
        });
    }
    std::vector<double> balance(static_cast<std::size_t>(dofs.dof_count()));
    for (std::size_t mu = 0; mu < balance.size(); ++mu) {
        balance[mu] = -force[dofs.coordinate_of(mu)] / size;
    }
    CoinPackedMatrix matrix(true, row.data(), column.data(), value.data(), static_cast<CoinBigIndex>(row.size()));
    matrix.setDimensions(dofs.dof_count(), static_cast<int>(pairs.size()));
    simplex.setLogLevel(0);
    simplex.loadProblem(matrix, nullptr, nullptr, nullptr, balance.data(), balance.data());
}

/// The end of the face in one direction of one force, from the last basis; false when Clp finds no optimum.
bool goes_to_end(ClpSimplex& simplex, int pair, double direction, double& end) {
    simplex.setObjectiveCoefficient(pair, -direction);
    count_work(Work::linear_programmes);
    simplex.primal();
    simplex.setObjectiveCoefficient(pair, 0);
    end = simplex.primalColumnSolution()[pair];
    return simplex.status() == 0;
}

/// The least and the largest value of every force, from a simplex at any point of the face.
bool find_ends(ClpSimplex& simplex, const std::vector<unsigned char>& varies, double size, ForceFace& face) {
    bool ended = true;
    for (std::size_t l = 0; l < varies.size() && ended; ++l) {
        double least = simplex.primalColumnSolution()[l]; // the only value when the force does not vary
        double most = least;
        if (varies[l] != 0) {
            const int pair = static_cast<int>(l);
            ended = goes_to_end(simplex, pair, -1, least) && goes_to_end(simplex, pair, +1, most);
        }
        face.least.push_back(least * size);
        face.most.push_back(most * size);
    }
    return ended;
}

} // namespace

Result<ForceFace> force_face(const Packing& packing, const Load& load, const std::vector<Contact>& contacts,
                             const std::vector<Contact>& touching) {
    auto structure = IsostaticStructure::prove(packing, contacts);
    if (!structure.ok()) {
        return structure.failure();
    }
    const Factorisation factorisation(structure.value());
    ForceFace face;
    face.pairs = structure.value().contacts();
    face.pairs.insert(face.pairs.end(), touching.begin(), touching.end());
    std::vector<unsigned char> varies(face.pairs.size(), 0);
    for (std::size_t m = 0; m < touching.size(); ++m) {
        std::vector<double> change(contacts.size(), 0.0); // column of H: minus the gradient of the gap
        gap_gradient(packing, touching[m]).for_each_dof(structure.value().dofs(), [&](std::size_t dof, double push) {
            change[dof] += push;
        });
        factorisation.solve_forces(change);
        change.resize(face.pairs.size(), 0.0);
        change[contacts.size() + m] = 1;
        for (std::size_t l = 0; l < change.size(); ++l) {
            constexpr double rounding = 1e-12; // of forces of order 1
            change[l] = std::abs(change[l]) > rounding ? change[l] : 0;
            varies[l] = varies[l] != 0 || change[l] != 0 ? 1 : 0;
        }
        face.self_stresses.push_back(std::move(change));
    }
    const std::vector<double> force = load.external_force(packing);
    const double size = largest(force) > 0 ? largest(force) : 1;
    ClpSimplex simplex;
    load_balance(simplex, packing, face.pairs, force, size);
    simplex.primal();
    if (simplex.status() != 0 || !find_ends(simplex, varies, size, face)) {
        return Failure{
            FailureKind::undecided,
            "no forces >= 0 of the pairs that touch were found to balance the load, or no end of them (linear "
            "programmes in double precision, not a proof that there are none)"};
    }
    return face;
}

} // namespace isostat
