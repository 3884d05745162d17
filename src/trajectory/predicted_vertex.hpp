#pragma once
// Guesses of a vertex before the arc that leads there is followed: private to the room.

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

} // namespace isostat
