#pragma once
// Where the polynomial of a piece of an arc is expanded: private to the room.

#include "linear/factorisation.hpp"
#include "motion/certify_arc.hpp"

#include <memory>
#include <vector>

namespace isostat {

/// A configuration whose contact matrix (moving grains only) was proved regular, factorised and bounded.
class ArcCentre {
  public:
    /// Null when a step fails.
    static std::unique_ptr<ArcCentre> make(Packing packing, std::vector<Contact> contacts, InverseBoundCache& cache);
    /// The same of the list of a vertex with another contact in a slot. Regularity follows from the bound of the
    /// inverse (V1), and the factors keep the order of those of the vertex; where no bound is found in doubles, as
    /// `make`.
    static std::unique_ptr<ArcCentre> near(const ArcVertex& vertex, std::size_t slot, Packing packing,
                                           const Contact& contact, InverseBoundCache& cache);
    /// The vertex itself as a centre; only its coordinates are copied.
    static std::unique_ptr<ArcCentre> of(const ArcVertex& vertex);

    [[nodiscard]] const Packing& packing() const { return packing_; }
    [[nodiscard]] const IsostaticStructure& structure() const { return own_ ? own_->structure : *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return own_ ? own_->factorisation : *factorisation_; }
    [[nodiscard]] double sigma_min() const { return sigma_min_; }

  private:
    Packing packing_;
    std::unique_ptr<FactorisedStructure> own_;
    const IsostaticStructure* structure_ = nullptr;
    const Factorisation* factorisation_ = nullptr;
    double sigma_min_ = 0;
};

} // namespace isostat
