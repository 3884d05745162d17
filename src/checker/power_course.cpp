#include "checker/at_wall.hpp"
#include "checker/courses.hpp"
#include "checker/index.hpp"

#include <utility>

namespace isostat::checker {

namespace {

constexpr int most_halvings = 30; // cost: halvings of a stretch

Bounds value_of(const std::vector<Bounds>& c, const Bounds& s) {
    Bounds sum(0);
    for (std::size_t k = c.size(); k-- > 0;) {
        sum = sum * s + c[k];
    }
    return sum;
}

std::vector<Bounds> slope_of(const std::vector<Bounds>& c) {
    std::vector<Bounds> slope;
    for (std::size_t k = 1; k < c.size(); ++k) {
        slope.push_back(c[k] * static_cast<double>(k));
    }
    return slope;
}

/// Whether a polynomial exceeds a number on [from, to].
bool exceeds(const std::vector<Bounds>& c, const std::vector<Bounds>& slope, double least, double from, double to,
             int depth) {
    const Bounds s(from, to);
    const Bounds middle(s.middle());
    if ((value_of(c, middle) + value_of(slope, s) * (s - middle)).lower > least) {
        return true;
    }
    const double half = middle.lower;
    if (depth >= most_halvings || !(half > from && half < to) || !(value_of(c, middle).upper > least)) {
        return false;
    }
    return exceeds(c, slope, least, from, half, depth + 1) && exceeds(c, slope, least, half, to, depth + 1);
}

/// Rows of A(m)^T times the multipliers, added to the force.
void add_rows(std::vector<Bounds>& force, const Moving& moving, const Tube& tube, const std::vector<double>& g) {
    const Layout layout = moving.state.packing.layout();
    const std::vector<double>& m = tube.centre();
    const Bounds weight(tube.weight());
    for (std::size_t l = 0; l < moving.kept.size(); ++l) {
        const Contact& c = moving.kept[l];
        const auto i = at(c.i);
        const auto j = at(c.j);
        if (c.kind == ContactKind::held) {
            force[i] = force[i] + weight * g[l];
        } else if (c.of_disks()) {
            const Separation<Bounds> d = difference(m, c, layout);
            for (std::size_t a = 0; a < d.axes; ++a) {
                const Bounds part = d[a] * g[l];
                if (i != j) {
                    force[layout.of_disk(c.i) + a] = force[layout.of_disk(c.i) + a] + part;
                    force[layout.of_disk(c.j) + a] = force[layout.of_disk(c.j) + a] - part;
                }
                for (std::size_t b = a; b < d.axes && !c.image.is_here(); ++b) {
                    Bounds& of_cell = force[a == b ? layout.of_length(a) : layout.of_tilt(a, b)];
                    of_cell = of_cell - part * static_cast<double>(c.image.m[b]);
                }
            }
        } else {
            const AtWall place(c, layout);
            const Bounds part = weight * g[l] * static_cast<double>(place.sign);
            force[place.disk] = force[place.disk] + part;
            if (place.wall) {
                force[*place.wall] = force[*place.wall] - part;
            }
        }
    }
    const auto row = at(tube.row());
    force[row] = force[row] + weight * g.back();
}

/// The terms g_l D_l(p - m) . D_l p' of contacts of two disks, as a polynomial, and their uncertainty from the tube.
class Bending {
  public:
    Bending(const Moving& moving, const Tube& tube, double h) : moving_(moving), tube_(tube), h_(h) {}

    void add(const Contact& c, double g, std::vector<Bounds>& power) {
        const auto& a = tube_.coefficients();
        const Layout layout = moving_.state.packing.layout();
        std::vector<Separation<Bounds>> d(a.size() + 1, Separation<Bounds>(layout.axes()));
        double way = 0;
        double rate = 0;
        for (std::size_t k = a.size(); k > 0; --k) {
            d[k] = difference(a[k - 1], c, layout);
            const double size = length_above(d[k]);
            way = product_above(sum_above(way, size), h_);
            rate = sum_above(product_above(rate, h_), product_above(size, static_cast<double>(k)));
        }
        power.resize(std::max(power.size(), 2 * d.size()), Bounds(0));
        for (std::size_t i = 1; i < d.size(); ++i) {
            for (std::size_t j = 1; j < d.size(); ++j) {
                power[i + j - 1] = power[i + j - 1] + product(d[i], d[j]) * (g * static_cast<double>(j));
            }
        }
        const double size = std::abs(g);
        const auto add_square = [size](double& sum, double x) {
            const double y = product_above(size, x);
            sum = sum_above(sum, product_above(y, y));
        };
        add_square(ways_, way);
        add_square(rates_, rate);
        largest_ = std::max(largest_, size);
        if (const double off = moving_.off_rest(c); off > 0) {
            const double fast = sum_above(rate, product_above(root_above(tube_.spread()), tube_.slope_error()));
            at_rest_ = sum_above(at_rest_, product_above(product_above(size, off), fast));
        }
    }
    [[nodiscard]] double open() const {
        const double spread = tube_.spread();
        const double linear = sum_above(product_above(root_above(ways_), tube_.slope_error()),
                                        product_above(root_above(rates_), tube_.radius()));
        const double both =
            product_above(product_above(largest_, spread), product_above(tube_.radius(), tube_.slope_error()));
        return sum_above(sum_above(product_above(root_above(spread), linear), both), at_rest_);
    }

