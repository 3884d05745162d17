#pragma once
/// \file
/// The load programme: equilibria and rearrangements under a changing sigma_2 (paper, section 2.3); segment after
/// segment, from the last equilibrium or from an earlier one.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/rigidity/counting.hpp>
#include <isostat/statics/rules.hpp>
#include <isostat/trajectory/records.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isostat {

/// One segment of the programme: change sigma_2 in one direction until something is reached.
struct Segment {
    int direction = +1;              ///< +1: up, -1: down
    std::optional<int> equilibria;   ///< stop after this many new equilibria
    std::optional<double> to_stress; ///< stop when sigma_2 has reached this value (inside a supported interval); where
                                     ///< it lies behind the start: nothing is done, and `no_limit`
    std::optional<int> from;         ///< start from this equilibrium of the run instead of the last one
    std::string name;                ///< name in records: "up", "down", "cycle 10"...
};

/// What a run does at a tie: two quantities that are exactly equal, or agree up to the largest precision tried.
/// - stop: the run ends with `tie`, and chooses nothing;
/// - choose: the radii are R_i + eps rho_i, eps > 0 smaller than every positive number, rho from `ties_seed` once for
///   the whole run: first-order terms decide (proofs/perturbation.md). Where these leave open which of several contacts
///   opens or closes first, and any of them may, the infinitesimal loads and the order of contacts choose by the rule
///   (proofs/degenerate.md, C1), at most `max_choices` times; then the run ends with `undecided`. Each choice is
///   recorded. The path is then one of several possible paths of the packing as it is, eps = 0.
enum class TiePolicy : unsigned char { stop, choose };
/// The words of scenes, in the order of `TiePolicy`.
inline constexpr auto tie_policy_words = words_of<TiePolicy>("stop", "choose");

/// Caps and choices of a run.
struct RunOptions {
    OpeningRule rule = OpeningRule::most_negative;
    std::uint64_t rule_seed = 1;                    ///< seed of the rule `random`
    long max_arcs = 20000;                          ///< per rearrangement; reaching it means that the sample fails
    double max_strain = 0.5;                        ///< |eps_2| since the reference state
    double step_fraction = 0.1;                     ///< longest predictor step, in units of the smallest radius
    CertifyLevel certify = CertifyLevel::decisions; ///< `states` needs an observer: here it is as `decisions`
    TiePolicy ties = TiePolicy::stop;
    std::uint64_t ties_seed = 1;                         ///< seed of rho
    long max_choices = std::numeric_limits<long>::max(); ///< 0: only first-order terms settle ties
    const std::atomic<bool>* stop = nullptr;             ///< set by Ctrl-C: the run ends after the current arc

    /// Ties are settled for radii R_i + eps rho_i.
    [[nodiscard]] bool at_first_order() const { return ties == TiePolicy::choose; }
    /// A rule chooses where first-order terms leave a tie.
    [[nodiscard]] bool chooses() const { return at_first_order() && max_choices > 0; }
};

/// The direction rho of a run: rho_i = k_i 2^(e-16), k_i an integer in [-2^15, 2^15) from a splitmix64 sequence started
/// at `seed`, 2^e the largest power of two that is not above the smallest radius.
std::vector<double> tie_direction(const std::vector<double>& radius, std::uint64_t seed);

/// Counters that let an interrupted run go on with the same bits.
struct RunCounters {
    long steps = 0;     ///< arcs so far
    int equilibria = 0; ///< number of the last equilibrium
    double seconds = 0;
    Tally tally;
    StateTally states;
    ArcTally arcs;
};

/// How a segment ended.
struct SegmentOutcome {
    bool completed = false;         ///< the segment's goal was reached
    std::optional<Failure> failure; ///< otherwise the reason; the state is the last equilibrium
};

/// Throws `Error(bad_input)` for states that a run cannot follow: a periodic cell that keeps its shape, true stresses
/// where the tilt moves, loads on disks that do not sum to 0 along a periodic axis. `source` starts the message.
/// `run_segment` calls this too.
void require_followed(const State& state, const std::string& source);

