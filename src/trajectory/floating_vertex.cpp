#include "trajectory/floating_vertex.hpp"

#include "core/dot.hpp"
#include "rigidity/contact_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

/// Relative accuracy, estimated and not bounded, of forces that are close to 0 or to each other.
constexpr double accuracy = 1e-12;
/// Other forces are only as accurate as the choice of what opens needs: the estimated error times `safety` does not
/// change it. If no arc was begun, some more digits save passes in the proof, which starts from these forces.
constexpr double accuracy_for_proof = 1e-8;
constexpr double accuracy_during_arc = 1e-3;
constexpr double safety = 30;

} // namespace

FloatingVertex::FloatingVertex(Arrival arrival, const Context& context)
    : packing(std::move(arrival.packing)), structure(std::move(arrival.structure)),
      factorisation(structure, arrival.approximate), context_(context) {
    const DofMap& dofs = structure.dofs();
    force = on_dofs(context.load.external_force(packing), dofs);
    const std::vector<double> unit = on_dofs(context.load.unit_force(packing), dofs);
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        if (force[mu] != 0 || unit[mu] != 0) {
            loaded_.push_back(static_cast<int>(mu));
        }
    }
    if (arrival.predicted != nullptr && arrival.predicted->loaded == loaded_) {
        backbone_ = std::move(arrival.predicted->backbone);
    } else {
        arrival.predicted = nullptr;
        pending_backbone_ =
            Future<std::vector<unsigned char>>([this] { return ContactPattern(packing, structure).carrying(loaded_); });
    }
    if (renew_candidates(context.candidates, packing)) { // not in a task, which may be dropped without running
        arrival.open.clear();
    }
    load_on_dofs_ = force;
    if (arrival.predicted != nullptr) {
        predicted_passes_ = arrival.predicted->passes;
        arrival.guess = std::move(arrival.predicted->force);
        if (arrival.predicted->opens.valid()) {
            depart(arrival, arrival.predicted->opens.index());
        }
    }
    if (departure_) { // another thread begins the arc, this one solves the forces
        Task solving([&] { solve(arrival); });
        begin_arc(arrival);
        if (solving.underway()) { // else first solve the forces, which may select another contact
            departure_->arc.begin_here();
        }
        solving.finish();
    } else {
        solve(arrival);
    }
    take_backbone();
}

void FloatingVertex::take_backbone() {
    if (pending_backbone_.pending()) {
        backbone_ = pending_backbone_.get();
    }
}

void FloatingVertex::depart(const Arrival& arrival, std::size_t opens) {
    departure_ =
        std::make_unique<Departure>(Departure{ContactId(opens), Factorisation(structure, arrival.approximate), {}});
}

void FloatingVertex::begin_arc(const Arrival& arrival) {
    departure_->arc = Future<std::unique_ptr<ArcDeparture>>([this, &there = *departure_, open = arrival.open] {
        return std::make_unique<ArcDeparture>(ArcOrigin{packing, structure, there.factorisation, there.opened},
                                              PowerLoad{&context_.load, false, false}, context_.candidates,
                                              context_.arc, open);
    });
}

/// Solves the finite forces as accurately as the choice of what opens needs; the arc that opens it begins meanwhile.
void FloatingVertex::solve(const Arrival& arrival) {
    const auto enough = [&](std::span<const double> f, double error) {
        take_backbone();
        error_ = safety * error;
        const std::size_t chosen = most_negative(f, structure.contacts(), backbone_);
        if (!departure_ && chosen < f.size() && structure.contacts()[chosen].kind != ContactKind::held) {
            depart(arrival, chosen);
            begin_arc(arrival);
        }
        const bool begun = departure_ && departure_->opened == ContactId(chosen);
        const double asked = begun ? accuracy_during_arc : accuracy_for_proof;
        return (chosen == f.size() || error_ <= asked * std::abs(f[chosen])) && clear(f, chosen);
    };
    error_ = safety * factorisation.solve_forces_until(force, arrival.guess, enough);
}

const std::vector<double>& FloatingVertex::infinitesimal() {
    if (infinitesimal_.empty()) {
        infinitesimal_ = on_dofs(context_.load.infinitesimal, structure.dofs());
        factorisation.solve_forces_from(infinitesimal_, {}, accuracy);
    }
    return infinitesimal_;
}

