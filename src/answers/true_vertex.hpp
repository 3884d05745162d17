#pragma once
/// \file
/// The output of `certify` and `inspect` on what is proved of the true vertex.

#include "answers/answer.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::answers {

/// `claims`, null where a claim is absent: one line per claim with its bounds and the arithmetic that proved it; absent
/// claims with the reason. `contacts`: of the state; the smallest force is that of a contact, not of a bar.
void add_claims(Answer& out, const Certification& certification, const std::vector<Contact>& contacts);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// `true_configuration`: what is proved of the true vertex near a stored configuration, in the words of `inspect`.
void add_true_vertex(Answer& out, const Certification& certification);

/// How far the forces in a state file are from the proved ones, and where; nothing when the file holds none or none are
/// known. These forces are no part of the proof.
void add_forces_in_file(Answer& out, const StateFile& file, const Certification& truth);

/// Adds what the rounding of a file leaves undecided, if anything; its words are of the command.
void add_untold(Answer& out, const compare::Untold& untold, Verdict of_the_doubles);

} // namespace isostat::answers
