#include "contact/candidates.hpp"
#include "contact/other_pairs.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "preparation/polish.hpp"
#include "statics/quotient.hpp"
#include "statics/statics.hpp"
#include "verified/configuration.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace isostat::preparation {

namespace {

/// Entries of an exchange below this share of the largest entry are not pivots, because the next matrix would be so
/// badly conditioned that Newton leaves the neighbourhood (seen at 1e-9, for lattices perturbed by 1e-9).
constexpr double smallest_pivot = 1e-6;
constexpr int most_pivots = 1000;

/// Force of a contact for comparisons: the finite part, then the infinitesimal part.
using Force = std::pair<double, double>;

/// How the signs of gaps and forces are found.
enum class Signs {
    as_computed, ///< mostly right beyond their bounds too: radii that differ by 1e-13 are told apart
    told,        ///< a value within its bound of 0 counts as 0: in symmetric patches pairs touch without being
                 ///< contacts and forces vanish together, and rounding there would exchange contacts for ever
};

double value_of(const Enclosure& x, Signs signs) {
    return signs == Signs::as_computed || x.positive() || x.negative() ? x.value : 0.0;
}

/// One basis: sorted contacts, and a configuration at which their gaps are 0 to rounding.
class Basis {
  public:
    Basis(const ProvedStructure& at, const Load& load, Signs signs)
        : at_(at), load_(final_load(load, at.packing)),
          vertex_(enclose_vertex_double_double(at.packing, at.structure, at.factorisation, at.inverse)),
          statics_(at.packing, load_, at.structure, at.factorisation, at.inverse) {
        statics_.climb();
        others_ = without(find_candidates(at.packing, pivot_reach).contacts, contacts(), at.packing.disk_count());
        for (const Contact& other : others_) {
            gaps_.push_back(value_of(gap_at_vertex(at.packing, vertex_, other), signs));
        }
        const double sigma = load_.loaded_stress();
        for (std::size_t l = 0; l < contacts().size(); ++l) {
            const ContactId id(l);
            if (!contacts()[l].is_unilateral()) {
                forces_.emplace_back(std::numeric_limits<double>::infinity(), 0); // a bar never opens
                continue;
            }
            forces_.emplace_back(statics_.is_structural_zero(id) ? 0.0 : value_of(statics_.force(id, sigma), signs),
                                 value_of(statics_.infinitesimal(id), signs));
        }
    }

    /// Whether the gaps and forces have proved bounds.
    [[nodiscard]] bool known() const {
        return at_.inverse.verdict == Verdict::proved && vertex_.verdict == Verdict::proved;
    }

    /// The other pair with the most negative gap.
    [[nodiscard]] std::optional<std::size_t> overlapping() const {
        const auto least = std::ranges::min_element(gaps_);
        return least != gaps_.end() && *least < 0 ? std::optional(static_cast<std::size_t>(least - gaps_.begin()))
                                                  : std::nullopt;
    }

    /// The contact with the most negative force.
    [[nodiscard]] std::optional<std::size_t> pulling() const {
        const auto least = std::ranges::min_element(forces_);
        return least != forces_.end() && *least < Force(0, 0)
                   ? std::optional(static_cast<std::size_t>(least - forces_.begin()))
                   : std::nullopt;
    }

    /// Row m = sum of a_l rows l: as the force of m grows, f_l - a_l f_m reaches 0 first for the returned contact l.
    [[nodiscard]] std::optional<std::size_t> leaving(std::size_t other) const {
        std::vector<double> a(contacts().size(), 0.0);
        gap_gradient(at_.packing, others_[other])
            .for_each_dof(at_.structure.dofs(), [&](std::size_t dof, double value) { a[dof] = -value; });
        at_.factorisation.solve_forces(a);
        const double least = smallest_pivot * largest(a);
        std::optional<std::size_t> first;
        Force ratio;
        for (std::size_t l = 0; l < a.size(); ++l) {
            if (a[l] > least) {
                const Force f = std::max(forces_[l], Force(0, 0));
                const Force r(f.first / a[l], f.second / a[l]);
                if (!first || r < ratio) {
                    first = l;
                    ratio = r;
                }
            }
        }
        return first;
    }

    /// Velocity that opens contact l at unit rate, and the gap that this velocity closes first.
    struct Motion {
        std::vector<double> velocity; ///< on the degrees of freedom
        std::optional<Vanishing> entering;
    };
    [[nodiscard]] Motion open(std::size_t l) const {
        Motion out;
        out.velocity.assign(contacts().size(), 0.0);
        out.velocity[l] = -1; // a negative approach velocity
        at_.factorisation.solve_velocities(out.velocity);
        const double least = smallest_pivot * largest(out.velocity);
        const auto rate = [&](std::size_t m) {
            double sum = 0;
            gap_gradient(at_.packing, others_[m])
                .for_each_dof(at_.structure.dofs(),
                              [&](std::size_t dof, double value) { sum += value * out.velocity[dof]; });
            return sum < -least ? sum : 0.0;
        };
        out.entering = first_to_vanish(
            others_.size(), [this](std::size_t m) { return gaps_[m]; }, rate);
        return out;
    }

