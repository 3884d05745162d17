#pragma once
/// \file
/// A series of frames of soft grains (manifest "isostat-series 1" and the files it names) against the exact trajectory
/// of rigid ones.

#include <isostat/contact/state.hpp>
#include <isostat/packing/load.hpp>
#include <isostat/snap/snap.hpp>
#include <isostat/statics/rules.hpp>

#include <array>
#include <atomic>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// A contact as the files give it. `row`: "FILE:LINE" where it was read.
struct FileContact {
    Contact contact;
    double force = 0;
    std::string row;
};

/// One frame. Lengths and forces in the unit of the manifest (its factors are multiplied out); lower walls at 0.
struct Frame {
    int number = 0; ///< row of frames.csv, from 0
    long timestep = 0;
    std::string row; ///< "FILE:LINE" in frames.csv
    Packing packing;
    std::vector<long> ids;
    Load load;
    std::vector<FileContact> contacts; ///< in the order of the files, walls included
    std::string note;                  ///< empty, or why and how another description of the same cell was taken
    std::vector<double> velocity;      ///< velocities of the disks, in any unit of time; empty: the files have none
    double rounding = 0;               ///< bound of the error of a gap from the digits of the files
    double scale = 1;                  ///< sigma_1 of a series with `Series::several`
};

/// What the manifest says of every frame.
struct Series {
    std::string title, program;
    int dimension = 2; ///< 3: spheres
    ForceLaw law = ForceLaw::none;
    double stiffness = 0; ///< 0: no law
    /// All stresses vary, those of the axes but the last in proportion. The true vertex of a list supports a load if
    /// and only if it supports every positive multiple (forces are linear in it), so frames are placed by sigma_d /
    /// sigma_1 on an exact run with sigma_1 = 1.
    bool several = false;
    bool listed = false;      ///< contacts between disks come from a file; else they are the overlapping pairs
    bool wall_forces = false; ///< forces of walls: columns per grain; else the law, where a wall is overlapped
    double rest = 1e-3;       ///< largest unbalanced force of a frame at rest, in mean forces
    double agreement = force_agreement;
    /// 0: another law, or sigma_1 varies: soft limits are predicted only for linear contacts under one sigma_1.
    [[nodiscard]] double linear_stiffness() const { return law == ForceLaw::linear && !several ? stiffness : 0; }
};

