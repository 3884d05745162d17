#include "certificate/true_vertex.hpp"
#include "contact/candidates.hpp"
#include "contact/contact_set.hpp"
#include "crafted/able.hpp"
#include "rigidity/isostatic.hpp"
#include "snap/backbone.hpp"
#include "verified/to_vertex.hpp"

#include <isostat/core/result.hpp>
#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <vector>

namespace isostat::compare {

namespace {

/// The vertex must be within this distance, in smallest radii, because grains farther away are not nearly rigid.
constexpr double nearest_vertex = 0.1;
constexpr double up = 1 + 0x1p-49; // covers the rounding of a difference and of a sum

/// Takes the disks and contacts of the list without the rattlers.
void take_backbone(const SoftState& soft, Snap& out) {
    std::vector<int> number(soft.packing.radius.size(), -1);
    out.rattlers = untouched(soft.packing.disk_count(), soft.contacts);
    for (int i = 0; i < soft.packing.disk_count(); ++i) {
        if (!std::ranges::binary_search(out.rattlers, i)) {
            number[static_cast<std::size_t>(i)] = static_cast<int>(out.disks.size());
            out.disks.push_back(i);
        }
    }
    out.backbone.packing = of_disks(soft.packing, out.disks);
    const Packing& packing = out.backbone.packing;
    std::ranges::transform(soft.contacts, std::back_inserter(out.backbone.contacts),
                           [&](const Contact& c) { return renumbered(c, number); });
    out.backbone.load = soft.load;
    out.backbone.load.disk_force.clear();
    // Where several forces vanish together for structural reasons, the end of the interval depends on these loads.
    out.backbone.load.infinitesimal = generic_infinitesimal(packing.radius, 1, packing.dimension);
    balance(out.backbone.load.infinitesimal, packing.cell);
    if (packing.dimension != plane) { // a sphere may bear forces in one plane only, and touch a wall too
        out.backbone.load.infinitesimal = resting_loads(packing, out.backbone.contacts, 1);
    }
}

/// The contact in the names of the whole packing.
std::string renamed(const Snap& snap, const Contact& c) {
    return to_string(renumbered(c, snap.disks), snap.packing.dimension);
}

/// Describes the first force that is proved negative, or empty.
std::string negative_force(const Snap& snap) {
    const std::vector<Interval>& f = snap.truth.finite;
    for (std::size_t l = 0; l < f.size(); ++l) {
        if (f[l].upper < 0) {
            return fmt::format("the force of {} is {:.3g} at the vertex of the list",
                               renamed(snap, snap.backbone.contacts[l]), f[l].upper);
        }
    }
    return "";
}

/// Describes the deepest overlap of the backbone at the vertex, or empty.
std::string overlapping_pair(const Snap& snap) {
    const double allowance = snap.truth.claims.vertex ? 3 * snap.truth.claims.vertex->radius : 0; // contacts touch
    Admissibility worst = certify_admissible(snap.backbone.packing, allowance);
    return worst.verdict == Verdict::refuted ? fmt::format("{} overlap by {:.3g} at the vertex of the list",
                                                           renamed(snap, worst.worst), -worst.worst_gap)
                                             : "";
}

void measure_moves(const SoftState& soft, Snap& out) {
    const double radius = out.truth.claims.vertex->radius;
    const std::vector<double>& q = out.backbone.packing.q;
    const auto way = [&](std::size_t here, std::size_t there) {
        return (std::abs(q[here] - soft.packing.q[there]) + radius) * up;
    };
    out.moved.assign(soft.packing.radius.size(), 0);
    out.distance = 0;
    const std::size_t d = soft.packing.axes();
    for (std::size_t b = 0; b < out.disks.size(); ++b) {
        const auto i = static_cast<std::size_t>(out.disks[b]);
        out.moved[i] = distance_above(d, [&](std::size_t a) { return way(d * b + a, d * i + a); });
        out.distance = std::max(out.distance, out.moved[i]);
        std::copy_n(&q[d * b], d, &out.packing.q[d * i]);
    }
    const std::size_t n = soft.packing.length_at(0), m = out.backbone.packing.length_at(0);
    out.walls = 0;
    for (std::size_t k = 0; m + k < q.size(); ++k) { // of walls, or of periods and tilt
        out.walls = std::max(out.walls, way(m + k, n + k));
        out.packing.q[n + k] = q[m + k];
    }
    out.packing.cell = soft.packing.cell;
    if (soft.packing.cell.any()) { // the pinned disk must carry a force
        out.packing.cell.pin = out.disks[static_cast<std::size_t>(out.backbone.packing.cell.pin)];
    }
}

void judge(Snap& out) {
    const CertificateClaims& claims = out.truth.claims;
    const std::string negative = negative_force(out);
    const std::string overlap = negative.empty() ? overlapping_pair(out) : "";
    if (out.truth.verdict == Verdict::refuted) {
        out.outcome = SnapOutcome::refuted;
        out.reason = !negative.empty() ? negative : !overlap.empty() ? overlap : out.truth.refuted.front();
    } else if (claims.counting && claims.vertex && claims.forces && claims.gaps) {
        out.outcome = SnapOutcome::vertex; // the interval of the load is decided elsewhere
    } else {
        out.reason = claims.undecided.empty() ? "the vertex is not proved" : claims.undecided.front();
    }
}

/// Judges whether the rattlers of a vertex have room.
void judge_room(Snap& out) {
    if (const std::string failed = make_room(out); !failed.empty()) {
        const std::string none = without_room(out);
        out.outcome = none.empty() ? SnapOutcome::undecided : SnapOutcome::refuted;
        out.reason = none.empty() ? failed : none;
    }
}

/// The contacts without structural zeros, or all contacts when the zeros are not known.
std::vector<Contact> without_zeros(const State& state, const std::vector<unsigned char>& zero) {
    const bool known = zero.size() == state.contacts.size();
    std::vector<Contact> out = known ? unmarked(state.contacts, zero) : state.contacts;
    std::ranges::sort(out);
    return out;
}

} // namespace

Packing of_disks(const Packing& packing, const std::vector<int>& disks) {
    Packing out;
    out.dimension = packing.dimension;
    out.walls = packing.walls;
    out.cell = packing.cell;
    for (const int disk : disks) {
        const auto i = static_cast<std::size_t>(disk);
        out.radius.push_back(packing.radius[i]);
        const double* const x = &packing.q[packing.axes() * i];
        out.q.insert(out.q.end(), x, x + packing.axes());
    }
    out.q.insert(out.q.end(), packing.q.begin() + static_cast<std::ptrdiff_t>(packing.length_at(0)), packing.q.end());
    const auto pin = std::ranges::find(disks, packing.cell.pin);
    out.cell.pin = pin == disks.end() ? 0 : static_cast<int>(pin - disks.begin());
    return out;
}

const char* to_string(SnapOutcome outcome) {
    static constexpr auto words = words_of<SnapOutcome>("vertex", "hyperstatic", "moving", "refuted", "undecided");
    return word_of(outcome, words);
}

State backbone_of(const State& state, const std::vector<Contact>& carrying) {
    Snap out;
    take_backbone({state.packing, carrying, state.load}, out);
    return std::move(out.backbone);
}

std::vector<Contact> able_to_carry(const Packing& packing, std::vector<Contact> contacts) {
    std::erase_if(contacts, [](const Contact& c) { return c.kind == ContactKind::held; });
    const crafted::Peeling peeling = crafted::peel(packing, contacts);
    const int all = static_cast<int>(contacts.size());
    const auto loaded = [&](int i) { return peeling.disk_from[static_cast<std::size_t>(i)] <= all; };
    std::vector<Contact> out;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const bool holds = loaded(c.i) && (!c.of_disks() || loaded(c.j));
        if (peeling.contact_from[l] <= all || holds) {
            out.push_back(c);
        }
    }
    return out;
}

