#include "checker/follow.hpp"

#include "checker/at_wall.hpp"
#include "checker/images.hpp"
#include "checker/newton.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>

namespace isostat::checker {

namespace {

/// Distance between the centres of a pair.
double distance(const Packing& packing, const std::vector<double>& q, const Contact& c) {
    const Layout layout = packing.layout();
    PerAxis<double> d{};
    for (std::size_t a = 0; a < layout.axes(); ++a) {
        d[a] = q[layout.of_disk(c.i) + a] - q[layout.of_disk(c.j) + a];
        if (!c.image.is_here()) {
            Row(c, layout).separate(q, a, d[a]);
        }
    }
    return std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
}

/// The gap of a pair.
double gap_at(const Packing& packing, const std::vector<double>& q, const Contact& c) {
    const auto i = static_cast<std::size_t>(c.i);
    const auto j = static_cast<std::size_t>(c.j);
    const auto& r = packing.radius;
    if (c.of_disks()) {
        return distance(packing, q, c) - r[i] - r[j];
    }
    return AtWall(c, packing.layout()).distance_in(q) - r[i];
}

/// A gap changes by at most this factor times the fastest coordinate for each of the two grains: above sqrt d.
double per_coordinate(const Packing& packing) {
    // 1.5: choice: reach of the list of the look; 1.75: choice: the same of spheres, above the root of 3
    return packing.dimension == plane ? 1.5 : 1.75;
}

/// The pairs within `reach` among all images of disks; empty: there are too many images.
std::optional<std::vector<Contact>> near_pairs_in_cell(const Packing& packing, const std::vector<double>& q,
                                                       double reach) {
    const CellImages images(packing, q);
    const double widest = 2 * packing.max_radius();
    const auto range = images.range(widest + 6 * reach); // choice: reach of the list of the look
    if (!images.usable() || !range) {
        return {};
    }
    const auto margin = [&](int spread) { return per_coordinate(packing) * reach * spread; };
    const double farthest = widest + margin(2 + images.periods(*range));
    std::vector<Placed> places = images.near_cell(*range, farthest);
    std::sort(places.begin(), places.end(), [](const Placed& a, const Placed& b) { return a.at[0] < b.at[0]; });
    std::set<Contact> pairs; // one of each
    for (std::size_t p = 0; p < places.size(); ++p) {
        for (std::size_t k = p + 1; k < places.size() && places[k].at[0] - places[p].at[0] < farthest; ++k) {
            if ((!places[p].central && !places[k].central) || std::abs(places[k].at[1] - places[p].at[1]) >= farthest ||
                std::abs(places[k].at[2] - places[p].at[2]) >= farthest) {
                continue;
            }
            const Contact pair = pair_between(places[p], places[k]);
            const Row row(pair, packing.layout());
            if (gap_at(packing, q, pair) < margin(row.spread())) {
                pairs.insert(pair);
            }
        }
    }
    return std::vector<Contact>(pairs.begin(), pairs.end());
}

/// Pairs of grains that may touch before a coordinate has moved by `reach`; nothing: there are too many images.
std::optional<std::vector<Contact>> near_pairs(const Packing& packing, const std::vector<double>& q, double reach) {
    const bool cell = packing.cell.any();
    std::vector<Contact> pairs;
    if (cell) {
        auto in_cell = near_pairs_in_cell(packing, q, reach);
        if (!in_cell) {
            return {};
        }
        pairs = std::move(*in_cell);
    }
    const auto n = packing.radius.size();
    const std::size_t axes = packing.axes();
    const auto fixed = [&](std::size_t i) { return !packing.fixed.empty() && packing.fixed[i] != 0; };
    const double margin = 2 * per_coordinate(packing) * reach;
    const double widest = 2 * packing.max_radius() + margin;
    std::vector<Placed> places;
    for (std::size_t i = 0; i < n && !cell; ++i) {
        std::copy_n(&q[axes * i], axes, places.emplace_back(Placed{static_cast<int>(i)}).at.begin());
    }
    for_each_near(
        places, widest, [widest] { return widest; },
        [&](const Placed& one, const Placed& two) {
            const Contact pair = pair_of(one.disk, two.disk);
            const bool both = fixed(static_cast<std::size_t>(one.disk)) && fixed(static_cast<std::size_t>(two.disk));
            if (gap_at(packing, q, pair) < margin && !both) {
                pairs.push_back(pair);
            }
        });
    for (std::size_t i = 0; i < n; ++i) {
        for_each_wall(packing, static_cast<int>(i), [&](const Contact& wall) {
            if (!fixed(i) && gap_at(packing, q, wall) < margin) {
                pairs.push_back(wall);
            }
        });
    }
    return pairs;
}

/// The result of a step: nothing, the end of the motion at a part of the step, or another event.
struct Met {
    bool lost = false; ///< the motion could not be computed
    std::optional<double> end;
    std::string wrong;
};

/// The walk along the motion on which all contacts but one stay closed.
class Walk {
  public:
    Walk(const State& from, const Motion& motion)
        : from_(from), motion_(motion), turns_(motion.closed.kind == ContactKind::held),
          tolerance_(1e-9 * from.packing.min_radius()), // 1e-9: choice: gaps and power that are looked at
          // 0.2: choice: reach of the pairs looked at; 4: cost: reach of the pairs looked at, in displacements
          reach_(std::min(0.2 * from.packing.min_radius(), 4 * motion.displacement)), body_(bodies_of(from.packing)),
          kept_(from.packing, from.contacts, motion.solver), q_(from.packing.q) {}

