#include "verified/first_order.hpp"

#include "contact/separation.hpp"
#include "core/roundoff.hpp"
#include "rigidity/rigid_group.hpp"
#include "verified/inverse_bound.hpp"
#include "verified/norm.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <optional>

namespace isostat {

namespace {

using roundoff::root2;
using roundoff::u;
constexpr double raise = 1 + 1e-10; ///< rounding of sums and products of a few bounds; precision.md B1

double length_of(const std::vector<double>& x) {
    std::vector<double> size(x.size());
    std::transform(x.begin(), x.end(), size.begin(), [](double c) { return std::abs(c); });
    return norm_above(size);
}

/// Relative rounding of a row times a vector: 4 terms, with an image 7, in space 6 and 12; their sum; 5u (5.51u)
/// per entry; and one for three periods.
double rounding(int dimension, const Contact& contact) {
    const bool here = contact.image.is_here();
    // 12: precision.md B8 (a); 16: precision.md B8 (f); 14: precision.md B8 (a); 22: precision.md B8 (f)
    return (dimension == plane ? (here ? 12 : 16) : (here ? 14 : 22)) * u;
}

/// Rounding of a relative velocity to which periods are added, by at most seven operations on each component.
/// Without an image each component is one difference, whose rounding is relative.
double lost_to_periods(const Layout& layout, const std::vector<double>& v, const Contact& pair) {
    double size = 0;
    if (!pair.image.is_here()) {
        Separation(pair, layout).for_each_coordinate([&](std::size_t k, std::size_t, int multiple) {
            size += std::abs(multiple * v[k]);
        });
    }
    return 16 * u * size; // precision.md B8 (f)
}

/// The grains of a contact, disks first, then walls.
std::array<std::size_t, 2> grains_of(const Contact& c, std::size_t disks) {
    const auto i = static_cast<std::size_t>(c.i);
    if (c.of_disks()) {
        return {i, static_cast<std::size_t>(c.j)};
    }
    return c.is_wall() ? std::array{i, disks + c.wall_number()} : std::array{disks, disks};
}

/// Shares of a force and differences of motions below this count as zero: a guess, since the list is counted exactly.
constexpr double carries_or_moves = 1e-8; // guess: which contacts carry the force of a pair

/// The coefficients a with row of the pair = sum a_l (row of l), in double.
std::vector<double> shares_of(const Packing& packing, const IsostaticStructure& structure,
                              const Factorisation& factorisation, const Contact& pair) {
    std::vector<double> a(static_cast<std::size_t>(structure.size()), 0.0);
    gap_gradient(packing, pair).for_each_dof(structure.dofs(), [&](std::size_t dof, double value) { a[dof] = -value; });
    factorisation.solve_forces(a);
    return a;
}

/// The contacts whose force balances that of a pair, as far as doubles tell: a wrong contact too many or too few
/// makes the count fail. Empty when `opened` is one of them, or a held coordinate.
std::vector<Contact> carriers(const Packing& packing, const IsostaticStructure& structure,
                              const Factorisation& factorisation, ContactId opened, const Contact& pair) {
    const std::vector<double> a = shares_of(packing, structure, factorisation, pair);
    std::vector<Contact> list;
    for (std::size_t l = 0; l < a.size(); ++l) {
        if (std::abs(a[l]) > carries_or_moves) {
            if (l == opened.index() || structure.contacts()[l].kind == ContactKind::held) {
                return {};
            }
            list.push_back(structure.contacts()[l]);
        }
    }
    return list;
}

/// All contacts that stay closed when `opened` opens, among the grains of some contacts and of a pair.
std::vector<Contact> closed_among(const Packing& packing, const IsostaticStructure& structure, ContactId opened,
                                  const std::vector<Contact>& some, const Contact& pair) {
    const auto& contacts = structure.contacts();
    const std::size_t disks = packing.radius.size();
    std::vector<unsigned char> in_body(disks + 2 * packing.axes(), 0);
    const auto join = [&](const Contact& c) {
        for (const std::size_t grain : grains_of(c, disks)) {
            in_body[grain] = 1;
        }
    };
    join(pair);
    std::for_each(some.begin(), some.end(), join);
    std::vector<Contact> among;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const auto grains = grains_of(contacts[l], disks);
        if (l != opened.index() && contacts[l].kind != ContactKind::held && in_body[grains[0]] != 0 &&
            in_body[grains[1]] != 0) {
            among.push_back(contacts[l]);
        }
    }
    return among;
}

/// Position and velocity of a disk relative to the first of a pair, found from contact to contact, through images.
struct Seen {
    PerAxis<double> place{};
    PerAxis<double> velocity{};
    /// The grain at the other end of a contact: its second disk, or its first when `sign` is -1.
    [[nodiscard]] Seen across(const Packing& packing, const std::vector<double>& v, const Contact& c, int sign) const {
        const auto d = separation(packing.layout(), packing.q, c);
        const auto w = separation(packing.layout(), v, c);
        Seen other = *this;
        for (std::size_t a = 0; a < d.size(); ++a) {
            other.place[a] += sign * d[a];
            other.velocity[a] += sign * w[a];
        }
        return other;
    }
};

/// Contacts that stay closed when `opened` opens and that join to the grains of a pair the grains that move with
/// them as one body, as far as doubles tell; `v`: the motion. Walls are grains of a body that does not turn.
std::vector<Contact> moving_alike(const Packing& packing, const IsostaticStructure& structure, ContactId opened,
                                  const std::vector<double>& v, const Contact& pair) {
    const std::size_t disks = packing.radius.size();
    const double fastest =
        std::abs(*std::max_element(v.begin(), v.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    std::vector<std::optional<Seen>> body(disks + 2 * packing.axes()); // for walls the entry is empty
    const auto grains = grains_of(pair, disks);
    body[grains[0]].emplace();
    double turn = 0;
    if (pair.of_disks()) {
        const Seen second = Seen().across(packing, v, pair, 1);
        const auto& [x, w] = second;
        turn = (x[0] * w[1] - x[1] * w[0]) / (x[0] * x[0] + x[1] * x[1]);
        body[grains[1]] = second;
    } else {
        body[grains[1]].emplace();
    }
    const bool turns = std::abs(turn) * packing.min_radius() > carries_or_moves * fastest;
    const auto moves_with = [&](const Seen& disk) {
        const auto& [x, w] = disk;
        return std::abs(w[0] + turn * x[1]) + std::abs(w[1] - turn * x[0]) <= carries_or_moves * fastest;
    };
    std::vector<Contact> list;
    std::vector<unsigned char> taken(structure.contacts().size(), 0);
    for (bool grows = true; grows;) {
        grows = false;
        for (std::size_t l = 0; l < taken.size(); ++l) {
            const Contact& c = structure.contacts()[l];
            if (taken[l] != 0 || l == opened.index() || c.kind == ContactKind::held) {
                continue;
            }
            const auto [i, j] = grains_of(c, disks);
            Seen other; // unused for a wall
            if (!c.of_disks()) {
                if (!body[i] || turns) {
                    continue;
                }
            } else if (body[i] || body[j]) {
                other = body[i] ? body[i]->across(packing, v, c, 1) : body[j]->across(packing, v, c, -1);
                if (!moves_with(other)) {
                    continue;
                }
            } else {
                continue;
            }
            std::optional<Seen>& joins = body[i] ? body[j] : body[i];
            joins = joins ? joins : other;
            list.push_back(c);
            taken[l] = 1;
            grows = true;
        }
    }
    return list;
}

/// Whether contacts that stay closed when `opened` opens make the two grains of a pair one body. Any set of
/// contacts may be tried. Tried are those among the grains whose contacts carry the force of the pair, then those among
/// grains that move alike. Always false for spheres.
bool rests(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
           ContactId opened, const std::vector<double>& v, const Contact& pair) {
    if (packing.dimension != plane) {
        return false;
    }
    const std::vector<Contact> carrying = carriers(packing, structure, factorisation, opened, pair);
    const auto as_one = [&](const std::vector<Contact>& among) {
        return moves_as_one(structure.dofs(), packing.disk_count(), among, pair);
    };
    return !carrying.empty() && (as_one(closed_among(packing, structure, opened, carrying, pair)) ||
                                 as_one(moving_alike(packing, structure, opened, v, pair)));
}

} // namespace

FirstOrder::FirstOrder(const Packing& packing, const IsostaticStructure& structure, const Factorisation& factorisation,
                       const InverseBound& inverse, const VertexEnclosure& enclosure, const std::vector<double>& rho)
    : packing_(&packing), structure_(&structure), factorisation_(&factorisation), rho_(&rho) {
    assert(inverse.verdict == Verdict::proved && enclosure.verdict == Verdict::proved);
    assert(rho.size() == packing.radius.size());
    away_ = enclosure.distance() * raise;
    uncertainty_ = normal_rate(packing, structure.contacts()) * away_ * raise;
    sigma_ = (inverse.sigma_min - uncertainty_) * (1 - 4 * u); // precision.md B8 (e), last operations
    std::vector<double> approach;
    std::vector<double> rounding;
    for (const Contact& c : structure.contacts()) {
        double sum = 0;
        if (c.kind != ContactKind::held) {
            sum = rho[static_cast<std::size_t>(c.i)];
            if (c.of_disks()) {
                sum += rho[static_cast<std::size_t>(c.j)];
            }
        }
        approach.push_back(-sum);
        rounding.push_back(2 * u * std::abs(sum));
    }
    change_ = velocity(approach, norm_above(rounding));
}

/// Solves G v = approach: |v - v*|_2 <= (|G v - approach| + |G - G*| |v|) / sigma_min.
FirstOrder::Velocity FirstOrder::velocity(const std::vector<double>& approach, double approach_error) const {
    const sparse::Matrix<double>& h = structure_->matrix();
    std::vector<double> v = approach;
    factorisation_->solve_velocities(v);
    std::vector<double> residual(v.size());
    for (std::size_t l = 0; l < v.size(); ++l) {
        double dot = -approach[l];
        double terms = std::abs(dot);
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            const auto s = static_cast<std::size_t>(e);
            const double term = h.value[s] * v[static_cast<std::size_t>(h.row[s])];
            dot += term;
            terms += std::abs(term);
        }
        residual[l] = std::abs(dot) + rounding(packing_->dimension, structure_->contacts()[l]) * terms;
    }
    Velocity result;
    result.v = structure_->dofs().on_coordinates(v);
    const double open = norm_above(residual) + approach_error + uncertainty_ * length_of(v);
    result.error = sigma_ > 0 ? open / sigma_ * raise : std::numeric_limits<double>::infinity();
    return result;
}

Enclosure FirstOrder::gap_rate(const Contact& contact, const Velocity& velocity) const {
    if (contact.kind == ContactKind::held) {
        return {velocity.v[static_cast<std::size_t>(contact.i)], velocity.error};
    }
    const auto rate = gap_gradient(*packing_, contact).rate(velocity.v);
    const double weight = separation_weight(contact);
    double turned = 0; // the normal of the true vertex differs
    if (contact.of_disks()) {
        double square = 0;
        for (const double r : separation(packing_->layout(), velocity.v, contact)) {
            square += r * r;
        }
        // |n - n*| <= 2 |x - x*| / d for the relative positions x
        turned = (std::sqrt(square) + lost_to_periods(packing_->layout(), velocity.v, contact)) * 2 * weight * away_ /
                 (0.99 * target(*packing_, contact)); // precision.md B8 (b)
    }
    return {rate.value,
            (weight * velocity.error + turned + rounding(packing_->dimension, contact) * rate.terms) * raise};
}

Enclosure FirstOrder::gap(const Contact& contact) const {
    Enclosure c = gap_rate(contact, change_);
    if (contact.kind != ContactKind::held) {
        const double grown = touching_distance(*rho_, contact);
        c = c - Enclosure{grown, 2 * u * std::abs(grown)};
    }
    return c;
}

Enclosure FirstOrder::rate(ContactId opened, int direction, const Contact& contact) const {
    // h_m = sum a_l h_l over the structure: the rate is proportional to a_opened, which may be a structural zero.
    const std::vector<int> rows = touched_rows(structure_->dofs(), contact);
    if (ContactPattern(*packing_, *structure_, true).carrying(rows)[opened.index()] == 0) {
        return {0, 0};
    }
    std::vector<double> approach(static_cast<std::size_t>(structure_->size()), 0.0);
    approach[opened.index()] = -direction;
    const Velocity motion = velocity(approach, 0);
    const Enclosure rate = gap_rate(contact, motion);
    const bool told = rate.decided() || !rests(*packing_, *structure_, *factorisation_, opened, motion.v, contact);
    return told ? rate : Enclosure{0, 0};
}

std::vector<double> FirstOrder::shares(const Contact& contact) const {
    return shares_of(*packing_, *structure_, *factorisation_, contact);
}

bool FirstOrder::moves_as_linkage(ContactId opened, const Contact& contact) const {
    if (packing_->dimension != plane) {
        return false;
    }
    const std::vector<Contact> carrying = carriers(*packing_, *structure_, *factorisation_, opened, contact);
    return !carrying.empty() &&
           (isostat::moves_as_linkage(*packing_, carrying, contact) ||
            isostat::moves_as_linkage(*packing_, closed_among(*packing_, *structure_, opened, carrying, contact),
                                      contact));
}

FirstOrder::LoadChange FirstOrder::load_change(const std::vector<Enclosure>& f0, const Load& load,
                                               double stress_error) const {
    const auto& contacts = structure_->contacts();
    const std::vector<double>& v = change_.v;
    LoadChange on{std::vector<double>(v.size(), 0.0), std::vector<double>(v.size(), 0.0)};
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        if (!c.of_disks()) {
            continue; // normals of walls do not turn
        }
        const auto x = separation(packing_->layout(), packing_->q, c);
        const auto r = separation(packing_->layout(), v, c);
        double square = 0;
        double dot = 0;
        double speed = 0;
        for (std::size_t e = 0; e < x.size(); ++e) {
            square += x[e] * x[e];
            dot += x[e] * r[e];
            speed += r[e] * r[e];
        }
        const double d = std::sqrt(square);
        speed = std::sqrt(speed);
        // dn = (r - n (n.r)) / d; relative errors of n and d at the true vertex, of r, and of the arithmetic.
        const double weight = separation_weight(c);
        const double lost = lost_to_periods(packing_->layout(), v, c);
        speed += lost;
        const double place = weight * away_ / d;
        // precision.md B8 (c)
        const double off = (weight * change_.error + lost + speed * (6 * place + 40 * u)) / d * 1.01;
        Separation(c, packing_->layout()).for_each_coordinate([&](std::size_t k, std::size_t e, int sign) {
            const double turn = (r[e] - x[e] * dot / square) / d;
            const double push = f0[l].value * turn;
            const double unknown = f0[l].radius * (std::abs(turn) + off) + std::abs(f0[l].value) * off;
            on.value[k] += sign * push; // column l of H is minus the gradient of the gap
            on.error[k] += std::abs(sign) * (unknown + 2 * u * std::abs(push)) + 2 * u * std::abs(on.value[k]);
        });
    }
    if (load.kind == LoadKind::true_stress) { // the force on a wall depends on the other lengths
        for (std::size_t a = 0; a < packing_->axes(); ++a) {
            const double off =
                load.path ? stress_error * std::abs(load.rate_of(a)) + 2 * u * std::abs(load.stress[a]) : stress_error;
            add_stress_change(a, load.stress[a], off, on);
        }
    }
    return on;
}

