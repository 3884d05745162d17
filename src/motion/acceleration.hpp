#pragma once
// Anderson's acceleration of a fixed-point iteration: private to the room.

#include <array>
#include <cstddef>
#include <vector>

namespace isostat {

/// Speeds up an iteration x <- x + y(x) whose y shrinks slowly along a few directions. From the last changes of x and
/// the resulting changes of y, the next change is chosen so that the part of y along those directions vanishes (to
/// first order). Costs a few vector operations, and changes the iterates, not the fixed point.
class Acceleration {
  public:
    void clear() { count_ = 0; }
    /// Replaces y(x) by the better change of x, and remembers both vectors.
    void improve(std::vector<double>& y);

  private:
    static constexpr std::size_t depth = 3;
    struct Change {
        std::vector<double> x, y; ///< changes of x and y in one iteration
    };
    std::array<Change, depth> changes_;
    std::array<std::array<double, depth>, depth> products_{}; ///< scalar products of the changes of y
    std::vector<double> x_, y_;                               ///< last change of x, last y
    std::size_t count_ = 0;                                   ///< calls since the start
};

} // namespace isostat
