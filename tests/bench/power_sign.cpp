// Whether the power of the load could be proved positive between the two ends of an arc (statement A9, proofs/arcs.md),
// and what that would cost: no run does it. A stretch at level `arcs` gives the vertices. Between two of them the chord
// with a quadratic correction, found in P passes, is taken for the curve; where A9 fails a point of the curve between
// them is made a centre, with its own bound of the inverse, and both halves are tried. Bounds of the inverse are made
// anew at every vertex, sharper than those that runs carry; rounding and the radii of the vertices are left out, and
// stretches are looked at in 32 points: so the true price is not below this one. Usage:
//   bench_power_sign [--json FILE] [--equilibria E] [--passes P] [n | state file ...]
// default: 400 1936, 20 equilibria, 1 and 3 passes.
#include "bench/shared/report.hpp"
#include "bench/shared/stretch.hpp"
#include "core/dot.hpp"
#include "linear/factorisation.hpp"
#include "motion/chord.hpp"
#include "motion/geometry.hpp"
#include "motion/kept_curve.hpp"
#include "statics/statics.hpp"
#include "verified/configuration.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>

using namespace isostat;

namespace {

using Vector = std::vector<double>;

double norm(const Vector& x) {
    return std::sqrt(dot(x, x));
}

/// A point of the curve: an end, or a centre between them whose free row is that of a coordinate.
struct Point {
    Packing packing;
    IsostaticStructure structure;
    Factorisation factors;
    double sigma;
    Vector force;
};

struct Times {
    long bounds = 0;
    bench::Sample bound;     ///< of the inverse, with the symbolic work at hand
    bench::Sample centre;    ///< a point of the curve between two others
    bench::Sample enclosure; ///< what A9 says of two points, its passes included
};

std::unique_ptr<Point> point(Packing packing, std::vector<Contact> contacts, const Vector& load, Times& times) {
    auto proved = IsostaticStructure::prove(packing, std::move(contacts));
    if (!proved.ok()) {
        return nullptr;
    }
    IsostaticStructure structure = std::move(proved.value());
    Factorisation factors(structure);
    InverseBoundCache cache;
    InverseBound inverse = bound_inverse(structure, factors, cache); // the next one has the symbolic work of this one
    times.bound.add(bench::milliseconds([&] { inverse = bound_inverse(structure, factors, cache); }, 1).median());
    ++times.bounds;
    Vector f(static_cast<std::size_t>(structure.size()));
    for (std::size_t mu = 0; mu < f.size(); ++mu) {
        const auto k = static_cast<std::size_t>(structure.dofs().coordinate_of(static_cast<int>(mu)));
        f[mu] = k < load.size() ? load[k] : 0;
    }
    factors.solve_forces(f);
    return std::make_unique<Point>(Point{std::move(packing), std::move(structure), std::move(factors),
                                         inverse.verdict == Verdict::proved ? inverse.sigma_min : 0, std::move(f)});
}

/// What A9 says of the curve between two of its points.
class Between {
  public:
    Between(const Point& a, const Point& b, std::size_t slot, int passes)
        : a_(a), b_(b), slot_(slot), curve_(a.packing, a.structure.contacts(), slot, 0), delta_(a.packing.q),
          middle_(a.packing.q), bend_(a.packing.q.size(), 0.0) {
        for (std::size_t k = 0; k < delta_.size(); ++k) {
            delta_[k] = b.packing.q[k] - a.packing.q[k];
            middle_[k] = 0.5 * (b.packing.q[k] + a.packing.q[k]);
        }
        for (int pass = 0; pass < passes; ++pass) {
            miss();
            Vector better = missed_;
            a.factors.approximate().velocities(better);
            for (std::size_t mu = 0; mu < better.size(); ++mu) {
                bend_[coordinate(mu)] += better[mu];
            }
            const double along = dot(bend_, delta_) / dot(delta_, delta_);
            for (std::size_t k = 0; k < bend_.size(); ++k) {
                bend_[k] -= along * delta_[k];
            }
        }
        sum();
    }

    /// kappa > 0 all along: regular, in norm; Kantorovich's test too: a tube.
    bool regular = true, tube = true, positive = true;

    void look(bool from_zero, bool to_zero) {
        constexpr int stretches = 32;
        for (int k = 0; k <= stretches && regular; ++k) {
            const bool open = (k == 0 && from_zero) || (k == stretches && to_zero);
            look_at(static_cast<double>(k) / stretches, open);
        }
        tube = tube && regular;
        positive = positive && tube;
    }

