#pragma once
// LAMMPS dumps of styles custom and local: the header of a frame, and a file frame by frame.

#include "io/foreign_source.hpp"

#include <array>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::foreign {

/// What stands before the rows of a frame.
struct DumpHeader {
    long timestep = 0;
    long rows = -1;
    int line = 0; ///< of the names
    std::vector<std::string> names;
    std::array<double, 4> box{};
    double tilt = 0; ///< xy
    std::array<Boundary, 2> boundary{Boundary::unknown, Boundary::unknown};
    std::array<bool, 2> loose{};
};

/// Reads the items up to the names of the columns. \p item: "ATOMS" or "ENTRIES".
DumpHeader read_dump_header(Lines& lines, const std::string& item);

/// One frame with its rows. They refer to `text`.
struct DumpFrame {
    DumpHeader header;
    std::vector<Line> rows;
    std::unique_ptr<std::string> text;
};

/// A file frame by frame: one frame is in memory at a time.
class DumpFile {
  public:
    /// \p item: "ATOMS" or "ENTRIES". Throws when the file cannot be read.
    DumpFile(std::string path, std::string item);
    DumpFile(const DumpFile&) = delete;
    DumpFile& operator=(const DumpFile&) = delete;

    /// Nothing at the end of the file.
    std::optional<DumpFrame> next();
    /// The frame of this time step; frames before it are passed over. Throws when there is none, and when time steps
    /// do not grow on the way to it.
    DumpFrame at(long timestep);
    /// The column, which must be there.
    [[nodiscard]] std::size_t column(const DumpFrame& frame, const std::string& name) const;
    /// "FILE:LINE".
    [[nodiscard]] std::string where(int line) const;
    /// Throws about the end of the file.
    [[noreturn]] void fail(const std::string& message) const;

  private:
    std::unique_ptr<std::string> take_text();
    std::string source_, item_;
    std::ifstream file_;
    std::string pending_; ///< first line of the next frame
    int lines_ = 0;       ///< before it
    long last_ = -1;      ///< time step that `at` came to
};

} // namespace isostat::foreign
