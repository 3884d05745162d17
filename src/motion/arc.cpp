#include "core/dot.hpp"
#include "motion/acceleration.hpp"
#include "motion/geometry.hpp"

#include <isostat/contact/contact_set.hpp>
#include <isostat/motion/arc.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>

namespace isostat {

namespace {

/// Relative accuracy of tangents: they only predict, choose the fastest coordinate and place dips and power turns; no
/// sign rests on them.
constexpr double tangent_accuracy = 1e-7;
constexpr double turn_tangent_accuracy = 1e-15; ///< at a power turn, which is located no better than its tangent
constexpr double end_tangent_accuracy = 1e-4;   ///< at an event, where only dips and the sign of the power are read off

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Smallest positive root of h + h1 s + h2 s^2 / 2, h >= 0; infinity when there is none.
double first_root(double h, double h1, double h2) {
    const double a = 0.5 * h2;
    const double discriminant = h1 * h1 - 4 * a * h;
    if (discriminant < 0) {
        return infinity;
    }
    if (h1 < 0) {
        return 2 * h / (-h1 + std::sqrt(discriminant));
    }
    return a < 0 ? (h1 + std::sqrt(discriminant)) / (-2 * a) : infinity;
}

/// Where the cubic with end values h0, h1 and end slopes d0 < 0 < d1 on [0, s] is smallest, and its value there.
struct Dip {
    double position = 0;
    double value = 0;
};
Dip lowest_point(double h0, double d0, double h1, double d1, double s) {
    const double c3 = (d0 + d1) * s - 2 * (h1 - h0);
    const double c2 = 3 * (h1 - h0) - (2 * d0 + d1) * s;
    const double c1 = d0 * s;
    // c1 + 2 c2 x + 3 c3 x^2 changes sign once on [0, 1]: bisection.
    double low = 0;
    double high = 1;
    for (int k = 0; k < 40; ++k) {
        const double x = 0.5 * (low + high);
        (c1 + x * (2 * c2 + 3 * c3 * x) < 0 ? low : high) = x;
    }
    return {low * s, h0 + low * (c1 + low * (c2 + low * c3))};
}

/// Displacement from `at` that the candidates still allow.
template <int Dim> double reach_left(const CandidateList<Dim>& candidates, const Packing<Dim>& at) {
    if (candidates.reference.size() != at.q.size()) {
        return -1;
    }
    const double unit = 1 / candidates.reach; // squares neither under- nor overflow, whatever the units are
    double moved = 0;
    for (std::size_t k = 0; k + Dim <= at.q.size(); k += Dim) {
        double square = 0;
        for (std::size_t a = 0; a < Dim; ++a) {
            const double d = unit * (at.q[k + a] - candidates.reference[k + a]);
            square += d * d;
        }
        moved = std::max(moved, square);
    }
    return candidates.reach * (0.5 - std::sqrt(moved));
}

template <int Dim> class Follower {
  public:
    Follower(const Packing<Dim>& start, const IsostaticStructure<Dim>& structure, const Factorisation& factorisation,
             ContactId opened, int direction, const PowerLoad<Dim>& power, CandidateList<Dim>& candidates,
             const ArcOptions& options, std::vector<Contact> open = {})
        : structure_(&structure), factorisation_(&factorisation), slot_(opened.index()),
          opened_(structure.contacts()[opened.index()]), power_(power), candidates_(candidates), options_(options),
          start_(start), q_(start), size_(static_cast<std::size_t>(structure.size())), rhs_(size_),
          y_(start.q.size(), 0.0), active_(std::move(open)) {
        if (!active_.empty()) {
            complete_candidates();
        }
        step_limit_ = options.step_fraction * start.min_radius();
        fresh_slot_mechanism();
        tangent_ = mechanism_;
        for (double& c : tangent_) {
            c *= -direction;
        }
    }

    /// Tangent, curvature and the first event that they predict, at the start.
    void begin();
    /// \pre begin()
    [[nodiscard]] std::optional<typename ArcDeparture<Dim>::Expected> expected() const {
        if (!predicted_ || !(s_event_ <= step_limit_)) {
            return std::nullopt;
        }
        return typename ArcDeparture<Dim>::Expected{active_[event_], predicted(s_event_)};
    }
    /// \pre begin()
    Result<Arc<Dim>> run();

  private:
    using Vector = std::vector<double>;

    /// From q_ and its tangent; false: `failure_` says why.
    bool predict();

    /// Velocity (on coordinates) with unit approach velocity in the slot and none in the kept contacts.
    void fresh_slot_mechanism() {
        mechanism_.assign(y_.size(), 0.0);
        to_coordinates(factorisation_->approximate().mechanism(static_cast<int>(slot_)), mechanism_);
    }

    void to_coordinates(const Vector& on_dofs, Vector& on_coordinates) const {
        const DofMap<Dim>& dofs = structure_->dofs();
        for (std::size_t mu = 0; mu < size_; ++mu) {
            on_coordinates[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] = on_dofs[mu];
        }
    }

    /// y_ = (velocity on coordinates with about the approach velocities of rhs_): one pass.
    void solve() {
        ++passes_;
        factorisation_->approximate().velocities(rhs_);
        to_coordinates(rhs_, y_);
    }

    /// One chord step: y_ such that kept gaps change by minus `kept` (given as approach) and row . y_ = target.
    template <class Kept, class Row> void chord(Kept kept, Row row, double target) {
        const auto& contacts = structure_->contacts();
        for (std::size_t l = 0; l < size_; ++l) {
            rhs_[l] = l == slot_ ? 0.0 : kept(contacts[l]);
        }
        finish_chord(row, target);
    }

    /// From the approach velocities rhs_ of the kept contacts.
    template <class Row> void finish_chord(Row row, double target) {
        solve();
        const double scale = (target - row(y_)) / row(mechanism_);
        for (std::size_t k = 0; k < y_.size(); ++k) {
            y_[k] += scale * mechanism_[k];
        }
    }

    void choose_fastest() {
        fastest_ = 0;
        for (std::size_t k = 0; k < tangent_.size(); ++k) {
            if (std::abs(tangent_[k]) > std::abs(tangent_[fastest_])) {
                fastest_ = k;
            }
        }
        const double scale = 1 / std::abs(tangent_[fastest_]);
        for (double& c : tangent_) {
            c *= scale;
        }
    }

    /// Newton-like iteration with the chord matrix: kept gaps = 0 and `row`.y = target(at). Stops at rounding.
    template <class Row, class Target> bool converge(Packing<Dim>& at, Row row, Target target) {
        const Packing<Dim> guess = at;
        if (iterate(at, row, target, true)) {
            return true;
        }
        at = guess; // acceleration may have taken rounding for a direction
        return iterate(at, row, target, false);
    }
    template <class Row, class Target> bool iterate(Packing<Dim>& at, Row row, Target target, bool accelerated) {
        const double rounding = 2 * grid_step(at);
        double previous = infinity;
        double rate = infinity;
        last_iterations_ = 0;
        acceleration_.clear();
        for (int k = 0; k < 60; ++k) {
            chord([&](const Contact& c) { return quick_gap(at, c); }, [&](const Vector& v) { return row(at, v); },
                  target(at));
            const double size = largest(y_);
            if (!(size < infinity)) {
                return false;
            }
            // About linear convergence: the next change is this one times the worse of the last two ratios.
            const double ratio = size / previous;
            const bool last = size <= rounding || (k > 1 && size * std::max(ratio, rate) <= 0.1 * rounding);
            rate = ratio;
            if (accelerated && size > rounding) { // the last change too: the ratios are those of accelerated ones
                acceleration_.improve(y_);
            }
            for (std::size_t i = 0; i < y_.size(); ++i) {
                at.q[i] += y_[i];
            }
            ++last_iterations_;
            if (last) {
                return true;
            }
            // What no longer shrinks is rounding noise, or the factors are stale; factors taken over shrink it slowly.
            if (k > 3 && size > (factorisation_->is_fresh() ? 0.5 : 0.9) * previous) {
                return size <= (accelerated ? 64 * rounding : 1e-9 * at.min_radius());
            }
            previous = size;
        }
        return false;
    }

    bool converge_to_coordinate(Packing<Dim>& at) {
        return converge(
            at, [&](const Packing<Dim>&, const Vector& v) { return v[fastest_]; },
            [](const Packing<Dim>&) { return 0.0; });
    }

    bool converge_to_event(Packing<Dim>& at, const Contact& closing) {
        const bool ok = converge(
            at, [&](const Packing<Dim>& p, const Vector& v) { return gap_rate(p, closing, v); },
            [&](const Packing<Dim>& p) { return -quick_gap(p, closing); });
        if (ok) {
            snap_to_grid(at);
        }
        return ok;
    }

    /// rhs_ = rates of the kept gaps along v at a point of the curve.
    void gap_rates(const Packing<Dim>& at, const Vector& v) {
        const auto& contacts = structure_->contacts();
        if (&at == &q_ && !moved_ && !own_structure_) { // minus the approach velocities G v, whose G is at hand
            const sparse::Matrix<double>& h = structure_->matrix();
            const DofMap<Dim>& dofs = structure_->dofs();
            Vector on_dofs(size_);
            for (std::size_t mu = 0; mu < size_; ++mu) {
                on_dofs[mu] = v[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))];
            }
            for (std::size_t l = 0; l < size_; ++l) {
                double rate = 0;
                for (auto e = static_cast<std::size_t>(h.start[l]); e < static_cast<std::size_t>(h.start[l + 1]); ++e) {
                    rate -= h.value[e] * on_dofs[static_cast<std::size_t>(h.row[e])];
                }
                rhs_[l] = rate;
            }
        } else {
            for (std::size_t l = 0; l < size_; ++l) {
                rhs_[l] = gap_rate(at, contacts[l], v);
            }
        }
        rhs_[slot_] = 0;
    }

