#include "bench/shared/references.hpp"

#include "rigidity/isostatic.hpp"

#include <klu.h>

namespace bench {

using isostat::sparse::Matrix;

namespace {

/// KLU takes pointers to what it only reads.
int* data(const std::vector<int>& x) {
    return const_cast<int*>(x.data());
}
double* data(const std::vector<double>& x) {
    return const_cast<double*>(x.data());
}

klu_common defaults() {
    klu_common common;
    klu_defaults(&common);
    return common;
}

} // namespace

FillReducing order_of(const isostat::State& state) {
    return state.packing.dimension == isostat::plane ? FillReducing::chosen : FillReducing::metis;
}

void klu(const Matrix<double>& matrix) {
    (void)KluAnalysis(matrix).factorise();
}

KluAnalysis::KluAnalysis(const Matrix<double>& matrix) : matrix_(matrix) {
    klu_common common = defaults();
    symbolic_ = klu_analyze(matrix.rows, data(matrix.start), data(matrix.row), &common);
}

KluAnalysis::~KluAnalysis() {
    klu_common common = defaults();
    auto* symbolic = static_cast<klu_symbolic*>(symbolic_);
    klu_free_symbolic(&symbolic, &common);
}

int KluAnalysis::factorise() const {
    klu_common common = defaults();
    klu_numeric* numeric = klu_factor(data(matrix_.start), data(matrix_.row), data(matrix_.value),
                                      static_cast<klu_symbolic*>(symbolic_), &common);
    const int entries = numeric == nullptr || common.status != KLU_OK ? 0 : numeric->lnz + numeric->unz;
    klu_free_numeric(&numeric, &common);
    return entries;
}

void umfpack(const Matrix<double>& matrix, FillReducing order) {
    UmfpackAnalysis(matrix, order).factorise();
}

UmfpackAnalysis::UmfpackAnalysis(const Matrix<double>& matrix, FillReducing order) : matrix_(matrix) {
    umfpack_di_defaults(control_.data());
    if (order == FillReducing::metis) {
        control_[UMFPACK_ORDERING] = UMFPACK_ORDERING_METIS;
    }
    umfpack_di_symbolic(matrix.rows, matrix.cols, matrix.start.data(), matrix.row.data(), matrix.value.data(),
                        &symbolic_, control_.data(), nullptr);
}

UmfpackAnalysis::~UmfpackAnalysis() {
    umfpack_di_free_symbolic(&symbolic_);
}

long UmfpackAnalysis::factorise() const {
    void* numeric = nullptr;
    std::array<double, UMFPACK_INFO> info{};
    umfpack_di_numeric(matrix_.start.data(), matrix_.row.data(), matrix_.value.data(), symbolic_, &numeric,
                       control_.data(), info.data());
    umfpack_di_free_numeric(&numeric);
    return static_cast<long>(info[UMFPACK_LNZ] + info[UMFPACK_UNZ]);
}

Matrix<double> matrix_of(const isostat::State& state) {
    return isostat::contact_matrix(state.packing, isostat::DofMap(state.packing), state.contacts);
}

} // namespace bench
