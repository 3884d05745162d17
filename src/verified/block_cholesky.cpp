#include "verified/block_cholesky.hpp"

#include <amd.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <new>
#include <numeric>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

double gamma(double terms) {
    return terms * u / (1 - terms * u);
}

/// Blocks that share a contact, as AMD wants them: columns of a symmetric pattern, both halves, with repetitions.
std::vector<int> little_fill(const sparse::Matrix<double>& h, std::size_t blocks) {
    std::vector<int> start(blocks + 1, 0);
    std::vector<int> row;
    const auto for_each_pair = [&](auto use) {
        for (std::size_t l = 0; l < static_cast<std::size_t>(h.cols); ++l) {
            for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                for (int f = h.start[l]; f < h.start[l + 1]; ++f) {
                    const int a = h.row[static_cast<std::size_t>(e)] / 2;
                    const int b = h.row[static_cast<std::size_t>(f)] / 2;
                    if (a != b) {
                        use(static_cast<std::size_t>(a), b);
                    }
                }
            }
        }
    };
    for_each_pair([&](std::size_t a, int) { ++start[a + 1]; });
    std::partial_sum(start.begin(), start.end(), start.begin());
    row.resize(static_cast<std::size_t>(start.back()) + 1); // AMD refuses a null array
    std::vector<int> next(start.begin(), start.end() - 1);
    for_each_pair([&](std::size_t a, int b) { row[static_cast<std::size_t>(next[a]++)] = b; });
    std::vector<int> order(blocks);
    const int status = amd_order(static_cast<int>(blocks), start.data(), row.data(), order.data(), nullptr, nullptr);
    if (status == AMD_OUT_OF_MEMORY) {
        throw std::bad_alloc();
    }
    assert(status == AMD_OK || status == AMD_OK_BUT_JUMBLED);
    return order;
}

} // namespace

BlockCholesky::BlockCholesky(const sparse::Matrix<double>& h, std::vector<int>& permutation)
    : h_(h), blocks_((static_cast<std::size_t>(h.rows) + 1) / 2) {
    if (permutation.size() != blocks_) {
        permutation = little_fill(h, blocks_);
    }
    position_.resize(blocks_);
    for (std::size_t k = 0; k < blocks_; ++k) {
        position_[static_cast<std::size_t>(permutation[k])] = static_cast<int>(k);
    }
    form_products(position_);
    analyse();
}

/// Blocks of H H^T: each contact adds the products of its entries.
void BlockCholesky::form_products(const std::vector<int>& position) {
    diagonal_.assign(blocks_, Block{});
    if (h_.rows % 2 != 0) { // a row that is not there: pivot 1 - s, coupled to nothing
        diagonal_[static_cast<std::size_t>(position[blocks_ - 1])][3] = 1;
    }
    std::vector<Product> unsorted;
    unsorted.reserve(static_cast<std::size_t>(h_.cols));
    product_start_.assign(blocks_ + 1, 0);
    for (std::size_t l = 0; l < static_cast<std::size_t>(h_.cols); ++l) {
        // The entries by blocks; rows are sorted, so those of one block follow each other.
        std::array<int, 8> block{};
        std::array<std::array<double, 2>, 8> part{};
        std::size_t count = 0;
        for (auto e = static_cast<std::size_t>(h_.start[l]); e < static_cast<std::size_t>(h_.start[l + 1]); ++e) {
            const int b = position[static_cast<std::size_t>(h_.row[e] / 2)];
            if (count == 0 || block[count - 1] != b) {
                block[count++] = b;
            }
            part[count - 1][static_cast<std::size_t>(h_.row[e] % 2)] = h_.value[e];
        }
        for (std::size_t a = 0; a < count; ++a) {
            Block& d = diagonal_[static_cast<std::size_t>(block[a])];
            for (std::size_t c = 0; c < 2; ++c) {
                for (std::size_t r = 0; r < 2; ++r) {
                    d[2 * c + r] += part[a][r] * part[a][c];
                }
            }
            for (std::size_t b = 0; b < count; ++b) {
                if (block[b] > block[a]) {
                    unsorted.push_back({block[b],
                                        block[a],
                                        {part[b][0] * part[a][0], part[b][1] * part[a][0], part[b][0] * part[a][1],
                                         part[b][1] * part[a][1]}});
                    ++product_start_[static_cast<std::size_t>(block[a]) + 1];
                }
            }
        }
    }
    std::partial_sum(product_start_.begin(), product_start_.end(), product_start_.begin());
    products_.resize(unsorted.size());
    std::vector<int> next(product_start_.begin(), product_start_.end() - 1);
    for (const Product& product : unsorted) {
        products_[static_cast<std::size_t>(next[static_cast<std::size_t>(product.column)]++)] = product;
    }
}

