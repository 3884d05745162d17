#pragma once
/// \file
/// Why a series leaves the exact run: a diagnosis.

#include "compare/frame.hpp"
#include "compare/path.hpp"

namespace isostat::compare {

/// Of the first frame that is not `same` (frames in motion alone are no departure). None: there is no such frame.
std::optional<Departure> find_departure(const Series& series, const std::vector<JudgedFrame>& frames, const Path& path,
                                        const Bundle& bundle, const CompareOptions& options);

} // namespace isostat::compare
