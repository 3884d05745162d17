#include "checker/normal_factor.hpp"

#include "checker/index.hpp"
#include "checker/problem.hpp"

#include <numeric>

namespace isostat::checker {

namespace {

/// In blocks of K columns, mostly those of one grain.
template <int K> class BlockFactor : public NormalFactor {
  public:
    BlockFactor(const SparseRows<double>& a, const std::vector<int>& order) : a_(a), place_(order.size()) {
        std::vector<int> node((order.size() + K - 1) / K, -1);
        for (const int k : order) {
            int& own = node[at(k / K)];
            own = own < 0 ? nodes_++ : own;
            place_[at(k)] = K * own + k % K;
        }
        padded_ = K * node.back() + static_cast<int>(order.size() - 1) % K + 1;
        for (int& column : a_.column) {
            column = place_[at(column)];
        }
        lessen_columns();
        find_parts();
        pattern_ = FactorPattern(at(nodes_), [this](int i, const auto& visit) {
            for (const int p : parts_at_[at(i)]) {
                for (const Part& part : parts_of(parts_[at(p)].contact)) {
                    visit(part.node);
                }
            }
        });
    }

    bool compute(double shift) override {
        std::vector<Block> x(at(nodes_), Block::Zero()); // the row that is computed; 0 elsewhere
        std::vector<std::size_t> end(pattern_.start.begin(), pattern_.start.end() - 1);
        row_.resize(pattern_.column.size());
        value_.resize(pattern_.column.size());
        diagonal_.assign(at(nodes_), Block::Zero());
        for (int i = 0; i < nodes_; ++i) {
            for (const int p : parts_at_[at(i)]) {
                const Part& own = parts_[at(p)];
                for (const Part& part : parts_of(own.contact)) {
                    if (part.node <= i) {
                        x[at(part.node)] += own.value * part.value.transpose();
                    }
                }
            }
            Block pivot = std::exchange(x[at(i)], Block::Zero());
            for (std::size_t c = pattern_.first[at(i)]; c < pattern_.first[at(i) + 1]; ++c) {
                const auto k = at(pattern_.column[c]);
                Block l = std::exchange(x[k], Block::Zero());
                for (int s = 0; s < K; ++s) {
                    for (int m = 0; m < s; ++m) {
                        l.col(s) -= diagonal_[k](s, m) * l.col(m);
                    }
                    l.col(s) /= diagonal_[k](s, s);
                }
                for (std::size_t p = pattern_.start[k]; p < end[k]; ++p) {
                    x[at(row_[p])] -= l * value_[p].transpose();
                }
                pivot -= l * l.transpose();
                row_[end[k]] = i;
                value_[end[k]++] = l;
            }
            if (!take_root(i, pivot, shift)) {
                return false;
            }
        }
        return true;
    }

    [[nodiscard]] double residual(double shift) const override {
        std::vector<double> terms(at(nodes_)); // at most, of one entry
        for (std::size_t i = 0; i < terms.size(); ++i) {
            terms[i] =
                // checker.md K30 (terms of an entry)
                static_cast<double>(parts_at_[i].size() + K * (pattern_.first[i + 1] - pattern_.first[i] + 1) + 4);
        }
        std::vector<Column> sum(at(nodes_), Column::Zero()); // (|A|^T |A| + |L| |L|^T) times them
        for (std::size_t k = 0; k < terms.size(); ++k) {
            Column down = diagonal_[k].cwiseAbs().colwise().sum().transpose() * terms[k];
            for (std::size_t p = pattern_.start[k]; p < pattern_.start[k + 1]; ++p) {
                down += value_[p].cwiseAbs().colwise().sum().transpose() * terms[at(row_[p])];
            }
            sum[k] += diagonal_[k].cwiseAbs() * down;
            for (std::size_t p = pattern_.start[k]; p < pattern_.start[k + 1]; ++p) {
                sum[at(row_[p])] += value_[p].cwiseAbs() * down;
            }
        }
        for (std::size_t l = 0; l + 1 < part_of_.size(); ++l) {
            double across = 0;
            for (const Part& part : parts_of(l)) {
                across += part.value.cwiseAbs().sum() * terms[at(part.node)];
            }
            for (const Part& part : parts_of(l)) {
                sum[at(part.node)] += part.value.cwiseAbs() * across;
            }
        }
        double largest = 0;
        for (std::size_t i = 0; i < terms.size(); ++i) {
            largest = std::max(largest, sum[i].maxCoeff() + shift * terms[i]);
        }
        // 1.02: checker.md K30 (gamma and sums); 0x1p-53: exact: u, the unit of rounding; 0x1p-900: checker.md K30
        // (underflow)
        return 1.02 * 0x1p-53 * largest + 0x1p-900;
    }

    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& b) const override {
        std::vector<Column> x(at(nodes_), Column::Zero());
        subtract_transposed(b, x);
        divide(x);
        Eigen::VectorXd result(b.size());
        for (std::size_t k = 0; k < place_.size(); ++k) {
            result(static_cast<Eigen::Index>(k)) = -x[at(place_[k] / K)](place_[k] % K) * scale_[at(place_[k])];
        }
        return result;
    }
    [[nodiscard]] Eigen::VectorXd solve_transposed(const Eigen::VectorXd& b, int steps) const override {
        std::vector<Column> sought(at(nodes_), Column::Zero());
        for (std::size_t k = 0; k < place_.size(); ++k) {
            sought[at(place_[k] / K)](place_[k] % K) = b(static_cast<Eigen::Index>(k)) * scale_[at(place_[k])];
        }
        Eigen::VectorXd result = Eigen::VectorXd::Zero(b.size());
        for (int step = 0; step < steps; ++step) {
            std::vector<Column> x = sought;
            subtract_transposed(result, x);
            divide(x);
            for (const Part& part : parts_) {
                result(static_cast<Eigen::Index>(part.contact)) += part.value.dot(x[at(part.node)]);
            }
        }
        return result;
    }
    [[nodiscard]] int entries() const override { return static_cast<int>(pattern_.column.size()) * K * K; }

