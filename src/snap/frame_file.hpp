#pragma once
// Files of frames: LAMMPS dumps of styles custom and local, extended XYZ, tables with a column of time steps.

#include "foreign/source.hpp"

#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// One frame with its rows, which refer to `text`.
struct FileFrame {
    foreign::FrameHeader header;
    std::vector<TextLine> rows;
    std::unique_ptr<std::string> text;
};

/// A file frame by frame: one frame is in memory at a time. The first line shows the format. Time steps are those of a
/// dump, the key Timestep of XYZ (without this key the number of the frame, from 0), the column `timestep` of a table
/// (without this column the table is one frame, 0). Coordinates of XYZ are named x, y, z as in the other formats.
class FrameFile {
  public:
    /// \p item: "ATOMS" or "ENTRIES". Throws when the file cannot be read.
    FrameFile(std::string path, std::string item);
    FrameFile(const FrameFile&) = delete;
    FrameFile& operator=(const FrameFile&) = delete;

    /// The next frame; nothing at the end of the file.
    std::optional<FileFrame> next();
    /// The frame of this time step; frames before it are skipped. Throws when no frame has it, and when time steps do
    /// not grow up to this one.
    FileFrame at(long timestep);
    /// The column, which must exist; where its name comes twice in the frame the values agree.
    [[nodiscard]] std::size_t column(const FileFrame& frame, const std::string& name) const;
    /// "FILE:LINE".
    [[nodiscard]] std::string where(int line) const;
    /// Throws an error at the end of the file.
    template <class... Values> [[noreturn]] void fail(fmt::format_string<Values...> message, Values&&... values) const {
        refuse(where(lines_), message, std::forward<Values>(values)...);
    }

  private:
    enum class Format { dump, xyz, table };
    /// The next line with its end; empty at the end of the file.
    std::string take_line();
    void recognise();
    /// The lines of the next frame.
    std::string take_dump();
    std::string take_xyz();
    std::string take_table();
    /// Reads the header of an XYZ frame.
    void read_xyz(TextLines& lines, foreign::FrameHeader& header) const;
    void read_rows(TextLines& lines, FileFrame& frame) const;
    void read_table(TextLines& lines, FileFrame& frame) const;

    std::string source_, item_;
    std::ifstream file_;
    Format format_ = Format::dump;
    foreign::TableNames names_; ///< for a table
    int step_ = -1;             ///< the column of time steps in a table
    std::string pending_;       ///< first line of the next frame
    int lines_ = 0;             ///< lines before `pending_`
    long frames_ = 0;           ///< frames read
    long last_ = -1;            ///< time step of the last frame that `at` returned
};

/// Names of the columns of a LAMMPS dump of style local, or of a table: two ids and the force between them, positive
/// when it repels, or the components of its vector.
struct PairColumns {
    std::string first, second;
    std::vector<std::string> force;
};

struct PairForce {
    int i = 0, j = 0;        ///< i < j
    PerAxis<double> force{}; ///< a number, or a vector: reversed where the row names j first
    int line = 0;            ///< line of the file
};

/// The pairs of disks with a force that is not 0 in one frame (from 0; nothing: the last frame) of a dump of style
/// local (`compute property/local`, `compute pair/local`) or of a table, whose frames a column `timestep`
/// distinguishes. The pairs are in the order of the file: a pair may touch through several images. \p ids: of the
/// disks. Throws `Error(bad_input)` with file, line, value and what was expected: also for unknown columns and ids.
std::vector<PairForce> read_local_dump(const std::filesystem::path& path, const PairColumns& columns,
                                       const std::vector<long>& ids, std::optional<long> frame);

} // namespace isostat::compare
