#include "trajectory/floating_steering.hpp"

#include "contact/words.hpp"
#include "core/splitmix.hpp"
#include "trajectory/descent.hpp"
#include "trajectory/record.hpp"

namespace isostat {

namespace {

/// "the arc that opens 1-2 and closes 3-4".
Words names(const ArcRecord& record) {
    return words("the arc that opens {} and closes {}", named(record.opened), named(record.closed));
}

} // namespace

std::uint64_t bits_for(std::uint64_t seed, long step) {
    return splitmix(seed, static_cast<std::uint64_t>(step + 1));
}

ArcKind kind_of(const Contact& opened, bool infinitesimal) {
    return opened.kind == ContactKind::held ? ArcKind::release : infinitesimal ? ArcKind::rattler : ArcKind::tension;
}

FloatingSteering::FloatingSteering(const Origin& from, const ArcStart& start, const RunOptions& options,
                                   CandidateList candidates)
    : packing_(&from.packing), structure_(&from.structure), factorisation_(&from.factorisation), start_(start),
      load_(*start.load), candidates_(std::move(candidates)) {
    arc_options_.step_fraction = options.step_fraction;
    arc_options_.extrapolate_tangent = true;
}

/// The work is counted when the arc is recorded, because the number of arcs that are proposed in vain depends on the
/// threads, and records must not.
Result<ArcProposal> FloatingSteering::propose() {
    WorkCounts work{};
    const CountingIn counting(&work);
    auto arc = next();
    if (arc.ok()) {
        arc.value().work = work;
    }
    return arc;
}

Result<ArcProposal> FloatingSteering::next() {
    ArcProposal arc;
    ArcRecord& record = arc.record;
    record.step = start_.step;
    record.kind = start_.kind;
    record.opened = structure_->contacts()[start_.opening.contact.index()];
    arc.opening = start_.opening;
    ended_ = true; // unless another arc follows
    Prediction prediction;
    prediction.passes = here_ ? here_->passes() : 0; // passes for the other forces at the start
    auto path = follow(prediction);
    if (!path.ok()) {
        return path.failure();
    }
    record_path(record, path.value());
    if (auto failure = check_work(record, path.value())) {
        return *failure;
    }
    if (auto failure = arrive(arc, path.value(), prediction)) {
        return *failure;
    }
    if (auto failure = check_power(record)) {
        return *failure;
    }
    arc.ahead = true;
    arc.end = *packing_;
    arc.tangent = std::move(path.value().tangent);
    arc.forces = here_->force;
    choose(arc);
    return arc;
}

/// Uses the arc that was begun while the opening was chosen, if it is the right one.
Result<Arc> FloatingSteering::follow(Prediction& prediction) {
    const Opening& opening = start_.opening;
    const PowerLoad power = power_load(load_, opening, start_.kind);
    // Rattlers turn far from arc to arc, so reused factors predict their curvature badly.
    std::optional<Factorisation> block;
    if (opening.infinitesimal) {
        block = Factorisation::of_moving_block(*structure_, static_cast<int>(opening.contact.index()));
    }
    const auto attempt = [&](const Factorisation& factors) {
        return follow_arc(ArcOrigin{*packing_, *structure_, factors, opening.contact, opening.direction}, power,
                          candidates_, arc_options_);
    };
    auto* departure = here_ ? here_->departure(opening) : nullptr;
    if (departure != nullptr) {
        factorisation_ = &departure->factorisation;
    }
    auto arc = [&] {
        if (departure == nullptr) {
            return attempt(block ? *block : *factorisation_);
        }
        const std::unique_ptr<ArcDeparture> begun = departure->arc.get();
        prediction.end = begun->expected();
        if (prediction.end) {
            prediction.vertex = Future<PredictedVertex>([this, &end = *prediction.end] {
                return predict(*structure_, here_->loaded(), here_->force, factorisation_->approximate(), load_,
                               start_.opening.contact, end);
            });
        }
        return begun->follow();
    }();
    const Contact& opened = structure_->contacts()[opening.contact.index()];
    if ((!arc.ok() || arc.value().closed == opened) && (block || !factorisation_->is_fresh())) {
        arc = attempt(Factorisation(*structure_));
    }
    return arc;
}

std::optional<Failure> FloatingSteering::check_work(const ArcRecord& record, const Arc& path) const {
    const WorkOfArc work = work_of(load_, *packing_, path.end);
    if (load_.kind == LoadKind::nominal && work.value < -1e-12 * work.size) {
        return failed(FailureKind::undecided, "W increased by {:.6g} along {}", -work.value, names(record));
    }
    return std::nullopt;
}

/// Makes the vertex at the end of the path `here_`.
std::optional<Failure> FloatingSteering::arrive(ArcProposal& arc, Arc& path, Prediction& prediction) {
    std::optional<PredictedVertex> predicted;
    if (prediction.end && prediction.end->closes == path.closed) {
        predicted = prediction.vertex.get();
    }
    prediction.vertex = {}; // it uses this vertex
    auto next = IsostaticStructure::exchange(*structure_, path.end, start_.opening.contact, path.closed,
                                             predicted && predicted->contacts ? &*predicted->contacts : nullptr);
    if (!next) {
        return failed(FailureKind::undecided, "the contacts are structurally singular at the end of {}",
                      names(arc.record));
    }
    if (!next->predicted()) { // a normal became parallel to an axis or ceased to be, so the backbone may differ
        predicted.reset();
    }
    ApproximateInverse approximate = operator_at(*next, path.passes + prediction.passes);
    arc.contacts = *next;
    auto unproved = IsostaticStructure::without_proof(std::move(*next));
    if (rule_.due(approximate)) {
        refactorisation_.begin(approximate, unproved.shared_matrix());
    }
    std::vector<double> guess = here_ ? std::move(here_->force) : std::vector<double>();
    here_ = std::make_unique<FloatingVertex>(
        FloatingVertex::Arrival{std::move(path.end), std::move(unproved), approximate, std::move(guess),
                                std::move(path.open), predicted ? &*predicted : nullptr},
        FloatingVertex::Context{load_, candidates_, arc_options_});
    arc.approximate = std::move(approximate);
    packing_ = &here_->packing;
    structure_ = &here_->structure;
    factorisation_ = &here_->factorisation;
    return std::nullopt;
}

/// An operator close to the inverse, after an arc that cost `passes`:
/// a renewed one, or the previous one with one more exchange.
ApproximateInverse FloatingSteering::operator_at(const ExchangedContacts& next, int passes) {
    rule_.add(passes, factorisation_->approximate());
    if (auto renewed = refactorisation_.after(next.slot(), next.matrix())) {
        rule_.restart();
        return std::move(*renewed);
    }
    return factorisation_->approximate().exchanged(next.slot(), next.matrix());
}

std::optional<Failure> FloatingSteering::check_power(const ArcRecord& record) const {
    if (record.power_turn) {
        return std::nullopt;
    }
    const std::size_t slot = start_.opening.contact.index();
    const bool infinitesimal = start_.opening.moves_rattlers();
    if ((infinitesimal || !here_->is_structural_zero(slot)) && !here_->compressive(slot, infinitesimal)) {
        return failed(FailureKind::undecided, "the power of the load is not clearly positive at the end of {}",
                      names(record));
    }
    return std::nullopt;
}

/// Chooses what opens next; no opening: the steering ends here.
void FloatingSteering::choose(ArcProposal& arc) {
    // Both ends of a straight strut carry one force at a power turn, and only a proof orders them.
    const auto chosen = arc.record.power_turn ? std::optional<Opening>() : here_->choose();
    if (!chosen) {
        const ContactId hold = arc.record.power_turn ? start_.opening.contact : ContactId();
        arc.last = SteeredEnd{here_->packing, structure_->contacts(), {hold, {}}, candidates_.triangulation};
        return;
    }
    start_.opening = *chosen;
    start_.kind = kind_of(structure_->contacts()[chosen->contact.index()], chosen->infinitesimal);
    ++start_.step;
    ended_ = false;
}

} // namespace isostat