    /// Tangent at another point of the curve, scaled like `tangent_` in the fastest coordinate.
    std::optional<Vector> tangent_at(const Packing<Dim>& at, double accuracy) {
        Vector t = tangent_;
        double previous = infinity;
        for (int k = 0; k < 40; ++k) {
            gap_rates(at, t);
            finish_chord([&](const Vector& v) { return v[fastest_]; }, 0.0);
            const double size = largest(y_);
            for (std::size_t i = 0; i < t.size(); ++i) {
                t[i] += y_[i];
            }
            if (!(size < previous)) {
                break;
            }
            // Linear convergence: what is left is about size^2 / previous.
            if (size < accuracy * largest(t) || (k > 0 && size * size < 0.1 * accuracy * largest(t) * previous)) {
                return t;
            }
            previous = size;
        }
        return previous < 1e-4 * largest(t) ? std::optional<Vector>(t) : std::nullopt;
    }

    /// The same after a step of length s, from the way it went: the third derivative is what the predictor missed.
    Vector extrapolated_tangent(const Packing<Dim>& at, double s) const {
        const double third = s > 1e-5 * step_limit_ ? 3 / s : 0.0; // else rounding
        Vector t(tangent_.size());
        for (std::size_t k = 0; k < t.size(); ++k) {
            const double missed = at.q[k] - (q_.q[k] + s * (tangent_[k] + 0.5 * s * curvature_[k]));
            t[k] = tangent_[k] + s * curvature_[k] + third * missed;
        }
        return t;
    }

