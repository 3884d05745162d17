#pragma once
/// \file
/// `verify` of one run and of many, with its output; `verify --coq`: the checker whose correctness is proved in Coq.

#include "cli/commands.hpp"
#include "cli/common.hpp"

#include <isostat/checker/verify.hpp>

#include <string>

namespace isostat::cli {

/// Verifies the finished run of a folder from its records alone.
int verify_folder(const std::string& folder, const Common& common);
/// Verifies each run of an ensemble, one after the other. 1: a record is wrong; else 65: a run cannot be read; else 2:
/// something is undecided, unfinished or missing; else 0.
int verify_ensemble(const std::string& folder, const Common& common);

/// The output of `--json` for a run.
Json json_of(const RunVerification& run, const std::string& folder);

/// Prints numbers of arcs and equilibria, and the verdict.
void print_totals(const RunVerification& run);

/// Coq's kernel evaluates the checker; or OCaml runs it, extracted by Coq.
enum class CoqChecker { kernel, extracted };

/// The claims of a certificate, proved by Coq from its own definitions
/// (proofs/coq_checker.md): proved, or undecided with the reason, which may be that Coq is not
/// installed or that its checker does not cover this kind of packing. `digest`: the SHA-256 of
/// the content that was read; other content is not proved. `limit`: seconds; 0: no limit.
ClaimCheck ask_coq(CoqChecker checker, const std::string& certificate, const std::string& digest, double limit,
                   bool quiet);

} // namespace isostat::cli
