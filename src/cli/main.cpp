// The command line: options go into plain structures, and one function per subcommand does the work.
#include "cli/commands.hpp"
#include "cli/manual.hpp"
#include "cli/ranges.hpp"
#include "cli/terminal.hpp"
#include "core/memory.hpp"
#include "ensemble/ensemble.hpp"
#include "io/text.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <concepts>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>
#include <new>
#include <numeric>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace isostat::cli;

/// The command line as a shell would take it back.
std::string quoted(int argc, char** argv) {
    std::string line;
    for (int k = 0; k < argc; ++k) {
        line += (k == 0 ? "" : " ") + isostat::text::shell(argv[k]); // NOLINT(*-pointer-arithmetic)
    }
    return line;
}

/// An option or an argument of a command, with the type that `--help` shows.
template <class T>
CLI::Option* option(CLI::App& command, const char* name, T& value, const std::string& words,
                    const char* type = nullptr) {
    CLI::Option* made = command.add_option(name, value, words);
    return type == nullptr ? made : made->type_name(type);
}
/// An option or argument with values that `allowed` accepts.
template <class T, std::derived_from<CLI::Validator> Check>
CLI::Option* option(CLI::App& command, const char* name, T& value, const char* words, const Check& allowed,
                    const char* type = nullptr) {
    return option(command, name, value, words, type)->check(allowed);
}
/// A required option or argument.
template <class T, class... More>
void needed(CLI::App& command, const char* name, T& value, const char* words, const More&... more) {
    option(command, name, value, words, more...)->required();
}

void add_threads(CLI::App& command, Common& common) {
    option(command, "--threads", common.threads,
           "cores for independent work (default: all that this process may use); results have the same bits for any "
           "number",
           ranges::integer(1, 1024), "N");
}

/// The registered subcommands; each sets `todo` when it was chosen.
struct Program {
    CLI::App app{"Quasi-static trajectories of rigid frictionless disks: equilibria and rearrangements, with proofs",
                 "isostat"};
    std::function<int()> todo;

    explicit Program(std::string line) : line_(std::move(line)) {
        app.require_subcommand(1);
        app.set_version_flag("--version", program_name());
        // For the build (src/CMakeLists.txt), which installs both; `--help` does not list them.
        app.add_flag_callback("--man", [this] { throw CLI::CallForVersion(man_page(app, program_name()), 0); })
            ->group("");
        app.add_option_function<std::string>(
               "--completion",
               [this](const std::string& shell) { throw CLI::CallForVersion(shell_completion(app, shell), 0); })
            ->check(CLI::IsMember({"bash", "zsh", "fish"}))
            ->group("");
        app.footer("Exit status: 0 done or proved; 1 refuted, or failed with a result; 2 undecided; 64 usage; 65 bad "
                   "input; 70 internal failure (says\n"
                   "nothing of the input); 74 cannot write; 130 stopped by Ctrl-C or SIGTERM, with valid files.\n"
                   "Example: isostat run examples/biaxial-400.toml -o out");
        add_prepare();
        add_run();
        add_ensemble();
        add_inspect();
        add_certify();
        add_plan();
        add_report();
        add_import();
        add_export();
        add_snap();
        add_compare();
        add_verify();
        add_plateau();
        add_genericity();
    }

  private:
    std::string line_;
    std::vector<std::shared_ptr<void>> kept_; ///< the arguments of each command

    template <class Arguments> Arguments& keep() {
        const auto kept = std::make_shared<Arguments>();
        kept_.push_back(kept);
        return *kept;
    }

    /// Adds the options of every command, and the function of this one.
    template <class Arguments>
    void does(CLI::App& command, Arguments& a, int (*work)(const Arguments&), bool shows_progress) {
        if (shows_progress) {
            command.add_flag("-q,--quiet", a.common.quiet, "no progress and no tables");
        }
        command.add_flag("--json", a.common.json, "print one JSON object on standard output, for programs");
        command.callback([&command, &a, work, this] {
            a.common.command = line_;
            if (command.get_option_no_throw("--threads") != nullptr) {
                isostat::set_threads(a.common.threads.value_or(isostat::available_cores()));
            }
            todo = [&a, work] { return work(a); };
        });
    }

    CLI::App& add(const char* name, const char* description, const char* footer) {
        CLI::App& command = *app.add_subcommand(name, description);
        command.footer(footer);
        return command;
    }

