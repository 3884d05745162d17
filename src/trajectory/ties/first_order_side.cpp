#include "trajectory/ties/first_order_side.hpp"

#include "contact/words.hpp"
#include "statics/perturbed.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

constexpr Contact none{ContactKind::disk_disk, -1, -1};

/// The load at which a force that is almost 0 at the stored stress vanishes. \pre its slope is decided.
LimitLoad zero_load(Statics& statics, ContactId at_zero, const Load& load) {
    LimitLoad at{load};
    const Enclosure slope = statics.slope(at_zero);
    const Enclosure f = statics.force(at_zero, at.stress());
    at.error = (std::abs(f.value) + f.radius) / (std::abs(slope.value) - slope.radius) * (1 + 1e-10);
    at.shift = statics.zero_of(at_zero, at.stress());
    return at;
}

/// Whether a force is positive at the stored load and at the exact one, with as many digits as needed.
bool is_positive(Statics& statics, ContactId l, const LimitLoad& limit) {
    statics.set_shift(nullptr, 0); // exact numbers cannot use the exact load
    ForceExpression force = statics.force_expression(l, limit.stress());
    const Order stored = statics.sign(force);
    force.shift = limit.shift.get();
    const Order exact = statics.sign(force);
    return stored.decided && stored.sign > 0 && exact.decided && exact.sign > 0;
}

} // namespace

FirstOrderSide::FirstOrderSide(State& state, std::uint64_t seed, bool choose) : state_(state), choose_(choose) {
    if (!state.perturbation) {
        state.perturbation.emplace();
        state.perturbation->seed = seed;
        state.perturbation->rho = tie_direction(state.packing.radius, seed);
    }
}

void FirstOrderSide::attach(Vertex& vertex, const LimitLoad& at) const {
    vertex.statics.perturb_radii();
    if (at.shift) {
        vertex.statics.set_shift(at.shift, at.error);
    }
    vertex.perturbed =
        std::make_unique<FirstOrderVertex>(FirstOrder(vertex.packing, vertex.structure, vertex.factorisation,
                                                      vertex.inverse, vertex.enclosure, state_.perturbation->rho),
                                           vertex.statics, at.load, at.stress_rate, choose_);
    vertex.perturbed->rho = &state_.perturbation->rho;
}

std::optional<Failure> FirstOrderSide::choose_contacts() const {
    auto kept = first_order_backbone(state_.packing, state_.load, state_.contacts, state_.perturbation->rho);
    if (!kept.ok()) {
        return kept.failure();
    }
    state_.contacts = kept.value();
    return std::nullopt;
}

void FirstOrderSide::load_is_stored() const {
    state_.perturbation->load_zero = none;
    state_.perturbation->stress_rate = {0, 0};
}

std::optional<Failure> FirstOrderSide::settle_load(Vertex& vertex, const LimitLoad& limit,
                                                   const std::vector<ContactId>& zeros) const {
    load_is_stored();
    if (!limit.shift) {
        return std::nullopt;
    }
    Statics& statics = vertex.statics;
    const auto& contacts = statics.structure().contacts();
    const auto known =
        std::find_if(zeros.begin(), zeros.end(), [&](ContactId l) { return statics.slope(l).decided(); });
    if (known != zeros.end()) {
        LimitLoad at = zero_load(statics, *known, limit.load);
        at.stress_rate = limit.stress_rate;
        state_.perturbation->load_zero = contacts[known->index()];
        state_.perturbation->stress_rate = limit.stress_rate;
        attach(vertex, at);
        return std::nullopt;
    }
    for (int l = 0; l < statics.structure().size(); ++l) {
        const ContactId id(l);
        if (statics.is_structural_zero(id) || contacts[id.index()].kind == ContactKind::held ||
            std::find(zeros.begin(), zeros.end(), id) != zeros.end()) {
            continue;
        }
        const Enclosure slope = statics.slope(id);
        Enclosure f = statics.force(id, limit.stress());
        f.radius += limit.error * (std::abs(slope.value) + slope.radius) * (1 + 1e-10);
        if (!f.positive() && !is_positive(statics, id, limit)) {
            return failed(FailureKind::undecided,
                          "the force in {} is so small, {:.3g}, that the limit load must be known better "
                          "than it is stored",
                          named(contacts[id.index()]), f.value);
        }
    }
    return std::nullopt;
}

std::optional<Failure> FirstOrderSide::resume(Vertex& vertex, const ZeroGaps& touching) const {
    const RadiusPerturbation& stored = *state_.perturbation;
    const auto& contacts = vertex.structure.contacts();
    const auto at = std::find(contacts.begin(), contacts.end(), stored.load_zero);
    if (stored.load_zero.i >= 0 && at != contacts.end()) {
        const ContactId l(static_cast<std::size_t>(at - contacts.begin()));
        if (!vertex.statics.slope(l).decided()) {
            return failed(FailureKind::undecided, "the load at which the force in {} vanishes is not known",
                          named(stored.load_zero));
        }
        LimitLoad meant = zero_load(vertex.statics, l, state_.load);
        meant.stress_rate = stored.stress_rate;
        attach(vertex, meant);
    }
    return settle_touching(vertex, touching);
}

void FirstOrderSide::set_limit(LimitLoad& at, Vertex& vertex, ContactId opens, double error) const {
    at.shift = vertex.statics.zero_of(opens, at.stress());
    at.error = error;
    at.stress_rate = vertex.perturbed->statics.limit_rate(opens, at.stress(), error);
}

std::optional<Failure> FirstOrderSide::settle_end(Vertex& vertex, const LimitLoad& limit,
                                                  const std::vector<ContactId>& zeros, const ZeroGaps& touching) const {
    auto failure = settle_load(vertex, limit, zeros);
    return failure ? failure : settle_touching(vertex, touching);
}

void FirstOrderSide::store(const Vertex& vertex, EquilibriumRecord& record) const {
    record.touching = static_cast<int>(vertex.perturbed->touching.size());
    RadiusPerturbation& stored = *state_.perturbation;
    stored.open = vertex.perturbed->touching;
    stored.zero.clear();
    for (const ContactId l : vertex.perturbed->zeros) {
        stored.zero.emplace_back(vertex.structure.contacts()[l.index()], vertex.perturbed->statics.force(l));
    }
}

std::unique_ptr<const TieSettling> tie_settling(State& state, const RunOptions& options) {
    if (options.at_first_order()) {
        return std::make_unique<const FirstOrderSide>(state, options.ties_seed, options.chooses());
    }
    return std::make_unique<const TieSettling>();
}

} // namespace isostat
