#pragma once
/// \file
/// From a state of soft grains and its list of contacts to the vertex of rigid grains with the same list, with proof;
/// and back, what finite stiffness does to an equilibrium: predictions in double precision, not proved.

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
/// sqrt(R_i); - none: not stated, forces are taken as they are.
enum class ForceLaw : unsigned char { linear, hertz, none };

/// Largest |force - stiffness overlap| of grains that are understood, in mean forces.
inline constexpr double force_agreement = 1e-3;

/// Disks of another program in the box with two fixed and two movable walls, or in a periodic cell, the contacts that
/// carry a force there (sorted, each once) and the load. Overlaps are allowed. Infinitesimal loads are not used.
struct SoftState {
    Packing packing;
    std::vector<Contact> contacts;
    Load load;
};

/// - vertex: the list has a true vertex near the soft place, isostatic, with positive forces under the load and without
///   overlap, and every rattler has room beside it: all proved;
/// - hyperstatic: h > 0, more contacts than rigid grains of generic radii can close; - moving: k > 0, the list holds
/// the grains not;
/// - refuted: the true vertex of the list has a negative force, an overlap, or a rattler that overlaps a grain of the
///   list wherever it is put within a quarter of the smallest radius of its soft place: proved;
/// - undecided: a sign was not decided, no vertex was found near, or no room was found for a rattler (which is no proof
///   that there is none).
enum class SnapOutcome : unsigned char { vertex, hyperstatic, moving, refuted, undecided };
const char* to_string(SnapOutcome outcome);

/// What became of a soft state. Grains without a contact in the list are its rattlers.
struct Snap {
    SnapOutcome outcome = SnapOutcome::undecided;
    std::string reason; ///< empty for a vertex
    /// Of the list, without rattlers, at the soft place.
    Counting counting;
    std::vector<int> rattlers; ///< disks
    std::vector<int> disks;    ///< the others: disk i of `backbone` is disk `disks[i]`
    /// The others alone, in the contacts of the list (the order is that of the list), at the doubles next to the vertex
    /// where Newton's method found one, else at the soft place.
    State backbone;
    Certification truth;       ///< of `backbone`
    std::vector<double> moved; ///< per disk: bound of the distance from the soft place to the true vertex; rattlers: 0
    /// Bounds of the same, largest over the disks of the list, and over the walls, or periods and tilt, where the
    /// pinned disk stays. Infinite without a vertex.
    double distance = std::numeric_limits<double>::infinity();
    double walls = std::numeric_limits<double>::infinity();
    /// All disks: those of the list as in `backbone`, rattlers where they have room (`outcome` is `vertex`; else where
    /// they were).
    Packing packing;
    double cage = std::numeric_limits<double>::infinity(); ///< proved lower bound of the gaps of the rattlers there
};

/// Newton's method on the gaps of the list from the soft place, then `certify` where it ends: the enclosure of the
/// vertex is asked there and not at the soft place, and the distance is way + radius. Rattlers that overlap at the
/// vertex are pushed apart; the gaps that they have then are proved positive. A vertex farther than a tenth of the
/// smallest radius is not taken. What is proved speaks of the doubles of `soft` as they are. Cost: that of `certify`
/// and of three to six rank proofs.
Snap snap(const SoftState& soft);

/// The state of a vertex with its rattlers at rest on generic infinitesimal loads (`generic_infinitesimal`, \p seed):
/// N_f contacts, from which a run can start. Rattlers move from where `snap` left them by arcs that are decided one by
/// one, the others stay. \pre `outcome` is `vertex`. Failures: those of `run_segment`, and `undecided` when the
/// contacts that carry a force are then not those of the list (the message says which).
Result<State> with_resting_rattlers(const Snap& snap, std::uint64_t seed);

/// The same on other infinitesimal loads, which say where the rattlers rest.
Result<State> with_resting_rattlers(const Snap& snap, std::vector<double> infinitesimal);

/// The vertex downhill of the soft place whatever its contacts (`find_vertex`), under the load of the soft state, and
/// what is proved of it. That it is *the* vertex of a list is not proved: with h > 0 there is none.
struct Exchanged {
    State state;
    Certification truth;
    std::vector<Contact> contacts; ///< that carry a force, sorted
    double distance = 0;           ///< as in `Snap`, over disks that carry a force
};
Result<Exchanged> exchange(const SoftState& soft, std::uint64_t seed);

/// The contacts of a certified state that carry a finite force, sorted.
std::vector<Contact> carrying(const State& state, const Certification& truth);
/// The same of a state that is known to be an equilibrium: by its structural zeros. Cost: a rank, no bound.
std::vector<Contact> carrying(const State& equilibrium);

/// Those of a vertex, with the numbers of the whole packing.
std::vector<Contact> carrying(const Snap& snap);

/// Names of contacts, " 1-2 3-left", " none", or the first of them and how many more.
std::string names_of(const std::vector<Contact>& contacts, int dimension = 2);

/// Those of `a` that are not in `b`; both sorted.
std::vector<Contact> without(const std::vector<Contact>& a, const std::vector<Contact>& b);

/// Forces of grains of stiffness K (force = K overlap) in the contacts of a state: gaps = -f / K and H f = F at the
/// same place, by Newton's method on the gaps and a solve in turn.
struct SoftEquilibrium {
    Packing packing;
    std::vector<double> forces; ///< one per contact
    std::vector<double> slopes; ///< per unit of the loaded stress, at this place
};

/// The state at the loaded stress `sigma` with stiffness K. \pre `contacts` is isostatic near `state`. Nothing when the
/// iteration does not settle at 1e-12 of the smallest radius. Double precision, no bound.
std::optional<SoftEquilibrium> soften(const State& state, double sigma, double stiffness);

/// The interval of the loaded stress in which the rigid grains of a state are supported, and the end that is looked at.
struct ExactInterval {
    double low = 0, high = 0;
    int direction = +1; ///< +1: `high`, -1: `low`
    [[nodiscard]] double end() const { return direction > 0 ? high : low; }
};

/// Where the loaded stress takes away the first force of the soft grains, looked for from the middle of the exact
/// interval towards its end and beyond. \pre the interval is finite and positive, every contact of the state carries a
/// force (no rattlers). Nothing where the soft grains have a negative force in the middle already, where `soften` has
/// no answer, or where no force vanishes within twice the interval. Relative accuracy 1e-10.
struct SoftLimit {
    double stress = 0;
    Contact opens;
};
std::optional<SoftLimit> soft_limit(const State& state, const ExactInterval& exact, double stiffness);

/// The stiffness at which the soft limit is within `error` (relative) of the exact one: the difference goes as 1 / K,
/// read off where it is small. Nothing as above.
std::optional<double> stiffness_needed(const State& state, const ExactInterval& exact, double error = 1e-3);

} // namespace isostat::compare
