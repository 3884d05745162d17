#include "trajectory/plain.hpp"

#include <isostat/core/threads.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

template <int Dim> std::vector<double> on_dofs(const std::vector<double>& on_coordinates, const DofMap<Dim>& dofs) {
    std::vector<double> force(static_cast<std::size_t>(dofs.dof_count()), 0.0);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        const auto k = static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)));
        force[mu] = k < on_coordinates.size() ? on_coordinates[k] : 0.0;
    }
    return force;
}

/// Relative, of forces on the way where they are close to 0 or to each other: estimated, not bounded.
constexpr double accuracy = 1e-12;
/// Elsewhere they are as accurate as the choice of what opens asks for, and as the record of its force does: the
/// estimated error times `safety` changes neither. Where the velocity of its arc is at hand, the record is made better
/// with that (`better_force`), and asks for less.
constexpr double recorded_accuracy = 1e-8;
constexpr double accuracy_with_velocity = 1e-3;
constexpr double safety = 30;

/// A vertex on the way. Nothing is proved of it.
template <int Dim> class PlainVertex {
  public:
    /// `guess`: forces in the same slots.
    PlainVertex(Packing<Dim> p, IsostaticStructure<Dim> s, const ApproximateInverse& approximate, const Load<Dim>& load,
                const std::vector<double>& guess, OpeningRule rule, CandidateList<Dim>& candidates,
                const ArcOptions& options)
        : packing(std::move(p)), structure(std::move(s)), factorisation(structure, approximate), load_(load) {
        const DofMap<Dim>& dofs = structure.dofs();
        force = on_dofs(load.external_force(packing), dofs);
        const std::vector<double> unit = on_dofs(load.unit_force(packing), dofs);
        std::vector<int> loaded;
        for (std::size_t mu = 0; mu < force.size(); ++mu) {
            if (force[mu] != 0 || unit[mu] != 0) {
                loaded.push_back(static_cast<int>(mu));
            }
        }
        const sparse::Matrix<double>& h = structure.matrix();
        Promised<std::vector<unsigned char>> backbone([&h, this, loaded = std::move(loaded)] {
            return sparse::structural_nonzeros(h.start, h.row, structure.matching(), loaded);
        });
        load_on_dofs_ = force;
        error_ = safety * factorisation.solve_forces_until(force, guess, [&](std::span<const double> f, double error) {
            if (backbone.pending()) {
                backbone_ = backbone.take();
            }
            error_ = safety * error;
            if (rule != OpeningRule::most_negative) {
                return false;
            }
            const std::size_t chosen = most_negative(f);
            if (!departure_ && chosen < f.size() && structure.contacts()[chosen].kind != ContactKind::held) {
                depart(approximate, ContactId(chosen), candidates, options);
            }
            const bool begun = departure_ && departure_->opened == ContactId(chosen);
            const double enough = begun ? accuracy_with_velocity : recorded_accuracy;
            return (chosen == f.size() || error_ <= enough * std::abs(f[chosen])) && clear(f, chosen);
        });
        if (backbone.pending()) {
            backbone_ = backbone.take();
        }
    }

    Packing<Dim> packing;
    IsostaticStructure<Dim> structure;
    Factorisation factorisation;
    std::vector<double> force; ///< finite forces

    [[nodiscard]] bool is_structural_zero(std::size_t l) const { return backbone_[l] == 0; }
    /// Forces of the infinitesimal loads.
    [[nodiscard]] const std::vector<double>& infinitesimal() {
        if (infinitesimal_.empty()) {
            infinitesimal_ = on_dofs(load_.infinitesimal, structure.dofs());
            factorisation.solve_forces_from(infinitesimal_, {}, accuracy);
        }
        return infinitesimal_;
    }
    /// The arc that opens what has the most negative force, begun before that was known to the end; nothing when it is
    /// another one. Its factors stay with this vertex.
    struct Departure {
        ContactId opened;
        Factorisation factorisation;
        Promised<std::unique_ptr<ArcDeparture<Dim>>> arc;
    };
    [[nodiscard]] Departure* departure(const Opening& opening) {
        // Fresh factors, if solving asked for some, are better.
        const bool useful = departure_ && departure_->opened == opening.contact && !opening.infinitesimal &&
                            opening.direction > 0 && !factorisation.is_fresh();
        if (!useful) {
            departure_.reset();
        }
        return departure_.get();
    }
    [[nodiscard]] std::optional<Opening> choose(OpeningRule rule, std::uint64_t random_bits) {
        const auto chosen = stage(true, rule, random_bits);
        return chosen ? chosen : stage(false, rule, random_bits);
    }
    /// The force in a contact whose opening at unit rate moves the grains at `velocity` (on coordinates): f + v . (F -
    /// H f), whose error is the product of those of f and v.
    [[nodiscard]] double better_force(std::size_t l, const std::vector<double>& velocity) const {
        std::vector<double> rest = load_on_dofs_;
        const sparse::Matrix<double>& h = structure.matrix();
        for (std::size_t c = 0; c < force.size(); ++c) {
            for (auto e = static_cast<std::size_t>(h.start[c]); e < static_cast<std::size_t>(h.start[c + 1]); ++e) {
                rest[static_cast<std::size_t>(h.row[e])] -= h.value[e] * force[c];
            }
        }
        double power = 0;
        for (std::size_t mu = 0; mu < rest.size(); ++mu) {
            power +=
                rest[mu] * velocity[static_cast<std::size_t>(structure.dofs().coordinate_of(static_cast<int>(mu)))];
        }
        return force[l] - power; // the approach velocity is minus the rate
    }
    /// Whether the force in a contact is compressive.
    [[nodiscard]] bool compressive(std::size_t l) {
        if (error_ > 0 && std::abs(force[l]) <= error_) {
            refine();
        }
        return force[l] > 0;
    }

  private:
    void depart(const ApproximateInverse& approximate, ContactId opened, CandidateList<Dim>& candidates,
                const ArcOptions& options) {
        departure_.reset(new Departure{opened, Factorisation(structure, approximate), {}});
        departure_->arc = Promised<std::unique_ptr<ArcDeparture<Dim>>>(
            [this, &factors = departure_->factorisation, opened, &candidates, options] {
                return std::make_unique<ArcDeparture<Dim>>(packing, structure, factors, opened, +1,
                                                           PowerLoad<Dim>{&load_, false, false}, candidates, options);
            });
    }
    void refine() {
        std::vector<double> better = load_on_dofs_;
        factorisation.solve_forces_from(better, force, accuracy);
        force = std::move(better);
        error_ = 0;
    }
    [[nodiscard]] std::size_t most_negative(std::span<const double> f) const {
        std::size_t best = f.size();
        double smallest = 0;
        for (std::size_t l = 0; l < f.size(); ++l) {
            const double size = signed_size(f, l);
            if (size < smallest && !is_structural_zero(l)) {
                smallest = size;
                best = l;
            }
        }
        return best;
    }
    /// Whether that is the most negative finite force for all forces within the error; if it is none: whether there is
    /// none for all.
    [[nodiscard]] bool clear(std::span<const double> f, std::size_t chosen) const {
        const double bar = chosen < f.size() ? signed_size(f, chosen) + 2 * error_ : error_;
        if (chosen < f.size() && bar >= error_) {
            return false; // it may be 0
        }
        for (std::size_t l = 0; l < f.size(); ++l) {
            if (l != chosen && signed_size(f, l) <= bar && !is_structural_zero(l)) {
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] double signed_size(std::span<const double> f, std::size_t l) const {
        return structure.contacts()[l].kind == ContactKind::held ? -std::abs(f[l]) : f[l];
    }

    /// Among the finite forces, or the infinitesimal ones of the structural zeros, that are negative.
    std::optional<Opening> stage(bool finite, OpeningRule rule, std::uint64_t random_bits) {
        if (!finite && std::find(backbone_.begin(), backbone_.end(), 0) == backbone_.end()) {
            return std::nullopt;
        }
        const std::vector<double>& f = finite ? force : infinitesimal();
        const auto& contacts = structure.contacts();
        const auto size = [&](std::size_t l) { return contacts[l].kind == ContactKind::held ? -std::abs(f[l]) : f[l]; };
        std::vector<std::size_t> negative;
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (is_structural_zero(l) != finite && size(l) < 0) {
                negative.push_back(l);
            }
        }
        if (negative.empty()) {
            return std::nullopt;
        }
        std::size_t best = negative.front();
        if (rule == OpeningRule::random) {
            std::sort(negative.begin(), negative.end(),
                      [&](std::size_t a, std::size_t b) { return contacts[a] < contacts[b]; });
            best = negative[random_bits % negative.size()];
        } else {
            double smallest = std::numeric_limits<double>::infinity();
            for (const std::size_t l : negative) {
                const double key = rule == OpeningRule::least_negative ? -size(l)
                                   : rule == OpeningRule::steepest     ? size(l) / mechanism_norm(l)
                                                                       : size(l);
                if (key < smallest) {
                    smallest = key;
                    best = l;
                }
            }
        }
        Opening opening;
        opening.contact = ContactId(best);
        opening.infinitesimal = !finite;
        opening.force = {f[best], std::numeric_limits<double>::infinity()};
        opening.direction = contacts[best].kind == ContactKind::held && f[best] >= 0 ? -1 : +1;
        opening.margin = 0;
        opening.rung = Rung::none;
        return opening;
    }

    double mechanism_norm(std::size_t l) {
        std::vector<double> v(force.size(), 0.0);
        v[l] = 1;
        factorisation.solve_velocities(v);
        double square = 0;
        for (const double c : v) {
            square += c * c;
        }
        return std::sqrt(square);
    }

    const Load<Dim>& load_;
    std::vector<unsigned char> backbone_;
    std::vector<double> infinitesimal_;
    std::vector<double> load_on_dofs_;
    double error_ = 0;                     ///< of the finite forces, with a margin; 0: they are as accurate as they get
    std::unique_ptr<Departure> departure_; ///< last: it uses the rest
};

/// When new factors are due: as soon as an arc costs more than the average since the last ones, their making included,
/// which keeps that average smallest. Counts passes, never seconds.
class Wear {
  public:
    void add(double passes, int exchanges) {
        last_ = passes;
        sum_ += passes;
        exchanges_ = exchanges;
    }
    [[nodiscard]] bool out() const {
        return exchanges_ > 0 && last_ * (exchanges_ + 1) > factorisation_in_passes + sum_;
    }
    void renew() { *this = {}; }

  private:
    /// Less than KLU takes (50 at n = 1936, 4900): with two threads it is done beside the arcs.
    static constexpr double factorisation_in_passes = 40;
    double last_ = 0;
    double sum_ = 0;
    int exchanges_ = 0;
};

/// New factors made beside the arcs, which go on with the old ones meanwhile.
class Renewal {
  public:
    /// Of the matrix that `old` stands for. Nothing when one is under way.
    void begin(const ApproximateInverse& old, std::shared_ptr<const sparse::Matrix<double>> matrix) {
        if (!factors_.pending()) {
            slots_.clear();
            factors_ = Promised<ApproximateInverse>([old, matrix = std::move(matrix)] { return old.renewed(*matrix); });
        }
    }
    /// One more exchange: the new factors with all that they missed, when it is time to take them.
    std::optional<ApproximateInverse> after(int slot, const sparse::Matrix<double>& matrix) {
        if (!factors_.pending()) {
            return std::nullopt;
        }
        if (std::find(slots_.begin(), slots_.end(), slot) == slots_.end()) {
            slots_.push_back(slot);
        }
        if (++arcs_ < arcs_beside) {
            return std::nullopt;
        }
        arcs_ = 0;
        ApproximateInverse inverse = factors_.take();
        for (const int missed : slots_) {
            inverse = inverse.exchanged(missed, matrix);
        }
        return inverse;
    }

  private:
    /// As many as take a core about the time of new factors. A fixed number: when they are ready depends on the
    /// machine, when they are taken must not.
    static constexpr int arcs_beside = 2;
    Promised<ApproximateInverse> factors_;
    std::vector<int> slots_; ///< exchanged since
    int arcs_ = 0;
};

/// Decrease of W along an arc; the second is what rounding may have changed.
template <int Dim>
std::pair<double, double> work_of(const Load<Dim>& load, const Packing<Dim>& from, const Packing<Dim>& to) {
    const std::vector<double> force = load.external_force(from);
    double work = 0;
    double size = 0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        work += force[k] * (to.q[k] - from.q[k]);
        size += std::abs(force[k] * to.q[k]);
    }
    return {work, 1e-12 * size};
}

} // namespace

