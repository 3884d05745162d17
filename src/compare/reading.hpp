#pragma once
/// \file
/// The list of contacts of one frame, and whether lists, forces and overlaps of the files agree.

#include <isostat/compare/compare.hpp>

#include <string>
#include <vector>

namespace isostat::compare {

struct Reading {
    std::string contradiction; ///< empty, or the pair, the row and by how much lists, forces and overlaps disagree
    /// Empty, or words: all disks balance, a wall or period does not. At rest that is the load of another frame; where
    /// the list has mechanisms, motion.
    std::string other_load;
    /// Without a law, nothing else speaks of a contact that is missing or of a wrong force. Empty, or words: one or two
    /// disks do not balance and all others do.
    std::string few;
    std::string dashpots; ///< empty, or words: forces differ from the law, and not by an error of the files
    std::string
        unsure; ///< empty, or words: whether a pair overlaps is not told by the digits of the files, nor by a list
    std::string rounding; ///< empty, or words: they differ by what the digits of the files leave open
    /// Forces that are not in the files are stiffness x overlap, and what is left is within their rounding.
    bool blurred = false;
    int listed = 0;             ///< contacts of the files with a force
    int overlapping = 0;        ///< pairs that overlap, walls included
    int twice = 0, missing = 0; ///< rows of a contact that has one; overlaps without a row
    double ratio = 1;           ///< force / (stiffness overlap) where they differ most
    double law = 0;             ///< largest |force - stiffness overlap| / mean force; NaN without a law
    double mean = 0;            ///< mean force
    double unbalanced = 0;      ///< largest force that is left on a disk, or on a movable wall, over the mean force
    /// Contacts with a force above what is left unbalanced that can carry it (without rattlers by the positions of the
    /// normals), sorted, and their forces.
    std::vector<Contact> contacts;
    std::vector<double> forces;
    std::vector<Contact> pressed; ///< all contacts with a positive force, sorted
};

/// Compared in doubles, beyond the rounding of an overlap and the allowance of the series: a diagnosis of numbers that
/// another program rounded. Throws nothing.
Reading read_frame(const Series& series, const Frame& frame);

} // namespace isostat::compare
