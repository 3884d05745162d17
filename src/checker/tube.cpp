#include "checker/tube.hpp"

#include "checker/at_wall.hpp"
#include "checker/index.hpp"
#include "checker/inverse.hpp"
#include "checker/solver.hpp"

#include <array>

namespace isostat::checker {

namespace {

constexpr std::size_t highest_order = 14; // cost: order of the polynomial
constexpr double infinity = std::numeric_limits<double>::infinity();

/// sum_k c_k h^k from `first` on, times k when `slope` (then h^(k-1)).
double series_above(const std::vector<double>& c, std::size_t first, double h, bool slope = false) {
    double sum = 0;
    for (std::size_t k = c.size(); k-- > first;) {
        const double term = slope ? product_above(static_cast<double>(k), c[k]) : c[k];
        sum = sum_above(product_above(sum, h), term);
    }
    for (std::size_t k = slope ? 1 : 0; k < first; ++k) {
        sum = product_above(sum, h);
    }
    return sum;
}

double norm_above(const std::vector<double>& x) {
    double square = 0;
    for (const double c : x) {
        square = sum_above(square, product_above(std::abs(c), std::abs(c)));
    }
    return root_above(square);
}

/// Lower bound of the singular values; 0: not known.
double least_singular_value(const Problem& problem, const Solver& solver) {
    const InverseBound inverse = bound_inverse(problem, solver, CheckerArithmetic::automatic);
    if (!inverse.found) {
        return 0;
    }
    if (inverse.singular_value > 0) {
        return rounded_down(inverse.singular_value);
    }
    if (inverse.residual_column >= 1) {
        return 0;
    }
    // |A^-1|_2^2 <= |A^-1|_1 |A^-1|_inf.
    const Rational rows = inverse.row_sum / (1 - inverse.residual_row);
    const Rational columns = inverse.column_sum_max / (1 - inverse.residual_column);
    const double largest = rounded_up(rows * columns);
    return largest > 0 && largest < infinity ? next_below(next_below(1 / root_above(largest))) : 0;
}

} // namespace

double length_above(const Separation<Bounds>& d) {
    double square = product_above(d[0].size(), d[0].size());
    for (std::size_t a = 1; a < d.axes; ++a) {
        square = sum_above(square, product_above(d[a].size(), d[a].size()));
    }
    return root_above(square);
}

Separation<Bounds> difference(const std::vector<double>& x, const Contact& c, const Layout& layout) {
    Separation<Bounds> d(layout.axes());
    if (c.of_disks()) {
        for (std::size_t a = 0; a < d.axes; ++a) {
            if (c.i != c.j) {
                d[a] = Bounds(x[layout.of_disk(c.i) + a]) - Bounds(x[layout.of_disk(c.j) + a]);
            }
            for (std::size_t b = a; b < d.axes && !c.image.is_here(); ++b) {
                const std::size_t k = a == b ? layout.of_length(a) : layout.of_tilt(a, b);
                d[a] = d[a] - Bounds(x[k]) * static_cast<double>(c.image.m[b]);
            }
        }
    } else if (c.is_wall()) {
        d[0] = AtWall(c, layout).distance([&x](std::size_t k) { return Bounds(x[k]); });
    }
    return d;
}

bool Moving::any_of(const std::vector<bool>& flags, int disk) const {
    const auto first = flags.begin() + static_cast<std::ptrdiff_t>(state.packing.layout().of_disk(disk));
    return std::find(first, first + state.packing.dimension, true) != first + state.packing.dimension;
}

bool Moving::of_cell(const std::vector<bool>& flags) const {
    const Packing& packing = state.packing;
    bool any = false;
    for (std::size_t k = 0; k < packing.axes() + packing.tilts() && packing.cell.any(); ++k) {
        any = any || ((k >= packing.axes() || packing.cell.periodic[k]) && flags[packing.length_at(k)]);
    }
    return any;
}

bool Moving::takes_part(const Contact& c) const {
    if (c.of_disks()) {
        return (c.i != c.j && (disk_moves(c.i) || disk_moves(c.j))) || (!c.image.is_here() && cell_moves());
    }
    if (c.kind == ContactKind::held) {
        return moves[at(c.i)];
    }
    const AtWall place(c, state.packing.layout());
    return moves[place.disk] || (place.wall && moves[*place.wall]);
}

double Moving::off_rest(const Contact& pair) const {
    const bool here = pair.image.is_here() || !of_cell(loose);
    double off = (any_of(loose, pair.i) || any_of(loose, pair.j)) && pair.i != pair.j ? 1 : 0;
    double square = 0; // integers
    for (std::size_t a = state.packing.axes(); a-- > 0;) {
        off += here ? 0 : std::abs(pair.image.m[a]);
        square += off * off;
    }
    return product_above(root_above(square), rest);
}

namespace {

/// |m|^2
double square_of(const Image& image) {
    double square = 0;
    for (const std::int8_t m : image.m) {
        square += static_cast<double>(m) * m;
    }
    return square;
}

} // namespace

double period_weight(const Contact& pair) {
    return pair.image.is_here() ? 0 : root_above(square_of(pair.image));
}

namespace {

/// The parts of a configuration that D_l depends on: blocks of coordinates
/// (disks, and the cell behind them), each with a factor for its norm.
struct Blocks {
    std::array<std::size_t, 3> block{}; // 3: exact: blocks that a contact touches
    std::array<double, 3> weight{};
    std::size_t count = 0;

