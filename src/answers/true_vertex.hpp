#pragma once
/// \file
/// The output of `certify` and `inspect` on what is proved of the true vertex.

#include "io/json.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::answers {

/// One line per claim with its bounds and the arithmetic that proved it; absent claims with the reason. `contacts`: of
/// the state; the smallest force is that of a contact, not of a bar.
void print_claims(std::string& out, const Certification& certification, const std::vector<Contact>& contacts);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// The claims of `print_claims` for programs; null where a claim is absent.
json::Json claims_json(const Certification& certification, const std::vector<Contact>& contacts);

/// What is proved of the true vertex near a stored configuration, in the words of `inspect`.
void print_true_vertex(std::string& out, const Certification& certification);
json::Json true_vertex_json(const Certification& certification);

/// How far the forces in a state file are from the proved ones, and where; nothing when the file holds none or none are
/// known. These forces are no part of the proof.
void print_forces_in_file(std::string& out, const StateFile& file, const Certification& truth);
void add_forces_in_file(json::Json& object, const StateFile& file, const Certification& truth);

/// Adds what the rounding of a file leaves undecided, if anything.
void add_untold(json::Json& object, const compare::Untold& untold, Verdict of_the_doubles);

} // namespace isostat::answers
