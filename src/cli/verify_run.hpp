#pragma once
/// \file
/// `verify` of runs: its words, of one and of many.

#include "cli/commands.hpp"
#include "cli/common.hpp"

#include <isostat/checker/verify.hpp>

#include <string>

namespace isostat::cli {

/// The finished run of a folder from its records alone.
int verify_folder(const std::string& folder, const Common& common);
/// Each run of an ensemble, one after the other. 1: a record is wrong; else 65: a run cannot be read; else 2: something
/// is undecided, unfinished or missing; else 0.
int verify_ensemble(const std::string& folder, const Common& common);

/// What `--json` says of a run.
Json json_of(const RunVerification& run, const std::string& folder);

/// Arcs, equilibria, and the verdict.
void print_totals(const RunVerification& run);

} // namespace isostat::cli
