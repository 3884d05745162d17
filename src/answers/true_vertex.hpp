#pragma once
/// \file
/// How `certify` and `inspect` say what is proved of the true vertex.

#include "io/json.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::answers {

/// One line per claim with its bounds and the arithmetic that proved it; absent ones with the reason. `contacts`: of
/// the state; the smallest force is that of a contact, not of a bar.
void print_claims(std::string& out, const Certification& certification, const std::vector<Contact>& contacts);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// The same for programs; null where a claim is absent.
json::Json claims_json(const Certification& certification, const std::vector<Contact>& contacts);

/// What is proved of the true configuration near a stored one, in the words of `inspect`.
void print_true_vertex(std::string& out, const Certification& certification);
json::Json true_vertex_json(const Certification& certification);

/// How far the forces that a state file holds are from the proved ones, and where; nothing where it holds none or none
/// are known. They are no part of what is proved.
void print_forces_in_file(std::string& out, const StateFile& file, const Certification& truth);
void add_forces_in_file(json::Json& object, const StateFile& file, const Certification& truth);

/// What the rounding of a file leaves open, if anything.
void add_untold(json::Json& object, const compare::Untold& untold, Verdict of_the_doubles);

} // namespace isostat::answers
