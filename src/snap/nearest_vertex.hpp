#pragma once
/// \file
/// The equilibrium of rigid grains next to a packing of another program: what `import` writes.

#include "snap/soft_list.hpp"

#include <isostat/preparation/preparation.hpp>
#include <isostat/snap/snap.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace isostat::compare {

/// The contacts of the widest range of thresholds in which the backbone is proved isostatic; or the contacts at
/// `threshold`. \p rounding: bound for gaps.
Result<SoftList> list_below(const Packing& packing, std::optional<double> threshold, double rounding);

/// The backbone of the widest range of thresholds, for any h and k; without a range, the gaps up to `rounding`.
SoftList list_of_plateau(const Packing& packing, double rounding);

/// A vertex with what is proved of it, and the contacts that carry a force, in words.
struct NearestVertex {
    State state;
    Certification truth;
    std::string contacts;
};

/// The state that `find_vertex` ends at, also where only another proof may succeed.
Result<State> state_downhill(const Packing& packing, const PreparationOptions& options);

/// The vertex downhill, for any contacts.
Result<NearestVertex> vertex_downhill(const SoftState& soft, std::uint64_t seed);
/// The vertex of the list, under the stresses times the lengths that the box has there. \p words: origin of the list.
Result<NearestVertex> vertex_of_list(SoftState soft, const std::string& words, std::uint64_t seed);

/// The pairs of grains and walls with a gap of at most `threshold` at the coordinates of the file, sorted.
SoftList list_up_to(const Packing& packing, double threshold);

/// The state of a packing of spheres or of clumps with the contacts of `soft` and the bars, at their vertex where it is
/// determined and near, else at the coordinates of the file; and what is proved of it. Infinitesimal loads give a force
/// to each contact of a rattler that rests on as many contacts as there are axes, so that it rests where it is; clumps
/// have no such loads, and their free motions are held. \p words: origin of the list.
NearestVertex vertex_as_listed(const SoftState& soft, const std::string& words, std::uint64_t seed);

/// Bounds of |true vertex - place in the file|: per disk, and the largest for walls, backbone and rattlers.
struct Moves {
    std::vector<double> disk;
    std::vector<unsigned char> rattler;
    double walls = 0, backbone = 0, rattlers = 0;
};
/// \p from: coordinates of the file.
Moves moves_to(const State& state, const Certification& truth, const std::vector<double>& from);

} // namespace isostat::compare