    Followed to_the_end() {
        if (!kept_.square() || !(motion_.displacement >= 0) || !std::isfinite(motion_.displacement)) {
            return {};
        }
        if (Followed there = arrive_at_once(); there.end || motion_.displacement == 0) {
            return there;
        }
        if (Followed there = arrive_on_parabola(); there.end) {
            return there;
        }
        // 1.75: choice: first step of the look (the end lies within the second step); 3.5: choice: first step of the
        // look (the end lies within the fourth step)
        const double parts = motion_.doublings > 0 ? 3.5 : 1.75;
        double longest = std::min(motion_.displacement / parts, motion_.step * from_.packing.min_radius());
        // 8: cost: steps of the look; 16: cost: steps of the look, and how much shorter near its end; 1e5: cost: steps
        // of the look
        auto steps = static_cast<long>(std::min(8 * motion_.displacement / longest + 16, 1e5)) + motion_.doublings;
        double step = std::ldexp(longest, -motion_.doublings);
        int zooms = 0;
        int halvings = 0;
        std::vector<double> next;
        for (long k = 0; k < steps; ++k) {
            if (!move(step, next)) { // the curve may bend too much for this step
                if (halvings++ == most_halvings) {
                    return {};
                }
                longest = step /= 2;
                steps = k + 2 * (steps - k);
                continue;
            }
            if (!list_pairs(next)) {
                return {};
            }
            const Met met = turns_ ? turn(next) : closing(next, k == 0);
            if (met.lost || !met.wrong.empty()) {
                return {{}, met.wrong};
            }
            if (met.end && zooms < motion_.zooms) { // two ends may be near each other
                ++zooms;
                longest = step /= 16;
                continue;
            }
            if (met.end) {
                return nearer(arrive(next, *met.end));
            }
            if (!turns_ && (passes(next) || dips(next))) {
                if (Followed there = arrive_slowly(); there.end) {
                    return there;
                }
            }
            if (std::string wrong = closed_before(next); !wrong.empty()) {
                return {{}, std::move(wrong)};
            }
            std::swap(q_, next);
            step = std::min(2 * step, longest);
        }
        return {};
    }

  private:
    // 1e-6: choice: of the recorded displacement: what an end that is taken at once is off by
    static constexpr double same = 1e-6;
    static constexpr double near = 1e-2; ///< choice: of the recorded displacement: an end there may be the right one
    static constexpr int most_halvings = 10; // cost: how often a step of the look is halved

