#include "trajectory/descent.hpp"

#include "verified/norm.hpp"
#include "verified/precise_vertex.hpp"

#include <qd/dd_real.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

constexpr double dd_unit = 0x1p-98; // bounds one operation in double-double (proofs/bounds.md)
constexpr double above = 1 + 1e-10; // for sums of a few bounds

/// Enclosure of a true vertex: within `radius` (2-norm) of packing.q + correction.
struct Place {
    const std::vector<double>& q;
    const std::vector<double>& correction; ///< empty: 0
    double radius;

    [[nodiscard]] dd_real operator[](std::size_t k) const {
        return correction.empty() ? dd_real(q[k]) : dd_real::add(q[k], correction[k]);
    }
};

struct Sum {
    dd_real value = 0.0;
    double size = 0;   ///< size of the terms
    double square = 0; ///< sum of the squares of the forces
    void add(const dd_real& force, const dd_real& way) {
        const dd_real term = force * way;
        value += term;
        size += std::abs(term.x[0]);
        square += force.x[0] * force.x[0];
    }
};

/// F . (to - from).
Enclosure work(const Vertex& start, const Place& from, const Place& to, const Load& load, bool infinitesimal) {
    Sum sum;
    const std::vector<double>& on_disks = infinitesimal ? load.infinitesimal : load.disk_force;
    double terms = 4;
    for (std::size_t k = 0; k < on_disks.size(); ++k) {
        if (on_disks[k] != 0 && start.structure.dofs().dof_of(k) >= 0) {
            sum.add(on_disks[k], to[k] - from[k]);
            ++terms;
        }
    }
    for (const WallForce& wall : infinitesimal ? std::vector<WallForce>() : load.wall_forces(start.packing)) {
        const auto k = static_cast<std::size_t>(wall.coordinate);
        sum.add(-stress_times(wall, wall.length) * wall.other, to[k] - from[k]);
        ++terms;
    }
    const double radius = (std::sqrt(sum.square) * (from.radius + to.radius) + (terms + 8) * dd_unit * sum.size) *
                          sum_slack(start.packing.q.size());
    return {sum.value.x[0], radius + 0x1p-52 * std::abs(sum.value.x[0])};
}

/// ln(b / a) = 2 artanh(t), t = (b - a) / (b + a), by its series, because the error of a library function is not
/// proved. `error`: bound of the error of the sum.
dd_real log_of_ratio(const dd_real& a, const dd_real& b, double& error) {
    const dd_real t = (b - a) / (b + a);
    const dd_real square = t * t;
    dd_real power = t;
    dd_real sum = t;
    int terms = 1;
    for (int k = 3; k < 2000 && std::abs(power.x[0]) > 0x1p-110 * std::abs(t.x[0]); k += 2) {
        power *= square;
        sum += power / static_cast<double>(k);
        ++terms;
    }
    const double rest = square.x[0] < 0.999 ? std::abs(power.x[0]) / (1 - square.x[0]) // of the tail of the series
                                            : std::numeric_limits<double>::infinity();
    error = 2 * (rest + (4.0 * terms + 8) * dd_unit * std::abs(sum.x[0])) * above;
    return 2 * sum;
}

/// Phi(from) - Phi(to).
Enclosure decrease_of_phi(const Vertex& start, const Place& from, const Place& to, const Load& load) {
    dd_real value = 0.0;
    double radius = 0;
    double size = 0;
    for (std::size_t a = 0; a < start.packing.axes(); ++a) {
        const std::size_t k = start.packing.axes() * start.packing.radius.size() + a;
        if (start.structure.dofs().dof_of(k) < 0) {
            continue;
        }
        double error = 0;
        const ExactStress stress = load.exact_stress(a);
        const dd_real term = dd_real::add(stress.nearest, stress.rest[0]) * log_of_ratio(to[k], from[k], error);
        value += term;
        size += std::abs(term.x[0]);
        // |ln x - ln y| <= |x - y| / min(x, y); no bound for a length that may be 0.
        const auto moved = [&](const Place& at) {
            const double least = at[k].x[0] - at.radius;
            return least > 0 ? at.radius / least : std::numeric_limits<double>::infinity();
        };
        radius += std::abs(load.stress[a]) * (error + (moved(from) + moved(to)) * above);
    }
    const double bound = (radius + 8 * dd_unit * size) * above + 0x1p-52 * std::abs(value.x[0]);
    return {value.x[0], bound >= 0 ? bound : std::numeric_limits<double>::infinity()};
}

