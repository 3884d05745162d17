#include "checker/at_wall.hpp"
#include "checker/courses.hpp"
#include "checker/images.hpp"
#include "checker/index.hpp"

#include <fmt/format.h>

#include <array>
#include <numeric>

namespace isostat::checker {

namespace {

constexpr int deepest = 55; // cost: halvings of a stretch

/// Horner's rule for the derivative of order 0, 1 or 2.
Bounds value_of(const std::vector<Bounds>& c, const Bounds& s, int derivative) {
    Bounds sum(0);
    for (std::size_t k = c.size(); k-- > at(derivative);) {
        double factor = 1;
        for (int d = 0; d < derivative; ++d) {
            factor *= static_cast<double>(k) - d;
        }
        sum = sum * s + c[k] * factor;
    }
    return sum;
}

} // namespace

/// Relative position of the two grains of a pair along p(s), and bounds of its distance from the curve.
struct GapCourses::Motion {
    Motion(const Tube& tube, const Moving& moving, const Contact& pair)
        : wall(!pair.of_disks()), target(moving.state.packing.radius[at(pair.i)]),
          x(wall ? 1 : moving.state.packing.axes()) {
        const Layout layout = moving.state.packing.layout();
        if (!wall) {
            target = target + moving.state.packing.radius[at(pair.j)];
        }
        const auto add = [&](const std::vector<double>& q) {
            const Separation<Bounds> d = difference(q, pair, layout);
            for (std::size_t a = 0; a < (wall ? 1 : d.axes); ++a) {
                x[a].push_back(d[a]);
            }
        };
        add(tube.centre());
        for (const auto& a : tube.coefficients()) {
            add(a);
        }
        const double m = period_weight(pair); // |D x|^2 <= (2 + |m|^2) |x|^2
        const double weight = pair.image.is_here() ? root_of_two : root_above(sum_above(2, product_above(m, m)));
        apart = product_above(weight, sum_above(tube.radius(), product_above(2, moving.rest)));
        apart = pair.image.is_here() ? apart : sum_above(apart, moving.off_rest(pair));
        rate_apart = product_above(weight, tube.slope_error());
    }

    struct View {
        Bounds gap;  ///< has the sign of the gap everywhere on the stretch
        Bounds rate; ///< of its rate
    };
    [[nodiscard]] View view(double from, double to) const {
        const Bounds s(from, to);
        const Bounds middle(s.middle());
        const Bounds off = s - middle;
        if (wall) {
            const Bounds v = value_of(x[0], s, 1);
            const Bounds gap = value_of(x[0], middle, 0) + v * off - target;
            return {gap + Bounds::around(apart), v + Bounds::around(rate_apart)};
        }
        Bounds square(0);
        Bounds square_slope(0);
        Bounds rate(0);
        Bounds rate_slope(0);
        Bounds speed(0);
        for (const auto& c : x) {
            const Bounds here = value_of(c, middle, 0);
            const Bounds there = value_of(c, s, 0);
            const Bounds v_here = value_of(c, middle, 1);
            const Bounds v = value_of(c, s, 1);
            square = square + here * here;
            square_slope = square_slope + there * v;
            rate = rate + here * v_here;
            rate_slope = rate_slope + v * v + there * value_of(c, s, 2);
            speed = speed + Bounds(v.size()) * v.size();
        }
        square = square + square_slope * off * 2;
        rate = rate + rate_slope * off;
        const double length = root_above(std::max(square.size(), 0.0));
        const double fast = root_above(speed.upper);
        const double square_open = product_above(apart, sum_above(product_above(2, length), apart));
        const double rate_open =
            sum_above(product_above(apart, sum_above(fast, rate_apart)), product_above(rate_apart, length));
        return {square - target * target + Bounds::around(square_open), rate + Bounds::around(rate_open)};
    }

