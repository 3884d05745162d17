#include "checker/gap_course.hpp"

#include "checker/index.hpp"

#include <fmt/format.h>

#include <array>
#include <numeric>

namespace isostat::checker {

namespace {

constexpr int deepest = 55;

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

/// Relative position of the two grains of a pair along p(s), and how far the curve may be from it.
struct GapCourses::Motion {
    Motion(const Tube& tube, const Moving& moving, const Contact& pair)
        : wall(pair.kind != ContactKind::disk_disk), target(moving.state.packing.radius[at(pair.i)]) {
        const std::size_t disks = moving.state.packing.radius.size();
        const auto i = at(pair.i);
        const auto j = at(pair.j);
        if (!wall) {
            target = target + moving.state.packing.radius[j];
        }
        const auto add = [&](const std::vector<double>& q) {
            if (pair.kind == ContactKind::disk_disk) {
                x[0].push_back(Bounds(q[2 * j]) - q[2 * i]);
                x[1].push_back(Bounds(q[2 * j + 1]) - q[2 * i + 1]);
            } else {
                x[0].push_back(pair.kind == ContactKind::lower_wall ? Bounds(q[2 * i + j])
                                                                    : Bounds(q[2 * disks + j]) - q[2 * i + j]);
            }
        };
        add(tube.centre());
        for (const auto& a : tube.coefficients()) {
            add(a);
        }
        apart = product_above(root_of_two, sum_above(tube.radius(), product_above(2, moving.rest)));
        rate_apart = product_above(root_of_two, tube.slope_error());
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
    std::array<std::vector<Bounds>, 2> x;
    double apart = 0;
    double rate_apart = 0;
};

GapCourses::GapCourses(const Moving& moving, const std::vector<Contact>& contacts, const Contact& opened,
                       std::optional<std::vector<Contact>> watched)
    : moving_(moving), kept_(contacts.begin(), contacts.end()), watched_(std::move(watched)) {
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
            return false; // it may have passed through 0 where the two meet
        }
        last = Course::rising;
        return true;
    }
    if (view.rate.negative()) {
        if (last == Course::zero) {
            return false; // it does not open
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
        trouble_ = fmt::format("the gap of {} is not proved positive", to_string<2>(pair));
        return false;
    }
    if (last) {
        last_[pair] = *last;
    } else {
        last_.erase(pair);
    }
    return true;
}

/// Pairs that may come to touch while s stays within h of the centre: all others keep away from each other by K19.
std::vector<Contact> GapCourses::near(const Tube& tube, double h) const {
    const Packing<2>& packing = moving_.state.packing;
    const std::size_t disks = packing.radius.size();
    const std::vector<double>& q = tube.centre();
    const auto way_of = [&](std::size_t k) { // of the curve, along one coordinate
        double sum = 0;
        for (std::size_t order = tube.coefficients().size(); order > 0; --order) {
            sum = product_above(sum_above(sum, std::abs(tube.coefficients()[order - 1][k])), h);
        }
        return sum_above(sum, moving_.moves[k] ? tube.radius() : moving_.loose[k] ? moving_.rest : 0);
    };
    std::vector<double> way(disks + 1);
    for (std::size_t g = 0; g <= disks; ++g) {
        way[g] = sum_above(way_of(2 * g), way_of(2 * g + 1));
    }
    const double most = *std::max_element(way.begin(), way.end());
    constexpr double more = 1 + 1e-12; // the roundings of a difference and of four sums
    std::vector<std::size_t> order(disks);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return q[2 * a] < q[2 * b]; });
    const double widest = 2 * (packing.max_radius() + most) * more;
    std::vector<Contact> pairs;
    const auto add = [&](const Contact& pair) {
        if (!kept_.contains(pair)) {
            pairs.push_back(pair);
        }
    };
    for (std::size_t p = 0; p < disks; ++p) {
        const std::size_t i = order[p];
        for (std::size_t k = p + 1; k < disks && q[2 * order[k]] - q[2 * i] <= widest; ++k) {
            const std::size_t j = order[k];
            const double near = (packing.radius[i] + packing.radius[j] + way[i] + way[j]) * more;
            if ((moving_.moves[2 * i] || moving_.moves[2 * j]) && std::abs(q[2 * i] - q[2 * j]) <= near &&
                std::abs(q[2 * i + 1] - q[2 * j + 1]) <= near) {
                add({ContactKind::disk_disk, static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))});
            }
        }
        for (std::size_t a = 0; a < 2; ++a) {
            const double near = (packing.radius[i] + way[i] + way[disks]) * more;
            const bool moves = moving_.moves[2 * i + a];
            if (packing.walls.lower[a] != WallKind::absent && moves && q[2 * i + a] <= near) {
                add({ContactKind::lower_wall, static_cast<int>(i), static_cast<int>(a)});
            }
            if (packing.walls.upper[a] != WallKind::absent && (moves || moving_.moves[2 * disks + a]) &&
                q[2 * disks + a] - q[2 * i + a] <= near) {
                add({ContactKind::upper_wall, static_cast<int>(i), static_cast<int>(a)});
            }
        }
    }
    return pairs;
}

bool GapCourses::look(const Tube& tube, double from, double to) {
    const std::vector<Contact> pairs = watched_ ? *watched_ : near(tube, std::max(std::abs(from), std::abs(to)));
    // What was seen falling and is not near any more stays where a look at it would put it.
    for (const Contact& pair : pairs) {
        if (!look(tube, pair, from, to)) {
            return false;
        }
    }
    std::erase_if(last_,
                  [&](const auto& entry) { return std::find(pairs.begin(), pairs.end(), entry.first) == pairs.end(); });
    return true;
}

} // namespace isostat::checker
