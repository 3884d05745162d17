#pragma once
// A vertex on the way of floating steering: private to the room.

#include "trajectory/foreseen_vertex.hpp"

#include <isostat/contact/candidates.hpp>
#include <isostat/core/threads.hpp>
#include <isostat/linear/factorisation.hpp>
#include <isostat/motion/arc.hpp>
#include <isostat/statics/decisions.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// A vertex on the way. Nothing is proved of it.
template <int Dim> class FloatingVertex {
  public:
    /// `guess`: forces in the same slots. `open`: see `Arc`. `foreseen`: of the same pattern, or null.
    FloatingVertex(Packing<Dim> p, IsostaticStructure<Dim> s, const ApproximateInverse& approximate,
                   const Load<Dim>& load, const std::vector<double>& guess, OpeningRule rule,
                   CandidateList<Dim>& candidates, const ArcOptions& options, std::vector<Contact> open,
                   ForeseenVertex<Dim>* foreseen)
        : packing(std::move(p)), structure(std::move(s)), factorisation(structure, approximate), load_(load) {
        const DofMap<Dim>& dofs = structure.dofs();
        force = on_dofs(load.external_force(packing), dofs);
        const std::vector<double> unit = on_dofs(load.unit_force(packing), dofs);
        for (std::size_t mu = 0; mu < force.size(); ++mu) {
            if (force[mu] != 0 || unit[mu] != 0) {
                loaded_.push_back(static_cast<int>(mu));
            }
        }
        Promised<std::vector<unsigned char>> backbone;
        if (foreseen != nullptr && foreseen->loaded == loaded_) {
            backbone_ = std::move(foreseen->backbone);
        } else {
            foreseen = nullptr;
            backbone = Promised<std::vector<unsigned char>>(
                [this] { return ContactPattern(packing, structure).carrying(loaded_); });
        }
        const bool departs = rule == OpeningRule::most_negative;
        if (departs && renew_candidates(candidates, packing)) { // not by an errand that may be dropped
            open.clear();
        }
        const auto depart = [&](std::size_t chosen) {
            departure_.reset(new Departure{ContactId(chosen), Factorisation(structure, approximate), {}});
        };
        if (foreseen != nullptr) {
            foreseen_passes_ = foreseen->passes;
            if (departs && foreseen->opens.valid()) {
                depart(foreseen->opens.index());
            }
        }
        const auto begin_arc = [this, &candidates, options, open = std::move(open)] {
            departure_->arc = Promised<std::unique_ptr<ArcDeparture<Dim>>>(
                [this, &factors = departure_->factorisation, opened = departure_->opened, &candidates, options, open] {
                    return std::make_unique<ArcDeparture<Dim>>(packing, structure, factors, opened, +1,
                                                               PowerLoad<Dim>{&load_, false, false}, candidates,
                                                               options, open);
                });
        };
        load_on_dofs_ = force;
        const std::vector<double>& from = foreseen != nullptr ? foreseen->force : guess;
        const auto solve = [&] {
            const auto enough = [&](std::span<const double> f, double error) {
                if (backbone.pending()) {
                    backbone_ = backbone.take();
                }
                error_ = safety * error;
                if (!departs) {
                    return false;
                }
                const std::size_t chosen = most_negative(f, structure.contacts(), backbone_);
                if (!departure_ && chosen < f.size() && structure.contacts()[chosen].kind != ContactKind::held) {
                    depart(chosen);
                    begin_arc();
                }
                const bool begun = departure_ && departure_->opened == ContactId(chosen);
                const double asked = begun ? accuracy_with_velocity : recorded_accuracy;
                return (chosen == f.size() || error_ <= asked * std::abs(f[chosen])) && clear(f, chosen);
            };
            error_ = safety * factorisation.solve_forces_until(force, from, enough);
        };
        if (departure_) { // the arc by the thread that will follow it, the forces beside it
            Errand solving(solve);
            begin_arc();
            if (solving.underway()) { // else the forces come first: they may say that another contact opens
                departure_->arc.begin_here();
            }
            solving.finish();
        } else {
            solve();
        }
        if (backbone.pending()) {
            backbone_ = backbone.take();
        }
    }

    Packing<Dim> packing;
    IsostaticStructure<Dim> structure;
    Factorisation factorisation;
    std::vector<double> force; ///< finite forces

    [[nodiscard]] bool is_structural_zero(std::size_t l) const { return backbone_[l] == 0; }
    /// Of the factors, for forces.
    [[nodiscard]] int passes() const { return factorisation.passes() + foreseen_passes_; }
    /// Degrees of freedom.
    [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }
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
    [[nodiscard]] bool has_departure() const { return departure_ != nullptr; }
    [[nodiscard]] std::optional<Opening> choose(OpeningRule rule, std::uint64_t random_bits) {
        const auto chosen = stage(true, rule, random_bits);
        return chosen ? chosen : stage(false, rule, random_bits);
    }
    /// Whether the errors of the forces leave that choice as it is; else it takes a proof. What `steepest` compares
    /// besides signs is not looked at.
    [[nodiscard]] bool resolves(const Opening& chosen, OpeningRule rule) {
        const double finite_error = std::max(error_, accuracy * largest(force));
        if (chosen.infinitesimal) {
            const std::vector<double>& f = infinitesimal();
            return signs_are_clear(true, force, finite_error) &&
                   is_clear(false, f, accuracy * largest(f), chosen.contact.index(), rule);
        }
        return is_clear(true, force, finite_error, chosen.contact.index(), rule);
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
    /// Whether the force in a contact is compressive: clearly, but where a proof will tell.
    [[nodiscard]] bool compressive(std::size_t l, bool of_infinitesimal, bool proved_behind) {
        if (!of_infinitesimal && error_ > 0 && std::abs(force[l]) <= error_) {
            refine();
        }
        const std::vector<double>& f = of_infinitesimal ? infinitesimal() : force;
        return f[l] > (proved_behind ? 0 : accuracy * largest(f));
    }

  private:
    /// Relative, of forces on the way where they are close to 0 or to each other: estimated, not bounded.
    static constexpr double accuracy = 1e-12;
    /// Elsewhere they are as accurate as the choice of what opens asks for, and as the record of its force does: the
    /// estimated error times `safety` changes neither. Where the velocity of its arc is at hand, the record is made
    /// better with that (`better_force`), and asks for less.
    static constexpr double recorded_accuracy = 1e-8;
    static constexpr double accuracy_with_velocity = 1e-3;
    static constexpr double safety = 30;

    void refine() {
        std::vector<double> better = load_on_dofs_;
        factorisation.solve_forces_from(better, force, accuracy);
        force = std::move(better);
        error_ = 0;
    }
    /// Whether that is the most negative finite force for all forces within the error; if it is none: whether there is
    /// none for all.
    [[nodiscard]] bool clear(std::span<const double> f, std::size_t chosen) const {
        const double bar =
            chosen < f.size() ? signed_size(structure.contacts()[chosen], f[chosen]) + 2 * error_ : error_;
        if (chosen < f.size() && bar >= error_) {
            return false; // it may be 0
        }
        for (std::size_t l = 0; l < f.size(); ++l) {
            if (l != chosen && signed_size(structure.contacts()[l], f[l]) <= bar && !is_structural_zero(l)) {
                return false;
            }
        }
        return true;
    }
    static double largest(const std::vector<double>& f) {
        double size = 0;
        for (const double x : f) {
            size = std::max(size, std::abs(x));
        }
        return size;
    }
    [[nodiscard]] bool signs_are_clear(bool finite, const std::vector<double>& f, double error) const {
        for (std::size_t l = 0; l < f.size(); ++l) {
            if (is_structural_zero(l) != finite && !(std::abs(f[l]) > error)) {
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] bool is_clear(bool finite, const std::vector<double>& f, double error, std::size_t chosen,
                                OpeningRule rule) const {
        const bool most = rule == OpeningRule::most_negative;
        if (!(std::abs(f[chosen]) > error) || (!most && !signs_are_clear(finite, f, error))) {
            return false;
        }
        const auto& contacts = structure.contacts();
        const double size = signed_size(contacts[chosen], f[chosen]);
        for (std::size_t l = 0; l < f.size(); ++l) {
            const double difference = signed_size(contacts[l], f[l]) - size;
            const bool rival = l != chosen && is_structural_zero(l) != finite;
            if (rival && ((most && difference <= 2 * error) ||
                          (rule == OpeningRule::least_negative && std::abs(difference) <= 2 * error))) {
                return false;
            }
        }
        return true;
    }
    /// Among the finite forces, or the infinitesimal ones of the structural zeros, that are negative.
    std::optional<Opening> stage(bool finite, OpeningRule rule, std::uint64_t random_bits) {
        if (!finite && std::find(backbone_.begin(), backbone_.end(), 0) == backbone_.end()) {
            return std::nullopt;
        }
        const std::vector<double>& f = finite ? force : infinitesimal();
        const auto& contacts = structure.contacts();
        const auto size = [&](std::size_t l) { return signed_size(contacts[l], f[l]); };
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
    std::vector<int> loaded_;
    std::vector<unsigned char> backbone_;
    std::vector<double> infinitesimal_;
    std::vector<double> load_on_dofs_;
    int foreseen_passes_ = 0;
    double error_ = 0;                     ///< of the finite forces, with a margin; 0: they are as accurate as they get
    std::unique_ptr<Departure> departure_; ///< last: it uses the rest
};

} // namespace isostat
