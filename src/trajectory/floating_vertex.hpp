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

/// A vertex along floating steering. Nothing is proved of it.
class FloatingVertex {
  public:
    /// Data of the steering for all of its vertices. Must outlive the vertices.
    struct Context {
        const Load& load;
        CandidateList& candidates; ///< made anew when their remaining reach is shorter than an arc needs
        const ArcOptions& arc;
    };
    /// Data at the end of the arc that leads to this vertex.
    struct Arrival {
        Packing packing;
        IsostaticStructure structure;
        const ApproximateInverse& approximate; ///< close to the inverse of its matrix
        std::vector<double> guess;             ///< forces, by the same slots
        std::vector<Contact> open;             ///< see `Arc`
        PredictedVertex* predicted;            ///< predicted vertex of the same pattern, or null
    };
    FloatingVertex(Arrival arrival, const Context& context);

    Packing packing;
    IsostaticStructure structure;
    Factorisation factorisation;
    std::vector<double> force; ///< finite forces

    [[nodiscard]] bool is_structural_zero(std::size_t l) const { return backbone_[l] == 0; }
    /// Passes of the factors for the forces.
    [[nodiscard]] int passes() const { return factorisation.passes() + predicted_passes_; }
    /// The degrees of freedom on which the finite load acts.
    [[nodiscard]] const std::vector<int>& loaded() const { return loaded_; }
    /// Forces of the infinitesimal loads.
    [[nodiscard]] const std::vector<double>& infinitesimal();
    /// The arc that opens the contact with the apparently most negative force, begun before the forces are converged;
    /// `departure` gives nothing when another contact opens. The factors of the arc stay with this vertex.
    struct Departure {
        ContactId opened;
        Factorisation factorisation;
        Future<std::unique_ptr<ArcDeparture>> arc;
    };
    [[nodiscard]] Departure* departure(const Opening& opening);
    /// The contact with the most negative force, which opens; nothing: no force is negative.
    [[nodiscard]] std::optional<Opening> choose();
    /// Whether the force in a contact is compressive, judged in double precision.
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
    Future<std::vector<unsigned char>> pending_backbone_; ///< filled while another task computes `backbone_`
    std::vector<double> infinitesimal_;
    std::vector<double> load_on_dofs_;
    int predicted_passes_ = 0;
    double error_ = 0;                     ///< bound of the error of `force`, with a margin; 0: converged to rounding
    std::unique_ptr<Departure> departure_; ///< last because it uses the other members
};

} // namespace isostat