std::vector<double> resting_loads(const Packing& packing, const std::vector<Contact>& contacts, std::uint64_t seed) {
    std::vector<double> out(packing.length_at(0), 0);
    if (contacts.empty()) {
        return out;
    }
    std::mt19937_64 random(seed);
    const double unit = packing.min_radius() * packing.min_radius();
    for (const Contact& contact : contacts) {
        const double force = unit * (1 + static_cast<double>(random() >> 11U) * 0x1p-53);
        gap_gradient(packing, contact).for_each([&](std::size_t k, double value) {
            if (k < out.size()) {
                out[k] -= force * value;
            }
        });
    }
    balance(out, packing.cell);
    return out;
}

Snap snap(const SoftState& soft) {
    Snap out;
    out.packing = soft.packing;
    take_backbone(soft, out);
    out.counting = count_contacts(out.backbone.packing, out.backbone.contacts);
    const Counting& c = out.counting;
    if (c.mechanisms > 0 || c.hyperstaticity > 0) {
        // h is exact, or an upper bound: with k = 0 the rank is N_f, and h = N - N_f.
        out.outcome = c.mechanisms > 0 ? SnapOutcome::moving : SnapOutcome::hyperstatic;
        out.reason = fmt::format("the list has N_f = {}, N = {}, rank {}, h = {}, k = {}", c.dof_count, c.contact_count,
                                 c.rank, c.hyperstaticity, c.mechanisms);
        return out;
    }
    Packing& packing = out.backbone.packing;
    long steps = 0;
    if (const auto failure = to_vertex(packing, out.backbone.contacts, steps, nearest_vertex * packing.min_radius())) {
        out.reason = failure->message(packing.dimension);
        return out;
    }
    if (packing.cell.keeps_shape) {
        snap_to_grid(packing); // the vertex is that of the stored period along x
    }
    out.truth = certify(out.backbone);
    judge(out);
    if (out.truth.claims.vertex) {
        measure_moves(soft, out);
    }
    if (out.outcome == SnapOutcome::vertex) {
        judge_room(out);
    }
    return out;
}

std::vector<Contact> carrying(const State& state, const Certification& truth) {
    return without_zeros(state, truth.structural_zero);
}

std::vector<Contact> carrying(const State& equilibrium) {
    const auto structure = IsostaticStructure::prove(equilibrium.packing, equilibrium.contacts);
    return without_zeros(equilibrium,
                         structure.ok() ? Subject(equilibrium, structure.value()).zero : std::vector<unsigned char>());
}

std::string names_of(const std::vector<Contact>& contacts, int dimension) {
    constexpr std::size_t most = 8;
    std::string text;
    for (std::size_t k = 0; k < std::min(most, contacts.size()); ++k) {
        text += " " + to_string(contacts[k], dimension);
    }
    return contacts.empty()         ? " none"
           : contacts.size() > most ? fmt::format("{} and {} more", text, contacts.size() - most)
                                    : text;
}

std::vector<Contact> without(const std::vector<Contact>& a, const std::vector<Contact>& b) {
    std::vector<Contact> out;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(out));
    return out;
}

} // namespace isostat::compare
