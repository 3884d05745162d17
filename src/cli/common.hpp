#pragma once
/// \file
/// What several subcommands share.

#include <isostat/core/result.hpp>
#include <isostat/core/verdict.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace isostat::cli {

using Json = nlohmann::ordered_json;

/// null for infinities and NaN, which JSON does not have.
Json number(double value);

/// One line on standard output.
void print_json(const Json& object);

/// Decimal number with that many digits that is not below (not above) the value.
std::string rounded_up(double value, int digits);
std::string rounded_down(double value, int digits);

/// "value +- bound" of an interval: what is printed contains it. 12 digits, or more where the interval is narrower.
std::string with_bound(double lower, double upper);

/// Exit status of a domain failure: 2 for ties and undecided signs, 130 when the user stopped it, 1 otherwise.
int status_of(FailureKind kind);

/// 0 proved, 1 refuted, 2 undecided.
int status_of(Verdict verdict);

/// What may help after a failure: equal radii tie, and a jitter of a prepared scene makes them different. Empty:
/// nothing.
std::string advice(const Scene& scene, const Failure& failure, std::vector<double> radius);

/// The start of a scene that reads one: file, overrides of [load], checks in the words of a user, and then the grid
/// (`snap_to_grid`; the provenance says in `moved_to_grid` by how much it moved a coordinate, when it did). Throws
/// `Error(bad_input)`.
State<2> load_start(const Scene& scene);

/// Prepares the packing of a scene with progress on the terminal. After a failure, what was reached is in `failed`
/// (atomically).
Result<State<2>> prepare_start(const Scene& scene, const std::string& command, bool quiet,
                               const std::filesystem::path& failed);

} // namespace isostat::cli