    [[nodiscard]] const std::vector<Contact>& contacts() const { return at_.structure.contacts(); }
    [[nodiscard]] const Contact& other(std::size_t m) const { return others_[m]; }

  private:
    static Load final_load(Load load, const Packing& packing) {
        load.refer_to(packing);
        return load;
    }

    const ProvedStructure& at_;
    Load load_;
    VertexEnclosure vertex_;
    Statics statics_;
    std::vector<Contact> others_;
    std::vector<double> gaps_;  ///< of `others_`
    std::vector<Force> forces_; ///< of the contacts
};

/// The proved vertex, or a failure that leaves the state to another proof as `candidate`.
Result<Polished> end_at(Packing packing, std::vector<Contact> contacts, const Load& load, long& iterations,
                        std::optional<State>& candidate) {
    auto polished = polish(packing, contacts, load, iterations);
    const bool open = !polished.ok() && (polished.failure().kind == FailureKind::undecided ||
                                         polished.failure().kind == FailureKind::tie);
    if (open) {
        candidate.emplace();
        candidate->load = load;
        candidate->load.refer_to(packing);
        candidate->packing = std::move(packing);
        candidate->contacts = std::move(contacts);
    }
    return polished;
}

Result<Polished> pivot(Packing packing, std::vector<Contact> contacts, const Load& load, const PivotLimits& limits,
                       Signs signs, long& iterations, std::optional<State>& candidate) {
    bool may_replace = signs == Signs::told;
    std::set<std::vector<Contact>> seen;
    for (int pivot = 0; pivot < most_pivots; ++pivot) {
        if (limits.stop != nullptr && limits.stop->load(std::memory_order_relaxed)) {
            return failed(FailureKind::interrupted, "stopped after {} pivots", pivot);
        }
        std::ranges::sort(contacts);
        if (signs == Signs::as_computed && !seen.insert(contacts).second) {
            return failed(FailureKind::not_converged, "after {} pivots the contacts are those of before", pivot);
        }
        const auto at = centre_at_vertex(packing, contacts, iterations);
        if (!at.ok()) {
            return at.failure();
        }
        const Basis basis(*at.value(), load, signs);
        const auto overlapping = basis.overlapping();
        const auto pulling = basis.pulling();
        if (!basis.known() && may_replace) { // the contacts are nearly dependent; other touching pairs are better
            may_replace = false;
            if (auto others = best_conditioned(packing)) {
                contacts = std::move(*others);
                continue;
            }
        }
        if (!basis.known() || (!overlapping && !pulling)) {
            return end_at(std::move(packing), std::move(contacts), load, iterations, candidate);
        }
        if (overlapping) {
            const auto leaving = basis.leaving(*overlapping);
            if (!leaving) {
                return failed(FailureKind::overlap, "{} cannot be parted", named(basis.other(*overlapping)));
            }
            contacts[*leaving] = basis.other(*overlapping);
            continue;
        }
        const auto motion = basis.open(*pulling);
        if (!motion.entering) {
            return failed(FailureKind::unbounded, "opening {} closes no gap", named(contacts[*pulling]));
        }
        const double time = motion.entering->distance;
        if (time * largest(motion.velocity) > limits.step) {
            return failed(FailureKind::not_converged, "opening {} moves farther ({:.3g}) than linear gaps hold",
                          named(contacts[*pulling]), time * largest(motion.velocity));
        }
        for (std::size_t mu = 0; mu < motion.velocity.size(); ++mu) {
            packing.q[at.value()->structure.dofs().coordinate_of(mu)] += time * motion.velocity[mu];
        }
        contacts[*pulling] = basis.other(motion.entering->index);
    }
    return failed(FailureKind::not_converged, "no vertex after {} pivots", most_pivots);
}

} // namespace

Result<Polished> pivot_to_vertex(const Packing& packing, const std::vector<Contact>& contacts, const Load& load,
                                 const PivotLimits& limits, long& iterations, std::optional<State>& candidate) {
    auto first = pivot(packing, contacts, load, limits, Signs::as_computed, iterations, candidate);
    if (first.ok() || first.failure().kind == FailureKind::interrupted) {
        return first;
    }
    std::optional<State> other;
    auto second = pivot(packing, contacts, load, limits, Signs::told, iterations, other);
    const bool better = second.ok() || other.has_value();
    if (better) {
        candidate = std::move(other);
    }
    return better ? second : first;
}

} // namespace isostat::preparation
