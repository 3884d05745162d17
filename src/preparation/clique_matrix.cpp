#include "preparation/clique_matrix.hpp"

#include <cholmod.h>

#include <algorithm>
#include <utility>

namespace isostat::preparation {

struct CliqueMatrix::Factor {
    Factor() {
        cholmod_start(&common);
        common.supernodal = CHOLMOD_SIMPLICIAL;
        common.final_ll = 1;
        common.print = 0;
        common.quick_return_if_not_posdef = 1;
        common.nmethods = 2; // the one with less fill: nested dissection from some thousand disks on
        common.method[0].ordering = CHOLMOD_AMD;
        common.method[1].ordering = CHOLMOD_NESDIS;
    }
    Factor(const Factor&) = delete;
    Factor& operator=(const Factor&) = delete;
    ~Factor() {
        cholmod_free_dense(&solution, &common);
        cholmod_free_dense(&work_y, &common);
        cholmod_free_dense(&work_e, &common);
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }

    cholmod_common common{};
    cholmod_sparse matrix{};
    cholmod_factor* factor = nullptr;
    cholmod_dense* solution = nullptr;
    cholmod_dense* work_y = nullptr;
    cholmod_dense* work_e = nullptr;
};

CliqueMatrix::CliqueMatrix(std::size_t columns, const std::vector<int>& start, const std::vector<int>& column)
    : start_of_(start), column_of_(column), factor_(std::make_unique<Factor>()) {
    build_pattern(columns);
    factor_->factor = cholmod_analyze(&factor_->matrix, &factor_->common);
}

CliqueMatrix::~CliqueMatrix() = default;

void CliqueMatrix::build_pattern(std::size_t columns) {
    // Lower triangle by columns, diagonal first.
    std::vector<std::pair<int, int>> entries;
    for (std::size_t k = 0; k < columns; ++k) {
        entries.emplace_back(static_cast<int>(k), static_cast<int>(k));
    }
    const auto each = [&](const auto& visit) {
        for (std::size_t l = 0; l + 1 < start_of_.size(); ++l) {
            for (int p = start_of_[l]; p < start_of_[l + 1]; ++p) {
                for (int r = start_of_[l]; r <= p; ++r) {
                    const int a = column_of_[static_cast<std::size_t>(p)];
                    const int b = column_of_[static_cast<std::size_t>(r)];
                    visit(std::min(a, b), std::max(a, b));
                }
            }
        }
    };
    each([&](int column, int row) { entries.emplace_back(column, row); });
    std::sort(entries.begin(), entries.end());
    entries.erase(std::unique(entries.begin(), entries.end()), entries.end());
    start_.assign(columns + 1, 0);
    row_.reserve(entries.size());
    for (const auto& [column, row] : entries) {
        ++start_[static_cast<std::size_t>(column) + 1];
        row_.push_back(row);
    }
    for (std::size_t k = 0; k < columns; ++k) {
        start_[k + 1] += start_[k];
    }
    value_.assign(entries.size(), 0.0);
    entries = {};
    each([&](int column, int row) {
        const auto from = row_.begin() + start_[static_cast<std::size_t>(column)];
        const auto to = row_.begin() + start_[static_cast<std::size_t>(column) + 1];
        place_.push_back(static_cast<int>(std::lower_bound(from, to, row) - row_.begin()));
    });
    cholmod_sparse& matrix = factor_->matrix;
    matrix.nrow = matrix.ncol = columns;
    matrix.nzmax = value_.size();
    matrix.p = start_.data();
    matrix.i = row_.data();
    matrix.x = value_.data();
    matrix.stype = -1;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_REAL;
    matrix.dtype = CHOLMOD_DOUBLE;
    matrix.sorted = 1;
    matrix.packed = 1;
}

bool CliqueMatrix::factorise() {
    cholmod_factor* const factor = factor_->factor;
    return factor != nullptr && cholmod_factorize(&factor_->matrix, factor, &factor_->common) != 0 &&
           factor_->common.status == CHOLMOD_OK && factor->minor == factor->n;
}

bool CliqueMatrix::solve(std::vector<double>& b) {
    cholmod_dense right{};
    right.nrow = right.nzmax = right.d = b.size();
    right.ncol = 1;
    right.x = b.data();
    right.xtype = CHOLMOD_REAL;
    right.dtype = CHOLMOD_DOUBLE;
    Factor& f = *factor_;
    if (cholmod_solve2(CHOLMOD_A, f.factor, &right, nullptr, &f.solution, nullptr, &f.work_y, &f.work_e, &f.common) ==
        0) {
        return false;
    }
    const auto* const x = static_cast<const double*>(f.solution->x);
    std::copy_n(x, b.size(), b.begin());
    return true;
}

} // namespace isostat::preparation
