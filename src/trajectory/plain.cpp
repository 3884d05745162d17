#include "trajectory/plain.hpp"

#include "trajectory/plain_vertex.hpp"
#include "trajectory/renewal.hpp"

#include <fmt/format.h>

#include <cmath>

namespace isostat {

namespace {

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
        // Rattlers turn far from arc to arc: factors taken over predict their curvature badly.
        std::optional<Factorisation> block;
        if (opening.infinitesimal) {
            block = Factorisation::of_moving_block(*structure, static_cast<int>(opening.contact.index()));
        }
        const auto attempt = [&](const Factorisation& factors) {
            return follow_arc(*packing, *structure, factors, opening.contact, opening.direction, power, candidates,
                              arc_options);
        };
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
        wear.add(path.passes + force_passes, factorisation->approximate());
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
        if (wear.out(*approximate)) {
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