    void add_prepare() {
        auto& a = keep<PrepareArguments>();
        CLI::App& command = add(
            "prepare", "random disks -> equilibrium under isotropic load",
            R"(Writes a state file. When a stage fails, what it reached goes to STATE.failed.json, which no command takes for a
state.
Example: isostat prepare examples/biaxial-400.toml -o start.json)");
        needed(command, "scene", a.scene, "scene file (TOML)", "SCENE.toml");
        needed(command, "-o,--output", a.output, "state file to write", "STATE.json");
        add_threads(command, a.common);
        does(command, a, prepare, true);
    }

    void add_run() {
        auto& a = keep<RunArguments>();
        CLI::App& command = add(
            "run", "a whole trajectory: start, then the programme of the scene",
            R"(The folder holds run.json, events.jsonl, equilibria.csv, checkpoint.json, states/ and, at the end, summary.json and
figures/. After a kill or Ctrl-C, --resume goes on from the last equilibrium; the files are then those of a run that
was not interrupted, times apart.
A tie (two forces that vanish at one load, two gaps that close at once) ends the run with exit status 2; with
ties = "choose" in [run] it is settled for radii R_i + eps rho_i, eps -> 0, a rule chooses where these do
not tell (at most max_choices times), and the records say how.
Examples: isostat run examples/biaxial-400.toml -o out
          isostat run examples/biaxial-400.toml -o out --resume)");
        needed(command, "scene", a.scene, "scene file (TOML)", "SCENE.toml");
        needed(command, "-o,--output", a.output, "folder of the run", "DIR");
        CLI::Option* resume = command.add_flag("--resume", a.resume, "go on after an interruption");
        command.add_flag("--force", a.force, "delete the run that the folder holds first, and nothing else there")
            ->excludes(resume);
        add_threads(command, a.common);
        does(command, a, run, true);
    }