    bool wall;
    Bounds target;
    std::vector<std::vector<Bounds>> x; ///< of each axis; of a wall the one
    double apart = 0;
    double rate_apart = 0;
};

GapCourses::GapCourses(const Moving& moving, const std::vector<Contact>& contacts, const Contact& opened,
                       std::optional<std::vector<Contact>> watched)
    : moving_(moving), kept_(contacts.begin(), contacts.end()), body_(bodies_of(moving.state.packing)),
      watched_(std::move(watched)) {
    kept_.erase(opened);
    if (opened.kind != ContactKind::held) {
        last_[opened] = Course::zero;
    }
}

bool GapCourses::falls(const Contact& pair) const {
    const auto found = last_.find(pair);
    return found != last_.end() && found->second == Course::falling;
}

bool GapCourses::walk(const Motion& motion, double from, double to, int depth, std::optional<Course>& last) {
    const auto view = motion.view(from, to);
    if (view.gap.positive()) {
        last.reset();
        return true;
    }
    if (view.rate.positive()) {
        if (last == Course::falling && !motion.view(from, from).gap.positive()) {
            return false; // the gap may have passed through 0 where the two meet
        }
        last = Course::rising;
        return true;
    }
    if (view.rate.negative()) {
        if (last == Course::zero) {
            return false; // the contact does not open
        }
        last = Course::falling;
        return true;
    }
    const double middle = from + (to - from) / 2;
    if (depth >= deepest || !(middle > from && middle < to)) {
        return false;
    }
    return walk(motion, from, middle, depth + 1, last) && walk(motion, middle, to, depth + 1, last);
}

bool GapCourses::look(const Tube& tube, const Contact& pair, double from, double to) {
    const auto found = last_.find(pair);
    std::optional<Course> last = found == last_.end() ? std::nullopt : std::optional(found->second);
    if (!walk(Motion(tube, moving_, pair), from, to, 0, last)) {
        trouble_ =
            fmt::format("the gap of {} is not proved positive", to_string(pair, moving_.state.packing.dimension));
        return false;
    }
    if (last) {
        last_[pair] = *last;
    } else {
        last_.erase(pair);
    }
    return true;
}

namespace {

double largest_entry(const std::vector<double>& x) {
    double most = 0;
    for (const double c : x) {
        most = std::max(most, std::abs(c));
    }
    return most;
}

// checker.md K19 (roundings of what is near)
constexpr double more = 1 + 1e-12; // for the roundings of a difference and of four sums

/// Extent of the centres.
double extent(const std::vector<double>& q, const Layout& layout) {
    PerAxis<double> low{};
    std::copy_n(q.begin(), layout.dimension, low.begin());
    PerAxis<double> high = low;
    for (std::size_t k = 0; k < layout.of_length(0); ++k) {
        const std::size_t a = k % layout.axes();
        low[a] = std::min(low[a], q[k]);
        high[a] = std::max(high[a], q[k]);
    }
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) * more;
}

/// Lower bound of the singular values of the periodic part of A: its determinant over the product of the other two,
/// which is at most half of the sum of all squares; for two periods the determinant over the root of that sum.
double least_stretch(const Packing& packing, const std::vector<double>& q) {
    double determinant = 1;
    double squares = 0;
    for (std::size_t b = 0; b < packing.axes(); ++b) {
        for (std::size_t a = 0; a <= b; ++a) {
            if (packing.cell.periodic[a] && packing.cell.periodic[b]) {
                const double entry = q[a == b ? packing.length_at(a) : packing.tilt_at(a, b)];
                determinant *= a == b ? entry : 1;
                squares += entry * entry;
            }
        }
    }
    switch (packing.cell.periodic_axes()) {
    case 1: return determinant;
    case 2: return determinant / std::sqrt(squares);
    default: return 2 * determinant / squares;
    }
}

} // namespace

/// Bounds of the displacements of the disks, then of walls or cell, for s within h of the centre.
std::vector<double> GapCourses::ways(const Tube& tube, double h) const {
    const std::size_t disks = moving_.state.packing.radius.size();
    const auto way_of = [&](std::size_t k) { // of the curve, along one coordinate
        double sum = 0;
        for (std::size_t order = tube.coefficients().size(); order > 0; --order) {
            sum = product_above(sum_above(sum, std::abs(tube.coefficients()[order - 1][k])), h);
        }
        return sum_above(sum, moving_.moves[k] ? tube.radius() : moving_.loose[k] ? moving_.rest : 0);
    };
    std::vector<double> way(disks + 1);
    const Packing& packing = moving_.state.packing;
    for (std::size_t g = 0; g <= disks; ++g) {
        const std::size_t first = packing.axes() * g;
        const std::size_t tilts = g == disks && packing.cell.any() ? packing.tilts() : 0;
        for (std::size_t k = 0; k < packing.axes() + tilts; ++k) {
            way[g] = k == 0 ? way_of(first) : sum_above(way[g], way_of(first + k));
        }
    }
    return way;
}

/// Pairs of disks that may touch within these displacements: all other pairs stay apart by K19.
std::optional<std::vector<Contact>> GapCourses::near_disks(const Tube& tube, const std::vector<double>& way) const {
    const Packing& packing = moving_.state.packing;
    const std::size_t disks = packing.radius.size();
    const std::size_t axes = packing.axes();
    const std::vector<double>& q = tube.centre();
    const double most = *std::max_element(way.begin(), way.end());
    const double widest = 2 * (packing.max_radius() + most) * more;
    std::vector<std::size_t> order(disks);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return q[axes * a] < q[axes * b]; });
    std::vector<Contact> pairs;
    for (std::size_t p = 0; p < disks; ++p) {
        const std::size_t i = order[p];
        for (std::size_t k = p + 1; k < disks && q[axes * order[k]] - q[axes * i] <= widest; ++k) {
            const std::size_t j = order[k];
            const double near = (packing.radius[i] + packing.radius[j] + way[i] + way[j]) * more;
            const Contact pair = pair_of(static_cast<int>(i), static_cast<int>(j));
            if (!moving_.disk_moves(pair.i) && !moving_.disk_moves(pair.j)) {
                continue;
            }
            bool apart = false;
            for (std::size_t a = 0; a < axes; ++a) {
                apart = apart || std::abs(q[axes * i + a] - q[axes * j + a]) > near;
            }
            if (!apart) {
                pairs.push_back(pair);
            }
        }
    }
    return pairs;
}

