#pragma once
/// \file
/// The output of `inspect` for a state, of a periodic cell, of a box, and of a vertex where more pairs touch than its
/// contacts.

#include "answers/answer.hpp"
#include "certificate/jammed_box.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::answers {

/// `claims`, null where a claim is absent: one line per claim with its bounds and the arithmetic that proved it; absent
/// claims with the reason. `contacts`: of the state; the smallest force is that of a contact, not of a bar.
void add_claims(Answer& out, const Certification& certification, const std::vector<Contact>& contacts);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// `true_configuration`: what is proved of the true vertex near a stored configuration, in the words of `inspect`.
void add_true_vertex(Answer& out, const Certification& certification);

/// How far the forces in a state file are from the proved ones, and where; nothing when the file holds none or none are
/// known. These forces are no part of the proof.
void add_forces_in_file(Answer& out, const StateFile& file, const Certification& truth);

/// Adds what the rounding of a file leaves undecided, if anything; its words are of the command.
void add_untold(Answer& out, const compare::Untold& untold, Verdict of_the_doubles);

/// "15.4 x 14.8, tilt 0; x, y move, disk 0 is pinned".
std::string cell_words(const Packing& packing);

/// Counts of the stored coordinates, one row for each way to strain the cell, under a title; returns their values.
Json add_counts(Answer& out, const std::string& title, const StrainCounts& counts);

/// `box`, with the walls held.
void add_box(Answer& out, const Packing& packing, const BoxInspection& box);

/// `cell`: axes, tilts and what moves; where strains were counted, the counts side by side, the words of jamming, and
/// the count of contacts that elastic moduli need. \pre some axis is periodic
void add_cell(Answer& out, const Packing& packing, const CellInspection* cell);

/// For a state that a run left with touching pairs besides its contacts: `face`, their names, and the ranges of forces
/// that are not unique, or why these are `undecided`. For contacts that the run left at force 0: `left_at_zero`, their
/// names. Nothing when the state names no such pair.
void add_face(Answer& out, const State& state);

/// What is proved of a state. Verdicts that the rounding of its file leaves open are withheld.
struct StateAnswer {
    const StateFile& file;
    Result<Inspection> result;
    Certification truth;
    std::optional<CellInspection> cell;
    std::optional<BoxInspection> box;
    compare::Untold untold;
    std::vector<double> singular_values; ///< the smallest ones, for a structure proved regular

    [[nodiscard]] bool refuted() const { return !result.ok() && result.failure().kind == FailureKind::not_isostatic; }
};

/// \p singular_values: how many; absent: ten for spheres, 0 for disks. \pre the file outlives the answer
StateAnswer answer_of(const StateFile& file, std::optional<int> singular_values);

/// \p file: its name. \p each_force: the text has every force too. \p lists: as in `Answer`.
Answer to_answer(const StateAnswer& answer, const std::string& file, bool each_force, bool lists);

} // namespace isostat::answers
