#include <isostat/exact/number.hpp>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <stdexcept>

namespace isostat::exact {

namespace {

using Row = std::vector<Number>;

Number dot(const Row& a, const Row& b) {
    Number sum;
    for (std::size_t k = 0; k < a.size(); ++k) {
        if (!a[k].is_zero() && !b[k].is_zero()) {
            sum += a[k] * b[k];
        }
    }
    return sum;
}

/// The columns are the z, one artificial per row, and the right-hand side. The cost row holds reduced costs, and minus
/// the objective at its end.
class Tableau {
  public:
    Tableau(const std::vector<Row>& rows, const Row& b, int cols)
        : cols_(static_cast<std::size_t>(cols)), flipped_(rows.size(), false), basis_(rows.size()) {
        const std::size_t m = rows.size();
        cost_.assign(cols_ + m + 1, Number());
        for (std::size_t i = 0; i < m; ++i) {
            Row line = rows[i];
            line.resize(cols_ + m + 1);
            line.back() = b[i];
            flipped_[i] = b[i].sign() < 0;
            if (flipped_[i]) {
                std::ranges::transform(line, line.begin(), std::negate());
            }
            line[cols_ + i] = 1;
            basis_[i] = cols_ + i;
            // Each artificial has cost 1. Priced out, the cost row is minus the sum of the rows.
            for (std::size_t c = 0; c < line.size(); ++c) {
                if (c != cols_ + i) {
                    cost_[c] -= line[c];
                }
            }
            line_.push_back(std::move(line));
        }
    }

    /// Pivots to the least cost, from a feasible point.
    void solve() {
        for (;;) {
            std::size_t enter = 0;
            while (enter < cols_ && cost_[enter].sign() >= 0) {
                ++enter; // Bland's rule: the first column that lowers the cost
            }
            if (enter == cols_) {
                return;
            }
            std::size_t leave = line_.size();
            Number best;
            for (std::size_t i = 0; i < line_.size(); ++i) {
                if (line_[i][enter].sign() > 0) {
                    const Number ratio = line_[i].back() / line_[i][enter];
                    const int order = leave == line_.size() ? -1 : (ratio - best).sign();
                    if (order < 0 || (order == 0 && basis_[i] < basis_[leave])) {
                        leave = i;
                        best = ratio;
                    }
                }
            }
            assert(leave < line_.size() && "the cost is bounded below");
            pivot(leave, enter);
        }
    }

    /// The second phase. Artificials that remain at 0 leave the basis, unless their rows are 0 and remain 0.
    void solve_for(const Row& cost) {
        for (std::size_t i = 0; i < line_.size(); ++i) {
            std::size_t enter = 0;
            while (basis_[i] >= cols_ && enter < cols_ && line_[i][enter].is_zero()) {
                ++enter;
            }
            if (basis_[i] >= cols_ && enter < cols_) {
                pivot(i, enter);
            }
        }
        cost_ = cost;
        cost_.resize(cols_ + line_.size() + 1);
        for (std::size_t i = 0; i < line_.size(); ++i) {
            const Number factor = basis_[i] < cols_ ? cost[basis_[i]] : Number(0);
            for (std::size_t k = 0; k < cost_.size() && !factor.is_zero(); ++k) {
                cost_[k] -= factor * line_[i][k];
            }
        }
        artificial_ = 0;
        solve();
    }

    [[nodiscard]] bool feasible() const { return cost_.back().is_zero(); }
    [[nodiscard]] Row solution() const {
        Row z(cols_);
        for (std::size_t i = 0; i < line_.size(); ++i) {
            if (basis_[i] < cols_) {
                z[basis_[i]] = line_[i].back();
            }
        }
        return z;
    }
    [[nodiscard]] Row multipliers() const {
        Row u(line_.size());
        for (std::size_t i = 0; i < u.size(); ++i) {
            u[i] = artificial_ - cost_[cols_ + i];
            u[i] = flipped_[i] ? -u[i] : u[i];
        }
        return u;
    }

  private:
    void pivot(std::size_t r, std::size_t c) {
        const Number scale = line_[r][c].inverse();
        for (Number& x : line_[r]) {
            x = x.is_zero() ? x : x * scale;
        }
        const auto clear = [&](Row& row) {
            if (!row[c].is_zero()) {
                const Number factor = row[c];
                for (std::size_t k = 0; k < row.size(); ++k) {
                    if (!line_[r][k].is_zero()) {
                        row[k] -= factor * line_[r][k];
                    }
                }
            }
        };
        for (std::size_t i = 0; i < line_.size(); ++i) {
            if (i != r) {
                clear(line_[i]);
            }
        }
        clear(cost_);
        basis_[r] = c;
    }

