#pragma once
/// \file
/// The equilibrium of rigid grains next to a packing of another program: what `import` writes.

#include <isostat/snap/snap.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// The contacts that a vertex must have, and in words where they come from.
struct WantedList {
    std::vector<Contact> contacts;
    std::string words;
};

/// The contacts of the widest range of thresholds in which the backbone is isostatic, proved; or those at `threshold`.
/// \p rounding: of gaps.
Result<WantedList> list_below(const Packing& packing, std::optional<double> threshold, double rounding);

/// The backbone of the widest range of thresholds, whatever its h and k; where there is none the gaps up to `rounding`.
WantedList list_of_plateau(const Packing& packing, double rounding);

/// A vertex with what is proved of it, and in words which contacts carry a force.
struct NearestVertex {
    State state;
    Certification truth;
    std::string contacts;
};

/// The vertex downhill, whatever its contacts.
Result<NearestVertex> vertex_downhill(const SoftState& soft, std::uint64_t seed);
/// The vertex of the list, under the stresses times the lengths that the box has there. \p words: of the list.
Result<NearestVertex> vertex_of_list(SoftState soft, const std::string& words, std::uint64_t seed);

/// The pairs of grains and walls with a gap of at most `threshold` as they stand in the file, sorted.
WantedList list_up_to(const Packing& packing, double threshold);

/// The state of a packing of spheres or of clumps in the contacts of `soft`, and its bars, at their vertex where it is
/// determined and near, else where the file has them; what is proved of it, which may be nothing. Infinitesimal loads
/// are such that each contact of a rattler that rests on as many as there are axes carries one: so it rests where it
/// is; of clumps there are none, free motions are held. \p words: of the list.
NearestVertex vertex_as_listed(const SoftState& soft, const std::string& words, std::uint64_t seed);

/// How far the true vertex may be from a place in the file: per disk, and at most for walls, backbone and rattlers.
struct Moves {
    std::vector<double> disk;
    std::vector<unsigned char> rattler;
    double walls = 0, backbone = 0, rattlers = 0;
};
/// \p from: coordinates of the file.
Moves moves_to(const State& state, const Certification& truth, const std::vector<double>& from);

} // namespace isostat::compare
