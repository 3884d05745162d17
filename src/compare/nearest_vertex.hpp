#pragma once
/// \file
/// The equilibrium of rigid grains next to a packing of another program: what `import` writes.

#include <isostat/compare/snap.hpp>

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

/// How far the true vertex may be from a place in the file: per disk, and at most for walls, backbone and rattlers.
struct Moves {
    std::vector<double> disk;
    std::vector<unsigned char> rattler;
    double walls = 0, backbone = 0, rattlers = 0;
};
/// \p from: coordinates of the file.
Moves moves_to(const State& state, const Certification& truth, const std::vector<double>& from);

} // namespace isostat::compare
