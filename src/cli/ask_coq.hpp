#pragma once
/// \file
/// `verify --coq`: the checker that Coq knows to be right.

#include <isostat/checker/verify.hpp>

#include <string>

namespace isostat::cli {

/// The claims of a certificate, proved by Coq from its own definitions (proofs/coq_checker.md): proved, or undecided
/// with the reason, which may be that Coq is not installed or that its checker does not cover this kind of packing.
/// `digest`: the SHA-256 of what was read of the file; nothing is proved of another content. `limit`: seconds; 0: as
/// long as it takes.
ClaimCheck ask_coq(const std::string& certificate, const std::string& digest, double limit, bool quiet);

} // namespace isostat::cli
