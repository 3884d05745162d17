#pragma once
/// \file
/// A vertex on the way of floating steering: private to the room.

#include "contact/candidates.hpp"
#include "core/parallel.hpp"
#include "linear/factorisation.hpp"
#include "motion/arc.hpp"
#include "statics/decisions.hpp"
#include "trajectory/predicted_vertex.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// A vertex on the way. Nothing is proved of it.
class FloatingVertex {
  public:
    /// What the steering has for each of its vertices. Must outlive them.
    struct Context {
        const Load& load;
        CandidateList& candidates; ///< made anew when less is left of their reach than an arc needs
        const ArcOptions& arc;
    };
    /// What the arc that leads here brings.
    struct Arrival {
        Packing packing;
        IsostaticStructure structure;
        const ApproximateInverse& approximate; ///< close to the inverse of its matrix
        std::vector<double> guess;             ///< forces in the same slots
        std::vector<Contact> open;             ///< see `Arc`
        PredictedVertex* predicted;            ///< of the same pattern, or null
    };
    FloatingVertex(Arrival arrival, const Context& context);

    Packing packing;
    IsostaticStructure structure;
    Factorisation factorisation;
    std::vector<double> force; ///< finite forces

    [[nodiscard]] bool is_structural_zero(std::size_t l) const { return backbone_[l] == 0; }
    /// Of the factors, for forces.
    [[nodiscard]] int passes() const { return factorisation.passes() + predicted_passes_; }
    /// Degrees of freedom.
    [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }
    /// Forces of the infinitesimal loads.
    [[nodiscard]] const std::vector<double>& infinitesimal();
    /// The arc that opens what has the most negative force, begun before that was known to the end; nothing when it is
    /// another one. Its factors stay with this vertex.
    struct Departure {
        ContactId opened;
        Factorisation factorisation;
        Future<std::unique_ptr<ArcDeparture>> arc;
    };
    [[nodiscard]] Departure* departure(const Opening& opening);
    /// What has the most negative force, and opens; nothing: no force is negative.
    [[nodiscard]] std::optional<Opening> choose();
    /// Whether the force in a contact is compressive, as far as doubles tell.
    [[nodiscard]] bool compressive(std::size_t l, bool of_infinitesimal);

  private:
    void take_backbone();
    void solve(const Arrival& arrival);
    void depart(const Arrival& arrival, std::size_t opens);
    void begin_arc(const Arrival& arrival);
    [[nodiscard]] bool clear(std::span<const double> f, std::size_t chosen) const;
    std::optional<Opening> stage(bool finite);

    Context context_;
    std::vector<int> loaded_;
    std::vector<unsigned char> backbone_;
    Future<std::vector<unsigned char>> pending_backbone_; ///< while it is made
    std::vector<double> infinitesimal_;
    std::vector<double> load_on_dofs_;
    int predicted_passes_ = 0;
    double error_ = 0;                     ///< of the finite forces, with a margin; 0: they are as accurate as they get
    std::unique_ptr<Departure> departure_; ///< last: it uses the rest
};

} // namespace isostat