  private:
    [[nodiscard]] std::size_t coordinate(std::size_t mu) const {
        return static_cast<std::size_t>(a_.structure.dofs().coordinate_of(static_cast<int>(mu)));
    }
    /// Sums over the contacts with the forces of one end.
    struct Sums {
        double xx = 0, xz = 0, zz = 0; ///< f x.x / D, ...
        Vector x, z;                   ///< the forces of f x / D and f z / D on the coordinates
        double of_x = 0, of_z = 0;     ///< their norms
        double rate = 0, bend = 0;     ///< of the gap in the slot
    };
    /// What the quadratic misses to first order.
    void miss() {
        const auto& contacts = a_.structure.contacts();
        missed_.assign(contacts.size(), 0.0);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (l == slot_) {
                continue;
            }
            const auto z = separation_over(a_.packing.layout(), bend_, contacts[l]);
            missed_[l] = z[0];
            if (contacts[l].of_disks()) {
                const auto x = separation_over(a_.packing.layout(), delta_, contacts[l]);
                const auto r = separation_over(a_.packing.layout(), middle_, contacts[l]);
                missed_[l] = (dot(a_.packing.layout(), x, x) + dot(a_.packing.layout(), r, z)) / curve_.target[l];
            }
        }
    }
    void sum() {
        miss();
        const auto& contacts = a_.structure.contacts();
        Vector ex(contacts.size(), 0.0);
        Vector ez(contacts.size(), 0.0);
        of_a_ = of_b_ = {0, 0, 0, Vector(delta_.size(), 0.0), Vector(delta_.size(), 0.0)};
        double rho = 0, rate = 0, straight = 0;
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            const Contact& contact = contacts[l];
            if (l == slot_) {
                continue;
            }
            if (!contact.of_disks()) {
                rho += missed_[l] * missed_[l];
                rate += 0.25 * missed_[l] * missed_[l];
                continue;
            }
            const double d = curve_.target[l];
            const auto x = separation_over(a_.packing.layout(), delta_, contact);
            const auto z = separation_over(a_.packing.layout(), bend_, contact);
            const double xx = dot(a_.packing.layout(), x, x) / d;
            const double xz = std::abs(dot(a_.packing.layout(), x, z)) / d;
            const double zz = dot(a_.packing.layout(), z, z) / d;
            const double most = std::abs(missed_[l]) + 0.5 * xz + zz / 16;
            const double fastest = 0.5 * most + 0.125 * (xz + 0.25 * zz);
            rho += most * most;
            rate += fastest * fastest;
            straight += xx * xx;
            ex[l] = std::sqrt(xx / d);
            ez[l] = std::sqrt(zz / d);
            turn_ = std::max(turn_, ex[l] + 0.5 * ez[l]);
            add(of_a_, a_.force[l] / d, contact, x, z);
            add(of_b_, b_.force[l] / d, contact, x, z);
        }
        rho_ = std::sqrt(rho);
        rate_ = std::sqrt(rate);
        straight_ = std::sqrt(straight);
        of_x_ = curve_.norm_of(ex);
        of_z_ = curve_.norm_of(ez);
        length_ = norm(delta_);
        finish(of_a_, a_);
        finish(of_b_, b_);
    }
    void finish(Sums& sums, const Point& end) const {
        sums.of_x = norm(sums.x);
        sums.of_z = norm(sums.z);
        sums.rate = gap_rate(end.packing, end.structure.contacts()[slot_], delta_);
        sums.bend = gap_rate(end.packing, end.structure.contacts()[slot_], bend_);
    }
    void add(Sums& sums, double weight, const Contact& contact, const PerAxis<double>& x, const PerAxis<double>& z) {
        const Layout layout = a_.packing.layout();
        sums.xx += weight * dot(layout, x, x);
        sums.xz += weight * dot(layout, x, z);
        sums.zz += weight * dot(layout, z, z);
        heaviest_ = std::max(heaviest_, std::abs(weight));
        Separation(contact, layout).for_each_coordinate([&](std::size_t k, std::size_t component, int multiple) {
            if (a_.structure.dofs().dof_of(k) >= 0) {
                sums.x[k] += multiple * weight * x[component];
                sums.z[k] += multiple * weight * z[component];
            }
        });
    }
    void look_at(double t, bool open) {
        const double theta = t * (1 - t);
        const double tau = t - 0.5;
        const double kappa = std::max(a_.sigma - t * of_x_, b_.sigma - (1 - t) * of_x_) - 0.5 * theta * of_z_;
        const double sine = (std::abs(tau) * straight_ + 0.5 * theta * rho_) / (kappa * length_);
        regular = kappa > 0 && sine < 1;
        if (!regular) {
            return;
        }
        const double beta = 1 / (kappa * std::sqrt(1 - sine * sine));
        tube = tube && beta * beta * curve_.lipschitz * 0.5 * theta * rho_ <= 0.25;
        const double apart = beta * theta * rho_;
        const double at_curve = beta / std::max(0.1, 1 - beta * curve_.lipschitz * apart);
        const double slope_apart = at_curve * (rate_ + turn_ * std::sqrt(curve_.spread) * apart);
        const auto power = [&](const Point& end, const Sums& sums, double way) { // from below
            const double own = -end.force[slot_] * (sums.rate + tau * sums.bend);
            const double kept = way * sums.xx + (way * tau - 0.5 * theta) * sums.xz - 0.5 * theta * tau * sums.zz;
            const double off = (sums.of_x + 0.5 * sums.of_z) * apart +
                               (std::abs(way) * sums.of_x + 0.5 * theta * sums.of_z) * slope_apart +
                               heaviest_ * curve_.spread * apart * slope_apart;
            return own + kept - off - std::abs(end.force[slot_]) * std::sqrt(2.0) * slope_apart;
        };
        positive = positive && (open || power(a_, of_a_, t) > 0 || power(b_, of_b_, t - 1) > 0);
    }
    const Point& a_;
    const Point& b_;
    std::size_t slot_;
    KeptCurve curve_;
    Vector delta_, middle_, bend_, missed_;
    Sums of_a_, of_b_;
    double rho_ = 0, rate_ = 0, straight_ = 0, turn_ = 0, heaviest_ = 0, of_x_ = 0, of_z_ = 0, length_ = 0;
};

