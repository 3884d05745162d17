#pragma once
/// \file
/// The vertices of a crafted packing after its radii, the places of the members of clumps, and, on request, the tilt
/// of its cell are perturbed. A cell of which nothing moves keeps its shape: its size is free.

#include <isostat/contact/state.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace isostat::crafted {

struct GenericityOptions {
    int samples = 100;
    /// Each radius is multiplied by 1 + size * u, u uniform in [-1, 1), and rounded to double: a dyadic number, which
    /// is then exact. Each coordinate of a member of a clump moves by its radius times size * u.
    double size = 1e-6;
    std::uint64_t seed =
        1; ///< sample s draws its u from a 64-bit Mersenne twister seeded with seed + s: it can be repeated alone
    double stress = 1; ///< isotropic
    /// Disks of equal radius get the same u and stay equal: the theorem on generic radii (T7) then does not apply.
    /// Members of clumps keep their places.
    bool keep_equal = false;
    /// The tilt of a cell is perturbed too: the first period times size * u is added to the tilt, with another u of the
    /// same stream. A tilt that does not move is a datum of the packing, as the radii are (T7p).
    bool tilt = false;
};

/// One perturbed packing, taken downhill to its vertex by
/// `find_vertex`; `certify` proves everything about the true vertex.
struct GenericitySample {
    std::uint64_t seed = 0;
    /// Filled, with the reason, when no vertex is proved; the rest is then empty. `tie`: more gaps than N_f cannot be
    /// told from 0 in double-double arithmetic, so that h > 0 is likely, and not proved. `undecided`: some sign is
    /// beyond 100 digits or has no bound. Others: no vertex was found.
    std::optional<Failure> failure;
    std::vector<Contact> contacts; ///< N = N_f - k of them, rank proved, every other gap proved positive: h = 0
    int mechanisms = 0; ///< k: 0 but for clumps that still move under the infinitesimal loads, without any force
    std::vector<Contact> carrying; ///< contacts that carry a force of the applied stress: N_f - d rattlers
    int rattlers = 0;
    int turns = 0;          ///< of rotational rattlers: carrying = N_f - turns - 3 rattlers of clumps in the plane
    double min_force = 0;   ///< proved lower bound of the smallest backbone force
    double min_gap = 0;     ///< proved lower bound of the smallest gap of a pair that is not a contact
    double sigma_min = 0;   ///< proved lower bound of the smallest singular value at the true vertex
    Rung rung = Rung::none; ///< the highest arithmetic that a sign needed
    bool within_original = false; ///< every contact that carries force is an exact contact of the unperturbed packing
};

/// A network of force-carrying contacts and the number of samples with it, most frequent first. (The other contacts of
/// rattlers depend on the infinitesimal loads, which are drawn anew for every sample.)
struct ContactListCount {
    std::vector<Contact> contacts;
    int samples = 0;
};

struct Genericity {
    std::vector<GenericitySample> samples;
    std::vector<ContactListCount> lists;
    int proved = 0;    ///< samples with a proved isostatic vertex: h = k = 0, or free motions of clumps alone
    int ties = 0;      ///< failures `tie`
    int undecided = 0; ///< failures `undecided`
    int failed = 0;    ///< other failures
    /// Samples whose force network is part of the unperturbed contacts.
    [[nodiscard]] int within() const;
    /// Numbers of proved samples by the arithmetic that they needed.
    [[nodiscard]] std::map<std::string, int> rungs() const;
};

/// \p packing has along each axis a fixed lower and a movable upper wall or a period that moves, and no fixed disk
/// (throws `Error(bad_input)` otherwise, and for options out of range); \p original are its contacts. The samples are
/// independent; only proved vertices count. From a failure nothing follows for the vertex of the perturbed packing.
/// Cost: one `find_vertex` and one `certify` per sample.
Genericity genericity(const Packing& packing, const std::vector<Contact>& original, const GenericityOptions& options);

} // namespace isostat::crafted
