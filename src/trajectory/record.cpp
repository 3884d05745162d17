#include "trajectory/record.hpp"

#include "contact/other_pairs.hpp"
#include "contact/words.hpp"
#include "core/roundoff.hpp"
#include "packing/bodies.hpp"
#include "trajectory/descent.hpp"

#include <isostat/rigidity/counting.hpp>

#include <qd/dd_real.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace isostat {

namespace {

/// |f . (G v) - F . v| / sum |F_i v_i| for a fixed pseudo-random v: both sides of the theorem of virtual power.
double virtual_power_error(const Vertex& vertex, double sigma) {
    const sparse::Matrix<double>& h = vertex.structure.matrix();
    std::mt19937_64 random(20000731);
    std::vector<double> v(static_cast<std::size_t>(h.rows));
    for (double& c : v) {
        c = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    }
    double inner = 0;
    double size = 0;
    for (std::size_t l = 0; l < static_cast<std::size_t>(h.cols); ++l) {
        double approach = 0;
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            approach += h.value[s] * v[static_cast<std::size_t>(h.row[s])];
        }
        inner += vertex.statics.force(ContactId(l), sigma).value * approach;
    }
    const std::vector<double> force = vertex.statics.external_force(sigma);
    double outer = 0;
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        outer += force[mu] * v[mu];
        size += std::abs(force[mu] * v[mu]);
    }
    return size > 0 ? std::abs(inner - outer) / size : std::abs(inner);
}

/// Bound of the relative error of a few operations in double-double, several times too large.
constexpr double dd_rounding = 0x1p-96;
constexpr double rounded_up = 1 + 0x1p-40; ///< covers the rounding of a bound

/// The best enclosure that is known.
VertexEnclosure at_true_vertex(const Vertex& vertex) {
    VertexEnclosure at = vertex.enclosure;
    if (at.correction.empty() && !at.step.empty() && at.step_radius < at.radius) {
        at.correction = vertex.structure.dofs().on_coordinates(at.step);
        at.radius = at.step_radius;
    }
    return at;
}

/// The bound includes the part of `value` that one double cannot show.
Enclosure shown(const dd_real& value, double error) {
    return {value.x[0], (error + std::abs(value.x[1])) * rounded_up};
}

/// Coordinates of a true vertex in double-double.
struct TrueCoordinates {
    const Vertex& vertex;
    const VertexEnclosure& at;

    [[nodiscard]] dd_real operator[](std::size_t k) const {
        return dd_real(vertex.packing.q[k]) + (at.correction.empty() ? 0.0 : at.correction[k]);
    }
    [[nodiscard]] double error(std::size_t k) const {
        const bool moves = vertex.structure.dofs().dof_of(k) >= 0;
        return (moves ? at.radius : 0) + dd_rounding * std::abs(vertex.packing.q[k]);
    }
};

Enclosure length_of(const TrueCoordinates& q, std::size_t axis) {
    const std::size_t k = q.vertex.packing.length_at(axis);
    return shown(q[k], q.error(k));
}

Enclosure strain_of(const TrueCoordinates& q, const Load& load, std::size_t axis) {
    const std::size_t k = q.vertex.packing.length_at(axis);
    const double at_rest = load.at_rest(static_cast<int>(axis));
    const double reference = load.strain_length(static_cast<int>(axis));
    if (!(reference > 0)) {
        return {0, 0};
    }
    const double rounding = dd_rounding * (std::abs(q.vertex.packing.q[k]) + reference);
    return shown((at_rest - q[k]) / reference, (q.error(k) + rounding) / reference);
}

/// Potential of dead loads on the degrees of freedom; true stresses have no W: an infinite bound.
void record_potential(EquilibriumRecord& record, const TrueCoordinates& q, const Load& load) {
    dd_real sum = 0.0;
    double error = load.kind == LoadKind::nominal ? 0 : std::numeric_limits<double>::infinity();
    const auto add = [&](const dd_real& force, std::size_t k) {
        const dd_real term = force * q[k];
        sum -= term;
        error +=
            std::abs(force.x[0]) * q.error(k) * rounded_up + dd_rounding * (std::abs(term.x[0]) + std::abs(sum.x[0]));
    };
    for (std::size_t k = 0; k < load.disk_force.size(); ++k) {
        if (load.disk_force[k] != 0 && q.vertex.structure.dofs().dof_of(k) >= 0) {
            add(load.disk_force[k], k);
        }
    }
    for (const WallForce& wall : load.wall_forces(q.vertex.packing)) {
        add(-stress_times(wall, wall.length) * wall.other, static_cast<std::size_t>(wall.coordinate));
    }
    const Enclosure potential = shown(sum, error * rounded_up);
    record.potential = potential.value;
    record.potential_bound = potential.radius;
}

/// First members of bodies without a contact that bears a force.
std::vector<int> rattling_bodies(const Packing& packing, const std::vector<Contact>& carrying) {
    const std::vector<int> idle = untouched(packing.disk_count(), unilateral(carrying));
    std::vector<int> rattling;
    for (const std::vector<int>& body : Bodies(packing).members(1)) {
        if (std::includes(idle.begin(), idle.end(), body.begin(), body.end())) {
            rattling.push_back(body.front());
        }
    }
    return rattling;
}

} // namespace