/// The point of the curve in the middle between two of its points.
std::unique_ptr<Point> middle(const Point& a, const Point& b, std::size_t slot, const Vector& load, Times& times) {
    Packing at = a.packing;
    std::size_t fastest = 0;
    for (std::size_t k = 0; k < at.q.size(); ++k) {
        at.q[k] = 0.5 * (a.packing.q[k] + b.packing.q[k]);
        const auto way = [&](std::size_t c) { return std::abs(b.packing.q[c] - a.packing.q[c]); };
        fastest = way(k) > way(fastest) ? k : fastest;
    }
    const Contact row{ContactKind::held, static_cast<int>(fastest), 0};
    Chord chord(a.structure, a.factors, slot);
    bool found = false;
    times.centre.add(bench::milliseconds([&] { found = chord.converge(at, row); }, 1).median());
    if (!found && (chord.renew(at, fastest) || !chord.converge(at, row))) {
        return nullptr;
    }
    snap_to_grid(at);
    std::vector<Contact> contacts = a.structure.contacts();
    contacts[slot] = row;
    return point(std::move(at), std::move(contacts), load, times);
}

/// Counts over the arcs of a stretch.
struct Counts {
    long arcs = 0;
    long regular = 0, tube = 0, positive = 0; ///< without a centre between the ends
    long in_the_end = 0;                      ///< positive, with centres
    Times times;                              ///< of the centres
};

bool prove(const Point& a, const Point& b, std::size_t slot, int passes, const std::pair<bool, bool>& zero,
           const Vector& load, Counts& counts, int depth) {
    std::optional<Between> made;
    const auto look = [&] {
        made.emplace(a, b, slot, passes);
        made->look(zero.first, zero.second);
    };
    counts.times.enclosure.add(bench::milliseconds(look, 1).median());
    const Between& between = *made;
    if (depth == 0) {
        counts.regular += between.regular ? 1 : 0;
        counts.tube += between.tube ? 1 : 0;
        counts.positive += between.positive ? 1 : 0;
    }
    if (between.positive || depth == 10) {
        return between.positive;
    }
    const auto half = middle(a, b, slot, load, counts.times);
    return half && prove(a, *half, slot, passes, {zero.first, false}, load, counts, depth + 1) &&
           prove(*half, b, slot, passes, {false, zero.second}, load, counts, depth + 1);
}