/// Decrease of -F.q, or of Phi, between the two vertices, as an interval of at least `bits`.
PreciseInterval decrease_between(const PreciseVertex& from, const PreciseVertex& to, const Vertex& start,
                                 const Load& load, bool infinitesimal, int bits) {
    PreciseInterval sum(bits);
    const auto exactly = [bits](double x) { return difference(x, 0, bits); };
    const std::vector<double>& on_disks = infinitesimal ? load.infinitesimal : load.disk_force;
    for (std::size_t k = 0; k < on_disks.size(); ++k) {
        if (on_disks[k] != 0 && start.structure.dofs().dof_of(k) >= 0) {
            sum = sum + exactly(on_disks[k]) * (to[k] - from[k]);
        }
    }
    if (infinitesimal) {
        return sum;
    }
    for (const WallForce& wall : load.wall_forces(start.packing)) {
        const auto k = static_cast<std::size_t>(wall.coordinate);
        const PreciseInterval a = from[k];
        const PreciseInterval b = to[k];
        const PreciseInterval stress = exactly(wall.stress) + exactly(wall.rest[0]) + exactly(wall.rest[1]);
        if (load.kind == LoadKind::nominal) {
            sum = sum + stress * exactly(wall.length) * exactly(wall.other) * (a - b);
        } else {
            sum = sum + stress * (logarithm(a) - logarithm(b));
        }
    }
    return sum;
}

/// Computes in MPFR until the sign is known; returns `rough` if this gives no sign.
Enclosure precise_decrease(const Vertex& from, const Vertex& to, const Load& load, bool infinitesimal,
                           const Enclosure& rough) {
    PreciseVertex a(from.packing, from.structure, from.factorisation, from.inverse);
    PreciseVertex b(to.packing, to.structure, to.factorisation, to.inverse);
    Enclosure best = rough;
    constexpr LadderOptions ladder;
    for (int bits = ladder.first_bits; bits <= ladder.max_bits && !best.decided(); bits *= 2) {
        if (!a.enclose(bits) || !b.enclose(bits)) {
            break;
        }
        const Enclosure found = decrease_between(a, b, from, load, infinitesimal, bits).rounded();
        best = found.radius < best.radius ? found : best;
    }
    return best;
}

} // namespace

WorkOfArc work_of(const Load& load, const Packing& from, const Packing& to) {
    WorkOfArc work;
    load.for_each_force(from, [&](std::size_t k, double f) {
        work.value += f * (to.q[k] - from.q[k]);
        work.size += std::abs(f * to.q[k]);
    });
    return work;
}

bool has_potential(const Load& load, bool infinitesimal) {
    return infinitesimal || load.kind == LoadKind::nominal ||
           std::all_of(load.disk_force.begin(), load.disk_force.end(), [](double f) { return f == 0; });
}

Enclosure work_between(const Vertex& from, const Vertex& to, const Load& load) {
    static const std::vector<double> none;
    return work(from, Place{from.packing.q, none, from.enclosure.distance()},
                Place{to.packing.q, none, to.enclosure.distance()}, load, false);
}

Enclosure potential_decrease(const Vertex& from, const Vertex& to, const Load& load, bool infinitesimal,
                             double wanted) {
    assert(has_potential(load, infinitesimal));
    const bool phi = load.kind == LoadKind::true_stress && !infinitesimal;
    const auto between = [&](const Place& a, const Place& b) {
        return phi ? decrease_of_phi(from, a, b, load) : work(from, a, b, load, infinitesimal);
    };
    static const std::vector<double> none;
    const Enclosure rough = between(Place{from.packing.q, none, from.enclosure.distance()},
                                    Place{to.packing.q, none, to.enclosure.distance()});
    if (rough.decided() && rough.radius <= wanted) {
        return rough;
    }
    const auto nearer = [](const Vertex& v) {
        return enclose_vertex_double_double(v.packing, v.structure, v.factorisation, v.inverse);
    };
    const VertexEnclosure a = nearer(from);
    const VertexEnclosure b = nearer(to);
    if (a.verdict != Verdict::proved || b.verdict != Verdict::proved) {
        return rough;
    }
    const Enclosure near =
        between(Place{from.packing.q, a.correction, a.radius}, Place{to.packing.q, b.correction, b.radius});
    const bool at_once = from.perturbed && from.packing.q == to.packing.q; // an arc of length O(eps) has decrease 0
    return near.decided() || at_once ? near : precise_decrease(from, to, load, infinitesimal, near);
}

} // namespace isostat
