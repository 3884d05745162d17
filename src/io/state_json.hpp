#pragma once
/// \file
/// A state as a part of another document.

#include "io/json.hpp"

#include <isostat/io/state_file.hpp>

namespace isostat::json {

/// The state that `parse_state` reads, from an object of a document. Throws `Error(bad_input)`.
template <int Dim> StateFile<Dim> state_from_json(const Field& document, const std::string& source);

} // namespace isostat::json
