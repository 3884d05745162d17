#pragma once
/// \file
/// What the rounding of the file that a state was imported from leaves open. Proofs speak of the doubles of the state;
/// of the packing that the file was written from they hold where no gap and no force is that small.

#include <isostat/certificate/certify.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

/// `rounding` of the provenance of a state, a bound of what is not known of a gap of the file; 0: it was not imported.
/// Throws `Error(bad_input)` for a value that is none.
double imported_rounding(const State& state);

/// Words where the state is a copy of a file with other radii (`jitter` of the provenance): of what its verdicts speak.
/// Empty: it is none.
std::string words_of_copy(const State& state);

/// What cannot be told apart from 0 when every gap of a contact is off by the rounding.
struct Untold {
    double rounding = 0;
    int dimension = 2;           ///< of the packing
    std::vector<Contact> gaps;   ///< of other pairs: there may be a contact
    bool rattlers = false;       ///< some of them are of rattlers, which may then carry a force
    std::vector<Contact> forces; ///< of contacts: there may be none
    int contacts = 0;            ///< that carry a force
    bool refuted = false;        ///< an overlap or a negative force is larger than that
    [[nodiscard]] bool any() const { return !gaps.empty() || !forces.empty(); }
    [[nodiscard]] std::string words() const;
};

/// Found from sixteen copies whose gaps are off by the rounding, with signs drawn at random: what is less than twice
/// the largest change in them. Diagnosis, not a bound. Nothing without a true vertex or with a rounding of 0.
Untold untold_by(double rounding, const State& state, const Certification& truth);

/// Of the packing the verdict is open where something is untold; what is proved of the doubles becomes the reason.
Verdict withheld(const Untold& untold, Verdict of_the_doubles);
void withhold(const Untold& untold, Inspection& inspection);
void withhold(const Untold& untold, JammingAnswer& answer);
void withhold(const Untold& untold, CellInspection& cell);

} // namespace isostat::compare
