#pragma once
/// \file
/// State files: one vertex, complete, with numbers that come back bit for bit.

#include <isostat/contact/state.hpp>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace isostat {

/// What a state file holds.
struct StateFile {
    State state;
    std::vector<double>
        forces; ///< empty, or f0 of every contact of the state: for pictures, never a start of a computation
};

/// The JSON text of a state (format "isostat-state", version 2): packing, load, contacts, provenance, and forces when
/// given (one per contact). Doubles are written in a short form that reads back to the same bits. Rows are one per
/// line. Throws `Error(bad_input)` naming the field when a number is not finite.
std::string state_text(const State& state, std::span<const double> forces = {});

/// Writes `state_text` atomically. Throws `Error(cannot_write)`.
void write_state(const std::filesystem::path& path, const State& state, std::span<const double> forces = {});

/// Writes what a failed preparation reached, for pictures: format "isostat-packing", disks and box only, with the
/// reason. No command takes it for a state. Throws `Error(cannot_write)`.
void write_packing(const std::filesystem::path& path, const Packing& packing, const std::string& reason);

/// Reads a state from text; `source` (a file name) starts every message. Numbers may also be strings with a hexadecimal
/// float. Throws `Error(bad_input)` with file, field, value and what was expected: text that is not complete JSON,
/// unknown or missing fields, numbers that are not finite, radii that are not positive, disks larger than the box,
/// contacts out of range, of a disk with itself or given twice. It does not look at the geometry (gaps, overlaps) nor
/// count contacts: see `check_start`. A state with a periodic cell is refused: most of the program takes boxes only.
StateFile parse_state(const std::string& text, const std::string& source);

/// The same, periodic cells too. Further messages: walls along a periodic axis, images in a box or more than 3 periods
/// away, periods that are not positive, disks that overlap their own images, loads that do not sum to zero along a
/// periodic axis.
StateFile parse_any_state(const std::string& text, const std::string& source);

/// Reads a state file or, recognised by its first character, a vertex text (`vertex_text.hpp`).
StateFile read_state(const std::filesystem::path& path);
StateFile read_any_state(const std::filesystem::path& path);

} // namespace isostat
