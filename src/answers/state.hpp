#pragma once
/// \file
/// The output of `inspect` for a state, of a periodic cell, of a box, and of a vertex where more pairs touch than its
/// contacts.

#include "certificate/jammed_box.hpp"
#include "io/json.hpp"
#include "snap/untold.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/io/state_file.hpp>

#include <optional>
#include <string>
#include <vector>

namespace isostat::answers {

/// One line per claim with its bounds and the arithmetic that proved it; absent claims with the reason. `contacts`: of
/// the state; the smallest force is that of a contact, not of a bar.
void print_claims(std::string& out, const Certification& certification, const std::vector<Contact>& contacts);

/// One end of the supported interval with its bound, and what opens there.
std::string end_text(const LoadEndClaim& end, int dimension);

/// The claims of `print_claims` for programs; null where a claim is absent.
json::Json claims_json(const Certification& certification, const std::vector<Contact>& contacts);

/// What is proved of the true vertex near a stored configuration, in the words of `inspect`.
void print_true_vertex(std::string& out, const Certification& certification);
json::Json true_vertex_json(const Certification& certification);

/// How far the forces in a state file are from the proved ones, and where; nothing when the file holds none or none are
/// known. These forces are no part of the proof.
void print_forces_in_file(std::string& out, const StateFile& file, const Certification& truth);
void add_forces_in_file(json::Json& object, const StateFile& file, const Certification& truth);

/// Adds what the rounding of a file leaves undecided, if anything.
void add_untold(json::Json& object, const compare::Untold& untold, Verdict of_the_doubles);

/// "15.4 x 14.8, tilt 0; x, y move, disk 0 is pinned".
std::string cell_words(const Packing& packing);

/// Counts of the stored coordinates, one row for each way to strain the cell.
void print_counts(std::string& out, const std::string& title, const StrainCounts& counts);

void print_box(std::string& out, const Packing& packing, const BoxInspection& box);
json::Json box_json(const BoxInspection& box);

/// Prints the counts side by side, the words of jamming, and the count of contacts that elastic moduli need.
void print_cell(std::string& out, const CellInspection& cell);
json::Json cell_json(const Packing& packing, const CellInspection& cell);

/// For a state that a run left with touching pairs besides its contacts: their names, and the ranges of forces that are
/// not unique. For contacts that the run left at force 0: their names. Nothing when the state names no such pair.
void print_face(std::string& out, const State& state);
/// `face`: `h`, `touching`, `self_stresses`, `forces_between`, or `undecided` with the reason; `left_at_zero`.
void add_face(json::Json& object, const State& state);

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

/// \p each_force: prints every force too.
std::string to_text(const StateAnswer& answer, bool each_force);
/// \p file: its name.
json::Json to_json(const StateAnswer& answer, const std::string& file);

} // namespace isostat::answers
