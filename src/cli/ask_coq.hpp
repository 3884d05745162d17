#pragma once
/// \file
/// `verify --coq`: the checker whose correctness is proved in Coq.

#include <isostat/checker/verify.hpp>

#include <string>

namespace isostat::cli {

/// Coq's kernel evaluates the checker; or OCaml runs it, extracted by Coq.
enum class CoqChecker { kernel, extracted };

/// The claims of a certificate, proved by Coq from its own definitions
/// (proofs/coq_checker.md): proved, or undecided with the reason, which may be that Coq is not
/// installed or that its checker does not cover this kind of packing. `digest`: the SHA-256 of
/// the content that was read; other content is not proved. `limit`: seconds; 0: no limit.
ClaimCheck ask_coq(CoqChecker checker, const std::string& certificate, const std::string& digest, double limit,
                   bool quiet);

} // namespace isostat::cli
