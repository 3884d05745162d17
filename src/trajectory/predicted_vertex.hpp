#pragma once
// What is known of a vertex before the arc that leads there is followed: private to the room.

#include "linear/approximate_inverse.hpp"
#include "motion/arc.hpp"
#include "rigidity/isostatic.hpp"

#include <isostat/packing/load.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace isostat {

/// A force as the choice of what opens compares it: a bar never opens.
inline double signed_size(const Contact& contact, double force) {
    return contact.kind == ContactKind::held  ? -std::abs(force)
           : contact.kind == ContactKind::bar ? std::numeric_limits<double>::infinity()
                                              : force;
}

/// The most negative of the forces in the backbone, or of those outside; the number of all when none is negative.
std::size_t most_negative(std::span<const double> f, const std::vector<Contact>& contacts,
                          const std::vector<unsigned char>& backbone, bool inside = true);

/// The vertex at the end of an arc as the start of the arc predicts it. A guess: what is made of it is checked
/// against the vertex, or refined there.
struct PredictedVertex {
    std::optional<ExchangedContacts> contacts;
    std::vector<int> loaded;             ///< degrees of freedom, as at the start
    std::vector<unsigned char> backbone; ///< with these
    std::vector<double> force;           ///< rough
    ContactId opens;                     ///< what opens next, with these forces; or none
    int passes = 0;                      ///< of the factors, for the forces
};

/// `from`: the start, with the degrees of freedom loaded there, its forces, and an operator close to the inverse of its
/// matrix. Cost: one exchange, and two applications of that.
PredictedVertex predict(const IsostaticStructure& from, const std::vector<int>& loaded,
                        const std::vector<double>& force, const ApproximateInverse& approximate, const Load& load,
                        ContactId opens, const ArcDeparture::Expected& end);

} // namespace isostat
