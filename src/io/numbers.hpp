#pragma once
/// \file
/// Numbers as words of files and of the command line, and what the digits of a file leave open of its numbers.

#include <cstdint>
#include <optional>
#include <string_view>

namespace isostat {

/// A finite number, all of the word; a sign + may stand before it.
std::optional<double> finite_number(std::string_view word);

/// The same as programs write it: D or d may begin the exponent (Fortran).
std::optional<double> written_number(std::string_view word);

/// An integer as one writes it: digits, a sign - before them where it is needed, no zeros in front.
std::optional<std::int64_t> plain_integer(std::string_view word);

/// Numbers of one kind as they were written, with at most so many significant digits. Numbers of few digits all, like
/// 0.5 or 15.46, are taken as they stand; where there are more, the digits after the last one were cut off.
class Digits {
  public:
    void see(std::string_view number);
    /// And those that others saw.
    void see(const Digits& others);
    /// So far may the numbers be from what was meant: half a unit of the last digit of the largest one, and what
    /// doubles round. \p others: digits of other numbers of the file; where these have more, the zeros after the last
    /// digit were left out, not the digits.
    [[nodiscard]] double rounding(int others = 0) const;
    [[nodiscard]] int most() const { return most_; }
    /// Largest size.
    [[nodiscard]] double largest() const { return largest_; }

  private:
    int most_ = 0;
    double largest_ = 0;
};

/// Bound of the change of a gap of grains and walls when every coordinate is off by `place`, every bound of the box,
/// period and tilt by `side`, every radius by `radius`. Of an image in a neighbouring cell. A tilted box may be that of
/// a dump, whose bounds are those of all its corners.
struct BoxKind {
    int dimension = 2;
    bool tilted = false;
};
double rounding_of_gaps(double place, double side, double radius, BoxKind box = {});

} // namespace isostat
