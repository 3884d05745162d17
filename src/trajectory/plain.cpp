#include "trajectory/plain.hpp"

#include "trajectory/descent.hpp"
#include "trajectory/plain_vertex.hpp"
#include "trajectory/record.hpp"

#include <fmt/format.h>

#include <cmath>

namespace isostat {

template <int Dim>
PlainSteering<Dim>::PlainSteering(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                  const Factorisation& factorisation, Opening opening, std::string kind,
                                  const Load<Dim>& load, const RunOptions& options, CandidateList<Dim>& candidates)
    : packing_(&packing), structure_(&structure), factorisation_(&factorisation), opening_(opening),
      kind_(std::move(kind)), load_(load), options_(options), candidates_(candidates), at_limit_(kind_ == "limit") {
    arc_options_.step_fraction = options.step_fraction;
    arc_options_.extrapolate_tangent = true;
}

template <int Dim> PlainSteering<Dim>::~PlainSteering() = default;

template <int Dim> std::optional<Result<PlainEnd<Dim>>> PlainSteering<Dim>::step(const PlainCalls<Dim>& calls) {
    ArcRecord<Dim> record;
    record.kind = kind_;
    record.opened = structure_->contacts()[opening_.contact.index()];
    record.force = opening_.force.value;
    if (auto stop = calls.begin(record)) {
        return *stop;
    }
    const int force_passes = here_ ? here_->passes() : 0; // of others at the start
    const PowerLoad<Dim> power{&load_, opening_.infinitesimal, at_limit_};
    // Rattlers turn far from arc to arc: factors taken over predict their curvature badly.
    std::optional<Factorisation> block;
    if (opening_.infinitesimal) {
        block = Factorisation::of_moving_block(*structure_, static_cast<int>(opening_.contact.index()));
    }
    const auto attempt = [&](const Factorisation& factors) {
        return follow_arc(*packing_, *structure_, factors, opening_.contact, opening_.direction, power, candidates_,
                          arc_options_);
    };
    auto* departure = here_ ? here_->departure(opening_) : nullptr;
    if (departure != nullptr) {
        factorisation_ = &departure->factorisation;
    }
    std::optional<typename ArcDeparture<Dim>::Expected> expected;
    Promised<ForeseenVertex<Dim>> foreseeing;
    auto arc = [&] {
        if (departure == nullptr) {
            return attempt(block ? *block : *factorisation_);
        }
        const std::unique_ptr<ArcDeparture<Dim>> begun = departure->arc.take();
        expected = begun->expected();
        if (expected) {
            foreseeing = Promised<ForeseenVertex<Dim>>([this, &expected] {
                return foresee(*structure_, here_->loaded(), here_->force, factorisation_->approximate(), load_,
                               opening_.contact, *expected);
            });
        }
        return begun->follow();
    }();
    if ((!arc.ok() || arc.value().closed == record.opened) && (block || !factorisation_->is_fresh())) {
        arc = attempt(Factorisation(*structure_));
    }
    if (!arc.ok()) {
        return arc.failure();
    }
    Arc<Dim>& path = arc.value();
    if (departure != nullptr) {
        record.force = here_->better_force(opening_.contact.index(), path.opening);
    }
    record_path(record, path);
    const WorkOfArc work = work_of(load_, *packing_, path.end);
    record.work = work.value;
    const auto names = [&] {
        return fmt::format("the arc that opens {} and closes {}", to_string<Dim>(record.opened),
                           to_string<Dim>(record.closed));
    };
    if (load_.kind == LoadKind::nominal && work.value < -1e-12 * work.size) {
        return Failure{FailureKind::undecided, fmt::format("W increased by {:.6g} along {}", -work.value, names())};
    }
    std::optional<ForeseenVertex<Dim>> foreseen;
    if (expected && expected->closes == path.closed) {
        foreseen = foreseeing.take();
    }
    foreseeing = {}; // it reads this vertex
    auto next = IsostaticStructure<Dim>::exchange(*structure_, path.end, opening_.contact, path.closed,
                                                  foreseen && foreseen->contacts ? &*foreseen->contacts : nullptr);
    if (!next) {
        return Failure{FailureKind::not_isostatic,
                       fmt::format("the contacts are structurally singular at the end of {}", names())};
    }
    if (!next->foreseen()) { // a normal turned into or out of an axis: the backbone may be another one
        foreseen.reset();
    }
    std::optional<ApproximateInverse> approximate;
    wear_.add(path.passes + force_passes, factorisation_->approximate());
    if (auto renewed = renewal_.after(next->slot(), next->matrix())) {
        approximate = std::move(renewed);
        wear_.renew();
    } else if (foreseen && !calls.arrived) { // the new column is the foreseen one, which only a proof would notice
        approximate = std::move(foreseen->approximate);
    } else {
        approximate = factorisation_->approximate().exchanged(next->slot(), next->matrix());
    }
    std::optional<ExchangedContacts<Dim>> to_prove;
    if (calls.arrived) {
        to_prove = *next;
    }
    auto unproved = IsostaticStructure<Dim>::without_proof(std::move(*next));
    if (wear_.out(*approximate)) {
        renewal_.begin(*approximate, unproved.shared_matrix());
    }
    const std::vector<double> guess = here_ ? std::move(here_->force) : std::vector<double>();
    here_ = std::make_unique<PlainVertex<Dim>>(std::move(path.end), std::move(unproved), *approximate, load_, guess,
                                               options_.rule, candidates_, arc_options_, std::move(path.open),
                                               foreseen ? &*foreseen : nullptr);
    packing_ = &here_->packing;
    structure_ = &here_->structure;
    factorisation_ = &here_->factorisation;
    const std::size_t slot = opening_.contact.index();
    if (!record.power_turn) {
        record.power = opening_.infinitesimal ? here_->infinitesimal()[slot] : here_->force[slot];
    }
    if (!record.power_turn && (opening_.infinitesimal || !here_->is_structural_zero(slot)) &&
        !(opening_.infinitesimal ? here_->infinitesimal()[slot] > 0 : here_->compressive(slot))) {
        return Failure{FailureKind::undecided,
                       fmt::format("the power of the load is not positive at the end of {}", names())};
    }
    if (auto stop = calls.end(record, *packing_)) {
        return *stop;
    }
    if (to_prove) {
        calls.arrived({record, opening_, *packing_, std::move(*to_prove), std::move(*approximate),
                       std::move(path.tangent), here_->force});
    }
    if (record.power_turn) { // the ends of a straight strut carry one force there: only a proof orders them
        return PlainEnd<Dim>{here_->packing, structure_->contacts(), opening_.contact};
    }
    const auto chosen = here_->choose(options_.rule, calls.random_bits());
    if (!chosen) {
        return PlainEnd<Dim>{here_->packing, structure_->contacts(), ContactId()};
    }
    opening_ = *chosen;
    kind_ = structure_->contacts()[opening_.contact.index()].kind == ContactKind::held ? "release"
            : opening_.infinitesimal                                                   ? "rattler"
                                                                                       : "tension";
    at_limit_ = false;
    return std::nullopt;
}

template class PlainSteering<2>;

} // namespace isostat