    double power_of(const Packing<Dim>& at, const Vector& t) const {
        const Vector force = power_.infinitesimal ? power_.load->infinitesimal : power_.load->external_force(at);
        double sum = 0;
        for (std::size_t k = 0; k < force.size(); ++k) {
            sum += force[k] * t[k];
        }
        return sum;
    }

    /// DF v: true stresses act on lengths, linear in q in two dimensions. Empty when the load is dead.
    Vector change_of_load(const Vector& v) const {
        static_assert(Dim == 2);
        if (power_.infinitesimal || power_.load->kind == LoadKind::nominal) {
            return {};
        }
        Packing<Dim> there = q_;
        for (std::size_t k = 0; k < there.q.size(); ++k) {
            there.q[k] += v[k];
        }
        Vector change = power_.load->external_force(there);
        const Vector here = power_.load->external_force(q_);
        std::transform(change.begin(), change.end(), here.begin(), change.begin(), std::minus<>());
        return change;
    }
    static double product(const Vector& maybe_empty, const Vector& v) {
        double sum = 0;
        for (std::size_t k = 0; k < maybe_empty.size(); ++k) {
            sum += maybe_empty[k] * v[k];
        }
        return sum;
    }

    /// First place inside a step of length s where the power seems to be negative although both ends are positive: the
    /// cubic with its value and its first two derivatives at q_, and its value at the end.
    std::optional<double> power_dip(double p_start, double p_end, double s) {
        const auto third = [&](const Contact& c) { // kept gaps: n . third derivative = -3 (t . curvature) / d
            if (c.kind != ContactKind::disk_disk) {
                return 0.0;
            }
            const auto i = static_cast<std::size_t>(Dim * c.i);
            const auto j = static_cast<std::size_t>(Dim * c.j);
            double product = 0;
            double square = 0;
            for (std::size_t a = 0; a < Dim; ++a) {
                const double d = q_.q[j + a] - q_.q[i + a];
                square += d * d;
                product += (tangent_[j + a] - tangent_[i + a]) * (curvature_[j + a] - curvature_[i + a]);
            }
            return 3 * product / std::sqrt(square);
        };
        // p = F.t; with c = dt/ds and e = dc/ds: p' = F.c + t.DF t, p'' = F.e + 2 c.DF t + t.DF c; dead loads: DF = 0
        const Vector turn = change_of_load(tangent_);
        const double p1 = s * (power_of(q_, curvature_) + product(turn, tangent_));
        // A pass for the fourth number only where the curved part, as the other three show it, could bring the power
        // near 0. Like the cubic itself this is an estimate, not a proof.
        const double rest = std::abs(p_end - p_start - p1);
        if (std::min(p_start, p_start + p1) > 2 * rest) {
            return std::nullopt;
        }
        chord(
            third, [&](const Vector& v) { return v[fastest_]; }, 0.0);
        const double p2 =
            0.5 * s * s *
            (power_of(q_, y_) + 2 * product(turn, curvature_) + product(change_of_load(curvature_), tangent_));
        const double p3 = p_end - p_start - p1 - p2;
        // What the cubic misses at x is x^3 (1 - x) times a fourth derivative / 24, taken to be as much as p3.
        constexpr int samples = 32;
        for (int k = 1; k < samples; ++k) {
            const double x = static_cast<double>(k) / samples;
            if (p_start + x * (p1 + x * (p2 + x * p3)) < x * x * x * (1 - x) * std::abs(p3)) {
                return x * s;
            }
        }
        return std::nullopt;
    }

