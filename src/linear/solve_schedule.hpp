#pragma once
// The triangular solves of KLU's factors, laid out for speed: private to the room.

#include <klu.h>

#include <span>
#include <vector>

namespace isostat {

/// Solves with P A Q = L U + F (block upper triangular, F above the blocks). What bounds a triangular solve is the
/// number of loads, and the two unknowns of a grain make successive columns of L, and rows of U, with nearly the same
/// pattern: they are taken two at a time, with zeros where they differ, so that an index and an unknown serve two
/// entries. Both solves read the same lines, one way forwards (each unknown, once known, is taken out of the others),
/// the other way backwards (each unknown collects from the others). Inside a block the lines are ordered by level of
/// dependence and then by length, so that neighbours do not wait for each other and a branch predictor knows the
/// lengths.
class SolveSchedule {
  public:
    /// Cost: about half of the factorisation.
    SolveSchedule(klu_symbolic& symbolic, klu_numeric& numeric);
    /// x <- A^-1 x, and x <- A^-T x. Zeros that follow from the pattern stay exact.
    void solve(std::span<double> x) const;
    void solve_transposed(std::span<double> x) const;

    /// A sparse matrix by columns or rows.
    struct Lines {
        std::vector<int> start, index;
        std::vector<double> value;
        Lines(int lines, int entries);
        [[nodiscard]] Lines transposed() const;
    };

  private:
    /// L by columns, or U by rows: what depends on a line has a greater number.
    class Triangle {
      public:
        Triangle(const Lines& lines, const std::vector<int>& blocks);
        /// Block b: x <- T^-1 x for a triangle by columns, T^-T x for one by rows, and the other way round. `scale`:
        /// inverse diagonal, not read where that is known to be 1.
        template <bool unit> void forwards(std::size_t b, const double* scale, double* x) const;
        template <bool unit> void backwards(std::size_t b, const double* scale, double* x) const;

      private:
        /// One line, or this and the next. The values of two lines are interleaved, after the entry that links them.
        struct Step {
            int line, entries;
            bool two;
        };
        struct Place {
            std::size_t step, index, value;
        };
        std::vector<Place> block_; ///< where each begins, and the end of the last
        std::vector<Step> steps_;
        std::vector<int> index_;
        std::vector<double> value_;
    };
    /// An entry of F.
    struct Beside {
        int row, column;
        double value;
    };
    struct Parts;
    explicit SolveSchedule(Parts parts);

    std::vector<int> rows_, columns_; ///< P and Q
    Triangle lower_, upper_;
    std::vector<double> scale_; ///< inverse diagonal of U
    std::vector<Beside> beside_;
    std::vector<std::size_t> beside_start_; ///< by block of the row
};

} // namespace isostat