/// Adds -stress (L_b' L_c + L_b L_c'); in the plane -stress times the rate of the other length.
void FirstOrder::add_stress_change(std::size_t axis, double stress, double stress_error, LoadChange& on) const {
    const bool in_plane = packing_->dimension == plane;
    double sum = 0;
    double size = 0;
    double open = 0; // error of the sum without its rounding
    for (std::size_t b = 0; b < packing_->axes(); ++b) {
        if (b == axis) {
            continue;
        }
        const double rate = change_.v[packing_->length_at(b)];
        // exact: the third of the axes 0, 1, 2
        const double across = in_plane ? 1 : packing_->q[packing_->length_at(3 - axis - b)];
        const double away = in_plane ? 0 : away_;
        sum += rate * across;
        size += std::abs(rate) * across;
        open += change_.error * (across + away) + std::abs(rate) * away;
    }
    const std::size_t wall = packing_->length_at(axis);
    on.value[wall] -= stress * sum;
    // precision.md B8 (e), last operations
    on.error[wall] += std::abs(stress) * (open + 4 * u * size) + stress_error * (size + open);
}

std::vector<Enclosure> FirstOrder::forces(const std::vector<Enclosure>& f0,
                                          const std::vector<unsigned char>& structural_zero, const Load& load,
                                          double stress_error) const {
    const DofMap& dofs = structure_->dofs();
    const LoadChange on = load_change(f0, load, stress_error);
    const auto n = static_cast<std::size_t>(structure_->size());
    std::vector<double> b(n);
    std::vector<double> open(n);
    for (std::size_t mu = 0; mu < n; ++mu) {
        const std::size_t k = dofs.coordinate_of(mu);
        b[mu] = on.value[k];
        open[mu] = on.error[k];
    }
    std::vector<double> f1 = b;
    factorisation_->solve_forces(f1);
    std::vector<double> rest(n);
    std::vector<double> size(n);
    std::vector<int> terms(n);
    const double residual = residual_of_forces(structure_->matrix(), b, f1, rest, size, terms);
    const double bound = sigma_ > 0 ? (residual + norm_above(open) + uncertainty_ * length_of(f1)) / sigma_ * raise
                                    : std::numeric_limits<double>::infinity();
    std::vector<Enclosure> result(n);
    for (std::size_t l = 0; l < n; ++l) {
        result[l] = structural_zero[l] != 0 ? Enclosure{0, 0} : Enclosure{f1[l], bound};
    }
    return result;
}

} // namespace isostat