    /// The factors of the start are stale: prove and factorise the structure that holds the fastest coordinate, here.
    std::optional<Failure> renew() {
        std::vector<Contact> contacts = structure_->contacts();
        contacts[slot_] = Contact{ContactKind::held, static_cast<int>(fastest_), 0};
        auto proved = IsostaticStructure<Dim>::prove(q_, std::move(contacts));
        if (!proved.ok()) {
            return proved.failure();
        }
        own_structure_.emplace(std::move(proved.value()));
        own_factorisation_.emplace(*own_structure_);
        structure_ = &*own_structure_;
        factorisation_ = &*own_factorisation_;
        ++factorisations_;
        fresh_slot_mechanism();
        const double sign = tangent_[fastest_] < 0 ? -1.0 : 1.0;
        const double scale = sign / mechanism_[fastest_];
        tangent_ = mechanism_;
        for (double& c : tangent_) {
            c *= scale;
        }
        return std::nullopt;
    }

    void list_candidates() {
        if (renew_candidates(candidates_, q_)) {
            active_.clear();
        }
        reach_left_ = reach_left(candidates_, q_);
        if (active_.empty()) {
            const ContactSet kept(structure_->contacts(), q_.disk_count());
            active_.reserve(candidates_.contacts.size());
            std::copy_if(candidates_.contacts.begin(), candidates_.contacts.end(), std::back_inserter(active_),
                         [&](const Contact& c) { return !kept.contains(c); });
            complete_candidates();
        }
    }
    /// Of the open ones, those that take part; with the one that opens, which may close again.
    void complete_candidates() {
        std::erase_if(active_, [&](const Contact& c) { return c == opened_ || listed(options_.resting, c); });
        if (opened_.kind != ContactKind::held) {
            active_.push_back(opened_);
        }
    }

    /// The other way round at the end of the arc.
    std::vector<Contact> open_at_end(const Contact& closed) {
        if (!options_.resting.empty() || active_.empty()) {
            return {};
        }
        if (opened_.kind != ContactKind::held) {
            active_.pop_back();
        }
        std::erase(active_, closed);
        if (opened_.kind != ContactKind::held && opened_ != closed) {
            active_.insert(std::lower_bound(active_.begin(), active_.end(), opened_), opened_);
        }
        return std::move(active_);
    }

    static bool listed(const std::vector<Contact>& list, const Contact& c) {
        return std::find(list.begin(), list.end(), c) != list.end();
    }
    /// Its gap is 0 at the start, and grows.
    [[nodiscard]] bool leaves(const Contact& c) const { return c == opened_ || listed(options_.leaving, c); }

    Arc<Dim> finish(Packing<Dim> end, ArcEnd kind, Contact closed, double power, Vector tangent) {
        Arc<Dim> arc;
        for (const Contact& contact : structure_->contacts()) {
            if (contact.kind == ContactKind::held && contact != opened_ && &contact != &structure_->contacts()[slot_]) {
                const auto k = static_cast<std::size_t>(contact.i);
                end.q[k] = start_.q[k]; // held means held, rounding apart
            }
        }
        for (std::size_t k = 0; k < end.q.size(); ++k) {
            arc.displacement = std::max(arc.displacement, std::abs(end.q[k] - start_.q[k]));
        }
        arc.end = std::move(end);
        arc.kind = kind;
        arc.closed = closed;
        arc.power = power;
        arc.tangent = std::move(tangent);
        arc.opening = std::move(opening_);
        arc.open = open_at_end(closed);
        arc.steps = steps_;
        arc.factorisations = factorisations_;
        arc.passes = passes_;
        return arc;
    }

    Packing<Dim> predicted(double s) const {
        Packing<Dim> at = q_;
        for (std::size_t k = 0; k < at.q.size(); ++k) {
            at.q[k] += s * (tangent_[k] + 0.5 * s * curvature_[k]);
        }
        return at;
    }