/// Pattern of L: a column has the rows of its products and those of its children in the elimination tree.
void BlockCholesky::analyse() {
    std::vector<int> mark(blocks_, -1);
    std::vector<int> first_child(blocks_, -1);
    std::vector<int> next_child(blocks_, -1);
    std::vector<int> unsorted;
    unsorted.reserve(10 * blocks_);
    start_.assign(1, 0);
    start_.reserve(blocks_ + 1);
    for (std::size_t j = 0; j < blocks_; ++j) {
        const int column = static_cast<int>(j);
        mark[j] = column;
        int parent = static_cast<int>(blocks_);
        const auto add = [&](int row) {
            if (mark[static_cast<std::size_t>(row)] != column) {
                mark[static_cast<std::size_t>(row)] = column;
                unsorted.push_back(row);
                parent = std::min(parent, row);
            }
        };
        for (int p = product_start_[j]; p < product_start_[j + 1]; ++p) {
            add(products_[static_cast<std::size_t>(p)].row);
        }
        for (int child = first_child[j]; child >= 0; child = next_child[static_cast<std::size_t>(child)]) {
            const auto c = static_cast<std::size_t>(child);
            for (int p = start_[c]; p < start_[c + 1]; ++p) {
                add(unsorted[static_cast<std::size_t>(p)]);
            }
        }
        if (parent < static_cast<int>(blocks_)) {
            next_child[j] = first_child[static_cast<std::size_t>(parent)];
            first_child[static_cast<std::size_t>(parent)] = column;
        }
        start_.push_back(static_cast<int>(unsorted.size()));
    }
    // Two transpositions sort the rows of each column and list the entries of each row.
    across_start_.assign(blocks_ + 1, 0);
    for (const int row : unsorted) {
        ++across_start_[static_cast<std::size_t>(row) + 1];
    }
    std::partial_sum(across_start_.begin(), across_start_.end(), across_start_.begin());
    across_.resize(unsorted.size());
    std::vector<int> next(across_start_.begin(), across_start_.end() - 1);
    for (std::size_t j = 0; j < blocks_; ++j) {
        for (int p = start_[j]; p < start_[j + 1]; ++p) {
            const auto row = static_cast<std::size_t>(unsorted[static_cast<std::size_t>(p)]);
            across_[static_cast<std::size_t>(next[row]++)] = static_cast<int>(j);
        }
    }
    row_.resize(unsorted.size());
    column_of_.resize(unsorted.size());
    next.assign(start_.begin(), start_.end() - 1);
    for (std::size_t i = 0; i < blocks_; ++i) {
        for (int a = across_start_[i]; a < across_start_[i + 1]; ++a) {
            const int column = across_[static_cast<std::size_t>(a)];
            const int place = next[static_cast<std::size_t>(column)]++;
            row_[static_cast<std::size_t>(place)] = static_cast<int>(i);
            column_of_[static_cast<std::size_t>(place)] = column;
            across_[static_cast<std::size_t>(a)] = place;
        }
    }
}

bool BlockCholesky::factorise(double shift) {
    value_.resize(row_.size());
    pivot_.resize(blocks_);
    std::vector<int> place(blocks_, 0); // of each row in the column in work
    std::vector<Block> work;
    for (std::size_t j = 0; j < blocks_; ++j) {
        const auto begin = static_cast<std::size_t>(start_[j]);
        const auto count = static_cast<std::size_t>(start_[j + 1]) - begin;
        work.assign(count + 1, Block{});
        work[0] = diagonal_[j];
        work[0][0] -= shift;
        work[0][3] -= shift;
        place[j] = 0;
        for (std::size_t k = 0; k < count; ++k) {
            place[static_cast<std::size_t>(row_[begin + k])] = static_cast<int>(k) + 1;
        }
        for (int p = product_start_[j]; p < product_start_[j + 1]; ++p) {
            const Product& product = products_[static_cast<std::size_t>(p)];
            Block& w = work[static_cast<std::size_t>(place[static_cast<std::size_t>(product.row)])];
            for (std::size_t k = 0; k < 4; ++k) {
                w[k] += product.value[k];
            }
        }
        for (int a = across_start_[j]; a < across_start_[j + 1]; ++a) {
            const int own = across_[static_cast<std::size_t>(a)];
            const Block l = value_[static_cast<std::size_t>(own)];
            const auto end = static_cast<std::size_t>(
                start_[static_cast<std::size_t>(column_of_[static_cast<std::size_t>(own)]) + 1]);
            for (auto q = static_cast<std::size_t>(own); q < end; ++q) {
                Block& w = work[static_cast<std::size_t>(place[static_cast<std::size_t>(row_[q])])];
                const Block& m = value_[q];
                w[0] = w[0] - m[0] * l[0] - m[2] * l[2];
                w[1] = w[1] - m[1] * l[0] - m[3] * l[2];
                w[2] = w[2] - m[0] * l[1] - m[2] * l[3];
                w[3] = w[3] - m[1] * l[1] - m[3] * l[3];
            }
        }
        const double d0 = work[0][0];
        if (!(d0 > 0)) {
            return false;
        }
        const double l00 = std::sqrt(d0);
        const double l10 = work[0][1] / l00;
        const double d1 = work[0][3] - l10 * l10;
        if (!(d1 > 0)) {
            return false;
        }
        const double l11 = std::sqrt(d1);
        pivot_[j] = {l00, l10, 0, l11};
        for (std::size_t k = 0; k < count; ++k) {
            const Block& w = work[k + 1];
            Block& l = value_[begin + k];
            l[0] = w[0] / l00;
            l[1] = w[1] / l00;
            l[2] = (w[2] - l[0] * l10) / l11;
            l[3] = (w[3] - l[1] * l10) / l11;
        }
    }
    return true;
}

double BlockCholesky::error_bound(double shift) const {
    const auto n = static_cast<std::size_t>(h_.rows);
    std::vector<int> entries(n, 0);
    std::vector<double> diagonal(n, 0.0);
    for (std::size_t e = 0; e < h_.row.size(); ++e) {
        const auto row = static_cast<std::size_t>(h_.row[e]);
        ++entries[row];
        diagonal[row] += h_.value[e] * h_.value[e];
    }
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const auto block = static_cast<std::size_t>(position_[i / 2]);
        const int row_of_l = 2 * (across_start_[block + 1] - across_start_[block] + 1); // zeros in blocks counted too
        sum += gamma(entries[i] + row_of_l + 4.0) * (2 * diagonal[i] + shift);
    }
    return sum * 1.01 + 1e-290; // 1.01: second order in gamma and the rounding of this sum; 1e-290: underflow
}

} // namespace isostat
