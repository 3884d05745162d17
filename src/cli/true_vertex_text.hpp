#pragma once
/// \file
/// How `certify` and `inspect` say what is proved of the true vertex.

#include "cli/common.hpp"
#include "compare/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::cli {

/// One line per claim with its bounds and the arithmetic that proved it; absent ones with the reason.
void print_claims(const Certification& certification);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// The same for programs; null where a claim is absent.
Json claims_json(const Certification& certification);

/// What is proved of the true configuration near a stored one, in the words of `inspect`.
void print_true_vertex(const Certification& certification);
Json true_vertex_json(const Certification& certification);

/// How far the forces that a state file holds are from the proved ones, and where; nothing where it holds none or none
/// are known. They are no part of what is proved.
void print_forces_in_file(const StateFile& file, const Certification& truth);
void add_forces_in_file(Json& object, const StateFile& file, const Certification& truth);

/// What the rounding of a file leaves open, if anything.
void add_untold(Json& object, const compare::Untold& untold, Verdict of_the_doubles);

} // namespace isostat::cli
