#pragma once
/// \file
/// One frame, without looking at the exact run.

#include "compare/reading.hpp"

#include <isostat/compare/compare.hpp>

namespace isostat::compare {

/// A frame as far as it can be judged alone: `status` is file, moving, soft, refuted, undecided, or `same` where its
/// vertex is proved (which equilibrium it is, the exact run tells).
struct JudgedFrame {
    FrameResult result;
    std::vector<Contact> list;     ///< of the file
    std::vector<Contact> pressed;  ///< of a frame in motion, every contact with a positive force
    std::vector<Contact> downhill; ///< of the vertex that exchange found, proved; or none
    std::string note;              ///< on its cell
    std::optional<State> state;    ///< complete, where one was asked for or exchange found it
};

/// The load with its stresses over a number.
Load over(Load load, double scale);

/// \p complete: make `state` also of a vertex that Newton's method found.
JudgedFrame judge(const Series& series, const Frame& frame, bool complete);

} // namespace isostat::compare