    /// For an arc so short that gaps along it cannot be told from 0, so that there are no steps.
    [[nodiscard]] Followed arrive_at_once() const {
        Followed there = motion_.displacement <= tolerance_ ? arrive(q_, 0) : Followed();
        return there.end && displacement(*there.end) <= tolerance_ ? there : Followed();
    }

    /// For an arc no longer than a step: its end from the parabola that has the first two derivatives of the curve,
    /// where the power is seen to be positive at the start, nothing has closed in the middle, and the end is as far
    /// away as recorded.
    [[nodiscard]] Followed arrive_on_parabola() {
        constexpr int enough = 24; // guess: bits of the velocity for the parabola
        const bool leaves =
            motion_.closed == from_.contacts[motion_.opened] ||
            std::find(motion_.touching.begin(), motion_.touching.end(), motion_.closed) != motion_.touching.end();
        const double length = motion_.displacement; // of the parameter: that is the fastest coordinate
        if (turns_ || leaves || motion_.doublings > 0 || length > motion_.step * from_.packing.min_radius()) {
            return {};
        }
        const std::optional<System::Way> way = aim(enough);
        if (!way || !powered_) {
            return {};
        }
        const Eigen::VectorXd bend = length * kept_.bend(velocity_, *way);
        Followed there = arrive(from_here(length * (velocity_ + bend)), 1);
        if (!there.end || std::abs(displacement(*there.end) - length) > same * length) {
            return {};
        }
        const std::vector<double> middle = from_here(length / 2 * (velocity_ + bend / 2));
        const bool on_the_way = power(middle, velocity_ + bend) > 0 && kept_.value(middle, motion_.closed) > 0;
        return on_the_way && list_pairs(middle) && closed_before(middle).empty() ? there : Followed();
    }

    [[nodiscard]] std::vector<double> from_here(const Eigen::VectorXd& by) const {
        std::vector<double> q = q_;
        for (std::size_t d = 0; d < kept_.size(); ++d) {
            q[kept_.coordinate(d)] += by(static_cast<Eigen::Index>(d));
        }
        return q;
    }

    /// Finds the velocity, and the power. Contact `opened` opens in the first step; later the motion continues in the
    /// same direction. Which coordinate is the fastest; nothing: the motion could not be computed.
    std::optional<System::Way> aim(int bits) {
        if (!kept_.motion(q_, motion_.opened, opening_, bits)) {
            return {};
        }
        Eigen::Index fastest = 0;
        Eigen::VectorXd v = motion_.direction * opening_ / opening_.cwiseAbs().maxCoeff(&fastest);
        if (velocity_.size() > 0 && v.dot(velocity_) < 0) {
            v = -v;
        }
        velocity_ = v;
        power_size_ = {};
        power_ = power(q_, velocity_, &power_size_);
        powered_ = powered_ || power_ > 1e-9 * power_size_.terms;
        return System::Way{motion_.opened, fastest};
    }

    /// The next point.
    bool move(double step, std::vector<double>& next) {
        // choice: when the look's Newton has converged
        constexpr double between = 0x1p-40; // accuracy of the points between the ends
        constexpr int most = 46;            // bits of the velocity; choice: rounding of the velocity of a step
        const std::optional<System::Way> way = aim(most);
        if (!way) {
            return false;
        }
        next = from_here(step * velocity_);
        std::vector<double> guess = next;
        if (kept_.newton(next, way, between)) {
            return true;
        }
        next = std::move(guess); // the contacts are nearly singular there
        return kept_.newton_in_quadruple(next, way);
    }

    struct PowerSize {
        double terms = 0; ///< sum of the absolute values
        double load = 0;  ///< the largest component
    };
    /// Power of the load for a velocity.
    [[nodiscard]] double power(const std::vector<double>& q, const Eigen::VectorXd& v,
                               PowerSize* size = nullptr) const {
        const std::vector<double> load = motion_.power_load(q);
        double sum = 0;
        for (std::size_t d = 0; d < kept_.size(); ++d) {
            const double part = load[kept_.coordinate(d)] * v(static_cast<Eigen::Index>(d));
            sum += part;
            if (size != nullptr) {
                size->terms += std::abs(part);
                size->load = std::max(size->load, std::abs(load[kept_.coordinate(d)]));
            }
        }
        return sum;
    }