  private:
    const Moving& moving_;
    const Tube& tube_;
    double h_;
    double ways_ = 0, rates_ = 0, largest_ = 0, at_rest_ = 0;
};

/// The area on which a true stress acts along the tube: the product of the lengths of all axes but one, as a
/// polynomial, and the distance of that of the curve from it.
class Face {
  public:
    Face(const Moving& moving, const Tube& tube, std::size_t axis, double h) : tube_(tube) {
        const Packing& packing = moving.state.packing;
        own_ = packing.length_at(axis);
        for (std::size_t b = 0; b < packing.axes(); ++b) {
            if (b == axis) {
                continue;
            }
            std::vector<Bounds> length{tube.centre()[packing.length_at(b)]};
            for (const auto& a : tube.coefficients()) {
                length.emplace_back(a[packing.length_at(b)]);
            }
            const double size = largest(length, h);
            const double off = sum_above(tube.radius(), moving.rest);
            apart_ = sum_above(product_above(apart_, sum_above(size, off)), product_above(size_, off));
            size_ = product_above(size_, size);
            area_ = product(area_, length);
        }
        centre_ = std::exchange(area_[0], Bounds(0));
        gain_ = sum_above(largest(area_, h), apart_);
    }
    [[nodiscard]] const Bounds& at_centre() const { return centre_; }
    /// Adds to the power minus the stress times the change of the area since the centre, times the rate of the own
    /// length; returns the uncertainty. `fast`: |q'|
    double add(double stress, double fast, std::vector<Bounds>& power) const {
        std::vector<Bounds> rate;
        for (const auto& a : tube_.coefficients()) {
            rate.push_back(Bounds(a[own_]) * -stress * static_cast<double>(rate.size() + 1));
        }
        const std::vector<Bounds> part = product(area_, rate);
        power.resize(std::max(power.size(), part.size()), Bounds(0));
        for (std::size_t k = 0; k < part.size(); ++k) {
            power[k] = power[k] + part[k];
        }
        return product_above(std::abs(stress),
                             sum_above(product_above(gain_, tube_.slope_error()), product_above(apart_, fast)));
    }

  private:
    /// |c(s)| for |s| <= h.
    static double largest(const std::vector<Bounds>& c, double h) {
        double sum = 0;
        for (std::size_t k = c.size(); k-- > 0;) {
            sum = sum_above(product_above(sum, h), c[k].size());
        }
        return sum;
    }
    static std::vector<Bounds> product(const std::vector<Bounds>& x, const std::vector<Bounds>& y) {
        std::vector<Bounds> result(x.size() + y.size() - 1, Bounds(0));
        for (std::size_t i = 0; i < x.size(); ++i) {
            for (std::size_t j = 0; j < y.size(); ++j) {
                result[i + j] = result[i + j] + x[i] * y[j];
            }
        }
        return result;
    }

    const Tube& tube_;
    std::size_t own_ = 0;
    std::vector<Bounds> area_{Bounds(1)}; ///< minus its value at the centre
    Bounds centre_;
    double size_ = 1;  ///< size of the product of the polynomials
    double apart_ = 0; ///< distance of the product of the true lengths from it
    double gain_ = 0;  ///< change of the true area since the centre
};

} // namespace

bool power_is_positive(const Pushing& load, const Moving& moving, const Tube& tube, double from, double to) {
    const std::size_t walls = moving.state.packing.length_at(0);
    const double h = std::max(std::abs(from), std::abs(to));
    const double fast = sum_above(tube.speed(), tube.slope_error());
    std::vector<Bounds> force(moving.moves.size(), Bounds(0));
    for (const int k : moving.coordinates) {
        force[at(k)] = load.fixed[at(k)];
    }
    std::vector<Bounds> power(1, Bounds(0));
    double open = 0;
    for (std::size_t axis = 0; axis < moving.state.packing.axes(); ++axis) {
        if (load.pressure[axis] != 0 && moving.moves[walls + axis]) {
            const Face face(moving, tube, axis, h);
            force[walls + axis] = force[walls + axis] - face.at_centre() * load.pressure[axis];
            open = sum_above(open, face.add(load.pressure[axis], fast, power));
        }
    }
    std::vector<double> middle;
    for (const Bounds& f : force) {
        middle.push_back(f.middle());
    }
    const std::vector<double> g = tube.multipliers(middle);
    add_rows(force, moving, tube, g);
    power[0] = power[0] - Bounds(tube.weight()) * g.back() * static_cast<double>(tube.direction());
    Bending bending(moving, tube, h);
    for (std::size_t l = 0; l < moving.kept.size(); ++l) {
        if (moving.kept[l].of_disks() && g[l] != 0) {
            bending.add(moving.kept[l], g[l], power);
        }
    }
    double square = 0; // of the part that the multipliers do not balance
    for (const int k : moving.coordinates) {
        square = sum_above(square, product_above(force[at(k)].size(), force[at(k)].size()));
    }
    open = sum_above(sum_above(open, bending.open()), product_above(root_above(square), fast));
    return exceeds(power, slope_of(power), open, from, to, 0);
}

} // namespace isostat::checker
