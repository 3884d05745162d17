#include "motion/arc_centre.hpp"

namespace isostat {

std::unique_ptr<ArcCentre> ArcCentre::make(Packing packing, std::vector<Contact> contacts, InverseBoundCache& cache) {
    auto structure = IsostaticStructure::prove(packing, std::move(contacts));
    if (!structure.ok()) {
        return nullptr;
    }
    auto centre = std::make_unique<ArcCentre>();
    centre->packing_ = std::move(packing);
    centre->own_ = std::make_unique<FactorisedStructure>(std::move(structure.value()));
    const InverseBound bound = bound_inverse(centre->own_->structure, centre->own_->factorisation, cache);
    if (bound.verdict != Verdict::proved) {
        return nullptr;
    }
    centre->sigma_min_ = bound.sigma_min;
    return centre;
}

std::unique_ptr<ArcCentre> ArcCentre::near(const ArcVertex& vertex, std::size_t slot, Packing packing,
                                           const Contact& contact, InverseBoundCache& cache) {
    std::vector<Contact> list = vertex.structure.contacts();
    list[slot] = contact;
    auto exchange = IsostaticStructure::exchange(vertex.structure, packing, ContactId(slot), contact);
    if (!exchange) {
        return nullptr; // structurally singular
    }
    ApproximateInverse factors = vertex.factorisation.approximate()
                                     .exchanged(static_cast<int>(slot), exchange->matrix())
                                     .renewed(exchange->matrix(), ApproximateInverse::Use::few_solves);
    const auto proved = bound_exchanged(*exchange, factors, cache);
    if (!proved) {
        return make(std::move(packing), std::move(list), cache);
    }
    auto centre = std::make_unique<ArcCentre>();
    centre->packing_ = std::move(packing);
    centre->own_ = std::make_unique<FactorisedStructure>(
        IsostaticStructure::exchanged(std::move(*exchange), proved->proof), std::move(factors));
    centre->sigma_min_ = proved->bound.sigma_min;
    return centre;
}

std::unique_ptr<ArcCentre> ArcCentre::of(const ArcVertex& vertex) {
    auto centre = std::make_unique<ArcCentre>();
    centre->packing_ = vertex.packing;
    centre->structure_ = &vertex.structure;
    centre->factorisation_ = &vertex.factorisation;
    centre->sigma_min_ = vertex.inverse.sigma_min;
    return centre;
}

} // namespace isostat