bool holds_what_bears(const Vertex& vertex) {
    const std::vector<Contact> carrying = vertex.statics.carrying();
    return std::any_of(carrying.begin(), carrying.end(), [](const Contact& c) { return c.kind == ContactKind::held; });
}

int carrying_contacts(const Vertex& vertex) {
    const std::vector<Contact> carrying = vertex.statics.carrying();
    return static_cast<int>(carrying.size()) - bar_count(carrying);
}

std::vector<int> rattlers(const Vertex& vertex) {
    return rattling_bodies(vertex.packing, vertex.statics.carrying());
}

std::vector<double> finite_forces(const Vertex& vertex, const Load& load) {
    std::vector<double> forces(static_cast<std::size_t>(vertex.structure.size()));
    for (std::size_t l = 0; l < forces.size(); ++l) {
        forces[l] = vertex.statics.force(ContactId(l), load.loaded_stress()).value;
    }
    return forces;
}

/// An end of the supported interval with a bound above `vague`, relative to the end or to the largest stress, is
/// computed again with more digits, until the bound is below `sharp` or the ladder ends: small slopes need more digits
/// than the signs of the forces.
constexpr double vague = 1e-6;
constexpr double sharp = 1e-10;

Result<LoadLimit> well_known_limit(Vertex& vertex, const Load& load, int direction) {
    const double sigma = load.loaded_stress();
    double largest = 0;
    for (const double stress : load.stress) {
        largest = std::max(largest, std::abs(stress));
    }
    PerturbedStatics* const side = vertex.first_order();
    const std::size_t settled = side != nullptr ? side->log.size() : 0;
    auto limit = find_limit(vertex.statics, sigma, direction, side);
    const auto worse_than = [&](double accuracy) {
        const LoadLimit& end = limit.value();
        return !end.unbounded && !(end.stress_error <= accuracy * std::max(std::abs(end.stress), largest));
    };
    for (double asked = vague; limit.ok() && worse_than(asked) && vertex.statics.climb(); asked = sharp) {
        const std::vector<TieDecision> log = side != nullptr ? side->log : std::vector<TieDecision>();
        if (side != nullptr) {
            side->log.resize(settled); // the same decision once more
        }
        auto again = find_limit(vertex.statics, sigma, direction, side);
        if (!again.ok()) { // then the vague end stays
            if (side != nullptr) {
                side->log = log;
            }
            break;
        }
        limit = std::move(again);
    }
    return limit;
}

/// Decides both ends of the supported interval.
std::optional<Failure> describe_limits(Description& description, Vertex& vertex, const Load& load) {
    constexpr Contact none{ContactKind::disk_disk, -1, -1};
    EquilibriumRecord& record = description.record;
    for (const int direction : {-1, +1}) {
        double& stress = direction > 0 ? record.stress_high : record.stress_low;
        Contact& opens = direction > 0 ? record.opens_high : record.opens_low;
        if (holds_what_bears(vertex)) { // only at this load, where the multiplier of the held coordinate vanishes
            stress = load.loaded_stress();
            opens = none;
            continue;
        }
        const auto limit = well_known_limit(vertex, load, direction);
        if (!limit.ok()) {
            return failed(limit.failure().kind, "{} end of the supported interval: {}",
                          direction > 0 ? "upper" : "lower", limit.failure());
        }
        const LoadLimit& end = limit.value();
        stress = end.stress;
        opens = end.unbounded ? none : vertex.structure.contacts()[end.opens.index()];
        (direction > 0 ? record.stress_high_bound : record.stress_low_bound) = end.unbounded ? 0 : end.stress_error;
        record.margin = std::min(record.margin, end.margin);
        record.decided_by = std::max(record.decided_by, end.rung);
        description.limit[direction > 0 ? 1 : 0] = end;
    }
    return std::nullopt;
}

namespace {

/// Counts; bars do not count.
void record_counts(EquilibriumRecord& record, const Vertex& vertex) {
    const auto& contacts = vertex.structure.contacts();
    const int bars = bar_count(contacts);
    record.dof_count = vertex.structure.size() - bars;
    record.contact_count = static_cast<int>(contacts.size()) - bars;
    record.rank = record.dof_count; // proved by `IsostaticStructure`
    record.hyperstaticity = record.contact_count - record.rank;
    record.mechanisms = record.dof_count - record.rank;
    record.held = static_cast<int>(
        std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.kind == ContactKind::held; }));
    record.rattlers = static_cast<int>(rattlers(vertex).size());
    record.backbone = carrying_contacts(vertex);
}

} // namespace