    /// Makes the list of near pairs anew when a coordinate has moved far enough. False: this is impossible.
    bool list_pairs(const std::vector<double>& next) {
        double moved = listed_at_.empty() ? reach_ : 0;
        for (std::size_t c = 0; c < listed_at_.size(); ++c) {
            moved = std::max(moved, std::abs(next[c] - listed_at_[c]));
        }
        if (moved >= reach_) {
            auto pairs = near_pairs(from_.packing, q_, 2 * reach_);
            if (!pairs) {
                return false;
            }
            std::erase_if(*pairs, [this](const Contact& pair) { return are_members(body_, pair); });
            pairs_ = std::move(*pairs);
            listed_at_ = q_;
        }
        return true;
    }

    /// Whether the power of the load changes sign before `next`.
    Met turn(const std::vector<double>& next) {
        if (!kept_.motion(next, motion_.opened, opening_)) {
            return {true, {}, {}};
        }
        const Eigen::VectorXd ahead = opening_.dot(velocity_) < 0 ? Eigen::VectorXd(-opening_) : opening_;
        if (!powered_ || power(next, ahead) > 0) {
            return {};
        }
        const auto c = static_cast<std::size_t>(motion_.closed.i);
        const double way = next[c] - q_[c];
        // The turn is within this step, or next to it within the rounding of the power.
        const double room = std::abs(way) + tolerance_;
        if (motion_.held_at < std::min(q_[c], next[c]) - room || motion_.held_at > std::max(q_[c], next[c]) + room) {
            return {false,
                    {},
                    fmt::format("the power of the load turns near {}, but {} is held at {}", q_[c],
                                name(motion_.closed), motion_.held_at)};
        }
        return {false, std::clamp(way != 0 ? (motion_.held_at - q_[c]) / way : 0, 0.0, 1.0), {}};
    }

    /// Whether the contact closes before `next`.
    [[nodiscard]] Met closing(const std::vector<double>& next, bool first) const {
        // 0x1p-50: choice: power that is looked at; 1e-6: choice: power that is looked at
        constexpr double rounding = 0x1p-50; // of a velocity, whose largest component is 1
        if (powered_ && power_ < -1e-6 * power_size_.terms && power_ < -rounding * power_size_.load) {
            return {false, {}, fmt::format("the power of the load vanishes before {} closes", name(motion_.closed))};
        }
        const double before = kept_.value(q_, motion_.closed);
        const double after = kept_.value(next, motion_.closed);
        // The opened contact itself, or one that touched from the start, must have opened before.
        const bool from_start = first && (motion_.closed == from_.contacts[motion_.opened] ||
                                          std::find(motion_.touching.begin(), motion_.touching.end(), motion_.closed) !=
                                              motion_.touching.end());
        if (after > 0 || from_start) {
            return {};
        }
        return {false, before > 0 ? before / (before - after) : 1, {}};
    }

    /// Chooses of two ends near each other the one whose displacement agrees with the record.
    [[nodiscard]] Followed nearer(Followed there) const {
        const auto off = [this](const Followed& end) {
            return end.end ? std::abs(displacement(*end.end) - motion_.displacement)
                           : std::numeric_limits<double>::infinity();
        };
        if (off(there) <= same * motion_.displacement) {
            return there;
        }
        Followed other = arrive_slowly();
        return off(other) < off(there) ? other : there;
    }

    /// Whether the recorded displacement is reached for the first time, because a grazing gap is 0 nowhere.
    bool passes(const std::vector<double>& next) {
        const bool first = !passed_ && displacement(next) >= motion_.displacement;
        passed_ = passed_ || first;
        return first;
    }

    /// Whether the gap grows again near the recorded displacement: it may have been 0 within the last steps.
    bool dips(const std::vector<double>& next) {
        const double before = kept_.value(q_, motion_.closed);
        const double after = kept_.value(next, motion_.closed);
        const bool fell = std::exchange(falls_, after < before);
        return fell && after >= before && displacement(next) >= (1 - near) * motion_.displacement;
    }