    void add_ensemble() {
        auto& a = keep<EnsembleArguments>();
        CLI::App& command = add(
            "ensemble", "independent samples of a scene (seeds 1, 2, ...), their tables in one",
            R"(Every sample is a process of its own: one that fails or crashes loses no other. The folder holds samples/seed_.../
(each the folder of a run), equilibria.csv, increments.csv, samples.csv, ensemble.json. After a kill or Ctrl-C, --resume
goes on; with a larger --samples it adds more. The tables do not depend on --jobs. Under mpirun (builds with
ISOSTAT_WITH_MPI) the ranks share the samples.
Exit status: 0 all completed; 1 some failed, crashed or were refused; 2 some undecided; 130 interrupted.
Examples: isostat ensemble examples/biaxial-400.toml --samples 8 -o many
          mpirun -n 4 isostat ensemble examples/biaxial-400.toml --samples 8 -o many)");
        needed(command, "scene", a.scene, "scene file (TOML)", "SCENE.toml");
        needed(command, "-S,--samples", a.samples, "number of samples", ranges::integer(1, isostat::most_samples), "S");
        needed(command, "-o,--output", a.output, "folder of the ensemble", "DIR");
        option(command, "-j,--jobs", a.jobs, "samples at a time (default: one per core; under mpirun one per rank)",
               ranges::integer(1, 10'000), "J");
        option(command, "--first-seed", a.first_seed, "seed of the first sample (default 1)",
               ranges::integer(0, ranges::largest_seed), "SEED");
        CLI::Option* resume = command.add_flag("--resume", a.resume, "go on after an interruption, or add samples");
        command.add_flag("--force", a.force, "delete the ensemble that the folder holds first, and nothing else there")
            ->excludes(resume);
        does(command, a, ensemble, true);
    }

    void add_inspect() {
        auto& a = keep<InspectArguments>();
        CLI::App& command = add(
            "inspect",
            "N, N_f, rank, h, k, rattlers, smallest force and gap, supported interval of a state (spheres too)",
            R"(Nothing moves. Exit status 0: proved to be an isostatic equilibrium; 1: proved not to be one; 2: undecided.
A TOML file is a crafted packing with exact numbers (examples/packings): exact contacts, rank, bases, stability;
its [expected] entries are checked. A scene is not a packing: see plan.
Examples: isostat inspect start.json
          isostat inspect examples/packings/triangular_patch_3x3.toml)");
        needed(command, "file", a.file, "state file, or vertex text", "FILE");
        option(command, "--at", a.at,
               "under this sigma_2 (of spheres sigma_3) instead of that of the state; prints every force",
               ranges::number(-ranges::largest, ranges::largest), "SIGMA2");
        option(command, "--contacts", a.contacts,
               "writes a table of the contacts: point, normal, gap, force with bounds", "FILE.csv");
        option(
            command, "--singular-values", a.singular_values,
            "so many of the smallest, as computed (default: 10 of spheres, none of disks, where they take as long as "
            "the rest)",
            ranges::integer(0, 1000), "COUNT");
        add_threads(command, a.common);
        does(command, a, inspect, false);
    }

    void add_certify() {
        auto& a = keep<CertifyArguments>();
        CLI::App& command = add(
            "certify", "proves that a state is an isostatic, stable equilibrium, and writes what was proved",
            R"(Claims are about the true vertex near the stored coordinates, where all gaps of the contacts are exactly 0. What is not
proved is not claimed, and the reason is written. Exit status 0: every claim is proved; 1: one is refuted; 2: some are undecided.
Example: isostat certify out/states/last.json -o last.cert.json)");
        needed(command, "state", a.input, "state file, or vertex text", "STATE.json");
        needed(command, "-o,--output", a.output, "certificate to write", "CERT.json");
        add_threads(command, a.common);
        does(command, a, certify, false);
    }

    void add_plan() {
        auto& a = keep<PlanArguments>();
        CLI::App& command =
            add("plan", "which stages, solvers and outputs a scene uses and which it leaves out, and every setting",
                R"(Nothing is computed.
Example: isostat plan examples/biaxial-1936.toml)");
        needed(command, "scene", a.scene, "scene file (TOML)", "SCENE.toml");
        does(command, a, plan, false);
    }

    void add_report() {
        auto& a = keep<ReportArguments>();
        CLI::App& command = add(
            "report", "tables and figures of a run, or the force picture of a state",
            R"(Charts are drawn by gnuplot; without it, data and scripts are written and said to be so. Of an ensemble the distribution of the forces
of all samples together too: force_distribution.
Examples: isostat report out
          isostat report out --html
          isostat report start.json -o pictures --vtk)");
        needed(command, "input", a.input, "folder of a run or of an ensemble, or state file", "DIR|STATE");
        option(command, "-o,--output", a.output,
               "folder of the figures (default: DIR/figures, or the folder of the state); of an ensemble: a folder in "
               "it per seed",
               "DIR");
        command.add_flag("--vtk", a.options.vtk, "also write ParaView files");
        command.add_flag("--pdf", a.options.pdf, "charts as PDF too");
        command.add_flag("--html", a.options.html,
                         "of a run: also write trajectory.html, one page to look at every equilibrium and arc, without "
                         "network; of a state of spheres: a view that turns");
        command.add_flag("--contacts", a.options.contacts,
                         "also contacts_*.csv of each stored state: points, normals, gaps, proved forces");
        command.add_flag("--no-charts", a.no_charts, "do not call gnuplot");
        option(command, "--stiffness", a.stiffness,
               "of a run: also where grains of this stiffness (force / overlap) would leave each structure, predicted: "
               "soft_limits.csv",
               ranges::number(ranges::smallest, ranges::largest), "K");
        does(command, a, report, true);
    }

    void add_verify() {
        auto& a = keep<VerifyArguments>();
        CLI::App& command = add(
            "verify",
            "re-checks a certificate, or the records of a run, with separate code: proved, refuted or undecided",
            R"(The checker shares only the reader of the file with the program that made the certificate, and needs nothing of a run.
Exit status 0: all claims of a stable equilibrium are there and proved; 1: a claim is refuted; 2: a claim is
undecided or absent.
Of the folder of a run every arc and every equilibrium is replayed, power turns, held coordinates and ties settled at
first order included; the first wrong record is named. Runs with
states_every = 1 can be taken up again after an arc that the replay cannot follow. Of an ensemble every run is: 1 when one is
refuted, else 65 when one cannot be read, else 2 when one is undecided, unfinished or missing.
Examples: isostat verify certificate.json --input state.json
          isostat verify out/certificates/eq_*.json --coq-extracted
          isostat verify out)");
        needed(command, "certificate", a.certificates, "certificates (JSON), or the folder of a run or of an ensemble",
               "CERT.json|DIR");
        option(command, "--input", a.input, "also check that this is the file that the certificate speaks of", "FILE");
        command.add_flag("--coq", a.coq,
                         "also put the certificate through the checker that is proved in Coq (disks or "
                         "spheres in boxes or cells; minutes; Debian packages: see proofs/coq_checker.md)");
        command.add_flag("--coq-extracted", a.coq_extracted,
                         "the same by the program that Coq extracts from that checker: seconds; it trusts Coq's "
                         "extraction, OCaml's compiler and Zarith besides (see there)");
        option(command, "--coq-limit", a.coq_limit, "seconds for each certificate (default: as long as it takes)",
               ranges::number(1, 1e9), "SECONDS");
        add_threads(command, a.common);
        does(command, a, verify, true);
    }

    static void add_foreign(CLI::App& command, ForeignArguments& a) {
        option(command, "--radius", a.radius,
               "the column, or the number, that is every disk's radius; or those of the words of a column, "
               "type:1=1,2=1.4",
               "COLUMN|NUMBER");
        option(command, "--diameter", a.diameter, "the same for diameters", "COLUMN|NUMBER")->excludes("--radius");
        option(command, "--walls", a.walls,
               "none; box: left and bottom (of spheres the lower ones) fixed, the others movable; square: the size of "
               "the box alone moves; fixed: all (default: none for files of other programs)",
               CLI::IsMember({"none", "box", "square", "fixed"}));
        option(command, "--box", a.box,
               "positions of the walls instead of the bounds in the file (spheres: ,ZLO:ZHI too); with --periodic the "
               "periods, of a file without bounds",
               "XLO:XHI,YLO:YHI");
        option(command, "--lattice", a.lattice,
               "the cell of a file without bounds: periods and tilt (spheres: LX,LY,LZ,XY,XZ,YZ), or the entries of "
               "the period vectors",
               "LX,LY,TILT");
        option(command, "--dimension", a.options.dimension,
               "2: disks; 3: spheres (default: spheres where the file has a z that is not the same for all)",
               CLI::IsMember({2, 3}));
        option(command, "--frame", a.frame, "of a file with several, from 0 (default: last)", "NUMBER|last");
        option(command, "--columns", a.columns,
               "names of the columns, in place of those of the file; - leaves one out (LAMMPS data: of the section "
               "Atoms)",
               "x,y,r");
        option(command, "--skip", a.options.skip,
               "lines before the rows of a table that are passed over (with --columns)",
               ranges::integer(0, 1'000'000'000));
        option(command, "--style", a.options.style, "atom style of a LAMMPS data file that does not name it", "STYLE");
        option(command, "--plane", a.options.plane, "of disks: xy (default), xz, yz",
               CLI::IsMember({"xy", "xz", "yz"}));
        option(command, "--ids", a.options.first_id,
               "the rows have the ids from this one on, in their order, for files of contacts that count rows",
               ranges::integer(0, 1'000'000'000), "FIRST");
        option(command, "--select", a.select, "rows with one of these values in this column are the disks, e.g. type=1",
               "COLUMN=VALUE,...");
        option(command, "--fixed", a.fixed, "disks with one of these values in this column cannot move",
               "COLUMN=VALUE,...");
        option(
            command, "--bodies", a.options.bodies,
            "import: the column whose rows with the same number above 0 are one rigid body, e.g. mol; none (default: "
            "body, clump or clumpId where there is one)",
            "COLUMN|none");
        option(command, "--format", a.options.format,
               fmt::format("{} (default: from the content)", fmt::join(isostat::foreign_formats(), ", ")));
        command.add_flag("--not-periodic", a.options.not_periodic,
                         "take periodic boundaries for open ones: contacts across them are not looked for");
        command
            .add_flag("--periodic", a.options.periodic,
                      "boundaries that the file leaves open are periodic (LAMMPS data files say nothing of them)")
            ->excludes("--not-periodic");
    }

    static void add_cell(CLI::App& command, std::string& cell) {
        option(command, "--cell", cell,
               "what of a periodic cell moves besides its disks: rectangular, two periods; tilted, the tilt too; "
               "isotropic, its size alone; fixed, nothing (default: tilted if the file's is)",
               CLI::IsMember({"rectangular", "tilted", "isotropic", "fixed"}));
    }

    void add_import() {
        auto& a = keep<ImportArguments>();
        CLI::App& command = add(
            "import", "a packing of another program -> the equilibrium next to it, as a state",
            R"(Reads what plateau reads. Soft grains overlap: linear programmes and Newton's method end at the vertex downhill from the file,
under the stresses given, and certify proves it. Its force-carrying contacts must be those of the file: where a plateau of
thresholds is proved isostatic, at a threshold, or by the forces of a LAMMPS dump of style local or a table. A crafted packing (TOML) is
rounded to doubles and keeps its contacts and its load; a vertex text keeps them too. With --jitter a state is taken as well.
In a periodic cell or a channel: the vertex downhill whatever its contacts, unless --contacts says more.
Proofs are of the doubles written. Where gaps or forces are below what the digits of the file tell, so that they may be 0 in its
packing, they are named and the answer is undecided, here and when inspect or certify read the state.
Spheres: the pairs that touch as the digits of the file tell (or at --threshold) are the contacts, Newton's method goes to their vertex
where they determine one, and the state is written whatever is proved of it: isostat inspect says more. So with clumps, the rows of
one rigid body (--bodies), whose members keep the distances that they have in the file.
Exit status 0: written and certified; 1: no such equilibrium; 2: undecided.
Examples: isostat import disks.dump --box 0:15.46,0:14.88 -o start.json
          isostat import disks.dump --box 0:15.46,0:14.88 --contacts pairs.dump --contact-columns 'c_1[1],c_1[2],c_2[2]' -o start.json)");
        needed(command, "file", a.file, "packing", "FILE");
        needed(command, "-o,--output", a.output, "state file to write", "STATE.json");
        CLI::Option* contacts =
            option(command, "--contacts", a.contacts,
                   "plateau: as the widest range of thresholds with an isostatic backbone says; nearest: any; or a "
                   "dump of style local or a table with forces (default: plateau; nearest in a periodic cell)",
                   "plateau|nearest|FILE");
        option(command, "--contact-columns", a.contact_columns,
               "columns of that file: two ids and the force, or the components of its vector", "I,J,FORCE|FX,FY");
        option(command, "--threshold", a.threshold, "pairs with this gap or less are the contacts",
               ranges::number(-ranges::largest, ranges::largest))
            ->excludes(contacts);
        option(command, "--stress", a.stress,
               "sigma_1 and sigma_2, of spheres sigma_3 too (default: ones, or those of a state)", "S1,S2");
        option(command, "--load", a.load, "nominal: dead wall forces; true: stress x present length",
               CLI::IsMember({"nominal", "true"}));
        option(command, "--seed", a.seed, "of the infinitesimal loads and of the jitter (default 1)",
               ranges::integer(0, ranges::largest_seed));
        option(command, "--jitter", a.jitter, "radii R_i (1 + jitter rho_i), rho_i in [-1, 1) at random",
               ranges::number(0, 0.1));
        option(command, "--moved", a.moved, "write the way of each disk from the file to the vertex", "FILE.csv");
        command.add_flag("--far", a.far, "disks with a force may move by more than their radius");
        add_cell(command, a.cell);
        add_foreign(command, a.foreign);
        add_threads(command, a.common);
        does(command, a, import, false);
    }

    void add_snap() {
        auto& a = keep<SnapArguments>();
        CLI::App& command = add(
            "snap", "a frame of soft grains -> the vertex of rigid grains with the same contacts, with proof",
            R"(The list: pairs with a force in a LAMMPS dump of style local or a table, or those that overlap, or the contacts of a state. Newton's method
ends at the vertex where they all touch; certify proves it there, with its distance from the file. Rattlers must have room and
rest on infinitesimal loads in the state. Disks and spheres, in walls, in periods, or in both.
Exit status 0: written and proved; 1: the list has no such vertex (hyperstatic, moving, refuted: printed); 2: undecided.
Example: isostat snap disks.dump --frame 3 --box 0:15.46,0:14.88 --contacts pairs.dump --contact-columns 'c_1[1],c_1[2],c_2[2]' --stress 1,1.2 -o state.json)");
        needed(command, "file", a.file, "packing, or state", "FILE");
        needed(command, "-o,--output", a.output, "state file to write", "STATE.json");
        CLI::Option* contacts = option(command, "--contacts", a.contacts,
                                       "LAMMPS dump of style local, or a table (default: pairs that overlap)", "FILE");
        option(command, "--contact-columns", a.contact_columns,
               "columns of that file: two ids and the force, or the components of its vector", "I,J,FORCE|FX,FY")
            ->needs(contacts);
        option(command, "--stress", a.stress,
               "sigma_1 and sigma_2, of spheres sigma_3 too (default: ones, or those of a state)", "S1,S2");
        option(command, "--load", a.load, "nominal: dead wall forces; true: stress x present length",
               CLI::IsMember({"nominal", "true"}));
        option(command, "--reference-length", a.reference_length,
               "lengths that nominal stresses press on (default: those of the frame; a series has those of its first "
               "frame); of spheres L3 too",
               "L1,L2");
        CLI::Option* stiffness =
            option(command, "--stiffness", a.stiffness,
                   "force / overlap: forces that the file does not say are compared with the exact ones too",
                   ranges::number(ranges::smallest, ranges::largest), "K");
        option(
            command, "--law", a.law,
            "linear (default), or hertz: stiffness x overlap^(3/2) x sqrt(R_i R_j / (R_i + R_j)), at a wall sqrt(R_i)",
            CLI::IsMember({"linear", "hertz"}))
            ->needs(stiffness);
        command.add_flag("--exchange", a.exchange,
                         "where the list has no vertex: the one downhill, which need not be the only one near");
        option(command, "--seed", a.seed, "of the infinitesimal loads (default 1)",
               ranges::integer(0, ranges::largest_seed));
        add_cell(command, a.cell);
        add_foreign(command, a.foreign);
        does(command, a, snap, false);
    }

    void add_compare() {
        auto& a = keep<CompareArguments>();
        CLI::App& command = add(
            "compare", "a series of frames of another program against the exact trajectory",
            R"(Each frame: its list of contacts, the proved distance to the vertex of rigid grains, errors of the forces (law, rest,
stiffness), and what it is: same, early, late, other, soft, moving, file, refuted, undecided. Then where the frames leave the
exact run, and why. The folder gets comparison.csv, path.csv, comparison.json, bundle/ and
the figure.
Exit status 0: every frame at rest is the exact equilibrium of its load, proved; 1: a frame departs; 2: none departs, and one is
undecided or all are in motion.
Examples: isostat compare series.toml --init disks.dump
          isostat compare series.toml -o comparison)");
        needed(command, "series", a.series, "manifest (isostat-series 1)", "SERIES.toml");
        option(command, "-o,--output", a.output, "folder for tables and figure", "DIR");
        option(command, "--init", a.init,
               "write the manifest, and a table of frames beside it, for this file of frames; what it does not say is "
               "left to fill in",
               "DISKS");
        option(command, "--reference", a.reference,
               "start of the exact run: a state, or equilibrium 0 of the folder of a run (default: the vertex of the "
               "first frame that has one)",
               "STATE|DIR");
        option(command, "--bundle", a.options.bundle,
               "exact runs from the start: other rules of opening, rattlers that rest elsewhere (default 16; 0: none)",
               ranges::integer(0, 10'000));
        command.add_flag(
            "--local", a.options.local,
            "besides, the exact run from every frame to the next one: a score that a departure does not spoil");
        command.add_flag(
            "--nearest-arc", a.options.nearest_arc,
            "besides, the arc of the exact run whose contacts are nearest to those of each frame in motion");
        option(command, "--frames", a.frames, "the frames from A to B only, by their numbers from 0 (default: all)",
               "A:B");
        add_threads(command, a.common);
        does(command, a, compare_series, true);
    }

    void add_export() {
        auto& a = keep<ExportArguments>();
        CLI::App& command = add(
            "export", "a state, or the states of a run, for other programs",
            R"(LAMMPS data (.data), extended XYZ for OVITO (.xyz), CSV (.csv): grains and box; ParaView (.vtk): contacts with forces too. Of the
folder of a run: XYZ has a frame for each state stored, with the displacement from the first; the others the last state.
Every state of a run for ParaView: isostat report --vtk.
Examples: isostat export start.json -o start.data
          isostat export out -o out.xyz)");
        needed(command, "input", a.input, "state file, vertex text, or folder of a run", "STATE|DIR");
        needed(command, "-o,--output", a.output, "file to write", "FILE");
        option(command, "--format", a.format,
               "lammps-data, xyz, csv, vtk (default: from the end of the name of the file)",
               CLI::IsMember({"lammps-data", "xyz", "csv", "vtk"}));
        does(command, a, export_states, false);
    }

    void add_genericity() {
        auto& a = keep<GenericityArguments>();
        CLI::App& command = add(
            "genericity", "perturbs the radii of a packing and proves what its equilibria are",
            R"(Each sample: radii times 1 + size u (seeded), downhill to the vertex under isotropic stress, certificate of the true vertex.
Of clumps the places of the members move too, by their radii times size u, and rotational rattlers may turn.
Exit status 0: every sample is proved isostatic; 2: some are not (ties, signs beyond 100 digits, no vertex found).
Examples: isostat genericity examples/packings/square_lattice_3.toml --samples 20 --size 1e-2,1e-6,1e-10
          isostat genericity examples/packings/square_lattice_3.toml --size 1e-3 --keep-equal
          isostat genericity examples/packings/cell_triangular_lattice_6.toml --size 1e-3 --tilt)");
        needed(command, "packing", a.file,
               "crafted packing (TOML), state or vertex text, in a box with movable walls or a cell whose periods move",
               "FILE");
        option(command, "--samples", a.options.samples, "samples per size (default 100)",
               ranges::integer(1, 1'000'000'000));
        option(command, "--size", a.sizes, "largest relative change of a radius; several: 1e-2,1e-6 (default 1e-6)",
               ranges::number(0, 1))
            ->delimiter(',');
        option(command, "--seed", a.options.seed, "sample s uses seed + s (default 1)",
               ranges::integer(0, ranges::largest_seed));
        option(command, "--stress", a.options.stress, "isotropic stress (default 1)",
               ranges::number(ranges::smallest, ranges::largest));
        option(command, "--lists", a.lists, "frequent contact lists to show (default 10)",
               ranges::integer(0, 1'000'000'000));
        command.add_flag("--keep-equal", a.options.keep_equal,
                         "disks of equal radius stay equal, and members in their places");
        command.add_flag("--tilt", a.options.tilt,
                         "perturb the tilt of the cell too, by size u times its first period");
        option(command, "--csv", a.csv, "write one row per sample to this file", "FILE.csv");
        add_threads(command, a.common);
        does(command, a, genericity, false);
    }

    void add_plateau() {
        auto& a = keep<PlateauArguments>();
        CLI::App& command = add(
            "plateau", "contacts, rank, h, k of a packing made elsewhere against the gap threshold",
            R"(Reads LAMMPS data files (atom style sphere), LAMMPS dumps, extended XYZ, tables of x y r, CSV, and our own files. Whether a
size is a radius or a diameter is said by the name of its column or by you; it is never guessed. Gaps are compared exactly,
for the doubles that the file gives. Ranges of thresholds in which the backbone (no rattlers) is isostatic are proved at
every threshold, not only at those of the table. Clumps (states, files with a column of bodies) count as rigid bodies, and a
body that turns about the one member that holds it (a rotational rattler) is isostatic too. The answer is that of the widest range on a logarithmic scale; thresholds
between gaps that the digits of the file do not tell apart do not count.
Exit status 0: the widest range is isostatic, proved; 1: it is not; 2: undecided, or no range is wider than the digits tell.
Examples: isostat plateau dump.lammpstrj --thresholds=-1e-3:1e-2 --walls box
          isostat plateau disks.txt --columns x,y,d --thresholds 1e-12:0.1)");
        needed(command, "file", a.file, "packing", "FILE");
        option(command, "--thresholds", a.thresholds,
               "smallest and largest gap of a contact, in the unit of the file (default: from the deepest overlap to a "
               "tenth of the smallest radius)",
               "A:B");
        option(command, "--rows", a.rows, "rows of the table; 0: every change of the contact list",
               ranges::integer(0, 1'000'000'000));
        option(command, "--csv", a.csv, "write the table to this file", "FILE.csv");
        option(command, "--cell", a.strain,
               "what a periodic cell may do besides its disks: fixed, isotropic (shape kept, under a pressure), "
               "diagonal, full (default: isotropic)",
               CLI::IsMember({"fixed", "isotropic", "diagonal", "full"}));
        add_foreign(command, a.foreign);
        does(command, a, plateau, false);
    }
};

/// The number of letters to change, add or leave out between two words.
std::size_t difference(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = std::exchange(row[0], i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = std::exchange(row[j], std::min({changed, row[j] + 1, row[j - 1] + 1}));
        }
    }
    return row.back();
}

/// Empty, or the message about a first word that is no command.
std::string wrong_command(const CLI::App& app, const std::string& word) {
    if (word.starts_with("-")) {
        return "";
    }
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    const auto far = [&word](const CLI::App* command) { return difference(word, command->get_name()); };
    const CLI::App* near =
        *std::ranges::min_element(commands, [&](const auto* a, const auto* b) { return far(a) < far(b); });
    if (far(near) == 0) {
        return "";
    }
    return "'" + word + "' is no command" +
           (far(near) <= 2 ? ": did you mean '" + near->get_name() + "'?" : "; isostat --help lists them");
}

/// The first file on the command line, or empty.
std::string input_of(const CLI::App& app) {
    const CLI::App& command = *app.get_subcommands().front();
    const std::vector<const CLI::Option*> files =
        command.get_options([](const CLI::Option* o) { return o->get_positional() && !o->results().empty(); });
    return files.empty() ? "" : files.front()->results().front();
}

/// Empty, or the commands that take this file.
std::string use_of_input(const CLI::App& app) {
    const std::string file = input_of(app);
    return file.empty() ? "" : other_use(app.get_subcommands().front()->get_name(), file);
}

/// `use` is printed on a separate line.
int complain(isostat::ErrorKind kind, const std::string& message, const std::string& use = "") {
    say(stderr, "isostat: {}\n", message);
    if (!use.empty()) {
        say(stderr, "{}\n", use);
    }
    return isostat::Error(kind, "").exit_status();
}

/// Prints what CLI11 has to print: requested help, or an error of the command line. Where an option is missing, a
/// missing file, or one for another command, is reported first.
int explain(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_name() == "RequiredError" && !app.get_subcommands().empty()) {
        const std::string file = input_of(app), use = use_of_input(app);
        std::error_code ignored;
        if (!use.empty() || (!file.empty() && !std::filesystem::exists(file, ignored))) {
            return complain(isostat::ErrorKind::bad_input, use.empty() ? file + ": does not exist" : use);
        }
    }
    std::ostringstream help, trouble;
    const int status = app.exit(error, help, trouble);
    say_lines(help.str());
    say_lines(trouble.str(), stderr);
    return status == 0 ? done : isostat::Error(isostat::ErrorKind::usage, "").exit_status();
}

int run_program(int argc, char** argv) {
    Program program(quoted(argc, argv));
    if (argc <= 1) {
        say_lines(program.app.help());
        return isostat::Error(isostat::ErrorKind::usage, "").exit_status();
    }
    const std::string wrong = argc > 1 ? wrong_command(program.app, argv[1]) : ""; // NOLINT(*-pointer-arithmetic)
    if (!wrong.empty()) {
        return complain(isostat::ErrorKind::usage, wrong);
    }
    try {
        program.app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return explain(program.app, error);
    }
    isostat::require_floating_point();
    ignore_file_size_signals();
    try {
        return program.todo();
    } catch (const isostat::Error& error) {
        if (error.kind() != isostat::ErrorKind::bad_input) {
            throw;
        }
        return complain(error.kind(), error.what(), use_of_input(program.app));
    }
}

/// Runs `work`, and turns errors into words and an exit status.
/// Unforeseen errors give 70, never a status that is a result.
int answered(const std::function<int()>& work) {
    using isostat::ErrorKind;
    try {
        return work();
    } catch (const isostat::Error& error) {
        return complain(error.kind(), error.what());
    } catch (const std::bad_alloc&) {
        isostat::end_at_once(complain(ErrorKind::internal, "not enough memory"));
    } catch (const std::filesystem::filesystem_error& error) {
        return complain(ErrorKind::cannot_write, error.what());
    } catch (const std::exception& error) {
        if (std::ferror(stdout) != 0) { // `say` prints the reason
            return complain(ErrorKind::cannot_write, std::string("standard output: ") + error.what());
        }
        return complain(ErrorKind::internal, std::string("unexpected failure: ") + error.what());
    } catch (...) {
        return complain(ErrorKind::internal, "unexpected failure");
    }
}

/// A file opened later must not get the descriptor of standard output.
void open_standard_descriptors() {
    for (const int descriptor : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(descriptor, F_GETFD) < 0) { // NOLINT(cppcoreguidelines-pro-type-vararg)
            (void)::open("/dev/null", O_RDWR);  // NOLINT(cppcoreguidelines-pro-type-vararg): it gets the lowest number
        }
    }
}

/// The exit status: 74 where standard output did not take all of the output.
int delivered(int status) {
    errno = 0;
    const bool written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    const int error = errno;
    const int failure = isostat::Error(isostat::ErrorKind::cannot_write, "").exit_status();
    if (written || status == failure) {
        return status;
    }
    return complain(isostat::ErrorKind::cannot_write,
                    std::string("standard output: cannot write: ") + (error != 0 ? std::strerror(error) : "lost"));
}

} // namespace

int main(int argc, char** argv) {
    open_standard_descriptors();
    isostat::keep_freed_memory();
    isostat::say_when_memory_ends();
    const int status = delivered(answered([&] { return run_program(argc, argv); }));
    rlimit memory{};
    if (::getrlimit(RLIMIT_AS, &memory) == 0 && memory.rlim_cur != RLIM_INFINITY) {
        isostat::end_at_once(status);
    }
    return status;
}