    Blocks(const Contact& c, const Moving& moving) {
        for (const int disk : {c.i, c.j}) {
            if (c.i != c.j && moving.disk_moves(disk)) {
                add(at(disk), 1);
            }
        }
        if (!c.image.is_here() && moving.cell_moves()) {
            add(moving.state.packing.radius.size(), period_weight(c));
        }
    }

  private:
    void add(std::size_t b, double w) {
        block[count] = b;
        weight[count++] = w;
    }
};

/// w_l^2 = 2 + |m|^2: |D_l x|^2 is at most this times the sum of the squares of its blocks; without the disks of an
/// own image.
double square_weight(const Contact& c) {
    return (c.i == c.j ? 0 : 2) + square_of(c.image);
}

} // namespace

struct Tube::Linear {
    explicit Linear(const State& state) : problem(state, true), solver(problem) {}
    Problem problem;
    Solver solver;

    /// A^-1 b: b per contact (the free row last), result on all coordinates.
    [[nodiscard]] std::vector<double> solve(const std::vector<double>& b) const {
        Eigen::MatrixXd right(static_cast<Eigen::Index>(b.size()), 1);
        for (std::size_t l = 0; l < b.size(); ++l) {
            right(static_cast<Eigen::Index>(l), 0) = b[l];
        }
        const Eigen::MatrixXd x = solver.solve(right);
        std::vector<double> result(problem.stored.size(), 0.0);
        for (int k = 0; k < problem.dofs(); ++k) {
            result[at(problem.coordinate_of[at(k)])] = std::ldexp(x(k, 0), -solver.exponent());
        }
        return result;
    }
};

std::unique_ptr<Tube> Tube::make(const Moving& moving, std::vector<double> centre, int row, int direction) {
    State state = moving.state;
    state.packing.q = centre;
    state.contacts = moving.kept;
    for (const Contact& c : moving.kept) {
        if (c.kind == ContactKind::held && (c.i == row || centre[at(c.i)] != moving.state.packing.q[at(c.i)])) {
            return nullptr;
        }
    }
    state.contacts.push_back({ContactKind::held, row, 0});
    std::unique_ptr<Tube> tube(new Tube(moving, std::move(centre), row, direction));
    tube->linear_ = std::make_shared<Linear>(state);
    const Problem& problem = tube->linear_->problem;
    if (!problem.unsupported.empty() || problem.contacts() != problem.dofs() || !tube->linear_->solver.usable()) {
        return nullptr;
    }
    tube->weight_ = rounded_up(problem.length(problem.weight()));
    tube->sigma_ = least_singular_value(problem, tube->linear_->solver);
    if (!(tube->sigma_ > 0)) {
        return nullptr;
    }
    tube->expand();
    if (tube->a_.empty()) {
        return nullptr;
    }
    tube->bound_residuals();
    return tube;
}

/// The derivatives of the curve in double precision, which are not trusted.
void Tube::expand() {
    const std::size_t disks = moving_.state.packing.radius.size();
    const std::size_t contacts = moving_.kept.size();
    std::vector<double> spread(disks + 1, 0.0); // integers
    std::vector<double> fourth(disks + 1, 0.0);
    for (const Contact& c : moving_.kept) {
        if (c.of_disks()) {
            const Blocks blocks(c, moving_);
            const double w = square_weight(c);
            for (std::size_t b = 0; b < blocks.count; ++b) {
                spread[blocks.block[b]] += w;
                fourth[blocks.block[b]] += w * w;
            }
        }
    }
    spread_ = std::max(2.0, *std::max_element(spread.begin(), spread.end()));
    curvature_ = root_above(std::max(4.0, *std::max_element(fourth.begin(), fourth.end()))); // checker.md K16
    const double unit = moving_.state.packing.min_radius();
    longest_ = 0.2 * unit; // cost: longest piece
    std::vector<double> right(contacts + 1, 0.0);
    right[contacts] = weight_ * direction_;
    const Layout layout = moving_.state.packing.layout();
    std::vector<std::vector<Separation<double>>> differences;
    for (std::size_t k = 1; k <= highest_order; ++k) {
        std::vector<double> a = linear_->solve(right);
        for (const Contact& c : moving_.kept) {
            if (c.kind == ContactKind::held) {
                a[at(c.i)] = 0;
            }
        }
        a[at(row_)] = k == 1 ? direction_ : 0;
        double largest = 0;
        for (const double x : a) {
            largest = std::max(largest, std::abs(x));
        }
        if (!(largest < 1e100)) { // cost: order of the polynomial
            break;
        }
        auto& mine = differences.emplace_back(contacts, Separation<double>(layout.axes()));
        for (std::size_t l = 0; l < contacts; ++l) {
            const Separation<Bounds> d = difference(a, moving_.kept[l], layout);
            for (std::size_t axis = 0; axis < d.axes; ++axis) {
                mine[l][axis] = d[axis].middle();
            }
        }
        a_.push_back(std::move(a));
        // cost: order of the polynomial
        if (k > 1 && largest * std::pow(longest_, static_cast<double>(k)) < 0x1p-58 * unit) {
            break;
        }
        right[contacts] = 0;
        for (std::size_t l = 0; l < contacts; ++l) {
            double sum = 0;
            for (std::size_t i = 0; i < k && moving_.kept[l].of_disks(); ++i) {
                sum += product(differences[i][l], differences[k - 1 - i][l]);
            }
            right[l] = -0.5 * sum; // exact: a half (checker.md K16)
        }
    }
}

/// Coefficients of every F_l along p, for any polynomial p.
void Tube::bound_residuals() {
    const Packing& packing = moving_.state.packing;
    const Layout layout = packing.layout();
    const std::size_t order = a_.size();
    for (const Contact& c : moving_.kept) {
        std::vector<double>& stretch = stretch_.emplace_back(order + 1, 0.0);
        std::vector<double>& residual = residual_.emplace_back(2 * order + 1, 0.0);
        if (c.kind == ContactKind::held) {
            continue; // the centre has the stored value, and a_k is 0 there
        }
        std::vector<Separation<Bounds>> d{difference(centre_, c, layout)};
        for (std::size_t k = 1; k <= order; ++k) {
            d.push_back(difference(a_[k - 1], c, layout));
            stretch[k] = length_above(d[k]);
        }
        const auto [one, other] = closed_at(packing, c);
        if (!c.of_disks()) {
            residual[0] = ((d[0][0] - one) * weight_).size();
            for (std::size_t k = 1; k <= order; ++k) {
                residual[k] = (d[k][0] * weight_).size();
            }
            const AtWall place(c, layout);
            for (const std::size_t k : {place.disk, place.wall.value_or(place.disk)}) {
                if (moving_.loose[k]) {
                    residual[0] = sum_above(residual[0], product_above(moving_.rest, weight_));
                }
            }
            continue;
        }
        const Bounds sum = Bounds(one) + other;
        residual[0] = ((product(d[0], d[0]) - sum * sum) * 0.5).size(); // 0.5: exact: a half (checker.md K16)
        for (std::size_t k = 1; k <= 2 * order; ++k) {
            Bounds value(0);
            for (std::size_t m = k > order ? k - order : 1; m <= std::min(order, k - 1); ++m) {
                value = value + product(d[m], d[k - m]);
            }
            value = value * 0.5;
            if (k <= order) {
                value = value + product(d[0], d[k]);
            }
            residual[k] = value.size();
        }
        if (const double off = moving_.off_rest(c); off > 0) {
            stretch[0] = off;
            residual[0] = sum_above(residual[0], product_above(off, sum_above(length_above(d[0]), off)));
            for (std::size_t k = 1; k <= order; ++k) {
                residual[k] = sum_above(residual[k], product_above(off, stretch[k]));
            }
        }
    }
}

/// Bound of |A(p(s)) - A(centre)|_2 for |s| <= h.
double Tube::change_norm(double h) const {
    const std::size_t disks = moving_.state.packing.radius.size();
    std::vector<double> e(moving_.kept.size(), 0.0);
    for (std::size_t l = 0; l < e.size(); ++l) {
        if (moving_.kept[l].of_disks()) {
            e[l] = series_above(stretch_[l], 0, h);
        }
    }
    std::vector<double> x(disks + 1, 1.0);
    double best = infinity;
    for (int round = 0; round < 5; ++round) { // cost: vectors of Collatz and Wielandt
        std::vector<double> z(disks + 1, 0.0);
        for (std::size_t l = 0; l < e.size(); ++l) {
            if (e[l] == 0) {
                continue;
            }
            const Blocks blocks(moving_.kept[l], moving_);
            double y = 0;
            for (std::size_t b = 0; b < blocks.count; ++b) {
                y = sum_above(y, product_above(blocks.weight[b], x[blocks.block[b]]));
            }
            y = product_above(product_above(e[l], e[l]), y);
            for (std::size_t b = 0; b < blocks.count; ++b) {
                double& sum = z[blocks.block[b]];
                sum = sum_above(sum, product_above(blocks.weight[b], y));
            }
        }
        double ratio = 0;
        double most = 0;
        for (std::size_t i = 0; i <= disks; ++i) {
            ratio = std::max(ratio, quotient_above(z[i], x[i]));
            most = std::max(most, z[i]);
        }
        best = std::min(best, ratio);
        for (std::size_t i = 0; i <= disks; ++i) {
            x[i] = z[i] + 1e-3 * most + std::numeric_limits<double>::min(); // guess: the vector of Collatz and Wielandt
        }
    }
    return root_above(best);
}

bool Tube::holds(double h) {
    const double left = next_below(sigma_ - change_norm(h)); // bound of the smallest singular value, at every p(s)
    if (!(left > 0.1 * sigma_)) {                            // cost: what a piece may take of the singular value
        return false;
    }
    std::vector<double> values;
    std::vector<double> rates;
    double turn = 0;
    for (std::size_t l = 0; l < residual_.size(); ++l) {
        values.push_back(series_above(residual_[l], 0, h));
        rates.push_back(series_above(residual_[l], 1, h, true));
        if (moving_.kept[l].of_disks()) {
            turn = std::max(turn, series_above(stretch_[l], 1, h, true));
        }
    }
    const double rho = norm_above(values);
    const double beta = quotient_above(1, left);
    // checker.md K16 (4 L rho)
    const double product = product_above(product_above(product_above(4, curvature_), rho), product_above(beta, beta));
    if (!(product <= 1)) {
        return false;
    }
    radius_ = product_above(product_above(2, beta), rho);
    unique_ = next_below(left / curvature_);
    const double at_curve = next_below(left - product_above(curvature_, radius_));
    const double apart = product_above(product_above(turn, root_above(spread_)), radius_);
    slope_error_ = quotient_above(sum_above(norm_above(rates), apart), at_curve);
    speed_ = 0;
    std::vector<double> sizes{0};
    for (const auto& a : a_) {
        sizes.push_back(norm_above(a));
    }
    speed_ = series_above(sizes, 1, h, true);
    reach_ = h;
    return at_curve > 0 && speed_ < infinity;
}

bool Tube::prove() {
    double turning = change_norm(1e-6 * longest_) * 1e6 / longest_; // guess: rate of change of the derivative
    double h = std::min(longest_, turning > 0 ? 0.75 * sigma_ / turning : longest_); // cost: longest piece
    // No farther than where the polynomial is about as good as the centre, as a wide tube leaves gaps and power open.
    const auto norm = [this](std::size_t first, double s) {
        std::vector<double> values;
        for (const std::vector<double>& residual : residual_) {
            values.push_back(first > 0 ? series_above(residual, first, s) : residual[0]);
        }
        return norm_above(values);
    };
    const double at_centre = norm(0, 0);
    const double least = 0.1 * h;                     // cost: shortest piece
    while (h > least && norm(1, h) > 4 * at_centre) { // cost: a piece as good as its centre
        h *= 0.85;                                    // cost: next shorter piece
    }
    for (; h > 1e-10 * longest_; h *= 0.7) { // 1e-10: cost: shortest piece; 0.7: cost: next shorter piece
        if (holds(h)) {
            return true;
        }
    }
    reach_ = 0;
    return false;
}

std::optional<Bounds> Tube::locate(const std::vector<double>& x, double uncertainty) const {
    const auto row = static_cast<std::size_t>(row_);
    const Bounds s = (Bounds(x[row]) - centre_[row]) * static_cast<double>(direction_);
    if (!(s.size() < reach_)) {
        return std::nullopt;
    }
    double square = 0;
    for (const int k : moving_.coordinates) {
        Bounds p(0);
        for (std::size_t order = a_.size(); order > 0; --order) {
            p = (p + a_[order - 1][at(k)]) * s;
        }
        const double off = (p + centre_[at(k)] - x[at(k)]).size();
        square = sum_above(square, product_above(off, off));
    }
    const double distance = sum_above(sum_above(root_above(square), uncertainty), product_above(speed_, uncertainty));
    const Bounds place = s + Bounds::around(uncertainty);
    if (!(place.size() < reach_) || !(distance < unique_)) {
        return std::nullopt;
    }
    return place;
}

std::vector<double> Tube::point(double s, double& error) const {
    std::vector<double> q = centre_;
    double square = 0;
    for (const int k : moving_.coordinates) {
        Bounds p(0);
        for (std::size_t order = a_.size(); order > 0; --order) {
            p = (p + a_[order - 1][at(k)]) * s;
        }
        p = p + centre_[at(k)];
        q[at(k)] = p.middle();
        const double off = (p - q[at(k)]).size();
        square = sum_above(square, product_above(off, off));
    }
    error = root_above(square);
    return q;
}

Bounds Tube::slope(int coordinate, const Bounds& s) const {
    Bounds v(0);
    for (std::size_t order = a_.size(); order > 0; --order) {
        v = v * s + Bounds(a_[order - 1][at(coordinate)]) * static_cast<double>(order);
    }
    return v + Bounds::around(slope_error_);
}

int Tube::fastest(double s) const {
    int best = row_;
    double speed = 0;
    for (const int k : moving_.coordinates) {
        double v = 0;
        for (std::size_t order = a_.size(); order > 0; --order) {
            v = v * s + static_cast<double>(order) * a_[order - 1][at(k)];
        }
        const bool held = std::any_of(moving_.kept.begin(), moving_.kept.end(),
                                      [k](const Contact& c) { return c.kind == ContactKind::held && c.i == k; });
        if (std::abs(v) > speed && !held) {
            speed = std::abs(v);
            best = k;
        }
    }
    return best;
}

std::vector<double> Tube::multipliers(const std::vector<double>& force) const {
    const Problem& problem = linear_->problem;
    Eigen::MatrixXd right(problem.dofs(), 1);
    for (int k = 0; k < problem.dofs(); ++k) {
        right(k, 0) = -force[at(problem.coordinate_of[at(k)])];
    }
    const Eigen::MatrixXd g = linear_->solver.solve_transposed(right);
    std::vector<double> result;
    for (Eigen::Index l = 0; l < g.rows(); ++l) {
        result.push_back(std::ldexp(g(l, 0), -linear_->solver.exponent()));
    }
    return result;
}

std::vector<double> Tube::corrected(double s) const {
    double unused = 0;
    std::vector<double> q = point(s, unused);
    const Packing& packing = moving_.state.packing;
    const Layout layout = packing.layout();
    for (int step = 0; step < 4; ++step) { // cost: Newton steps of a centre
        std::vector<double> right;
        for (const Contact& c : moving_.kept) {
            const Separation<Bounds> d = difference(q, c, layout);
            const auto [one, other] = closed_at(packing, c);
            const double sum = one + other;
            right.push_back(c.kind == ContactKind::held ? 0
                            : c.of_disks()              ? -(product(d, d).middle() - sum * sum) / 2
                                                        : -weight_ * (d[0].middle() - sum));
        }
        right.push_back(0);
        const std::vector<double> change = linear_->solve(right);
        for (const int k : moving_.coordinates) {
            if (k != row_ && std::isfinite(change[at(k)])) {
                q[at(k)] += change[at(k)];
            }
        }
    }
    for (const Contact& c : moving_.kept) {
        if (c.kind == ContactKind::held) {
            q[at(c.i)] = packing.q[at(c.i)];
        }
    }
    return q;
}

} // namespace isostat::checker