Result<Description> describe(Vertex& vertex, const Load& load) {
    Description description;
    EquilibriumRecord& record = description.record;
    record.margin = std::numeric_limits<double>::infinity();
    record.decided_by = Rung::combinatorial;
    const double sigma = load.loaded_stress();
    record.stress = sigma;
    record.sigma1 = load.other_stress();
    record.mean_stress = load.mean_stress();
    record.deviator = load.deviator();
    description.vertex = at_true_vertex(vertex);
    const TrueCoordinates q{vertex, description.vertex};
    const std::size_t tilts = vertex.packing.cell.shears() ? vertex.packing.tilts() : 0;
    for (std::size_t a = 0; a < vertex.packing.axes() + tilts; ++a) {
        const Enclosure length = length_of(q, a);
        const Enclosure strain = strain_of(q, load, a);
        record.length.push_back(length.value);
        record.length_bound.push_back(length.radius);
        record.strain.push_back(strain.value);
        record.strain_bound.push_back(strain.radius);
    }
    record_potential(record, q, load);
    const auto& contacts = vertex.structure.contacts();
    record_counts(record, vertex);
    record.gap_residual = vertex.enclosure.max_gap;
    record.sigma_min_bound = vertex.inverse.sigma_min;
    if (auto failure = describe_limits(description, vertex, load)) {
        return *failure;
    }
    // After the limits, which may have climbed, so that the bounds are those of the better solution.
    // But no finer than double-double, in which a checker can confirm the record.
    record.force_bound = std::max(vertex.statics.bound(sigma), 0x1p-98 * vertex.statics.largest_force(sigma));
    record.balance = vertex.statics.residual(sigma);
    record.virtual_power = virtual_power_error(vertex, sigma);
    record.min_force = std::numeric_limits<double>::infinity();
    record.min_force_contact = {ContactKind::disk_disk, -1, -1};
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const ContactId id(l);
        if (vertex.statics.is_structural_zero(id) || !contacts[l].is_unilateral()) {
            continue;
        }
        const double f = vertex.statics.force(id, sigma).value;
        if (f < record.min_force) {
            record.min_force = f;
            record.min_force_contact = contacts[l];
        }
    }
    return description;
}

std::optional<Failure> record_smallest_gap(EquilibriumRecord& record, const Vertex& vertex, const VertexEnclosure& at,
                                           const CandidateList& candidates) {
    const auto look = [&](const std::vector<Contact>& pairs) {
        record.min_gap_contact = {ContactKind::disk_disk, -1, -1};
        Enclosure smallest{std::numeric_limits<double>::infinity(), 0};
        double least = smallest.value;
        for (const Contact& pair : pairs) {
            const Enclosure h = gap_at_vertex(vertex.packing, at, pair);
            least = std::min(least, h.value - h.radius);
            if (h.value < smallest.value) {
                smallest = h;
                record.min_gap_contact = pair;
            }
        }
        if (smallest.value - least > smallest.radius) { // another one may be the smallest
            smallest.radius = (smallest.value - least) * (1 + 4 * roundoff::u);
        }
        return smallest;
    };
    const std::vector<Contact>& contacts = vertex.structure.contacts();
    Enclosure gap = look(without(candidates.contacts, contacts, vertex.packing.disk_count()));
    // Pairs that are not listed are farther apart than that; otherwise all pairs are searched.
    if (!candidates.covers(vertex.packing, 0.5 * (gap.value + gap.radius) + 1.001 * at.distance())) {
        const OtherPairs others = other_pairs(vertex.packing, contacts);
        if (others.far()) {
            return Failure{FailureKind::undecided, "the smallest gap is that of a disk and an image too many periods "
                                                   "away: expected a basis of short periods"};
        }
        gap = look(others.near);
    }
    const bool touches = !gap.positive(); // decided by more digits, or at first order: not negative
    record.min_gap = touches ? 0 : gap.value;
    record.min_gap_bound = touches ? gap.value + gap.radius : gap.radius;
    return std::nullopt;
}

std::optional<Failure> check_no_overlap(const Vertex& vertex, const Load& load, const CandidateList& candidates) {
    // No two grains overlap by more than the uncertainty of the stored configuration, all pairs included.
    const double allowance = 4 * vertex.enclosure.distance();
    const Admissibility admissible = certify_admissible(vertex.packing, allowance, &candidates);
    if (admissible.verdict != Verdict::proved) {
        return failed(FailureKind::overlap, "equilibrium at sigma = {:.17g}: {} overlap, gap {:.6g}",
                      load.loaded_stress(), named(admissible.worst), admissible.worst_gap);
    }
    return std::nullopt;
}

void record_strain(ArcRecord& record, const Vertex& end, const Load& load) {
    const VertexEnclosure at = at_true_vertex(end);
    const Enclosure strain = strain_of(TrueCoordinates{end, at}, load, static_cast<std::size_t>(load.loaded_axis));
    record.strain = strain.value;
    record.strain_bound = strain.radius;
}

void record_path(ArcRecord& record, const Arc& path) {
    record.closed = path.closed;
    record.power_turn = path.kind == ArcEnd::power_turn;
    record.held_at = record.power_turn ? path.end.q[static_cast<std::size_t>(path.closed.i)] : 0;
    record.power = path.power;
    record.displacement = path.displacement;
    record.steps = path.steps;
}

} // namespace isostat