template <int Dim>
Result<PlainEnd<Dim>> steer_plainly(const Vertex<Dim>& from, Opening opening, const std::string& kind,
                                    const Load<Dim>& load, const RunOptions& options, CandidateList<Dim>& candidates,
                                    const PlainCalls<Dim>& calls) {
    ArcOptions arc_options;
    arc_options.step_fraction = options.step_fraction;
    arc_options.extrapolate_tangent = true;
    const Packing<Dim>* packing = &from.packing;
    const IsostaticStructure<Dim>* structure = &from.structure;
    const Factorisation* factorisation = &from.factorisation;
    std::unique_ptr<PlainVertex<Dim>> here;
    std::string arc_kind = kind;
    Wear wear;
    Renewal renewal;
    bool first = true;
    while (true) {
        ArcRecord<Dim> record;
        record.kind = arc_kind;
        record.opened = structure->contacts()[opening.contact.index()];
        record.force = opening.force.value;
        if (auto stop = calls.begin(record)) {
            return *stop;
        }
        const int force_passes = factorisation->passes();
        const PowerLoad<Dim> power{&load, opening.infinitesimal, first && kind == "limit"};
        const auto attempt = [&](const Factorisation& factors) {
            return follow_arc(*packing, *structure, factors, opening.contact, opening.direction, power, candidates,
                              arc_options);
        };
        // Rattlers turn far from arc to arc: factors taken over predict their curvature badly.
        std::optional<Factorisation> block;
        if (opening.infinitesimal) {
            block = Factorisation::of_moving_block(*structure, static_cast<int>(opening.contact.index()));
        }
        auto* departure = here ? here->departure(opening) : nullptr;
        if (departure != nullptr) {
            factorisation = &departure->factorisation;
        }
        auto arc = departure != nullptr ? departure->arc.take()->follow() : attempt(block ? *block : *factorisation);
        if ((!arc.ok() || arc.value().closed == record.opened) && (block || !factorisation->is_fresh())) {
            arc = attempt(Factorisation(*structure));
        }
        if (!arc.ok()) {
            return arc.failure();
        }
        Arc<Dim>& path = arc.value();
        if (departure != nullptr) {
            record.force = here->better_force(opening.contact.index(), path.opening);
        }
        record.closed = path.closed;
        record.power_turn = path.kind == ArcEnd::power_turn;
        record.held_at = record.power_turn ? path.end.q[static_cast<std::size_t>(path.closed.i)] : 0;
        record.power = path.power;
        record.displacement = path.displacement;
        record.steps = path.steps;
        const auto [work, unknown] = work_of(load, *packing, path.end);
        record.work = work;
        const auto names = [&] {
            return fmt::format("the arc that opens {} and closes {}", to_string<Dim>(record.opened),
                               to_string<Dim>(record.closed));
        };
        if (load.kind == LoadKind::nominal && work < -unknown) {
            return Failure{FailureKind::undecided, fmt::format("W increased by {:.6g} along {}", -work, names())};
        }
        auto next = IsostaticStructure<Dim>::exchange(*structure, path.end, opening.contact, path.closed);
        if (!next) {
            return Failure{FailureKind::not_isostatic,
                           fmt::format("the contacts are structurally singular at the end of {}", names())};
        }
        std::optional<ApproximateInverse> approximate;
        wear.add((path.passes + force_passes) * factorisation->approximate().relative_cost(),
                 factorisation->approximate().exchanges());
        if (auto renewed = renewal.after(next->slot(), next->matrix())) {
            approximate = std::move(renewed);
            wear.renew();
        } else {
            approximate = factorisation->approximate().exchanged(next->slot(), next->matrix());
        }
        std::optional<ExchangedContacts<Dim>> to_prove;
        if (calls.arrived) {
            to_prove = *next;
        }
        auto unproved = IsostaticStructure<Dim>::without_proof(std::move(*next));
        if (wear.out()) {
            renewal.begin(*approximate, unproved.shared_matrix());
        }
        const std::vector<double> guess = here ? std::move(here->force) : std::vector<double>();
        here = std::make_unique<PlainVertex<Dim>>(std::move(path.end), std::move(unproved), *approximate, load, guess,
                                                  options.rule, candidates, arc_options);
        packing = &here->packing;
        structure = &here->structure;
        factorisation = &here->factorisation;
        const std::size_t slot = opening.contact.index();
        if (!record.power_turn && (opening.infinitesimal || !here->is_structural_zero(slot)) &&
            !(opening.infinitesimal ? here->infinitesimal()[slot] > 0 : here->compressive(slot))) {
            return Failure{FailureKind::undecided,
                           fmt::format("the power of the load is not positive at the end of {}", names())};
        }
        if (auto stop = calls.end(record, *packing)) {
            return *stop;
        }
        if (to_prove) {
            calls.arrived({record, opening, *packing, std::move(*to_prove), std::move(*approximate),
                           std::move(path.tangent), here->force});
        }
        if (record.power_turn) { // the ends of a straight strut carry one force there: only a proof orders them
            return PlainEnd<Dim>{here->packing, structure->contacts(), opening.contact};
        }
        const auto chosen = here->choose(options.rule, calls.random_bits());
        if (!chosen) {
            return PlainEnd<Dim>{here->packing, structure->contacts(), ContactId()};
        }
        opening = *chosen;
        arc_kind = structure->contacts()[opening.contact.index()].kind == ContactKind::held ? "release"
                   : opening.infinitesimal                                                  ? "rattler"
                                                                                            : "tension";
        first = false;
    }
}

template Result<PlainEnd<2>> steer_plainly<2>(const Vertex<2>&, Opening, const std::string&, const Load<2>&,
                                              const RunOptions&, CandidateList<2>&, const PlainCalls<2>&);

} // namespace isostat
