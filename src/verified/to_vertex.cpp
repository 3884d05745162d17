#include "verified/to_vertex.hpp"

#include "contact/words.hpp"
#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

double largest_gap(const Packing& packing, const std::vector<Contact>& contacts) {
    double largest = 0;
    for (const Contact& contact : contacts) {
        largest = std::max(largest, std::abs(gap(packing, contact)));
    }
    return largest;
}

/// For a cell that keeps its shape, where the last period is a degree of freedom and the rest of the cell follows.
/// `step` moves the degrees of freedom while the rest is at rest. When the rest is stretched by beta the step is step +
/// beta * answer, and beta is the stretch of the last period.
void keep_shape(Packing& packing, const std::vector<Contact>& contacts, const Factorisation& factorisation,
                std::vector<double>& step) {
    const std::size_t first = packing.length_at(0);
    const std::size_t leads = packing.length_at(packing.axes() - 1);
    std::vector<double> answer(contacts.size(), 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        gap_gradient(packing, contacts[l]).for_each([&](std::size_t k, double value) {
            answer[l] += k >= first && k != leads ? value * packing.q[k] : 0;
        });
    }
    factorisation.solve_velocities(answer);
    const double beta = step.back() / (packing.q[leads] - answer.back()); // the cell has no other degree of freedom
    for (std::size_t mu = 0; mu < step.size(); ++mu) {
        step[mu] += beta * answer[mu];
    }
    for (std::size_t k = first; k < packing.q.size(); ++k) {
        packing.q[k] *= k == leads ? 1 : 1 + beta;
    }
}

/// Takes one step; fails when the matrix is not proved regular.
std::optional<Failure> newton_step(Packing& packing, const std::vector<Contact>& contacts) {
    const auto structure = IsostaticStructure::prove(packing, contacts);
    if (!structure.ok()) {
        return structure.failure();
    }
    const Factorisation factorisation(structure.value());
    std::vector<double> step(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        step[l] = gap(packing, contacts[l]); // each gap is to be closed
    }
    factorisation.solve_velocities(step);
    if (packing.cell.keeps_shape) {
        keep_shape(packing, contacts, factorisation, step);
    }
    structure.value().dofs().move(packing.q, step);
    return std::nullopt;
}

} // namespace

std::optional<Failure> to_vertex(Packing& packing, const std::vector<Contact>& contacts, long& steps, double reach) {
    constexpr int max_steps = 30; // guess: when Newton stops
    Packing here = packing;
    double before = largest_gap(here, contacts);
    for (int k = 0; !(before <= grid_step(here)) || k == 0; ++k) {
        if (k == max_steps) {
            return failed(FailureKind::not_converged, "Newton on the gaps: still {:.3g} after {} steps", before, k);
        }
        Packing next = here;
        if (auto failure = newton_step(next, contacts)) {
            return failure;
        }
        ++steps;
        const double now = largest_gap(next, contacts);
        if (!(now < before)) {
            // Gaps of a few grid steps are at the level of rounding; larger gaps mean that the start was too far.
            if (before <= 64 * grid_step(here)) { // guess: when Newton stops
                break;
            }
            return failed(FailureKind::not_converged, "Newton on the gaps stopped at {:.3g} after {} steps", before,
                          k + 1);
        }
        for (std::size_t c = 0; c < next.q.size(); ++c) {
            if (const double moved = std::abs(next.q[c] - packing.q[c]); !(moved <= reach)) {
                return failed(FailureKind::not_converged,
                              "Newton's method on the gaps moves a coordinate by {:.3g}: expected at most {:.3g}",
                              moved, reach);
            }
        }
        here = std::move(next);
        before = now;
    }
    packing = std::move(here);
    return std::nullopt;
}

} // namespace isostat