    /// Point of the curve at distance s of the fastest coordinate from q_, and the tangent there.
    struct Point {
        Packing<Dim> at;
        Vector tangent;
    };
    std::optional<Point> step_to(double s, double accuracy = tangent_accuracy) {
        Packing<Dim> at = predicted(s);
        const Packing<Dim> guess = at;
        if (!converge_to_coordinate(at)) {
            return std::nullopt;
        }
        double off = 0;
        for (std::size_t k = 0; k < at.q.size(); ++k) {
            off = std::max(off, std::abs(at.q[k] - guess.q[k]));
        }
        // A start known to its last bits only is put back on the curve first: that is no bend, however short the step.
        if (off > 0.2 * s + 1e-10 * at.min_radius()) {
            return std::nullopt; // another branch, or a curve too bent for this step
        }
        auto t = tangent_at(at, accuracy);
        if (!t || largest(*t) > 4) {
            return std::nullopt; // another coordinate became much faster: shorter steps re-choose it in time
        }
        return Point{std::move(at), std::move(*t)};
    }

    /// A candidate that dips to or below 0 inside a step of length s without being negative at its end.
    std::optional<double> suspicious_dip(const Packing<Dim>& at, const Vector& t, double s,
                                         const Contact& except) const {
        std::optional<double> where;
        for (std::size_t c = 0; c < active_.size(); ++c) {
            const double d0 = start_rate_[c];
            if (!(d0 < 0) || active_[c] == except) {
                continue;
            }
            const double d1 = gap_rate(at, active_[c], t);
            if (!(d1 > 0)) {
                continue;
            }
            const double h0 = start_gap_[c];
            const double h1 = quick_gap(at, active_[c]);
            // The cubic is above its control points, so that `depth` below is at most max - floor, and x^2 (1 - x)^2 is
            // at most 1/16: most candidates are far from what is called a dip.
            const double floor = std::min(std::min(h0, h1), std::min(h0 + d0 * s / 3, h1 - d1 * s / 3));
            if (floor > 0.1 * (std::max(h0, h1) - floor)) {
                continue;
            }
            const Dip dip = lowest_point(h0, d0, h1, d1, s);
            // The error of the cubic at x is x^2 (1 - x)^2 h/24 (x in units of the step); h is taken as 40 depths, far
            // above what a disk rolling through a step of a tenth of a radius has. It vanishes at the ends, where the
            // gap is known.
            const double depth = std::max(h0, h1) - dip.value;
            const double x = dip.position / s;
            if (dip.value <= 1.6 * depth * x * x * (1 - x) * (1 - x) && (!where || dip.position < *where)) {
                where = dip.position;
            }
        }
        return where;
    }

    /// Candidate that is below 0 at `at` and whose gap reached 0 first, with the estimate of where.
    std::optional<std::pair<std::size_t, double>> first_violation(const Packing<Dim>& at, double s,
                                                                  const Contact& except, double noise) const {
        std::optional<std::pair<std::size_t, double>> found;
        double moved = 0;
        for (std::size_t k = 0; k < at.q.size(); ++k) {
            moved = std::max(moved, std::abs(at.q[k] - q_.q[k]));
        }
        // A gap changes by no more than its grains, or a grain and a wall, move.
        const double within = 2.01 * std::sqrt(static_cast<double>(Dim)) * moved;
        for (std::size_t c = 0; c < active_.size(); ++c) {
            if (start_gap_[c] > within || active_[c] == except) {
                continue;
            }
            const double h = quick_gap(at, active_[c]);
            if (h < -noise) {
                const double bend = 2 * (h - start_gap_[c] - start_rate_[c] * s) / (s * s);
                const double root = std::min(first_root(start_gap_[c], start_rate_[c], bend), s);
                if (!found || root < found->second) {
                    found = {c, root};
                }
            }
        }
        return found;
    }

    /// With the tangent that the event needs: where a dip or the sign of the power is not clear from an extrapolation,
    /// it is solved for.
    std::optional<Point> tangent_at_event(Packing<Dim> at, double s, const Contact& closing) {
        if (options_.extrapolate_tangent) {
            Vector t = extrapolated_tangent(at, s);
            const double p_start = power_of(q_, tangent_);
            if (power_of(at, t) > 0.1 * std::abs(p_start) && !suspicious_dip(at, t, s, closing)) {
                return Point{std::move(at), std::move(t)};
            }
        }
        auto t = tangent_at(at, end_tangent_accuracy);
        return t ? std::optional(Point{std::move(at), std::move(*t)}) : std::nullopt;
    }

    Result<Arc<Dim>> power_turn(double s_low, double p_low, double s_high, double p_high);

