#include "preparation/dense_panel.hpp"

#include "core/wide.hpp"

#include <isostat/core/threads.hpp>

#include <algorithm>
#include <cmath>

namespace isostat::preparation {

namespace {

constexpr std::size_t lanes = 4;
constexpr std::size_t tile = 4;       ///< columns
constexpr std::size_t panel_step = 8; ///< columns of a panel that are finished together
/// Multiplications below which another thread is not worth waking.
constexpr double worth_a_thread = 2e5;

/// `Vectors` times four rows, four columns.
template <std::size_t Vectors> ISOSTAT_WITHIN_WIDE void tile_of(const ProductSum& p, std::size_t i, std::size_t j) {
    Wide sum[tile][Vectors];
    for (std::size_t c = 0; c < tile; ++c) {
        for (std::size_t v = 0; v < Vectors; ++v) {
            read(sum[c][v], p.c + i + lanes * v + p.ldc * (j + c));
        }
    }
    const double* a = p.a + i;
    const double* b = p.b + j;
    for (std::size_t k = 0; k < p.terms; ++k, a += p.lda, b += p.ldb) {
        Wide left[Vectors];
        for (std::size_t v = 0; v < Vectors; ++v) {
            read(left[v], a + lanes * v);
        }
        for (std::size_t c = 0; c < tile; ++c) {
            const Wide right = {b[c], b[c], b[c], b[c]};
            for (std::size_t v = 0; v < Vectors; ++v) {
                sum[c][v] = sum[c][v] - left[v] * right;
            }
        }
    }
    for (std::size_t c = 0; c < tile; ++c) {
        for (std::size_t v = 0; v < Vectors; ++v) {
            write(p.c + i + lanes * v + p.ldc * (j + c), sum[c][v]);
        }
    }
}

/// Rows [first, last) of the columns [begin, end).
ISOSTAT_WITHIN_WIDE void remainder(const ProductSum& p, std::size_t first, std::size_t last, std::size_t begin,
                                   std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
        for (std::size_t i = first; i < last; ++i) {
            double sum = p.c[i + p.ldc * j];
            for (std::size_t k = 0; k < p.terms; ++k) {
                sum -= p.a[i + p.lda * k] * p.b[j + p.ldb * k];
            }
            p.c[i + p.ldc * j] = sum;
        }
    }
}

/// Columns [begin, end); `lower`: from the tile of the diagonal on.
ISOSTAT_WIDE
void subtract_columns(const ProductSum& p, std::size_t begin, std::size_t end, bool lower) {
    std::size_t j = begin;
    for (; j + tile <= end; j += tile) {
        std::size_t i = lower ? j : 0;
        for (; i + 2 * lanes <= p.rows; i += 2 * lanes) {
            tile_of<2>(p, i, j);
        }
        for (; i + lanes <= p.rows; i += lanes) {
            tile_of<1>(p, i, j);
        }
        remainder(p, i, p.rows, j, j + tile);
    }
    for (; j < end; ++j) {
        remainder(p, lower ? j : 0, p.rows, j, j + 1);
    }
}

/// y -= x factor
ISOSTAT_WITHIN_WIDE void subtract_multiple(double* y, const double* x, double factor, std::size_t count) {
    const Wide by = {factor, factor, factor, factor};
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        Wide a;
        Wide b;
        read(a, y + i);
        read(b, x + i);
        a = a - b * by;
        write(y + i, a);
    }
    for (; i < count; ++i) {
        y[i] -= x[i] * factor;
    }
}

/// Four partial sums, then the rest.
ISOSTAT_WITHIN_WIDE double product(const double* x, const double* y, std::size_t count) {
    Wide sum = {0, 0, 0, 0};
    std::size_t i = 0;
    for (; i + lanes <= count; i += lanes) {
        Wide a;
        Wide b;
        read(a, x + i);
        read(b, y + i);
        sum = sum + a * b;
    }
    double total = (sum[0] + sum[1]) + (sum[2] + sum[3]);
    for (; i < count; ++i) {
        total += x[i] * y[i];
    }
    return total;
}

/// Columns [begin, end) of a panel of which those before are finished, and the contributions of these subtracted.
ISOSTAT_WIDE
bool finish_columns(double* panel, std::size_t rows, std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
        double* const own = panel + rows * j;
        for (std::size_t k = begin; k < j; ++k) {
            const double* const before = panel + rows * k;
            subtract_multiple(own + j, before + j, before[j], rows - j);
        }
        if (!(own[j] > 0)) {
            return false;
        }
        const double pivot = std::sqrt(own[j]);
        const double by = 1 / pivot;
        own[j] = pivot;
        for (std::size_t i = j + 1; i < rows; ++i) {
            own[i] *= by;
        }
    }
    return true;
}

} // namespace

void ProductSum::subtract() const {
    subtract_columns(*this, 0, columns, false);
}

void ProductSum::subtract_lower() const {
    const double work = 0.5 * static_cast<double>(rows) * static_cast<double>(columns) * static_cast<double>(terms);
    if (work < worth_a_thread) {
        subtract_columns(*this, 0, columns, true);
        return;
    }
    const Pieces pieces{columns, 16 * tile};
    parallel_pieces(pieces.count(),
                    [&](std::size_t k) { subtract_columns(*this, pieces.first(k), pieces.last(k), true); });
}

bool factorise_panel(double* panel, std::size_t rows, std::size_t columns) {
    for (std::size_t begin = 0; begin < columns; begin += panel_step) {
        const std::size_t end = std::min(columns, begin + panel_step);
        if (begin > 0) {
            const std::size_t left = rows - begin;
            const Pieces pieces{left, 128};
            const auto part = [&](std::size_t first, std::size_t last) {
                ProductSum{panel + begin + first + rows * begin,
                           rows,
                           panel + begin + first,
                           rows,
                           panel + begin,
                           rows,
                           last - first,
                           end - begin,
                           begin}
                    .subtract();
            };
            if (static_cast<double>(left) * static_cast<double>(end - begin) * static_cast<double>(begin) <
                worth_a_thread) {
                part(0, left);
            } else {
                parallel_pieces(pieces.count(), [&](std::size_t k) { part(pieces.first(k), pieces.last(k)); });
            }
        }
        if (!finish_columns(panel, rows, begin, end)) {
            return false;
        }
    }
    return true;
}

ISOSTAT_WIDE
void solve_panel(const double* panel, std::size_t rows, std::size_t columns, double* x) {
    for (std::size_t j = 0; j < columns; ++j) {
        const double* const l = panel + rows * j;
        x[j] /= l[j];
        subtract_multiple(x + j + 1, l + j + 1, x[j], rows - j - 1);
    }
}

ISOSTAT_WIDE
void solve_panel_transposed(const double* panel, std::size_t rows, std::size_t columns, double* x) {
    for (std::size_t j = columns; j-- > 0;) {
        const double* const l = panel + rows * j;
        x[j] = (x[j] - product(l + j + 1, x + j + 1, rows - j - 1)) / l[j];
    }
}

} // namespace isostat::preparation
