#pragma once
/// \file
/// A vertex on the way of floating steering, and guesses of it before the arc that leads there is followed: private to
/// the room.

#include "contact/candidates.hpp"
#include "core/parallel.hpp"
#include "linear/factorisation.hpp"
#include "motion/arc.hpp"
#include "statics/decisions.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// The force that the choice of the opening contact compares: -|f| of a held coordinate; a bar never opens.
inline double signed_size(const Contact& contact, double force) {
    return contact.kind == ContactKind::held  ? -std::abs(force)
           : contact.kind == ContactKind::bar ? std::numeric_limits<double>::infinity()
                                              : force;
}

/// The position of the most negative force in the backbone, or outside; the number of forces when none is negative.
std::size_t most_negative(std::span<const double> f, const std::vector<Contact>& contacts,
                          const std::vector<unsigned char>& backbone, bool inside = true);

/// The vertex at the end of an arc as predicted at its start. All of this is a guess, which is checked against the
/// vertex or refined there before use.
struct PredictedVertex {
    std::optional<ExchangedContacts> contacts;
    std::vector<int> loaded;             ///< degrees of freedom, as at the start
    std::vector<unsigned char> backbone; ///< contacts that carry finite force at the predicted vertex
    std::vector<double> force;           ///< rough forces
    ContactId opens;                     ///< contact that opens next according to these forces; or none
    int passes = 0;                      ///< passes of the factors that the forces took
};

/// `from`: the structure at the start, followed by the degrees of freedom loaded there, its forces, and an operator
/// close to the inverse of its matrix. Cost: one exchange, and two applications of this operator.
PredictedVertex predict(const IsostaticStructure& from, const std::vector<int>& loaded,
                        const std::vector<double>& force, const ApproximateInverse& approximate, const Load& load,
                        ContactId opens, const ArcDeparture::Expected& end);

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
