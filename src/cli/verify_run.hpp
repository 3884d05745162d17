#pragma once
/// \file
/// `verify` of one run and of many, with its output.

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

} // namespace isostat::cli
