#include "certificate/parts.hpp"
#include "contact/images.hpp"
#include "core/roundoff.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace isostat {

using roundoff::infinity;

namespace {

/// The bounds count roundings, not underflow or overflow: where those could matter, nothing is claimed.
std::optional<std::string> out_of_range(const State& state) {
    constexpr double largest = 1e100;   // precision.md B2 (e), no over- or underflow
    constexpr double smallest = 1e-100; // precision.md B2 (e), no over- or underflow
    const auto [least, most] = std::ranges::minmax_element(state.packing.radius);
    const auto size = [](const std::vector<double>& x) {
        return std::accumulate(x.begin(), x.end(), 0.0, [](double m, double c) { return std::max(m, std::abs(c)); });
    };
    if (least == state.packing.radius.end() || *least < smallest || *most > largest ||
        size(state.packing.q) > largest) {
        return "there are no disks, or lengths beyond 1e-100 and 1e100";
    }
    for (const double load : {size(state.load.external_force(state.packing)), size(state.load.infinitesimal)}) {
        if (load != 0 && !(load > smallest && load < largest)) {
            return fmt::format("the largest load is {:.3g}, beyond 1e-100 and 1e100", load);
        }
    }
    return std::nullopt;
}

/// The smallest stretch of a lattice vector, from below: |A m| >= that times |m|. It is 1 / |A^-1|, in the Frobenius
/// norm and with the entries of A^-1 from above: sums of products of magnitudes, without cancellation (proofs/cells.md,
/// C4).
double least_stretch(const Packing& packing) {
    PerAxis<double> column{}; // of A^-1
    double inverse_norm = 0;
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        column.fill(0);
        for (std::size_t a = b + 1; a-- > 0 && packing.cell.periodic[b];) {
            double sum = a == b ? 1 : 0;
            for (std::size_t c = a + 1; c <= b; ++c) {
                sum += std::abs(packing.lattice(a, c)) * column[c];
            }
            column[a] = packing.cell.periodic[a] ? sum / packing.lattice(a, a) : 0;
            inverse_norm = std::hypot(inverse_norm, column[a]);
        }
    }
    return 1 / inverse_norm * (1 - 1e-12); // cells.md C4, rounding of a bound
}

} // namespace

std::optional<std::string> beyond_claims(const State& state) {
    const auto held =
        std::ranges::find_if(state.contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    return held == state.contacts.end() || !state.packing.bars.empty()
               ? out_of_range(state)
               : fmt::format("the state keeps a coordinate ({}), which is not a contact",
                             to_string(*held, state.packing.dimension));
}

double largest_length(const Packing& packing) {
    double largest = packing.max_radius();
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        const bool exists = k < packing.axes() * packing.radius.size() || packing.cell.any() ||
                            packing.walls.upper[k % packing.axes()] != WallKind::absent;
        largest = exists ? std::max(largest, std::abs(packing.q[k])) : largest;
    }
    return largest;
}

bool any_far(const std::vector<Contact>& pairs) {
    return std::ranges::any_of(pairs, [](const Contact& pair) { return is_beyond(pair, farthest_image); });
}

std::optional<Packing> on_grid(Packing packing, const std::vector<Contact>& contacts, double& moved) {
    const Packing before = packing;
    moved = snap_to_grid(packing);
    const DofMap dofs(packing);
    bool stays = !any_far(contacts);
    for (std::size_t k = packing.length_at(0); k < packing.q.size(); ++k) {
        stays = stays && (dofs.dof_of(k) >= 0 || packing.q[k] == before.q[k]);
    }
    return stays ? std::optional(std::move(packing)) : std::nullopt;
}

double far_weight(const Packing& packing, double reach) {
    constexpr double root2 = 1.4143; // true_vertex.md V5 (other gaps), above sqrt 2
    if (!packing.cell.any()) {
        return packing.arcs.empty() ? root2 : 2; // U9
    }
    double extent = 0; // of the centres
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        double low = infinity;
        double high = -infinity;
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            low = std::min(low, packing.q[packing.axes() * i + a]);
            high = std::max(high, packing.q[packing.axes() * i + a]);
        }
        extent = std::hypot(extent, high - low);
    }
    // cells.md C4, rounding of a bound
    return root2 + (2 * packing.max_radius() + reach + extent) / least_stretch(packing) * (1 + 1e-12);
}

std::optional<std::string> beyond_sectors(const ArcBodies& arcs, const std::vector<Contact>& contacts,
                                          double distance) {
    if (arcs.any() && !(distance < arcs.known_to())) {
        return "the vertex is not known well enough to say which arcs are nearest, or arcs are no convex curve there";
    }
    const auto outside =
        std::ranges::find_if(contacts, [&](const Contact& contact) { return !arcs.faces(contact, distance); });
    return outside == contacts.end() ? std::nullopt
                                     : std::optional(fmt::format("contact {} is not inside the arcs of its members: at "
                                                                 "a joint, or beyond",
                                                                 to_string(*outside)));
}

} // namespace isostat
