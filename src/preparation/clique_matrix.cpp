#include "preparation/clique_matrix.hpp"

#include <cholmod.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <utility>

namespace isostat::preparation {

/// CHOLMOD's factor, and the arrays that its solves reuse.
struct CliqueMatrix::Factors {
    cholmod_common common{};
    cholmod_sparse matrix{};
    cholmod_factor* factor = nullptr;
    cholmod_dense* solution = nullptr;
    cholmod_dense* permuted = nullptr;
    cholmod_dense* unused = nullptr;

    Factors(std::vector<int>& first, std::vector<int>& row, std::vector<double>& value) {
        cholmod_start(&common);
        common.supernodal = CHOLMOD_SIMPLICIAL;
        common.final_ll = 1; // L L^T: a pivot that is not positive ends the factorisation
        common.print = 0;
        common.nmethods = 2; // the method with less fill: nested dissection from some thousand disks on
        common.method[0].ordering = CHOLMOD_AMD;
        common.method[1].ordering = CHOLMOD_NESDIS;
        matrix.nrow = matrix.ncol = first.size() - 1;
        matrix.nzmax = row.size();
        matrix.p = first.data();
        matrix.i = row.data();
        matrix.x = value.data();
        matrix.stype = -1;
        matrix.itype = CHOLMOD_INT;
        matrix.xtype = CHOLMOD_REAL;
        matrix.dtype = CHOLMOD_DOUBLE;
        matrix.sorted = 1;
        matrix.packed = 1;
        factor = cholmod_analyze(&matrix, &common);
        if (factor == nullptr) {
            cholmod_finish(&common);
            throw std::bad_alloc();
        }
    }
    Factors(const Factors&) = delete;
    Factors& operator=(const Factors&) = delete;
    ~Factors() {
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&permuted, &common);
        cholmod_free_dense(&unused, &common);
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
};

CliqueMatrix::CliqueMatrix(std::size_t columns, const std::vector<int>& start, const std::vector<int>& column)
    : block_start_(start) {
    std::vector<std::pair<int, int>> entries; // indices of blocks: column, row
    for (std::size_t l = 0; l + 1 < start.size(); ++l) {
        for (int p = start[l]; p < start[l + 1]; ++p) {
            for (int r = start[l]; r <= p; ++r) {
                entries.emplace_back(
                    std::minmax(column[static_cast<std::size_t>(p)], column[static_cast<std::size_t>(r)]));
            }
        }
    }
    std::vector<std::pair<int, int>> pattern = entries;
    for (std::size_t k = 0; k < columns; ++k) {
        pattern.emplace_back(static_cast<int>(k), static_cast<int>(k));
    }
    std::ranges::sort(pattern);
    pattern.erase(std::unique(pattern.begin(), pattern.end()), pattern.end());
    first_.assign(columns + 1, 0);
    for (const auto& [of, row] : pattern) {
        ++first_[static_cast<std::size_t>(of) + 1];
        row_.push_back(row);
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    for (const std::pair<int, int>& entry : entries) {
        const auto at = std::ranges::lower_bound(pattern, entry);
        place_.push_back(static_cast<std::size_t>(at - pattern.begin()));
    }
    value_.resize(row_.size());
    factors_ = std::make_unique<Factors>(first_, row_, value_);
}

CliqueMatrix::~CliqueMatrix() = default;

bool CliqueMatrix::factorise() {
    Factors& f = *factors_;
    if (cholmod_factorize(&f.matrix, f.factor, &f.common) == 0 && f.common.status == CHOLMOD_OUT_OF_MEMORY) {
        throw std::bad_alloc();
    }
    return f.common.status == CHOLMOD_OK && f.factor->minor == f.matrix.ncol;
}

void CliqueMatrix::solve(std::vector<double>& b) {
    Factors& f = *factors_;
    cholmod_dense right{};
    right.nrow = right.d = right.nzmax = b.size();
    right.ncol = 1;
    right.x = b.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    if (cholmod_solve2(CHOLMOD_A, f.factor, &right, nullptr, &f.solution, nullptr, &f.permuted, &f.unused, &f.common) ==
        0) {
        throw std::bad_alloc();
    }
    std::copy_n(static_cast<const double*>(f.solution->x), b.size(), b.begin());
}

} // namespace isostat::preparation