    const IsostaticStructure<Dim>* structure_;
    const Factorisation* factorisation_;
    std::optional<IsostaticStructure<Dim>> own_structure_;
    std::optional<Factorisation> own_factorisation_;
    std::size_t slot_;
    Contact opened_;
    PowerLoad<Dim> power_;
    CandidateList<Dim>& candidates_;
    ArcOptions options_;
    const Packing<Dim>& start_;
    Packing<Dim> q_;
    std::size_t size_;
    Vector rhs_, y_, mechanism_, tangent_, curvature_;
    Vector opening_; ///< velocity at the start that opens the contact at unit rate
    std::size_t fastest_ = 0;
    std::optional<Failure> failure_;
    bool predicted_ = false; ///< what follows belongs to q_
    bool moved_ = false;     ///< q_ is no longer the start
    double s_event_ = 0;     ///< predicted distance of the first event
    std::size_t event_ = 0;  ///< and its candidate
    std::vector<Contact> active_;
    Vector start_gap_, start_rate_; ///< of the active candidates at q_
    Acceleration acceleration_;
    double reach_left_ = 0; ///< displacement that the candidates allow from q_
    double step_limit_ = 0;
    int last_iterations_ = 0;
    int steps_ = 0;
    int factorisations_ = 0;
    int passes_ = 0;
};

template <int Dim>
Result<Arc<Dim>> Follower<Dim>::power_turn(double s_low, double p_low, double s_high, double p_high) {
    // Illinois iteration on the power as a function of the fastest coordinate.
    std::optional<Point> best;
    double p_best = infinity;
    int side = 0;
    for (int k = 0; k < 60; ++k) {
        double s = (p_low * s_high - p_high * s_low) / (p_low - p_high);
        if (!(s > s_low && s < s_high)) {
            s = 0.5 * (s_low + s_high);
        }
        auto point = step_to(s, turn_tangent_accuracy);
        if (!point) {
            return Failure{FailureKind::not_converged, "the point where the power of the load vanishes was not found"};
        }
        const double p = power_of(point->at, point->tangent);
        if (std::abs(p) < std::abs(p_best)) {
            p_best = p;
            best = std::move(point);
        }
        if (p == 0 || s_high - s_low < 4 * grid_step(q_)) {
            break;
        }
        if (p > 0) {
            s_low = s;
            p_low = p;
            p_high *= side == 1 ? 0.5 : 1.0;
            side = 1;
        } else {
            s_high = s;
            p_high = p;
            p_low *= side == -1 ? 0.5 : 1.0;
            side = -1;
        }
    }
    tangent_ = best->tangent;
    choose_fastest();
    snap_to_grid(best->at);
    return finish(std::move(best->at), ArcEnd::power_turn, Contact{ContactKind::held, static_cast<int>(fastest_), 0},
                  p_best, std::move(best->tangent));
}

template <int Dim> void Follower<Dim>::begin() {
    if (!factorisation_->is_fresh()) { // the mechanism is that of a neighbouring matrix
        choose_fastest();
        if (auto t = tangent_at(q_, end_tangent_accuracy)) {
            tangent_ = std::move(*t);
        } else {
            failure_ = renew();
        }
    }
    if (!failure_) {
        opening_ = tangent_;
        const double rate = 1 / gap_rate(q_, opened_, opening_);
        for (double& c : opening_) {
            c *= rate;
        }
        predicted_ = predict();
    }
}

template <int Dim> bool Follower<Dim>::predict() {
    choose_fastest();
    if (!std::isfinite(tangent_[fastest_])) {
        failure_ = Failure{FailureKind::not_converged, "the mechanism is not finite"};
        return false;
    }
    list_candidates();
    chord([&](const Contact& c) { return quick_curvature(q_, c, tangent_); },
          [&](const Vector& v) { return v[fastest_]; }, 0.0);
    curvature_ = y_;
    start_gap_.resize(active_.size());
    start_rate_.resize(active_.size());
    s_event_ = infinity;
    event_ = 0;
    // Roots beyond the longest step are not asked for: |t| <= 1 in every coordinate, so that no second derivative of a
    // gap is larger than this.
    const double root_dim = std::sqrt(static_cast<double>(Dim));
    const double bend = 1.01 * (2 * root_dim * largest(curvature_) + 2 * Dim / q_.min_radius());
    const double curved = 0.5 * bend * step_limit_ * step_limit_;
    for (std::size_t c = 0; c < active_.size(); ++c) {
        const bool opening = !moved_ && leaves(active_[c]);
        if (const auto line = centre_line(q_, active_[c]); line && !opening) {
            start_gap_[c] = gap_of(q_, active_[c], *line);
            start_rate_[c] = rate_of(*line, active_[c], tangent_);
            if (start_gap_[c] + std::min(1.01 * start_rate_[c], 0.0) * step_limit_ > curved) {
                continue;
            }
        }
        const GapCourse course = gap_course(q_, active_[c], tangent_, curvature_);
        start_gap_[c] = opening ? 0.0 : course.value;
        start_rate_[c] = course.rate;
        double root = first_root(std::max(start_gap_[c], 0.0), start_rate_[c], course.bend);
        if (start_gap_[c] <= 0 && !(start_rate_[c] > 0)) {
            root = 0;
        }
        if (root < s_event_) {
            s_event_ = root;
            event_ = c;
        }
    }
    return true;
}