/// The frames of a series, one after another, one in memory at a time. Disks are matched by id, in the order of the
/// first frame; frames by time step. The constructor (manifest, table of frames) and `next` throw `Error(bad_input)`
/// with file, line (of rows: and column) and what was expected: unknown keys, missing columns and wall positions
/// (bounds of a dump are never taken), fields that are no numbers, unknown ids, changed radii, time steps that a file
/// lacks, stresses that are not the force on the wall over its reference area. Contradictions between forces, overlaps
/// and lists do not throw: `compare` names them frame by frame. A lattice has many tilts, whole periods apart, and a
/// disk many places. The reader takes those next to the previous frame, because programs flip a sheared box; so
/// contacts keep their images.
class SeriesReader {
  public:
    explicit SeriesReader(const std::filesystem::path& manifest);
    ~SeriesReader();
    SeriesReader(const SeriesReader&) = delete;
    SeriesReader& operator=(const SeriesReader&) = delete;
    [[nodiscard]] const Series& series() const;
    /// The first frame is described like this packing: same disks, nearest tilts and images. \pre no frame was read
    void begin_after(const Packing& packing);
    /// The next frame; nothing after the last one. Throws when the series has no frame.
    std::optional<Frame> next();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

/// What a frame is.
/// - same: its list is that of the exact run at its load, and its vertex is proved;
/// - early, late: the list of a later (earlier) equilibrium of the exact run, proved at this load;
/// - other: a proved equilibrium that is not on the path of the exact run;
/// - soft: its list is no equilibrium of rigid grains (h > 0, or
///   its true vertex is refuted), and the vertex downhill of the
///   frame is proved; that no other vertex is near is not proved;
/// - moving: forces do not balance, or k > 0: says nothing of the program that made the frame;
/// - file: lists, forces and overlaps of the files contradict each other;
/// - refuted: the true vertex of the list has a negative force or an overlap, proved, and no vertex was found downhill;
/// - undecided: none of these was shown.
enum class FrameStatus : unsigned char { same, early, late, other, soft, moving, file, refuted, undecided };
inline constexpr auto frame_status_words =
    words_of<FrameStatus>("same", "early", "late", "other", "soft", "moving", "file", "refuted", "undecided");
constexpr const char* to_string(FrameStatus status) {
    return word_of(status, frame_status_words);
}
inline constexpr int frame_statuses = frame_status_words.size();

/// One frame. Numbers that were not found are NaN, missing numbers of equilibria -1.
struct FrameResult {
    int frame = 0;
    long timestep = 0;
    double stress = 0; ///< the loaded stress; over sigma_1 with `Series::several`
    double unbalanced = 0;
    int listed = 0, overlapping = 0, twice = 0, missing_rows = 0;
    Counting counting; ///< of the list without rattlers, at the soft place
    int rattlers = 0;
    std::string snapped;           ///< "newton", "exchange" or "none"
    double distance = 0;           ///< proved bound of the displacement of a disk of the list to the true vertex
    double walls = 0;              ///< the same bound for the walls
    int expected = -1, found = -1; ///< rearrangements of the exact run before the equilibrium
    FrameStatus status = FrameStatus::undecided;
    std::string reason;                  ///< words, with names and rows
    std::vector<Contact> missing, extra; ///< contacts of the expected equilibrium that the list lacks, and the reverse
    /// Largest error of a force over the mean force, in three parts: |f_file - K overlap|; |f_file - f(H(q_soft))|, the
    /// exact solve at the stored coordinates; |f(H(q_soft)) - f(H(q*))|, upper bounds (both proved to their bound).
    double law = 0, ratio = 1, rest = 0, stiffness = 0;
    /// With h > 0 there is no exact force on the list: `rest` is |f_file - g|, g the balanced forces nearest to the
    /// forces of the file. When the vertex was found downhill: |g - f*|, f* the forces there, an upper bound for that
    /// vertex; and, with h > 0, the part of it along the self-stresses of the list, in doubles.
    double downhill = 0, self_stress = 0;
    PerAxis<double> strain{};      ///< of the frame
    PerAxis<double> true_strain{}; ///< of its true vertex
    int node = -1;                 ///< node of the bundle that has this list
    /// With `local`: whether the exact run from the vertex of the previous frame, at the load of this one, has the list
    /// of this frame ("same"), another list ("other"), or ended before ("undecided" and why). Empty: not asked, or the
    /// previous frame has no vertex.
    std::string local;
    /// With `nearest_arc`, for a frame in motion: the arc of the exact run whose kept contacts differ least from those
    /// of the frame, and the difference. Diagnosis.
    std::string nearest_arc;
};

/// One equilibrium of the exact run: a list of contacts, the interval of the loaded stress that supports it, and what
/// stiffness does to the end of the interval ahead (predictions; NaN: no prediction).
struct PathEquilibrium {
    int number = 0;                ///< rearrangements before this equilibrium
    double stress = 0, strain = 0; ///< the loaded stress and strain
    double low = 0, high = 0;
    int arcs = 0;
    bool proved = false;
    std::vector<Contact> contacts; ///< the contacts that carry a force, sorted
    State state;                   ///< complete
    Contact opens;                 ///< the contact that opens at the end ahead
    double soft_limit = 0;         ///< the loaded stress at the end ahead, for the stiffness of the series
    double stiffness_needed = 0;   ///< the stiffness for which the soft limit is within 1e-3 of the exact one
};

/// Exact runs from the same start, which differ because other contacts open or rattlers rest elsewhere. A node is a
/// proved equilibrium on at least one of the runs, named by its list; members hold numbers of nodes.
struct BundleNode {
    PathEquilibrium equilibrium; ///< as the first member reached it; without soft limits
    std::vector<int> members;    ///< members whose run has this node
    std::vector<int> frames;     ///< frames of the series with this list
};
struct BundleMember {
    OpeningRule rule = OpeningRule::most_negative;
    std::uint64_t seed = 0;   ///< seed of the rule `random`
    std::string rest;         ///< where rattlers rest: down, up, left, right, back, front; "start": as in the start
    std::vector<int> nodes;   ///< its nodes in order
    std::vector<int> at_load; ///< per frame: the node there, -1 beyond the end of the run
    std::string end;          ///< empty, or why the run ends before the last frame
};
struct Bundle {
    std::vector<BundleNode> nodes;
    std::vector<BundleMember> members; ///< the first one is the exact run
    int common = 0;                    ///< number of first nodes that all members share, as far as each run goes
};

/// Why the frames leave the exact run: the first reason in this list that holds.
struct Departure {
    int from = -1, to = -1;              ///< the last frame before and the first one after; -1: none
    std::string reason;                  ///< file, moving, tie, stiffness, step, choice, dynamics, wrong, undecided
    std::string words;                   ///< the sentence with the numbers that decide
    std::vector<Contact> opened, closed; ///< contacts of the frame against the expected equilibrium
};

struct CompareOptions {
    std::optional<State> start; ///< start of the exact run; absent: the vertex of the first frame that has one
    OpeningRule rule = OpeningRule::most_negative;
    int bundle = 16;          ///< number of members of the bundle; 0: no bundle
    bool local = false;       ///< also follow the exact run from every frame to the next
    bool nearest_arc = false; ///< also find the arc of the exact run that each frame in motion is on
    /// The first and the last frame to read, by their numbers.
    std::array<int, 2> frames{0, std::numeric_limits<int>::max()};
    const std::atomic<bool>* stop = nullptr;
};

struct Comparison {
    int dimension = 2;
    std::vector<FrameResult> frames;
    std::vector<PathEquilibrium> path;
    std::string path_end; ///< empty, or why the exact run ends before the last frame
    Bundle bundle;
    std::optional<Departure> departure;
    /// 0 every frame at rest is `same`; 1 one departs; 2 none departs, and one is undecided or all are in motion.
    int status = 0;
};

/// Frames are read and judged (`snap`, else `exchange`), one by each thread; the exact run starts from
/// the first frame, follows the loads of the frames, up and down, and goes on for a few equilibria.
/// Proved are: verdict and distance of each snapped frame, forces, intervals, the run. Diagnosis are:
/// `file` (numbers that another program rounded), the reason of the departure, soft limits. Cost:
/// about two certificates per frame; of a frame only its list and its numbers are kept. Throws what
/// `SeriesReader::next` throws, and `Error(bad_input)` when `start` has other radii than the frames.
Comparison compare(SeriesReader& reader, const CompareOptions& options = {});

} // namespace isostat::compare
