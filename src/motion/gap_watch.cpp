#include "motion/gap_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;
constexpr double up = 1 + 1e-9;
constexpr double root2 = 1.4142135623731;
constexpr int max_depth = 60;

} // namespace

/// Relative position of the two grains of a candidate along p(s), and what the tube adds to it.
template <int Dim> struct GapWatch<Dim>::Motion {
    Motion(const CurvePiece<Dim>& piece, const Contact& contact) {
        const Packing<Dim>& at = piece.centre();
        const auto i = static_cast<std::size_t>(contact.i);
        const auto j = static_cast<std::size_t>(contact.j);
        const std::size_t disks = at.radius.size();
        wall = contact.kind != ContactKind::disk_disk;
        components = wall ? 1 : Dim;
        target = wall ? at.radius[i] : at.radius[i] + at.radius[j];
        const auto difference = [&](const std::vector<double>& x) {
            std::array<double, Dim> d{};
            if (contact.kind == ContactKind::lower_wall) {
                d[0] = x[Dim * i + j];
            } else if (contact.kind == ContactKind::upper_wall) {
                d[0] = x[Dim * disks + j] - x[Dim * i + j];
            } else {
                for (std::size_t c = 0; c < Dim; ++c) {
                    d[c] = x[Dim * j + c] - x[Dim * i + c];
                }
            }
            return d;
        };
        a.push_back(difference(at.q));
        for (const auto& coefficient : piece.coefficients()) {
            a.push_back(difference(coefficient));
        }
        for (const auto& d : a) {
            double square = 0;
            for (const double c : d) {
                square += c * c;
            }
            size.push_back(std::sqrt(square) * up);
        }
        apart = root2 * (piece.radius() + piece.curve().rest_radius) * up;
        slope_error = root2 * piece.slope_error() * up;
    }

    /// What is known for s in [from, to].
    struct View {
        double gap_low = 0;  ///< gap > gap_low
        double gap = 0;      ///< at the middle
        double gap_open = 0; ///< error of the gap at the middle
        double rate = 0;     ///< (relative position).(its derivative) at the middle (walls: the derivative)
        double rate_open = 0;
        double rate_spread = 0; ///< how much it may change within the stretch
    };
    View view(double from, double to) const {
        const double s = 0.5 * (from + to);
        const double half = std::max(to - s, s - from) * (1 + 4 * u);
        const double h = std::max(std::abs(from), std::abs(to));
        std::array<double, Dim> x{};
        std::array<double, Dim> v{};
        double first = 0;  // largest |x'|
        double second = 0; // largest |x''|
        double terms = 0;  // sum of the absolute values in x
        double power = 1;  // h^(k-2)
        for (std::size_t k = a.size(); k-- > 0;) {
            for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
                x[c] = x[c] * s + a[k][c];
                v[c] = k > 0 ? v[c] * s + static_cast<double>(k) * a[k][c] : v[c];
            }
        }
        for (std::size_t k = 1; k < a.size(); ++k) {
            const auto order = static_cast<double>(k);
            if (k >= 2) {
                second += order * (order - 1) * power * size[k];
                power *= h;
            }
            const double slope_power = k >= 2 ? power : 1;
            first += order * slope_power * size[k];
            terms += slope_power * h * size[k];
        }
        first *= up;
        second *= up;
        terms = (terms + size[0]) * up;
        const double rounding = (2 * static_cast<double>(a.size()) + 24) * u * (terms + target);
        const double slope_rounding = (2 * static_cast<double>(a.size()) + 8) * u * first;
        View view;
        if (wall) {
            view.gap = x[0] - target;
            view.gap_open = (apart + rounding) * up;
            const double lost = (half * std::abs(v[0]) + 0.5 * half * half * second) * up;
            view.gap_low = view.gap - view.gap_open - lost - u * std::abs(view.gap);
            view.rate = v[0];
            view.rate_open = (slope_error + slope_rounding) * up;
            view.rate_spread = half * second * up;
            return view;
        }
        double square = 0;
        double product = 0;
        for (std::size_t c = 0; c < Dim; ++c) {
            square += x[c] * x[c];
            product += x[c] * v[c];
        }
        const double distance = std::sqrt(square);
        view.gap = distance - target;
        view.gap_open = (apart + rounding) * up;
        // A distance is at least its projection on the line of centres in the middle of the stretch.
        const double projected = std::abs(product) / distance + slope_rounding;
        const double lost = (half * projected + 0.5 * half * half * second) * up;
        view.gap_low = view.gap - view.gap_open - lost - u * std::abs(view.gap);
        const double farthest = distance + half * first + rounding;
        view.rate = product;
        view.rate_open = (apart * first + slope_error * (farthest + apart) + rounding * first +
                          slope_rounding * farthest + 8 * u * distance * first) *
                         up;
        view.rate_spread = half * (first * first + farthest * second) * up;
        return view;
    }

    bool wall = false;
    int components = Dim;
    double target = 0;
    std::vector<std::array<double, Dim>> a; ///< position, then coefficients
    std::vector<double> size;
    double apart = 0;       ///< how far the true relative position is from that of p
    double slope_error = 0; ///< the same for its derivative
};

template <int Dim>
bool GapWatch<Dim>::walk(const Motion& motion, double from, double to, int depth, GapTrend& last, bool& only_falls) {
    ++tests_;
    const auto view = motion.view(from, to);
    if (view.gap_low > 0) {
        last = GapTrend::above;
        only_falls = false;
        margin_ = std::min(margin_, view.gap / view.gap_open);
        return true;
    }
    if (std::abs(view.rate) > view.rate_open + view.rate_spread) {
        const bool rises = view.rate > 0;
        if (rises && last == GapTrend::falling && !(motion.view(from, from).gap_low > 0)) {
            where_ = from;
            return false; // it may have passed through 0 where the two meet
        }
        if (!rises && last == GapTrend::zero) {
            where_ = from;
            return false; // it does not open
        }
        margin_ = std::min(margin_, std::abs(view.rate) / view.rate_open);
        only_falls = only_falls && !rises;
        last = rises ? GapTrend::rising : GapTrend::falling;
        return true;
    }
    const double middle = 0.5 * (from + to);
    if (depth >= max_depth || !(middle > from && middle < to) || std::abs(view.rate) < view.rate_open) {
        // No stretch around the middle can be settled unless the gap itself is clear there.
        if (depth >= max_depth || !(view.gap > view.gap_open) || !(middle > from && middle < to)) {
            where_ = middle;
            return false;
        }
    }
    return walk(motion, from, middle, depth + 1, last, only_falls) &&
           walk(motion, middle, to, depth + 1, last, only_falls);
}

template <int Dim>
bool GapWatch<Dim>::look(const CurvePiece<Dim>& piece, const Contact& contact, double from, double to) {
    const Motion motion(piece, contact);
    const auto found = last_.find(contact);
    GapTrend last = found == last_.end() ? GapTrend::above : found->second;
    bool only_falls = true;
    if (!walk(motion, from, to, 0, last, only_falls)) {
        return false;
    }
    if (only_falls) {
        fell_.insert(contact);
    } else {
        fell_.erase(contact);
    }
    if (last != GapTrend::above) {
        last_[contact] = last;
    } else if (found != last_.end()) {
        last_.erase(found);
    }
    return true;
}

template <int Dim> int GapWatch<Dim>::rate_sign(const CurvePiece<Dim>& piece, const Contact& contact, double s) {
    const auto view = Motion(piece, contact).view(s, s);
    return view.rate > view.rate_open ? 1 : -view.rate > view.rate_open ? -1 : 0;
}

template class GapWatch<2>;

} // namespace isostat
