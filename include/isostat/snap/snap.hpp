#pragma once
/// \file
/// From a state of soft grains and its list of contacts to the vertex of rigid grains with the same list, with proof;
/// and the effect of finite stiffness on an equilibrium, predicted in double precision and not proved.

#include <isostat/certificate/certify.hpp>
#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// - linear: force = stiffness x overlap; - hertz: stiffness x overlap^(3/2) x sqrt(R_i R_j / (R_i + R_j)), at a wall
///   sqrt(R_i); - none: the law is not stated, forces are taken as they are.
enum class ForceLaw : unsigned char { linear, hertz, none };
inline constexpr auto force_law_words = words_of<ForceLaw>("linear", "hertz", "none");

/// Largest |force - stiffness overlap|, in mean forces, at which forces count as agreeing with the law.
inline constexpr double force_agreement = 1e-3;

/// Disks of another program in the box with two fixed and two movable walls, or in a periodic cell; the contacts that
/// carry a force (sorted, each once); and the load. Overlaps are allowed. Infinitesimal loads are not used.
struct SoftState {
    Packing packing;
    std::vector<Contact> contacts;
    Load load;
};

/// - vertex: all proved: the list has a true vertex near the soft place, isostatic, with positive forces under the load
///   and without overlap, and every rattler has room there;
/// - hyperstatic: h > 0, more contacts than rigid grains of generic radii can close; - moving: k > 0, the grains can
///   move with all listed contacts closed;
/// - refuted: proved: the true vertex of the list has a negative force, an overlap, or a rattler that overlaps a grain
///   of the list wherever it is put within a quarter of the smallest radius of its soft place;
/// - undecided: a sign was not decided, no vertex was found nearby, or no place without overlap was found for a rattler
///   (which does not prove that there is none).
enum class SnapOutcome : unsigned char { vertex, hyperstatic, moving, refuted, undecided };
const char* to_string(SnapOutcome outcome);

/// The result for a soft state. Grains without a contact in the list are its rattlers.
struct Snap {
    SnapOutcome outcome = SnapOutcome::undecided;
    std::string reason; ///< empty for a vertex
    /// Counts of the list, without rattlers, at the soft place.
    Counting counting;
    std::vector<int> rattlers; ///< disks
    std::vector<int> disks;    ///< the other disks: disk i of `backbone` is disk `disks[i]`
    /// The other disks alone, with the contacts of the list (in its order), at the doubles next to the vertex where
    /// Newton's method found one, else at the soft place.
    State backbone;
    Certification truth;       ///< what is proved of `backbone`
    std::vector<double> moved; ///< per disk: bound of the distance from the soft place to the true vertex; rattlers: 0
    /// Bounds of the same distances, the largest over the disks of the list and over the walls, or periods and tilt,
    /// with the pinned disk kept in place. Infinite without a vertex.
    double distance = std::numeric_limits<double>::infinity();
    double walls = std::numeric_limits<double>::infinity();
    /// All disks: disks of the list as in `backbone`, rattlers where they do not overlap (if `outcome` is `vertex`;
    /// else at their soft places).
    Packing packing;
    double cage = std::numeric_limits<double>::infinity(); ///< proved lower bound of rattlers' gaps in `packing`
};

/// Newton's method on the gaps of the list from the soft place, then `certify` where it ends: the
/// vertex is enclosed there and not at the soft place, and `distance` is the Newton displacement +
/// radius. Rattlers that overlap at the vertex are pushed apart; their new gaps are proved
/// positive. A vertex farther than a tenth of the smallest radius is refused. The proofs hold for
/// the doubles of `soft` exactly as given. Cost: that of `certify` and of three to six rank proofs.
Snap snap(const SoftState& soft);

/// The state of a vertex with its rattlers at rest on generic infinitesimal loads (`generic_infinitesimal`, \p seed):
/// N_f contacts, from which a run can start. Rattlers move from where `snap` left them by arcs that are decided one by
/// one, the other disks stay. \pre `outcome` is `vertex`. Failures: those of `run_segment`, and `undecided` when the
/// contacts that then carry a force are not those of the list (the message names the difference).
Result<State> with_resting_rattlers(const Snap& snap, std::uint64_t seed);

/// `with_resting_rattlers` with given infinitesimal loads, which determine where the rattlers rest.
Result<State> with_resting_rattlers(const Snap& snap, std::vector<double> infinitesimal);

/// The vertex downhill of the soft place whatever its contacts (`find_vertex`), under the load of the soft state, and
/// what is proved of that vertex. It is not proved to belong to the list: with h > 0 no vertex does.
struct Exchanged {
    State state;
    Certification truth;
    std::vector<Contact> contacts; ///< that carry a force, sorted
    double distance = 0;           ///< as in `Snap`, over the disks that carry a force
};
Result<Exchanged> exchange(const SoftState& soft, std::uint64_t seed);

/// The contacts of a certified state that carry a finite force, sorted.
std::vector<Contact> carrying(const State& state, const Certification& truth);
/// These contacts for a state known to be an equilibrium, by its structural zeros. Cost: a rank, no bound.
std::vector<Contact> carrying(const State& equilibrium);

/// The contacts of a vertex that carry a force, with the numbers of the whole packing.
std::vector<Contact> carrying(const Snap& snap);

/// Names of contacts, " 1-2 3-left", " none", or the first of them and how many more.
std::string names_of(const std::vector<Contact>& contacts, int dimension = 2);

/// Contacts of `a` that are not in `b`; both sorted.
std::vector<Contact> without(const std::vector<Contact>& a, const std::vector<Contact>& b);

/// Forces of grains of stiffness K (force = K overlap) in the contacts of a state: gaps = -f / K and H f = F at one
/// configuration, found by turns of a Newton step on the gaps and a solve for the forces.
struct SoftEquilibrium {
    Packing packing;
    std::vector<double> forces; ///< one per contact
    std::vector<double> slopes; ///< derivatives of the forces by the loaded stress, at this place
};

/// The soft equilibrium at the loaded stress `sigma` with stiffness K. \pre `contacts` is isostatic near `state`.
/// Nothing when the iteration does not converge to 1e-12 of the smallest radius. Double precision, no bound.
std::optional<SoftEquilibrium> soften(const State& state, double sigma, double stiffness);

/// The interval of the loaded stress in which the rigid grains of a state are supported, and the end of interest.
struct ExactInterval {
    double low = 0, high = 0;
    int direction = +1; ///< +1: `high`, -1: `low`
    [[nodiscard]] double end() const { return direction > 0 ? high : low; }
};

/// The loaded stress at which the first force of the soft grains vanishes, searched from the middle of the exact
/// interval towards its end and beyond. \pre the interval is finite and positive, every contact of the state carries a
/// force (no rattlers). Nothing when the soft grains have a negative force in the middle already, when `soften` gives
/// nothing, or when no force vanishes within twice the interval. Relative accuracy 1e-10.
struct SoftLimit {
    double stress = 0;
    Contact opens;
};
std::optional<SoftLimit> soft_limit(const State& state, const ExactInterval& exact, double stiffness);

/// The stiffness at which the soft limit is within `error` (relative) of the exact one: extrapolated from large
/// stiffness, where the difference is proportional to 1 / K. Nothing in the cases of `SoftLimit`.
std::optional<double> stiffness_needed(const State& state, const ExactInterval& exact, double error = 1e-3);

} // namespace isostat::compare
