#pragma once
// Anderson's acceleration of a fixed-point iteration: private to the room.

#include <array>
#include <cstddef>
#include <vector>

namespace isostat {

/// An iteration x <- x + y(x) whose y shrinks slowly along a few directions. From the last changes of x and what they
/// did to y, the next change is chosen so that the part of y along those directions vanishes (to first order). Costs
/// a few vector operations, and changes the way to the fixed point, not the point.
class Acceleration {
  public:
    void clear() { count_ = 0; }
    /// Replaces y(x) by the better change of x, and remembers both.
    void improve(std::vector<double>& y);

  private:
    static constexpr std::size_t depth = 3;
    struct Change {
        std::vector<double> x, y; ///< of one iteration to the next
    };
    std::array<Change, depth> changes_;
    std::array<std::array<double, depth>, depth> products_{}; ///< of their y
    std::vector<double> x_, y_;                               ///< last change of x, last y
    std::size_t count_ = 0;                                   ///< calls since the start
};

} // namespace isostat
