#pragma once
/// \file
/// The records of a run as they are in its files.

#include "io/equilibria.hpp"

#include <isostat/io/state_file.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace isostat::checker {

/// One decision that first-order terms in the radii settled, or the rule, as its record has it.
struct TieRecord {
    std::string what;             ///< "force", "opening", "start", "limit", "zero all along", "gap", "step"
    std::string contact, against; ///< `against` may be empty
    std::string choice;           ///< "infinitesimal loads", "names", "zero"; empty: no choice
    double first = 0, first_bound = 0;
    double other = 0, other_bound = 0;
};

/// One line of events.jsonl.
struct EventRecord {
    std::string where; ///< file and line
    long step = 0;
    int equilibrium = 0;
    int arc = 0;
    std::string kind;
    std::string opened, closed; ///< names of contacts, as in messages
    bool power_turn = false;
    double stress = 0, strain = 0, force = 0, power = 0, work = 0, displacement = 0;
    double strain_bound = 0, force_bound = 0, power_bound = 0, work_bound = 0; ///< NaN: no bound
    std::optional<double> held_at;                                             ///< only for power turns
    std::vector<TieRecord> ties;
    long choices = 0;       ///< choices among the ties from the first line to this one
    bool claims_way = true; ///< at level arcs; false: its own certificate leaves the motion or the power undecided
};

struct RunRecords {
    std::filesystem::path directory;
    std::string rule;                                      ///< the rule in run.json
    std::optional<std::uint64_t> rule_seed;                ///< seed of the rule `random`
    bool chooses = false;                                  ///< ties = "choose", and max_choices is not 0
    double max_choices = 0;                                ///< 0 where nothing is chosen
    std::string status, reason;                            ///< the status, and the reason that follows it
    std::string program;                                   ///< the program that wrote the run
    int segments = 0;                                      ///< number of segments of the programme
    bool certified_states = false, certified_arcs = false; ///< the level requires these files
    std::vector<EventRecord> events;
    std::vector<EquilibriumLine> equilibria;
    std::filesystem::path states;
    std::optional<State> start; ///< start.json, which may be far from the true vertex until the first arc
    /// The stored state of an equilibrium, with its forces, if the file exists.
    [[nodiscard]] std::optional<StateFile> stored(int equilibrium) const;
};

/// The words of the rules that a replay follows: beside what it does with them, in rule.cpp.
std::vector<std::string_view> opening_rules();

/// Throws `Error(bad_input)`.
RunRecords read_records(const std::filesystem::path& directory, LastLine last = LastLine::complete);

/// "12-40", "12-40(0,-1)" (an image), "3-left", "held x of grain 4" (the walls are the grain after the last disk), in
/// the one spelling of records in this dimension; nothing for other text.
std::optional<Contact> contact_spelt(std::string_view name, int dimension);
/// As `contact_spelt`, for a contact that the packing can have.
std::optional<Contact> contact_named(std::string_view name, const Packing& packing);

/// The two columns of a contact in equilibria.csv; nothing for "none". They do not name the image: see `may_be`.
std::optional<Contact> contact_of_columns(int i, int j, const Packing& packing);
/// Whether the columns are those of a pair, with any image.
bool may_be(const Contact& columns, const Contact& pair);

} // namespace isostat::checker
