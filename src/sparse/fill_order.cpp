#include "sparse/pattern.hpp"

#include <cholmod.h>
#include <klu.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <new>

namespace isostat::sparse {

namespace {

/// CHOLMOD's memory, freed at the end.
class Cholmod {
  public:
    Cholmod() { cholmod_start(&common_); }
    Cholmod(const Cholmod&) = delete;
    Cholmod& operator=(const Cholmod&) = delete;
    ~Cholmod() {
        cholmod_free_sparse(&transposed_, &common_);
        cholmod_free_sparse(&sum_, &common_);
        cholmod_free_sparse(&half_, &common_);
        cholmod_finish(&common_);
    }

    /// Orders A A^T when `stype` of the matrix is 0, else the
    /// symmetric matrix of which A is one half. False: out of memory.
    bool dissect(cholmod_sparse& matrix, int* order) {
        static std::mutex one_at_a_time; // METIS seeds `rand` and draws from it
        const std::scoped_lock lock(one_at_a_time);
        return cholmod_metis(&matrix, nullptr, 0, 1, order, &common_) != 0;
    }
    /// One half of the pattern of A + A^T; null: out of memory.
    cholmod_sparse* symmetric(cholmod_sparse& matrix) {
        std::array<double, 2> one{1, 0};
        transposed_ = cholmod_transpose(&matrix, 0, &common_);
        if (transposed_ != nullptr) {
            sum_ = cholmod_add(&matrix, transposed_, one.data(), one.data(), 0, 1, &common_);
        }
        if (sum_ != nullptr) {
            sum_->stype = 1; // both halves are stored, and CHOLMOD ignores the lower one
            half_ = cholmod_copy(sum_, 1, 0, &common_);
        }
        return half_;
    }

  private:
    cholmod_common common_{};
    cholmod_sparse* transposed_ = nullptr;
    cholmod_sparse* sum_ = nullptr;
    cholmod_sparse* half_ = nullptr;
};

cholmod_sparse pattern(int rows, int columns, int* start, int* row) {
    cholmod_sparse matrix{};
    matrix.nrow = static_cast<std::size_t>(rows);
    matrix.ncol = static_cast<std::size_t>(columns);
    matrix.nzmax = static_cast<std::size_t>(start[columns]);
    matrix.p = start;
    matrix.i = row;
    matrix.itype = CHOLMOD_INT;
    matrix.xtype = CHOLMOD_PATTERN;
    matrix.packed = 1;
    return matrix;
}

/// Ordering function for KLU; 0: out of memory.
int dissection(int n, int* start, int* row, int* order, klu_common* /*common*/) {
    cholmod_sparse matrix = pattern(n, n, start, row);
    Cholmod cholmod;
    cholmod_sparse* half = cholmod.symmetric(matrix);
    return half != nullptr && cholmod.dissect(*half, order) ? 1 : 0;
}

/// The same, of the columns that share a row; no exception passes KLU, which has memory to free.
int columns(int n, int* start, int* row, int* order, klu_common* /*common*/) {
    const auto size = static_cast<std::size_t>(n);
    try {
        const std::vector<int> found =
            dissection_of_columns(n, {start, size + 1}, {row, static_cast<std::size_t>(start[n])});
        std::ranges::copy(found, order);
    } catch (const std::bad_alloc&) {
        return 0;
    }
    return 1;
}

} // namespace

void choose_order(klu_common& common, int rows, int entries) {
    constexpr int amd = 0;
    constexpr int colamd = 1;
    constexpr int by_function = 3;
    constexpr int many = 200'000; // rows
    const bool spheres = worth_dissection(rows, entries);
    common.ordering = spheres || rows >= many ? by_function : rows > 20000 ? colamd : amd;
    common.user_order = spheres ? dissection : columns;
}

std::vector<int> dissection_of_columns(int rows, std::span<const int> start, std::span<const int> row) {
    std::vector<std::vector<int>> columns_of(static_cast<std::size_t>(rows));
    for (std::size_t c = 0; c + 1 < start.size(); ++c) {
        for (int e = start[c]; e < start[c + 1]; ++e) {
            columns_of[static_cast<std::size_t>(row[static_cast<std::size_t>(e)])].push_back(static_cast<int>(c));
        }
    }
    std::vector<int> start_of_row{0};
    std::vector<int> list;
    for (const std::vector<int>& some : columns_of) {
        if (some.size() * some.size() < 100 * (start.size() - 1)) {
            list.insert(list.end(), some.begin(), some.end());
            start_of_row.push_back(static_cast<int>(list.size()));
        }
    }
    return dissection_of_products(static_cast<int>(start.size()) - 1, start_of_row, list);
}

std::vector<int> dissection_of_products(int rows, std::span<const int> start, std::span<const int> row) {
    // CHOLMOD's interface is not const-correct; the pattern is only read.
    cholmod_sparse matrix = pattern(rows, static_cast<int>(start.size()) - 1,
                                    const_cast<int*>(start.data()), // NOLINT(cppcoreguidelines-pro-type-const-cast)
                                    const_cast<int*>(row.data()));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
    std::vector<int> order(static_cast<std::size_t>(rows));
    if (Cholmod cholmod; !cholmod.dissect(matrix, order.data())) {
        throw std::bad_alloc();
    }
    return order;
}

} // namespace isostat::sparse
