#pragma once
/// \file
/// Why a series leaves the exact run: a diagnosis.

#include "compare/frame.hpp"
#include "compare/path.hpp"

namespace isostat::compare {

/// The departure at the first frame that is not `same` (frames in motion do not count). Nothing: no such frame.
std::optional<Departure> find_departure(const Series& series, const std::vector<JudgedFrame>& frames, const Path& path,
                                        const Bundle& bundle, const CompareOptions& options);

} // namespace isostat::compare
