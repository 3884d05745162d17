#pragma once
/// \file
/// The verdict on one frame without the exact run.

#include <isostat/compare/compare.hpp>

namespace isostat::compare {

/// A frame judged without the exact run: `status` is file, moving, soft, refuted, undecided, or `same` where its vertex
/// is proved (the exact run then decides which equilibrium it is).
struct JudgedFrame {
    FrameResult result;
    std::vector<Contact> list;     ///< list of the file
    std::vector<Contact> pressed;  ///< for a frame in motion, every contact with a positive force
    std::vector<Contact> downhill; ///< list of the vertex that exchange found and proved; or empty
    std::string note;              ///< words on its cell
    std::optional<State> state;    ///< complete, if asked for or if exchange found it
};

/// The load with its stresses divided by a number.
Load over(Load load, double scale);

/// \p complete: fill `state` also for a vertex that Newton's method found.
JudgedFrame judge(const Series& series, const Frame& frame, bool complete);

} // namespace isostat::compare
