#pragma once
/// \file
/// Quantities that the rounding of the imported file leaves undecided. Proofs hold for the doubles of the state, and
/// for the packing that the file was written from if no gap and no force is that small.

#include <isostat/certificate/certify.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

/// `rounding` in the provenance of a state, a bound of the error of a gap from the file; 0: not imported. Throws
/// `Error(bad_input)` for a bad value.
double imported_rounding(const State& state);

/// Words on a state that is a copy of a file with other radii (`jitter` of the provenance): what its verdicts are
/// about. Empty: it is no such copy.
std::string words_of_copy(const State& state);

/// Quantities that cannot be told from 0 when every gap of a contact is off by the rounding.
struct Untold {
    double rounding = 0;
    int dimension = 2;           ///< of the packing
    std::vector<Contact> gaps;   ///< gaps of other pairs, which may be contacts
    bool rattlers = false;       ///< some of these pairs are of rattlers, which may then carry a force
    std::vector<Contact> forces; ///< contacts whose force may be 0
    int contacts = 0;            ///< contacts that carry a force
    bool refuted = false;        ///< an overlap or a negative force is larger than the rounding
    [[nodiscard]] bool any() const { return !gaps.empty() || !forces.empty(); }
    [[nodiscard]] std::string words() const;
};

/// Computes from sixteen copies with gaps changed by the rounding, with random signs, the quantities smaller than twice
/// their largest change. A diagnosis, no bound. Empty without a true vertex or with a rounding of 0.
Untold untold_by(double rounding, const State& state, const Certification& truth);

/// The verdict on the packing: undecided where a quantity is; what is proved of the doubles becomes the reason.
Verdict withheld(const Untold& untold, Verdict of_the_doubles);
void withhold(const Untold& untold, Inspection& inspection);
void withhold(const Untold& untold, JammingAnswer& answer);
void withhold(const Untold& untold, CellInspection& cell);

} // namespace isostat::compare
