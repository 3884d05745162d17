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

/// A contact as the files say it. `row`: "FILE:LINE" where it was read.
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
    std::vector<FileContact> contacts; ///< as they stand in the files, in their order; walls too
    std::string note;                  ///< empty, or how the cell of the file was described anew
    std::vector<double> velocity;      ///< of the disks, in any unit of time; empty: not in the files
    double rounding = 0;               ///< so far are gaps known by the digits of the files
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
    bool listed = false;      ///< contacts between disks come from a file; else they are the pairs that overlap
    bool wall_forces = false; ///< of each grain, from columns; else walls that one overlaps, with the force of the law
    double rest = 1e-3;       ///< largest unbalanced force of a frame at rest, in mean forces
    double agreement = force_agreement;
    /// 0: another law, or a sigma_1 that varies; soft limits are predicted for linear contacts under one sigma_1 only.
    [[nodiscard]] double linear_stiffness() const { return law == ForceLaw::linear && !several ? stiffness : 0; }
};

/// The frames of a series, one after another: one is in memory at a time. Disks are matched by id, in the order of the
/// first frame; frames by time step. The constructor (manifest, table of frames) and `next` throw `Error(bad_input)`
/// with file, line (of rows: and column) and what was expected: unknown keys, missing columns and wall positions (the
/// bounds of a dump are never taken), numbers that are none, ids that are not there, radii that change, time steps that
/// a file does not have, stresses that are not the force on the wall over its reference area. Contradictions between
/// forces, overlaps and lists are not looked at: `compare` names them frame by frame. A lattice has many tilts, whole
/// periods apart, and a disk many places: each is taken next to the one of the frame before, so contacts keep their
/// images (programs flip a sheared box).
class SeriesReader {
  public:
    explicit SeriesReader(const std::filesystem::path& manifest);
    ~SeriesReader();
    SeriesReader(const SeriesReader&) = delete;
    SeriesReader& operator=(const SeriesReader&) = delete;
    [[nodiscard]] const Series& series() const;
    /// The first frame comes after this one: another description of the same disks. \pre no frame was read
    void begin_after(const Packing& packing);
    /// Nothing after the last one. Throws when there is none at all.
    std::optional<Frame> next();

  private:
    struct Files;
    std::unique_ptr<Files> files_;
};

/// What a frame is.
/// - same: its list is that of the exact run at its load, and its vertex is proved;
/// - early, late: the list of a later (earlier) equilibrium of the exact run, proved at this load;
/// - other: a proved equilibrium that is not on the path of the exact run;
/// - soft: its list is no equilibrium of rigid grains (h > 0, or its true vertex is refuted), and the vertex downhill
/// of
///   it is proved: that it is the only one near is not;
/// - moving: forces do not balance, or k > 0: says nothing of the program that made it;
/// - file: lists, forces and overlaps of the files contradict each other;
/// - refuted: the true vertex of the list has a negative force or an overlap, proved, and no vertex was found downhill;
/// - undecided: none of these was shown.
enum class FrameStatus : unsigned char { same, early, late, other, soft, moving, file, refuted, undecided };
inline constexpr int frame_statuses = 9;
const char* to_string(FrameStatus status);

/// One frame. Numbers that were not found are NaN, numbers of equilibria -1.
struct FrameResult {
    int frame = 0;
    long timestep = 0;
    double stress = 0; ///< the loaded one; over sigma_1 with `Series::several`
    double unbalanced = 0;
    int listed = 0, overlapping = 0, twice = 0, missing_rows = 0;
    Counting counting; ///< of the list without rattlers, at the soft place
    int rattlers = 0;
    std::string snapped;           ///< "newton", "exchange" or "none"
    double distance = 0;           ///< proved bound of the way of a disk of the list to the true vertex
    double walls = 0;              ///< the same of the walls
    int expected = -1, found = -1; ///< rearrangements of the exact run before the equilibrium
    FrameStatus status = FrameStatus::undecided;
    std::string reason;                  ///< words, with names and rows
    std::vector<Contact> missing, extra; ///< of the list against that of the equilibrium expected
    /// Largest error of a force over the mean force, in three parts: |f_file - K overlap|; |f_file - f(H(q_soft))|, the
    /// exact solve at the stored coordinates; |f(H(q_soft)) - f(H(q*))|, upper bounds (both proved to their bound).
    double law = 0, ratio = 1, rest = 0, stiffness = 0;
    /// With h > 0 there is no exact force on the list: `rest` is |f_file - g|, g the balanced forces nearest to those
    /// of the file. Where the vertex is one downhill: |g - f*|, f* its forces, an upper bound against that vertex; and,
    /// with h > 0, what of it is along the self-stresses of the list, in doubles.
    double downhill = 0, self_stress = 0;
    PerAxis<double> strain{};      ///< of the frame
    PerAxis<double> true_strain{}; ///< of its true vertex
    int node = -1;                 ///< of the bundle with this list
    /// With `local`: the exact run from the vertex of the frame before, at the load of this one, has the list of this
    /// frame ("same"), another one ("other"), or ended before ("undecided" and why). Empty: not asked, or no vertex
    /// there.
    std::string local;
    /// With `nearest_arc`, of a frame in motion: the arc of the exact run whose kept contacts differ least from those
    /// of the frame, and by which. Diagnosis.
    std::string nearest_arc;
};

