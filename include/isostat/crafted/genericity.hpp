#pragma once
/// \file
/// What becomes of a crafted packing when its radii are perturbed.

#include <isostat/contact/contact.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <cstdint>
#include <optional>
#include <vector>

namespace isostat::crafted {

struct GenericityOptions {
    int samples = 100;
    double size = 1e-6; ///< each radius is multiplied by 1 + size * u, u uniform in [-1, 1), and rounded to double
    std::uint64_t seed =
        1; ///< sample s draws its u from a 64-bit Mersenne twister seeded with seed + s: it can be repeated alone
    double stress = 1; ///< isotropic
};

/// One perturbed packing, taken downhill to its vertex by `find_vertex`.
struct GenericitySample {
    std::uint64_t seed = 0;
    std::optional<Failure> failure; ///< no proved vertex, and why; the rest is then empty
    std::vector<Contact> contacts;  ///< N = N_f of them, rank proved, every other gap proved positive: h = k = 0
    int carrying = 0; ///< contacts that carry a force of the applied stress (2 (n - rattlers) + 2 when isostatic)
    int rattlers = 0;
    double min_force = 0;       ///< smallest backbone force
    double min_gap = 0;         ///< smallest gap of a pair that is not a contact
    double sigma_min_bound = 0; ///< proved lower bound of the smallest singular value
    bool within_original =
        false; ///< every contact that carries force is one of the exact contacts of the unperturbed packing
};

/// A contact list and how many samples ended in it, most frequent first.
struct ContactListCount {
    std::vector<Contact> contacts;
    int samples = 0;
};

struct Genericity {
    std::vector<GenericitySample> samples;
    std::vector<ContactListCount> lists;
    int proved = 0; ///< samples with a proved isostatic vertex
};

/// \p packing has two fixed lower and two movable upper walls and no fixed disk (throws `Error(bad_input)` otherwise,
/// and for options out of range); \p original are its contacts. The samples are independent; only proved vertices
/// count. A failure says nothing of the perturbed packing's vertex but that it was not proved. Cost: one `find_vertex`
/// per sample.
Genericity genericity(const Packing<2>& packing, const std::vector<Contact>& original,
                      const GenericityOptions& options);

} // namespace isostat::crafted
