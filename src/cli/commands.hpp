#pragma once
/// \file
/// The subcommands of `isostat`: arguments as parsed, exit status as returned.

#include "crafted/genericity.hpp"
#include "report/run_report.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/foreign/foreign.hpp>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace isostat::cli {

/// Exit statuses beyond those of `Error` (64 usage, 65 bad input, 70 internal failure, 74 cannot write).
enum Status { done = 0, failed = 1, undecided = 2, interrupted = 130 };

/// Options that several subcommands have.
struct Common {
    bool quiet = false;         ///< no progress, no tables
    bool json = false;          ///< one JSON object on standard output and nothing else there
    std::string command;        ///< the command line, for records
    std::optional<int> threads; ///< for commands that can use several; absent: all cores
};

struct PrepareArguments {
    Common common;
    std::string scene, output;
};
int prepare(const PrepareArguments& arguments);

struct RunArguments {
    Common common;
    std::string scene, output;
    bool resume = false, force = false;
};
int run(const RunArguments& arguments);

struct EnsembleArguments {
    Common common;
    std::string scene, output;
    int samples = 0;
    std::uint64_t first_seed = 1;
    std::optional<int> jobs; ///< processes at a time (per rank under mpirun); absent: one per core, under mpirun one
    bool resume = false, force = false;
};
/// Independent samples of a scene, each a process `isostat run`; merges their tables. Returns 0 when all completed, 130
/// when some were interrupted, 1 when some failed, crashed or were refused, 2 when some are undecided.
int ensemble(const EnsembleArguments& arguments);

struct InspectArguments {
    Common common;
    std::string file;
    std::optional<double> at;           ///< loaded stress, if not that of the state
    std::string contacts;               ///< table to write; empty: none
    std::optional<int> singular_values; ///< how many; absent: ten for spheres, none for disks
};
int inspect(const InspectArguments& arguments);

struct CertifyArguments {
    Common common;
    std::string input, output;
};
int certify(const CertifyArguments& arguments);

struct PlanArguments {
    Common common;
    std::string scene;
};
int plan(const PlanArguments& arguments);

struct ReportArguments {
    Common common;
    std::string input, output;
    ReportOptions options; ///< as stated, but for `charts`
    bool no_charts = false;
    double stiffness = 0; ///< > 0: also the table of soft limits
};
int report(const ReportArguments& arguments);

struct VerifyArguments {
    Common common;
    std::vector<std::string> certificates; ///< certificates, or the folder of a run
    std::string input;                     ///< empty, or the file that the certificate is of
    bool coq = false;                      ///< also check with the checker that is proved in Coq
    bool coq_extracted = false;            ///< ... with the program that Coq extracts from it
    double coq_limit = 0;                  ///< seconds for each certificate; 0: no limit
};
/// Checks a certificate with code that shares nothing with its maker. Exit status 0 only when every claim of an
/// equilibrium is present and proved.
int verify(const VerifyArguments& arguments);

/// What the user states about a packing of another program, as typed.
struct ForeignArguments {
    ForeignOptions options; ///< what needs no reading
    std::string radius, diameter, walls, box, lattice, columns, select, fixed;
    std::string frame = "last";
    bool spheres = false; ///< the command takes spheres
    bool fixes = false;   ///< the command takes disks that cannot move
    bool clumps = false;  ///< the command takes clumps
};

struct PlateauArguments {
    Common common;
    std::string file, thresholds, csv;
    int rows = 40;
    std::string strain = "isotropic"; ///< or "fixed", "diagonal", "full": strains of a periodic cell
    ForeignArguments foreign;
};
/// Counts of a packing of another program against the gap threshold. 0: isostatic at some threshold, proved; 1: at
/// none; 2: proved at none, and not refuted at all.
int plateau(const PlateauArguments& arguments);

struct ImportArguments {
    Common common;
    std::string file, output;
    ForeignArguments foreign;
    std::string contacts; ///< "plateau", "nearest", or a file; empty: plateau in walls, nearest in a cell
    std::string contact_columns;
    std::optional<double> threshold;
    std::string stress, load, moved;
    std::string cell; ///< what moves of a cell: "rectangular" or "tilted"; empty: as in the file
    std::uint64_t seed = 1;
    double jitter = 0;
    bool far = false; ///< disks may move by more than their radius
};
/// A packing of another program -> the vertex next to it, as a state. 0:
/// certified; 1: no vertex has the contacts of the file; 2: undecided.
int import(const ImportArguments& arguments);

struct SnapArguments {
    Common common;
    std::string file, output;
    ForeignArguments foreign;
    std::string contacts, contact_columns; ///< of a dump of style local; empty: the pairs that overlap
    std::string stress, load, cell;        ///< cell: as in `ImportArguments`
    std::string reference_length;          ///< "L1,L2", for spheres L3 too; empty: the lengths of the frame
    double stiffness = 0;                  ///< > 0: forces of the law where the file has none
    std::string law;                       ///< "hertz"; empty: linear
    std::uint64_t seed = 1;
    bool exchange = false;
};
/// A frame of soft grains -> the vertex of its list of contacts. 0: proved
/// and written; 1: the list has none, with the reason; 2: undecided.
int snap(const SnapArguments& arguments);

struct CompareArguments {
    Common common;
    std::string series, output, reference;
    std::string init;   ///< a file of frames for which a manifest `series` is written
    std::string frames; ///< "A:B"; empty: all
    compare::CompareOptions options;
};
/// A series of frames against the exact run. 0: every frame at rest is the exact equilibrium; 1: a frame departs; 2:
/// undecided, or no frame is at rest.
int compare_series(const CompareArguments& arguments);

struct ExportArguments {
    Common common;
    std::string input, output, format;
};
/// Writes a state, or the states of a run, in formats of other programs.
int export_states(const ExportArguments& arguments);

struct GenericityArguments {
    Common common;
    std::string file, csv;
    std::vector<double> sizes{1e-6};
    int lists = 10;
    crafted::GenericityOptions options;
};
/// Vertices with perturbed radii. 0: every sample proved isostatic; 2: some were not.
int genericity(const GenericityArguments& arguments);

/// Empty, or a sentence for a message: the file or folder is of a kind that this command does not take, and the
/// commands that do. Judged by content, not by name. Throws nothing.
std::string other_use(const std::string& command, const std::filesystem::path& file);

/// "isostat 0.1.0".
std::string program_name();

} // namespace isostat::cli