/// One equilibrium of the exact run: a list of contacts, the interval of the loaded stress that supports it, and what
/// stiffness does to the end of it ahead (predictions; NaN without one).
struct PathEquilibrium {
    int number = 0;                ///< rearrangements before it
    double stress = 0, strain = 0; ///< the loaded ones
    double low = 0, high = 0;
    int arcs = 0;
    bool proved = false;
    std::vector<Contact> contacts; ///< that carry a force, sorted
    State state;                   ///< complete
    Contact opens;                 ///< at the end ahead
    double soft_limit = 0;         ///< of that stress ahead, at the stiffness of the series
    double stiffness_needed = 0;   ///< for which it is within 1e-3 of the exact one
};

/// Exact runs from the same start: they open other contacts, or rattlers rest elsewhere. A node is a proved equilibrium
/// that at least one of them comes through, named by its list; members hold numbers of nodes.
struct BundleNode {
    PathEquilibrium equilibrium; ///< as the first member came to it; soft limits not asked for
    std::vector<int> members;    ///< that come through it
    std::vector<int> frames;     ///< of the series with this list
};
struct BundleMember {
    OpeningRule rule = OpeningRule::most_negative;
    std::uint64_t seed = 0;   ///< of the rule `random`
    std::string rest;         ///< down, up, left, right, back, front: where rattlers rest; "start": as in the start
    std::vector<int> nodes;   ///< one after another
    std::vector<int> at_load; ///< per frame: the node there, -1 beyond the end of the run
    std::string end;          ///< empty, or why it ends before the last frame
};
struct Bundle {
    std::vector<BundleNode> nodes;
    std::vector<BundleMember> members; ///< the first one is the exact run
    int common = 0;                    ///< so many nodes from the start are the same in all members, as far as they go
};

/// Why the frames leave the exact run: the first of these that holds.
struct Departure {
    int from = -1, to = -1;              ///< frames: the last one before, and the first one after; -1: none
    std::string reason;                  ///< file, moving, tie, stiffness, step, choice, dynamics, wrong, undecided
    std::string words;                   ///< with the numbers that decide
    std::vector<Contact> opened, closed; ///< of the frame against the equilibrium expected
};

struct CompareOptions {
    std::optional<State> start; ///< of the exact run; none: the vertex of the first frame that has one
    OpeningRule rule = OpeningRule::most_negative;
    int bundle = 16;          ///< members of the bundle; 0: none
    bool local = false;       ///< besides, the exact run from every frame to the next
    bool nearest_arc = false; ///< besides, the arc of the exact run that each frame in motion is on
    /// The first and the last frame to look at, by their numbers.
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

/// Frames are read and judged (`snap`, else `exchange`), one by each thread; the exact run starts from the first,
/// follows the loads of the frames, up and down, and goes on for a few equilibria. What is proved: verdict and distance
/// of each snapped frame, forces, intervals, the run. What is diagnosis: `file` (numbers that another program rounded),
/// the reason of the departure, soft limits. Cost: about two certificates per frame; kept of a frame are its list and
/// its numbers. Throws what `SeriesReader::next` throws, and `Error(bad_input)` when `start` has other radii than the
/// frames.
Comparison compare(SeriesReader& reader, const CompareOptions& options = {});

} // namespace isostat::compare