template <int Dim> Result<Arc<Dim>> Follower<Dim>::run() {
    const double noise = 16 * grid_step(start_);
    double shrink = 1;
    double forced_step = infinity; // a step cut at a dip
    double power_step = infinity;  // for the rest of an arc whose power comes near 0
    double p_start = power_.starts_at_zero ? 0.0 : infinity;
    const auto narrow = [&]() -> std::optional<Failure> {
        // Stale factors first, then shorter steps.
        if (last_iterations_ > 12 || shrink < 0.3) {
            if (auto failure = renew()) {
                return failure;
            }
        }
        shrink *= 0.25;
        return std::nullopt;
    };
    bool renewed_here = false;
    if (failure_) {
        return *failure_;
    }
    while (steps_ < options_.max_steps) {
        if (!predicted_ && !predict()) {
            return *failure_;
        }
        predicted_ = false;
        const bool at_start = !moved_;
        if (!(p_start < infinity)) {
            p_start = power_of(q_, tangent_);
        }
        double s_event = s_event_;
        std::size_t event = event_;
        // Displacements are at most sqrt(Dim) s, and the corrector adds a little.
        const double reach = 0.9 * reach_left_ / (1.3 * std::sqrt(static_cast<double>(Dim)));
        const double s_max = std::min({step_limit_ * shrink, reach, forced_step, power_step});
        ++steps_;
        bool accepted = false;

        bool try_event = s_event <= s_max;
        double s = s_max;
        std::optional<Point> point;
        if (!try_event) {
            point = step_to(s);
            if (!point) {
                if (shrink < 1e-9) {
                    return Failure{FailureKind::not_converged,
                                   "the path could not be followed: steps became too short"};
                }
                if (auto failure = narrow()) {
                    return *failure;
                }
                continue;
            }
            const Contact none{ContactKind::held, -1, 0};
            if (const auto violation = first_violation(point->at, s, none, noise)) {
                event = violation->first;
                s_event = violation->second;
                try_event = true;
            } else {
                accepted = true;
            }
        }
        if (try_event) {
            for (int attempt = 0; attempt < 40 && !accepted; ++attempt) {
                const Contact closing = active_[event];
                Packing<Dim> at = predicted(s_event);
                const double direction = tangent_[fastest_] < 0 ? -1.0 : 1.0;
                if (!converge_to_event(at, closing)) {
                    break;
                }
                const double reached = direction * (at.q[fastest_] - q_.q[fastest_]);
                if (!(reached >= -noise) || reached > 1.5 * std::max(s_max, s_event) + noise) {
                    break; // another root
                }
                if (at_start && leaves(closing) && reached < 0.25 * s_event) {
                    break; // the start itself: the gap that opens is zero there too
                }
                s = std::max(reached, 0.0);
                if (s > noise) {
                    if (const auto violation = first_violation(at, s, closing, noise)) {
                        event = violation->first;
                        s_event = violation->second;
                        continue;
                    }
                }
                point = tangent_at_event(std::move(at), s, closing);
                if (!point) {
                    break;
                }
                accepted = true;
            }
            if (!accepted) {
                // The direct solve failed: shorten the step, and renew the factors when that does not help.
                if (s_max < 1e-12 * step_limit_ || shrink < 1e-9) {
                    return Failure{FailureKind::not_converged, fmt::format("the event at contact {} was not reached",
                                                                           to_string<Dim>(active_[event]))};
                }
                if (!renewed_here) {
                    if (auto failure = renew()) {
                        return *failure;
                    }
                    renewed_here = true;
                } else {
                    shrink = std::min(shrink, s_event / step_limit_) * 0.25;
                }
                continue;
            }
        }
        const Contact closing = try_event ? active_[event] : Contact{ContactKind::held, -1, 0};
        if (s > noise) {
            if (const auto dip = suspicious_dip(point->at, point->tangent, s, closing)) {
                if (*dip < 1e-9 * step_limit_) {
                    return Failure{FailureKind::undecided,
                                   "a gap touches zero inside an arc and cannot be told from a contact"};
                }
                forced_step = std::max(*dip, 0.05 * s);
                continue;
            }
        }
        double p_end = power_of(point->at, point->tangent);
        // At a limit load the power grows from zero: over the first, possibly tiny, step its sign is left to the force
        // in the new contact.
        const bool judged = !(power_.starts_at_zero && at_start);
        if (judged && p_end < 0) { // it may only seem so: a turn at the very end of an arc is none
            if (auto t = tangent_at(point->at, turn_tangent_accuracy)) {
                point->tangent = std::move(*t);
                p_end = power_of(point->at, point->tangent);
            }
        }
        if (!judged && p_end < 0 && s > 1e-6 * step_limit_) {
            forced_step = 0.25 * s; // it may have grown and turned within the step
            continue;
        }
        if (p_end > 0 && s > 1e-6 * step_limit_) {
            if (const auto dip = power_dip(p_start, p_end, s)) {
                power_step = std::min(power_step, 0.5 * *dip);
                continue;
            }
        }
        if (judged && p_end < 0 && p_start > 0) {
            return power_turn(0.0, p_start, s, p_end);
        }
        if (try_event && options_.closes && *options_.closes != closing) {
            if (!converge_to_event(point->at, *options_.closes)) {
                return Failure{FailureKind::not_converged, fmt::format("the event at contact {} was not reached",
                                                                       to_string<Dim>(*options_.closes))};
            }
            return finish(std::move(point->at), ArcEnd::contact, *options_.closes, p_end, std::move(point->tangent));
        }
        if (try_event) {
            return finish(std::move(point->at), ArcEnd::contact, closing, p_end, std::move(point->tangent));
        }
        moved_ = true;
        q_ = std::move(point->at);
        tangent_ = std::move(point->tangent);
        p_start = p_end;
        forced_step = infinity;
        renewed_here = false;
        if (last_iterations_ > 10) {
            choose_fastest();
            if (auto failure = renew()) {
                return *failure;
            }
        }
        shrink = std::min(1.0, 2 * shrink);
        for (int a = 0; a < Dim; ++a) {
            if (std::abs(q_.length(a) / start_.length(a) - 1) > options_.max_length_change) {
                return Failure{FailureKind::unbounded,
                               fmt::format("the motion has no end: L along axis {} went from {} to {}", a,
                                           start_.length(a), q_.length(a))};
            }
        }
    }
    return Failure{FailureKind::unbounded, fmt::format("no new contact after {} predictor steps", steps_)};
}

} // namespace

