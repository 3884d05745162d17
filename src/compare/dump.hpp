#pragma once
/// \file
/// LAMMPS dumps of styles custom and local: frame after frame, rows of numbers under names.

#include "io/foreign_source.hpp"

#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// The rows of one frame.
struct DumpFrame {
    long timestep = 0;
    int line = 0; ///< of the names
    std::vector<std::string> names;
    std::vector<foreign::Line> rows;
};

class Dump {
  public:
    /// Reads the file. \p item: "ATOMS" or "ENTRIES".
    Dump(const std::string& path, std::string item);
    Dump(const Dump&) = delete;
    Dump& operator=(const Dump&) = delete;

    /// The frame of this time step; frames before it are passed over. Throws when there is none.
    DumpFrame at(long timestep);
    /// Column, or -1; and the same, which must be there.
    [[nodiscard]] int find(const DumpFrame& frame, const std::string& name) const;
    [[nodiscard]] std::size_t column(const DumpFrame& frame, const std::string& name) const;
    /// "FILE:LINE".
    [[nodiscard]] std::string where(int line) const;
    [[nodiscard]] const std::string& source() const { return source_; }

  private:
    std::optional<DumpFrame> next();
    std::string source_, text_, item_;
    foreign::Lines lines_;
};

} // namespace isostat::compare