/// The coordinates at the end of an arc, from its witness.
bool move_to_end(Packing& packing, const ArcRecord& arc) {
    if (!arc.certificate || arc.certificate->verdict != Verdict::proved) {
        return false;
    }
    const ArcWitness& witness = arc.certificate->witness;
    const auto moves = [&](std::size_t k) {
        const std::size_t cell = packing.length_at(0);
        const std::size_t grain = k < cell ? k / packing.axes() : packing.radius.size() + k - cell;
        return witness.whole || std::ranges::find(witness.grains, static_cast<int>(grain)) != witness.grains.end();
    };
    const DofMap dofs(packing);
    std::size_t next = 0;
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (dofs.dof_of(k) >= 0 && moves(k)) {
            packing.q[k] = witness.end[next++];
        }
    }
    return next == witness.end.size();
}

/// False: an arc has no certificate, so that later vertices are not known.
bool count(const State& start, const bench::Stretch& stretch, int passes, Counts& counts) {
    Times unused;
    Packing at = start.packing;
    std::vector<Contact> contacts = start.contacts;
    std::unique_ptr<Point> before;
    for (const ArcRecord& arc : stretch.arcs) {
        const auto slot = static_cast<std::size_t>(std::ranges::find(contacts, arc.opened) - contacts.begin());
        Load load = start.load;
        load.set_loaded_stress(arc.stress);
        const Vector force = arc.kind == ArcKind::rattler ? load.infinitesimal : load.external_force(at);
        before = point(at, contacts, force, unused);
        contacts.at(slot) = arc.closed;
        if (!before || !move_to_end(at, arc)) {
            return false;
        }
        const auto end = point(at, contacts, force, unused);
        if (!end) {
            return false;
        }
        ++counts.arcs;
        counts.in_the_end +=
            prove(*before, *end, slot, passes, {arc.kind == ArcKind::limit, arc.power_turn}, force, counts, 0) ? 1 : 0;
    }
    return true;
}

} // namespace

int main(int argc, char** argv) {
    std::vector<std::string> sources{"400", "1936"};
    int equilibria = 20, passes = 0;
    bench::Program program("bench_power_sign", "the sign of the power along an arc from its two ends");
    program.option("--equilibria", equilibria, "equilibria of each run");
    program.option("--passes", passes, "passes for the quadratic correction (0: 1 and 3)");
    program.words("starts", sources, "numbers of disks or state files");
    program.parse(argc, argv);
    bench::Table table("power_sign", "Power proved positive along arcs (A9), estimates without rounding:",
                       {{"n", "n", ""},
                        {"arcs", "arcs", ""},
                        {"passes", "passes", ""},
                        {"regular", "inverse bounded all along", "", "{:.3f}"},
                        {"tube", "tube", "", "{:.3f}"},
                        {"positive", "positive", "", "{:.3f}"},
                        {"end", "positive with centres", "", "{:.3f}"},
                        {"centres", "centres / arc", "", "{:.2f}"},
                        {"enclosure", "enclosure between two points, ms", "ms", "{:.2f}"},
                        {"centre", "a point between, ms", "ms", "{:.2f}"},
                        {"bound", "a bound of the inverse, ms", "ms", "{:.2f}"},
                        {"decisions", "an arc at level decisions, ms", "ms", "{:.2f}"},
                        {"more", "all together / an arc", "", "{:.2f}"}});
    bool good = true;
    for (const std::string& source : sources) {
        const auto start = bench::start(source);
        if (!start) {
            good = false;
            continue;
        }
        bench::StretchOptions options{.equilibria = equilibria};
        const double price = bench::run_stretch(*start, options).milliseconds_per_arc;
        options.level = CertifyLevel::arcs;
        const bench::Stretch stretch = bench::run_stretch(*start, options);
        for (const int tried : passes > 0 ? std::vector<int>{passes} : std::vector<int>{1, 3}) {
            Counts counts;
            good = count(*start, stretch, tried, counts) && good;
            const auto share = [&](long part) {
                return static_cast<double>(part) / static_cast<double>(std::max(counts.arcs, 1L));
            };
            const Times& t = counts.times;
            const double centres = share(t.bounds);
            const double more =
                (centres * (t.bound.median() + t.centre.median()) + (1 + 2 * centres) * t.enclosure.median()) / price;
            table.add({static_cast<long>(start->packing.disk_count()), counts.arcs, static_cast<long>(tried),
                       share(counts.regular), share(counts.tube), share(counts.positive), share(counts.in_the_end),
                       share(counts.times.bounds), counts.times.enclosure.median(), counts.times.centre.median(),
                       counts.times.bound.median(), price, more});
        }
    }
    program.show(table);
    return program.finish(good);
}