FloatingVertex::Departure* FloatingVertex::departure(const Opening& opening) {
    // Fresh factors, made if the solve needed some, are better.
    const bool useful = departure_ && departure_->opened == opening.contact && !opening.infinitesimal &&
                        opening.direction > 0 && !factorisation.is_fresh();
    if (!useful) {
        departure_.reset();
    }
    return departure_.get();
}

std::optional<Opening> FloatingVertex::choose() {
    const auto chosen = stage(true);
    return chosen ? chosen : stage(false);
}

bool FloatingVertex::compressive(std::size_t l, bool of_infinitesimal) {
    if (!of_infinitesimal && error_ > 0 && std::abs(force[l]) <= error_) {
        std::vector<double> better = load_on_dofs_;
        factorisation.solve_forces_from(better, force, accuracy);
        force = std::move(better);
        error_ = 0;
    }
    return (of_infinitesimal ? infinitesimal() : force)[l] > 0;
}

/// Whether `chosen` is the most negative force for all forces within the error of `f`. Without a chosen contact:
/// whether all forces are positive for all such `f`.
bool FloatingVertex::clear(std::span<const double> f, std::size_t chosen) const {
    const double bar = chosen < f.size() ? signed_size(structure.contacts()[chosen], f[chosen]) + 2 * error_ : error_;
    if (chosen < f.size() && bar >= error_) {
        return false; // the force may be 0
    }
    for (std::size_t l = 0; l < f.size(); ++l) {
        if (l != chosen && signed_size(structure.contacts()[l], f[l]) <= bar && !is_structural_zero(l)) {
            return false;
        }
    }
    return true;
}

/// The most negative of the finite forces, or of the infinitesimal forces of structural zeros.
std::optional<Opening> FloatingVertex::stage(bool finite) {
    if (!finite && std::find(backbone_.begin(), backbone_.end(), 0) == backbone_.end()) {
        return std::nullopt;
    }
    const std::vector<double>& f = finite ? force : infinitesimal();
    const auto& contacts = structure.contacts();
    const std::size_t best = most_negative(f, contacts, backbone_, finite);
    if (best == contacts.size()) {
        return std::nullopt;
    }
    Opening opening;
    opening.contact = ContactId(best);
    opening.infinitesimal = !finite;
    opening.bears = !finite && grains_bear_force(contacts, opening.contact,
                                                 [this](std::size_t l) { return is_structural_zero(l); });
    opening.force = {f[best], std::numeric_limits<double>::infinity()};
    opening.direction = contacts[best].kind == ContactKind::held && f[best] >= 0 ? -1 : +1;
    return opening;
}

std::size_t most_negative(std::span<const double> f, const std::vector<Contact>& contacts,
                          const std::vector<unsigned char>& backbone, bool inside) {
    std::size_t best = f.size();
    double smallest = 0;
    for (std::size_t l = 0; l < f.size(); ++l) {
        const double size = signed_size(contacts[l], f[l]);
        if (size < smallest && (backbone[l] != 0) == inside) {
            smallest = size;
            best = l;
        }
    }
    return best;
}

PredictedVertex predict(const IsostaticStructure& from, const std::vector<int>& loaded,
                        const std::vector<double>& force, const ApproximateInverse& approximate, const Load& load,
                        ContactId opens, const ArcDeparture::Expected& end) {
    PredictedVertex predicted;
    predicted.contacts = IsostaticStructure::exchange(from, end.end, opens, end.closes);
    if (!predicted.contacts) {
        return predicted;
    }
    const sparse::Matrix<double>& h = predicted.contacts->matrix();
    predicted.loaded = loaded;
    predicted.backbone =
        ContactPattern(end.end, from.dofs(), predicted.contacts->contacts(), h, predicted.contacts->matching())
            .carrying(loaded);
    const auto structure = IsostaticStructure::without_proof(*predicted.contacts);
    const Factorisation factorisation(structure, approximate.exchanged(predicted.contacts->slot(), h));
    predicted.force = on_dofs(load.external_force(end.end), structure.dofs());
    // One pass mostly decides which force is most negative.
    factorisation.solve_forces_until(predicted.force, force, [](std::span<const double>, double) { return true; });
    predicted.passes = factorisation.passes();
    const std::size_t opens_next = most_negative(predicted.force, structure.contacts(), predicted.backbone);
    if (opens_next < predicted.force.size() && structure.contacts()[opens_next].kind != ContactKind::held) {
        predicted.opens = ContactId(opens_next);
    }
    return predicted;
}

} // namespace isostat