/// Runs one segment from `state`, which must be a vertex with N_f contacts.
/// \post `state` is the last equilibrium reached (also after a failure), with its stress set; `counters` advanced. The
/// observer gets every arc and every equilibrium. If `counters.equilibria == 0 && counters.steps == 0` the start is
/// first made an equilibrium (rearranged at its own load if some force is negative) and reported as number 0. Every
/// sign that steers is decided with a proved bound; an undecided one ends the segment with `undecided` or `tie`.
SegmentOutcome run_segment(State& state, const Segment& segment, int segment_number, const RunOptions& options,
                           RunCounters& counters, RunObserver& observer);

/// The first arc of the rearrangement at the end of the supported interval (`direction` +1: upper, -1: lower end): the
/// contact that opens, the motion along the one mechanism that is left, the contact that closes, recorded and proved as
/// in a run. For a state that is no equilibrium: of the rearrangement at its own load. `options.stop` is not used.
/// Failure: that of a run that ends before an arc is made; `no_limit` where nothing opens. Throws as `run_segment`
/// does. Cost: the proofs of the state, and of an arc.
Result<ArcRecord> first_arc(State state, int direction, RunOptions options = {});

/// The mechanism of a state without one of its contacts: velocities of the degrees of freedom (`DofMap`) at which the
/// gap of `opened` grows at rate 1 and the other contacts stay closed at first order. Exactly one mechanism exists,
/// which is proved (exact rank, of the stored coordinates); the velocities are computed in double, without a bound of
/// their error. Failure: `not_isostatic` where N != N_f, or the rank is deficient. Throws `Error(bad_input)` where
/// `opened` is no contact of the state. Cost: an exact rank and a factorisation.
Result<std::vector<double>> mechanism(const State& state, const Contact& opened);

/// What a segment of the programme does to the stress ratio sigma_2 / sigma_1 (shear / sigma_2 where the tilt is
/// loaded, t / p_0 on a path).
enum class Action { up, down, to };
inline constexpr auto action_words = words_of<Action>("up", "down", "to");

/// One segment as a scene names it ([[programme]] entry): its goal is a ratio instead of a stress.
struct ProgrammeStep {
    Action action = Action::up;
    std::optional<int> equilibria;       ///< `equilibria`: stop after this many new ones
    std::optional<double> to;            ///< `to`: stop at this ratio sigma_2 / sigma_1, inside a supported interval
    std::optional<int> from;             ///< `from`: start from this equilibrium of the run instead of the last one
    bool from_zero = false;              ///< a tilt is loaded, or a path: `to` has either sign
    std::string ratio = "sigma2/sigma1"; ///< name of the ratio `to`: `Load::ratio_name`
    std::string name;                    ///< `name`, or words for the goal
    int line = 0;                        ///< in the scene file
};

/// The programme's segment for a state under `load`: direction and stress of the goal. Throws `Error(bad_input)`,
/// starting with `source`, when the goal lies in the wrong direction.
Segment segment_of(const ProgrammeStep& step, const Load& load, const std::string& source);

/// A programme and the step at which it begins.
struct Programme {
    std::vector<ProgrammeStep> steps;
    std::string source;    ///< starts messages about a step: the name of the scene file
    std::size_t first = 0; ///< the step to begin with, or to go on with
    int made = 0;          ///< equilibria already made in that step
    /// The state of an earlier equilibrium of the run, for steps that start `from` it.
    std::function<State(int)> stored;
};

/// How a programme ended: completed when neither field is filled.
struct ProgrammeOutcome {
    std::optional<Failure> failure; ///< of the segment called `segment`
    std::string segment;
    std::string
        impossible; ///< not empty: a step that cannot begin where the run is, in words; only the packing could tell
};

/// Plays the steps one after the other with `run_segment`, from `state`. The observer is told of each segment before it
/// begins. \post `state` is the last equilibrium reached; `counters` advanced. Throws what `stored` throws.
ProgrammeOutcome play(const Programme& programme, State& state, const RunOptions& options, RunCounters& counters,
                      RunObserver& observer);

} // namespace isostat
