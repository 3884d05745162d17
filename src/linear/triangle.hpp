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
    /// The entry of a line with this number; 0 when there is none.
    [[nodiscard]] double entry(std::size_t line, int number) const;
};

/// Block diagonal of triangles: L by columns or U by rows, so that unknowns that depend on a line have a greater
/// number. Both solves read the same lines: forwards each known unknown is subtracted from the others, backwards each
/// unknown collects from the others.
///
/// The number of loads from memory and mispredicted jumps limit the speed of such a solve. So adjacent lines with
/// nearly the same pattern (the two unknowns of a grain, most lines near the end) make one step of two or four lines,
/// with zeros where they differ, because an index and an unknown then serve several entries. Adjacent steps of one
/// shape that do not depend on each other make a run, which one function for that shape executes. To make runs longer,
/// rare numbers of entries are rounded up with entries 0.
class Triangle {
  public:
    /// `blocks`: first lines, and the number of lines. `unit`: the diagonal is 1, and is not read.
    Triangle(const Lines& lines, const std::vector<int>& blocks, bool unit);
    /// Block b of the unknowns x: `forwards` is x <- T^-1 x for a triangle by columns, T^-T x for one by rows;
    /// `backwards` is the reverse. x has `spare` more unknowns behind those of all blocks, which are 0.
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
    std::vector<Place> block_; ///< where each block begins, and the end of the last one
    std::vector<Run> runs_;
    // By step: the first line, then the numbers of its entries; the inverse diagonals, the entries between its lines,
    // then its lines entry by entry.
    std::vector<int> index_;
    std::vector<double> value_;
};

} // namespace isostat