    std::size_t cols_;
    std::vector<bool> flipped_;
    std::vector<std::size_t> basis_;
    std::vector<Row> line_;
    Row cost_;
    Number artificial_ = 1; ///< cost of an artificial
};

void require(bool holds) {
    if (!holds) {
        throw std::logic_error("exact feasibility: a certificate fails its check");
    }
}

Row combine(const std::vector<Row>& vectors, const Row& weights, std::size_t size) {
    Row out(size);
    for (std::size_t k = 0; k < vectors.size(); ++k) {
        for (std::size_t i = 0; i < size && !weights[k].is_zero(); ++i) {
            out[i] += weights[k] * vectors[k][i];
        }
    }
    return out;
}

} // namespace

Feasibility feasible_point(const std::vector<Row>& rows, const Row& b, int cols) {
    Tableau tableau(rows, b, cols);
    tableau.solve();
    Feasibility out;
    out.feasible = tableau.feasible();
    if (out.feasible) {
        out.solution = tableau.solution();
        for (std::size_t i = 0; i < rows.size(); ++i) {
            require(dot(rows[i], out.solution) == b[i]);
        }
        for (const Number& z : out.solution) {
            require(z.sign() >= 0);
        }
    } else {
        out.farkas = tableau.multipliers();
        for (const Number& x : combine(rows, out.farkas, static_cast<std::size_t>(cols))) {
            require(x.sign() <= 0);
        }
        require(dot(out.farkas, b).sign() > 0);
    }
    return out;
}

std::optional<Number> least(const std::vector<Row>& rows, const Row& b, const Row& cost) {
    Tableau tableau(rows, b, static_cast<int>(cost.size()));
    tableau.solve();
    if (!tableau.feasible()) {
        return std::nullopt;
    }
    tableau.solve_for(cost);
    const Row z = tableau.solution(), u = tableau.multipliers(), below = combine(rows, u, cost.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        require(dot(rows[i], z) == b[i]);
    }
    for (std::size_t k = 0; k < z.size(); ++k) {
        require(z[k].sign() >= 0 && (cost[k] - below[k]).sign() >= 0);
    }
    Number value = dot(cost, z);
    require(value == dot(u, b));
    return value;
}

OneSignAnswer one_sign(const std::vector<Row>& whole, int size) {
    const auto components = static_cast<std::size_t>(size);
    if (whole.empty() || size == 0) {
        return {};
    }
    std::vector<Row> vectors = whole;
    for (Row& vector : vectors) {
        vector.resize(components);
    }
    // Gordan: either some combination is > 0 everywhere, or some y >= 0, sum y = 1, is orthogonal to all vectors.
    std::vector<Row> rows = vectors;
    rows.emplace_back(components, Number(1));
    Row b(vectors.size());
    b.emplace_back(1);
    const Feasibility gordan = feasible_point(rows, b, size);
    if (!gordan.feasible) {
        // u A <= 0 with u_last > 0: the combination -u exceeds u_last in every component.
        Row weights(gordan.farkas.begin(), gordan.farkas.end() - 1);
        std::ranges::transform(weights, weights.begin(), std::negate());
        OneSignAnswer out{OneSign::strict, combine(whole, weights, whole.front().size())};
        for (std::size_t i = 0; i < components; ++i) {
            require(out.combination[i].sign() > 0);
        }
        return out;
    }
    // Stiemke: either some combination is >= 0 and not 0, or some y > 0 is orthogonal to all vectors; y = 1 + z.
    Row sums(vectors.size());
    for (std::size_t k = 0; k < vectors.size(); ++k) {
        for (const Number& x : vectors[k]) {
            sums[k] -= x;
        }
    }
    const Feasibility stiemke = feasible_point(vectors, sums, size);
    if (stiemke.feasible) {
        return {};
    }
    Row weights = stiemke.farkas;
    std::ranges::transform(weights, weights.begin(), std::negate());
    OneSignAnswer out{OneSign::partial, combine(whole, weights, whole.front().size())};
    bool somewhere = false;
    for (std::size_t i = 0; i < components; ++i) {
        require(out.combination[i].sign() >= 0);
        somewhere = somewhere || out.combination[i].sign() > 0;
    }
    require(somewhere);
    return out;
}

} // namespace isostat::exact