  private:
    using Block = Eigen::Matrix<double, K, K>;
    using Column = Eigen::Matrix<double, K, 1>;
    /// What a contact has in the columns of a node.
    struct Part {
        int node;
        std::size_t contact;
        Column value = Column::Zero();
    };

    /// x becomes x - A^T b.
    void subtract_transposed(const Eigen::VectorXd& b, std::vector<Column>& x) const {
        for (const Part& part : parts_) {
            x[at(part.node)] -= part.value * b(static_cast<Eigen::Index>(part.contact));
        }
    }

    /// x becomes (L L^T)^-1 x.
    void divide(std::vector<Column>& x) const {
        for (std::size_t k = 0; k < x.size(); ++k) {
            Column& y = x[k];
            for (int s = 0; s < K; ++s) {
                for (int m = 0; m < s; ++m) {
                    y(s) -= diagonal_[k](s, m) * y(m);
                }
                y(s) /= diagonal_[k](s, s);
            }
            for (std::size_t p = pattern_.start[k]; p < pattern_.start[k + 1]; ++p) {
                x[at(row_[p])] -= value_[p] * y;
            }
        }
        for (std::size_t k = x.size(); k-- > 0;) {
            Column y = x[k];
            for (std::size_t p = pattern_.start[k]; p < pattern_.start[k + 1]; ++p) {
                for (int s = 0; s < K; ++s) { // the product of Eigen goes through memory
                    y(s) -= value_[p].col(s).dot(x[at(row_[p])]);
                }
            }
            for (int s = K; s-- > 0;) {
                for (int m = K; --m > s;) {
                    y(s) -= diagonal_[k](m, s) * y(m);
                }
                y(s) /= diagonal_[k](s, s);
            }
            x[k] = y;
        }
    }

    /// Columns of large norm, those of walls, times powers of two below 1: that makes no singular value larger.
    void lessen_columns() {
        constexpr double largest = 4; // cost: columns that are scaled
        std::vector<double> square(at(K * nodes_), 0.0);
        for (std::size_t p = 0; p < a_.value.size(); ++p) {
            square[at(a_.column[p])] += a_.value[p] * a_.value[p];
        }
        scale_.assign(square.size(), 1.0);
        for (std::size_t k = 0; k < square.size(); ++k) {
            for (; square[k] > largest; square[k] /= 4) { // exact: the square of 2
                scale_[k] /= 2;
            }
        }
        for (std::size_t p = 0; p < a_.value.size(); ++p) {
            a_.value[p] *= scale_[at(a_.column[p])];
        }
    }

    void find_parts() {
        std::vector<std::pair<int, int>> touching;
        for (std::size_t l = 0; l + 1 < a_.first.size(); ++l) {
            for (std::size_t p = a_.first[l]; p < a_.first[l + 1]; ++p) {
                const int node = a_.column[p] / K;
                std::size_t part = part_of_.back();
                while (part < parts_.size() && parts_[part].node != node) {
                    ++part;
                }
                if (part == parts_.size()) {
                    touching.emplace_back(node, static_cast<int>(part));
                    parts_.push_back({node, l});
                }
                parts_[part].value(a_.column[p] % K) = a_.value[p];
            }
            part_of_.push_back(parts_.size());
        }
        parts_at_ = {at(nodes_), touching};
    }
    [[nodiscard]] std::span<const Part> parts_of(std::size_t contact) const {
        return std::span(parts_).subspan(part_of_[contact], part_of_[contact + 1] - part_of_[contact]);
    }

    bool take_root(int i, const Block& pivot, double shift) {
        Block& l = diagonal_[at(i)];
        for (int s = 0; s < K; ++s) {
            for (int r = s; r < K; ++r) {
                double left = pivot(r, s);
                for (int m = 0; m < s; ++m) {
                    left -= l(r, m) * l(s, m);
                }
                const bool padded = K * i + r >= padded_ && K * i + r < (padded_ + K - 1) / K * K;
                l(r, s) = r > s ? left / l(s, s) : padded ? 1 : std::sqrt(left - shift);
            }
            if (!(l(s, s) > 0)) {
                return false;
            }
        }
        return true;
    }

    SparseRows<double> a_;      ///< its columns are places
    std::vector<int> place_;    ///< of each column: K times its node, and its place there
    std::vector<double> scale_; ///< of each place
    int nodes_ = 0;
    int padded_ = 0; ///< the first place without a degree of freedom in the node of the last ones
    std::vector<Part> parts_;
    std::vector<std::size_t> part_of_{0}; ///< the first of each contact
    Lists parts_at_;                      ///< of each node
    FactorPattern pattern_;
    std::vector<int> row_; ///< below the diagonal, column by column: rows ascend
    std::vector<Block> value_, diagonal_;
};

} // namespace

std::unique_ptr<NormalFactor> normal_factor(int dimension, const SparseRows<double>& a, const std::vector<int>& order) {
    if (dimension == plane) {
        return std::make_unique<BlockFactor<2>>(a, order);
    }
    return std::make_unique<BlockFactor<3>>(a, order); // exact: coordinates of a sphere
}

} // namespace isostat::checker