/// The near pairs in a cell, for all images; empty: there are too many.
std::optional<std::vector<Contact>> GapCourses::near_images(const Tube& tube, const std::vector<double>& way) const {
    const Packing& packing = moving_.state.packing;
    const std::vector<double>& q = tube.centre();
    const std::size_t disks = packing.radius.size();
    const double strain = way[disks] / least_stretch(packing, q) * more; // |dA| over the smallest singular value of A
    const CellImages images(packing, q);
    const double shift = strain * extent(q, packing.layout());
    const auto reach = [&](std::size_t i, std::size_t j) {
        return (packing.radius[i] + packing.radius[j] + way[i] + way[j] + shift) / (1 - strain) * more;
    };
    const double most = *std::max_element(way.begin(), way.end() - 1);
    const double farthest = (2 * (packing.max_radius() + most) + shift) / (1 - strain) * more;
    const auto range = images.range(2 * farthest);
    if (!(strain < 0.5) || !images.usable() || !range) { // cost: strain of the cell along a piece (checker.md K19)
        return std::nullopt;
    }
    // checker.md K19 (roundings of the places of images)
    const double slack = 0x1p-48 * (1 + images.periods(*range)) * largest_entry(q);
    std::vector<Placed> places = images.near_cell(*range, farthest + slack);
    std::sort(places.begin(), places.end(), [](const Placed& a, const Placed& b) { return a.at[0] < b.at[0]; });
    std::set<Contact> pairs; // one of each
    for (std::size_t p = 0; p < places.size(); ++p) {
        const Placed& one = places[p];
        for (std::size_t k = p + 1; k < places.size() && places[k].at[0] - one.at[0] <= farthest + slack; ++k) {
            const Placed& two = places[k];
            const double near = reach(at(one.disk), at(two.disk)) + slack;
            if ((one.central || two.central) && two.at[0] - one.at[0] <= near &&
                std::abs(two.at[1] - one.at[1]) <= near && std::abs(two.at[2] - one.at[2]) <= near) {
                if (const Contact pair = pair_between(one, two); moving_.takes_part(pair)) {
                    pairs.insert(pair);
                }
            }
        }
    }
    return std::vector<Contact>(pairs.begin(), pairs.end());
}

/// Pairs of a disk and a wall that may touch.
std::vector<Contact> GapCourses::near_walls(const Tube& tube, const std::vector<double>& way) const {
    const Packing& packing = moving_.state.packing;
    const std::size_t disks = packing.radius.size();
    const std::vector<double>& q = tube.centre();
    std::vector<Contact> pairs;
    for (std::size_t i = 0; i < disks; ++i) {
        const double near = (packing.radius[i] + way[i] + way[disks]) * more;
        for_each_wall(packing, static_cast<int>(i), [&](const Contact& wall) {
            if (moving_.takes_part(wall) && AtWall(wall, packing.layout()).distance_in(q) <= near) {
                pairs.push_back(wall);
            }
        });
    }
    return pairs;
}

bool GapCourses::look(const Tube& tube, double from, double to) {
    std::optional<std::vector<Contact>> pairs = watched_;
    if (!pairs) {
        const std::vector<double> way = ways(tube, std::max(std::abs(from), std::abs(to)));
        pairs = moving_.state.packing.cell.any() ? near_images(tube, way) : near_disks(tube, way);
        if (!pairs) {
            trouble_ = "there are too many images to look at";
            return false;
        }
        const std::vector<Contact> walls = near_walls(tube, way);
        pairs->insert(pairs->end(), walls.begin(), walls.end());
        std::erase_if(*pairs, [this](const Contact& pair) { return kept_.contains(pair) || are_members(body_, pair); });
    }
    // Tests every near pair; notes on pairs that are no longer near are dropped below.
    for (const Contact& pair : *pairs) {
        if (!look(tube, pair, from, to)) {
            return false;
        }
    }
    std::erase_if(
        last_, [&](const auto& entry) { return std::find(pairs->begin(), pairs->end(), entry.first) == pairs->end(); });
    return true;
}

} // namespace isostat::checker
