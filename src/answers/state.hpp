#pragma once
/// \file
/// The output of `inspect` for a state.

#include "certificate/jammed_box.hpp"
#include "io/json.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/state_file.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::answers {

/// What is proved of a state. Verdicts that the rounding of its file leaves open are withheld.
struct StateAnswer {
    const StateFile& file;
    Result<Inspection> result;
    Certification truth;
    std::optional<CellInspection> cell;
    std::optional<BoxInspection> box;
    compare::Untold untold;
    std::vector<double> singular_values; ///< the smallest ones, for a structure proved regular

    [[nodiscard]] bool refuted() const { return !result.ok() && result.failure().kind == FailureKind::not_isostatic; }
};

/// \p singular_values: how many; absent: ten for spheres, 0 for disks. \pre the file outlives the answer
StateAnswer answer_of(const StateFile& file, std::optional<int> singular_values);

/// \p each_force: prints every force too.
std::string to_text(const StateAnswer& answer, bool each_force);
/// \p file: its name.
json::Json to_json(const StateAnswer& answer, const std::string& file);

} // namespace isostat::answers
