#pragma once
// Triangular solves laid out for speed: private to the room.

#include <cstddef>
#include <vector>

namespace isostat {

/// A sparse matrix by columns or rows.
struct Lines {
    std::vector<int> start, index;
    std::vector<double> value;
    Lines(int lines, int entries);
    [[nodiscard]] Lines transposed() const;
    /// 0 when there is none.
    [[nodiscard]] double entry(std::size_t line, int number) const;
};

/// Block diagonal of triangles: L by columns or U by rows, so that what depends on a line has a greater number. Both
/// solves read the same lines, one way forwards (each unknown, once known, is taken out of the others), the other way
/// backwards (each unknown collects from the others).
///
/// What bounds such a solve is the number of loads, and the jumps that a processor does not foresee. Lines that follow
/// each other with nearly the same pattern, as those of the two unknowns of a grain, and most of them near the end,
/// are one step of two or four, with zeros where they differ: an index and an unknown then serve several entries. Steps
/// of one shape that need not wait for each other make a run, which one function does that knows the shape. For that,
/// numbers of entries are rounded up where few steps have that number: the entries added are 0.
class Triangle {
  public:
    /// `blocks`: first lines, and the number of lines. `unit`: the diagonal is 1, and not read.
    Triangle(const Lines& lines, const std::vector<int>& blocks, bool unit);
    /// Block b of the unknowns x: x <- T^-1 x for a triangle by columns, T^-T x for one by rows, and the other way
    /// round. Behind the unknowns of all blocks x has `spare` more, that are 0.
    void forwards(std::size_t b, double* x) const;
    void backwards(std::size_t b, double* x) const;
    static constexpr int spare = 4;

    /// Steps of one shape.
    struct Run {
        int width, entries, steps;
    };

  private:
    struct Place {
        std::size_t run, index, value;
    };
    struct Layout;
    bool unit_;
    std::vector<Place> block_; ///< where each begins, and the end of the last
    std::vector<Run> runs_;
    // By step: the first line, then the numbers of its entries; the inverse diagonals, the entries between its lines,
    // then entry by entry its lines.
    std::vector<int> index_;
    std::vector<double> value_;
};

} // namespace isostat
