#pragma once
/// \file
/// A series of frames of another program: manifest "isostat-series 1" and the files it names.

#include <isostat/contact/contact.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/packing/packing.hpp>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// - linear: force = stiffness x overlap; - none: not stated, forces are taken as they are.
enum class ForceLaw : unsigned char { linear, none };

/// A contact as the files say it. `row`: "FILE:LINE" where it was read.
struct FileContact {
    Contact contact;
    double force = 0;
    std::string row;
};

/// One frame. Lengths and forces in the unit of the manifest (its factors are multiplied out); left and bottom wall at
/// 0.
struct Frame {
    int number = 0; ///< row of frames.csv, from 0
    long timestep = 0;
    std::string row; ///< "FILE:LINE" in frames.csv
    Packing<2> packing;
    std::vector<long> ids;
    Load<2> load;
    std::vector<FileContact> contacts; ///< as they stand in the files, in their order; walls too
};

/// What the manifest says, with the frames.
struct Series {
    std::string title, program;
    ForceLaw law = ForceLaw::none;
    double stiffness = 0; ///< 0: no law
    bool listed = false;  ///< contacts between disks come from a file; else they are the pairs that overlap
    bool wall_forces =
        false;               ///< of each disk, from columns; else walls that a disk overlaps, with the force of the law
    double rest = 1e-3;      ///< largest unbalanced force of a frame at rest, in mean forces
    double agreement = 1e-3; ///< largest |force - stiffness overlap| of a frame that is understood, in mean forces
    std::vector<Frame> frames;
};

/// Reads the manifest and every frame. Disks are matched by id, in the order of the first frame; frames by time step.
/// Throws `Error(bad_input)` with file, line (of rows: and column) and what was expected: unknown keys, missing columns
/// and wall positions (the bounds of a dump are never taken), numbers that are none, ids that are not there, radii that
/// change, time steps that a file does not have, sigma2 that is not the force on the wall over the reference length.
/// Contradictions between forces, overlaps and lists are not looked at: `compare` names them frame by frame.
Series read_series(const std::filesystem::path& manifest);

} // namespace isostat::compare
