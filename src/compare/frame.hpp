#pragma once
/// \file
/// The verdict on one frame without the exact run; the list of its contacts, and whether lists, forces and overlaps of
/// the files agree.

#include <isostat/compare/compare.hpp>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// A frame judged without the exact run: `status` is file, moving, soft, refuted, undecided, or `same` where its vertex
/// is proved (the exact run then decides which equilibrium it is).
struct JudgedFrame {
    FrameResult result;
    std::vector<Contact> list;     ///< list of the file
    std::vector<Contact> pressed;  ///< for a frame in motion, every contact with a positive force
    std::vector<Contact> downhill; ///< list of the vertex that exchange found and proved; or empty
    std::string note;              ///< words on its cell
    std::optional<State> state;    ///< complete, if asked for or if exchange found it
};

/// The load with its stresses divided by a number.
Load over(Load load, double scale);

/// \p complete: fill `state` also for a vertex that Newton's method found.
JudgedFrame judge(const Series& series, const Frame& frame, bool complete);

struct Reading {
    std::string contradiction; ///< empty, or the pair, the row and by how much lists, forces and overlaps disagree
    /// Empty, or words: all disks balance, a wall or period does not. For a frame at rest this is the load of another
    /// frame; where the list has mechanisms, motion.
    std::string other_load;
    /// Needed without a law, when no other test detects a missing contact or a wrong force. Empty, or words: one or two
    /// disks do not balance and all others do.
    std::string few;
    std::string dashpots; ///< empty, or words: forces differ from the law, but not by an error of the files
    std::string unsure; ///< empty, or words: neither the digits of the files nor a list decide whether a pair overlaps
    std::string rounding; ///< empty, or words: the difference is within the rounding of the files
    /// Forces that are not in the files are stiffness x overlap, and the unbalanced rest is within their rounding.
    bool blurred = false;
    /// What the frame tells by itself: `listed` (contacts of the files with a force), `overlapping` (walls included),
    /// `twice` and `missing_rows` (rows that repeat a contact; overlaps without a row), `ratio` (force / (stiffness
    /// overlap) where the two differ most), `law` (largest |force - stiffness overlap| / mean force; NaN without a
    /// law), `unbalanced` (largest unbalanced force on a disk or a movable wall, over the mean force).
    FrameResult result;
    double mean = 0; ///< mean force
    /// Contacts, sorted, with a force larger than the unbalanced forces that can carry it (without rattlers by the
    /// positions of the normals), and their forces.
    std::vector<Contact> contacts;
    std::vector<double> forces;
    std::vector<Contact> pressed; ///< all contacts with a positive force, sorted
};

/// Compares in doubles, beyond the rounding of an overlap and the allowance of the series, because another program
/// rounded the numbers: a diagnosis. Throws nothing.
Reading read_frame(const Series& series, const Frame& frame);

/// A dashpot adds `constant` w v_n, v_n the speed of approach, w a function of the masses: m_i m_j / (m_i + m_j), at a
/// wall m_i, with m = R^`power`, or 1 with power 0.
struct Dashpot {
    double constant = 0;
    int power = 0;
    [[nodiscard]] std::string words() const;
};

/// The dashpot that explains `beyond`, the forces of the files minus those of the law: one constant for all contacts,
/// found by least squares, leaves at most `allowance` and a tenth of the largest; the best of several weights. Speeds
/// of walls, periods and tilt are not in the files and are fitted too. Nothing: no dashpot explains them, or the frame
/// has no velocities, or too few contacts. Diagnosis, in doubles. `law`: with a Hertzian law the dashpot may be
/// proportional to the root of the overlap.
std::optional<Dashpot> find_dashpot(const Frame& frame, const std::map<Contact, double>& beyond, ForceLaw law,
                                    double allowance);

} // namespace isostat::compare
