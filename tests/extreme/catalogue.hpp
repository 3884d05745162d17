#pragma once
// The catalogue of extreme cases: what was asked, what came out, and by what it was checked. Every case adds a row; the
// rows become a table at the end. A wrong answer is a failed test, and so is an outcome
// that is not that of the committed table; an honest refusal is a row.

#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <chrono>

namespace extreme {

using namespace isostat;

struct Row {
    std::string family, parameter;
    int disks = 0;
    std::string outcome; ///< proved, refuted, undecided, refused
    std::string reason;  ///< of everything but proved
    std::string rung;
    double bound = -1; ///< proved bound of the error of every force / largest force; negative: none was proved
    double seconds = 0;
    std::string checked; ///< by what
};

/// The outcome must be that of the committed table, extremes.csv.
void add(Row row);

class Clock {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Inspects a state and checks what was said about it:
/// - proved: every force positive in lexicographic order, to 200 digits, and every force within its bound; no pair
///   overlaps by more than the rounding of the coordinates;
/// - refuted: a force that is negative to 200 digits, or a pair that overlaps, or a matrix that is singular.
/// Adds the row. Returns the inspection, if there is one.
std::optional<Inspection> inspect(const std::string& family, const std::string& parameter, const State& state);

/// Prepares a packing and inspects it as above when it has at most `dense` disks
/// (larger ones: no overlap by brute force or by the certificate, counting). A failure is a row with its reason.
std::optional<State> prepared(const std::string& family, const std::string& parameter,
                              const PreparationOptions& options);

} // namespace extreme
