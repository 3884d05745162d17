#pragma once
/// \file
/// The folder of an ensemble: independent samples of one scene, each a run of its own, and the tables made of them.

#include "io/folders.hpp"

#include <isostat/io/run_directory.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace isostat {

/// What identifies an ensemble.
struct EnsembleHeader {
    std::string program; ///< name and version
    std::string command; ///< command line
    std::filesystem::path scene;
    std::string scene_text;
    std::uint64_t first_seed = 1;
    int samples = 1; ///< seeds first_seed ... first_seed + samples - 1
};

/// Largest number of samples of an ensemble.
inline constexpr int most_samples = 1'000'000;

/// The state of a sample.
/// - completed, failed (at its load: a result), undecided: as the run says;
/// - interrupted: by Ctrl-C, SIGTERM or the end of the program; goes on with resume;
/// - crashed: killed by another signal, or it ended without saying how; goes on from its last checkpoint with resume;
/// - refused: bad input, or a file that could not be written; tried again with resume;
/// - missing: not started.
enum class SampleStatus { completed, failed, undecided, interrupted, crashed, refused, missing };

/// The word used in files and messages.
const char* to_string(SampleStatus status);

/// One sample, from the files of its run.
struct Sample {
    std::uint64_t seed = 0;
    SampleStatus status = SampleStatus::missing;
    std::string reason; ///< for every status except completed and missing
    int equilibria = 0; ///< rows of its equilibria.csv
    int proved = 0;     ///< proved rows among them
    long arcs = 0;
    double seconds = 0; ///< time of the trajectory; 0 when no summary was written

    /// The sample has a result, which resume keeps.
    [[nodiscard]] bool finished() const {
        return status == SampleStatus::completed || status == SampleStatus::failed || status == SampleStatus::undecided;
    }
};

/// The folders of the samples, used by any rank.
class SampleFolders {
  public:
    SampleFolders(std::filesystem::path directory, EnsembleHeader header);
    [[nodiscard]] const EnsembleHeader& header() const { return header_; }
    [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
    /// Seed, folder (samples/seed_...) and text of the scene (see `with_seed`; throws `Error(bad_input)`) of sample
    /// `number` = 0 ... samples - 1.
    [[nodiscard]] std::uint64_t seed(std::size_t number) const { return header_.first_seed + number; }
    [[nodiscard]] std::filesystem::path folder(std::size_t number) const;
    [[nodiscard]] std::string scene(std::size_t number) const;
    /// The sample according to its files. A run of another scene, or one whose files cannot be read, is `refused`.
    [[nodiscard]] Sample sample(std::size_t number) const;
    /// Makes the folder and scene.toml of a sample and removes a note. True when there is a run to resume.
    [[nodiscard]] bool prepare(std::size_t number) const;
    /// Writes to sample.json why a sample ended when its run could not.
    void note(std::size_t number, SampleStatus status, const std::string& reason) const;

  private:
    void read(Sample& sample, std::size_t number) const;
    std::filesystem::path directory_;
    EnsembleHeader header_;
};

/// Files:
/// - ensemble.json: program, command, scene, seeds, status;
///   at the end also the number of samples of each status
///   and the reason of every sample that did not complete;
/// - samples/seed_000001/: the folder of a run (see `RunDirectory`) with scene.toml, the scene with this seed, and
///   log.txt, what the process printed; `isostat run scene.toml` alone makes the same run;
/// - equilibria.csv: those of all samples, columns `seed` and those of a run without its last one, the time;
/// - increments.csv: one row per rearrangement, columns `seed, segment, number, direction, ratio, arcs,
///   stress_increment, strain_increment`: see `RearrangementRow`; nan where there is no increment;
/// - samples.csv: one row per sample: `seed, status, equilibria, proved, arcs, seconds`, status as the number of
///   `SampleStatus`.
/// The tables are sorted by seed and contain no time but the last column of samples.csv: they do not depend on the
/// number of processes or ranks, nor on their order. Throws `Error(cannot_write)` when a file cannot be written.
class EnsembleDirectory {
  public:
    /// resume: finished samples stay; also `Error(bad_input)` for one of another scene, first seed or program version.
    /// The number of samples may differ: more samples are added; samples beyond it are kept, not merged.
    using Mode = FolderMode;
    /// Makes the folder if needed and locks it: `Error(cannot_write)` when a running program holds it. A scene that has
    /// no samples (`with_seed`) is refused here, before anything is deleted or computed.
    EnsembleDirectory(std::filesystem::path directory, EnsembleHeader header, Mode mode);
    ~EnsembleDirectory();
    EnsembleDirectory(const EnsembleDirectory&) = delete;
    EnsembleDirectory& operator=(const EnsembleDirectory&) = delete;

    [[nodiscard]] const SampleFolders& samples() const { return samples_; }
    /// Writes the tables and ensemble.json, whose status becomes "completed" when every sample is finished,
    /// "interrupted" otherwise. Returns the samples, by seed.
    [[nodiscard]] std::vector<Sample> merge() const;

  private:
    void check_resumed() const;
    void write_header(const std::string& status, const std::vector<Sample>& samples) const;
    SampleFolders samples_;
    TakenFolder taken_;
};

/// A run of an ensemble, for commands that take the folder of one in place of a run.
struct Member {
    std::uint64_t seed = 0;
    std::filesystem::path folder;
    bool begun = false; ///< its run.json exists
    int further = 0;    ///< for a run not begun: so many following ones are not begun either
};

/// Whether this is the folder of an ensemble (and not that of a run).
bool is_ensemble(const std::filesystem::path& directory);

/// The samples that ensemble.json names, by seed; the first one of each series not begun. Throws `Error(bad_input)`.
std::vector<Member> members_of(const std::filesystem::path& directory);

} // namespace isostat