template <int Dim> bool renew_candidates(CandidateList<Dim>& candidates, const Packing<Dim>& at) {
    if (reach_left(candidates, at) >= 0.25 * candidates.reach) {
        return false;
    }
    candidates = find_candidates(at, candidate_fraction, candidates.triangulation);
    return true;
}

template <int Dim> struct ArcDeparture<Dim>::Implementation {
    Follower<Dim> follower;
};

template <int Dim>
ArcDeparture<Dim>::ArcDeparture(const Packing<Dim>& start, const IsostaticStructure<Dim>& structure,
                                const Factorisation& factorisation, ContactId opened, int direction,
                                const PowerLoad<Dim>& power, CandidateList<Dim>& candidates, const ArcOptions& options,
                                std::vector<Contact> open)
    : implementation_(new Implementation{Follower<Dim>(start, structure, factorisation, opened, direction, power,
                                                       candidates, options, std::move(open))}) {
    implementation_->follower.begin();
}
template <int Dim> ArcDeparture<Dim>::ArcDeparture(ArcDeparture&&) noexcept = default;
template <int Dim> ArcDeparture<Dim>::~ArcDeparture() = default;

template <int Dim> std::optional<typename ArcDeparture<Dim>::Expected> ArcDeparture<Dim>::expected() const {
    return implementation_->follower.expected();
}

template <int Dim> Result<Arc<Dim>> ArcDeparture<Dim>::follow() {
    return implementation_->follower.run();
}

template <int Dim>
Result<Arc<Dim>> follow_arc(const Packing<Dim>& start, const IsostaticStructure<Dim>& structure,
                            const Factorisation& factorisation, ContactId opened, int direction,
                            const PowerLoad<Dim>& power, CandidateList<Dim>& candidates, const ArcOptions& options) {
    return ArcDeparture<Dim>(start, structure, factorisation, opened, direction, power, candidates, options).follow();
}

template bool renew_candidates<2>(CandidateList<2>&, const Packing<2>&);
template class ArcDeparture<2>;
template Result<Arc<2>> follow_arc<2>(const Packing<2>&, const IsostaticStructure<2>&, const Factorisation&, ContactId,
                                      int, const PowerLoad<2>&, CandidateList<2>&, const ArcOptions&);

} // namespace isostat