    /// Another pair that overlaps at `next`, as a message; empty: no pair does.
    [[nodiscard]] std::string closed_before(const std::vector<double>& next) const {
        const auto kept = [&](const Contact& pair) {
            return pair != from_.contacts[motion_.opened] &&
                   std::find(from_.contacts.begin(), from_.contacts.end(), pair) != from_.contacts.end();
        };
        for (const Contact& pair : pairs_) {
            if (pair != motion_.closed && gap_at(from_.packing, next, pair) < -tolerance_ && !kept(pair)) {
                return fmt::format("{} close before {}", name(pair), name(motion_.closed));
            }
        }
        return {};
    }

    /// The vertex of the contacts at the end, near a point of the last step.
    [[nodiscard]] Followed arrive(const std::vector<double>& next, double part) const {
        std::vector<double> q = q_;
        for (std::size_t i = 0; i < q.size(); ++i) {
            q[i] += part * (next[i] - q[i]);
        }
        return end_near(std::move(q), [](System& end, std::vector<double>& at) {
            // cost: a longer last step is refined in quadruple precision
            constexpr double rounding = 0x1p-44; // the vertex that is proved is found from there
            // cost: where rounding is enlarged more, the end is refined in quadruple precision
            constexpr double singular = 0x1p18; // roundings that grow more may end too far from it for its proof
            const std::optional<double> step = end.newton(at, {}, 0x1p-46); // cost: accuracy of the end in double
            std::vector<double> better = at;
            const bool rough = step && (*step > rounding || !(end.spread() < singular));
            if (rough && end.newton_in_quadruple(better)) {
                at = std::move(better);
            }
            return step.has_value();
        });
    }

    /// Arrives where the contacts are nearly singular, from the start of the last step, at the first of two places.
    [[nodiscard]] Followed arrive_slowly() const {
        return end_near(q_, [this](System& end, std::vector<double>& at) {
            return end.newton_in_quadruple(at) &&
                   std::abs(displacement(at) - motion_.displacement) <= near * motion_.displacement;
        });
    }

    template <class Newton> [[nodiscard]] Followed end_near(std::vector<double> q, const Newton& newton) const {
        std::vector<Contact> contacts = from_.contacts;
        contacts[motion_.opened] = motion_.closed;
        System end(from_.packing, contacts, {}, kept_.solver());
        if (turns_) {
            end.hold(motion_.closed, motion_.held_at);
        }
        if (!newton(end, q)) {
            return {};
        }
        for (const Contact& contact : contacts) { // a held coordinate keeps its value without rounding
            if (contact.kind == ContactKind::held) {
                q[static_cast<std::size_t>(contact.i)] = end.held_value(contact);
            }
        }
        return {q, {}, end.solver()};
    }

    [[nodiscard]] double displacement(const std::vector<double>& q) const {
        double moved = 0;
        for (std::size_t c = 0; c < q.size(); ++c) {
            moved = std::max(moved, std::abs(q[c] - from_.packing.q[c]));
        }
        return moved;
    }

    [[nodiscard]] std::string name(const Contact& contact) const { return to_string(contact, from_.packing.dimension); }

    const State& from_;
    const Motion& motion_;
    bool turns_;
    bool passed_ = false; ///< the recorded displacement was reached
    bool falls_ = false;  ///< the closing gap falls
    double tolerance_;    ///< for gaps, which are not proved here
    double reach_;
    std::vector<int> body_; ///< of each disk
    System kept_;
    std::vector<double> q_;
    std::vector<double> listed_at_; ///< coordinates at which pairs_ was made
    std::vector<Contact> pairs_;
    Eigen::VectorXd opening_;  ///< the motion on which the gap alone grows
    Eigen::VectorXd velocity_; ///< of the last step
    bool powered_ = false;     ///< the power was positive
    double power_ = 0;
    PowerSize power_size_;
};

} // namespace

Followed follow(const State& from, const Motion& motion) {
    return Walk(from, motion).to_the_end();
}

} // namespace isostat::checker
