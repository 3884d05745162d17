#include "bench/shared/references.hpp"

#include "rigidity/isostatic.hpp"

#include <klu.h>
#include <umfpack.h>

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

void umfpack(const Matrix<double>& matrix) {
    UmfpackAnalysis(matrix).factorise();
}

UmfpackAnalysis::UmfpackAnalysis(const Matrix<double>& matrix) : matrix_(matrix) {
    umfpack_di_symbolic(matrix.rows, matrix.cols, matrix.start.data(), matrix.row.data(), matrix.value.data(),
                        &symbolic_, nullptr, nullptr);
}

UmfpackAnalysis::~UmfpackAnalysis() {
    umfpack_di_free_symbolic(&symbolic_);
}

void UmfpackAnalysis::factorise() const {
    void* numeric = nullptr;
    umfpack_di_numeric(matrix_.start.data(), matrix_.row.data(), matrix_.value.data(), symbolic_, &numeric, nullptr,
                       nullptr);
    umfpack_di_free_numeric(&numeric);
}

Matrix<double> matrix_of(const isostat::State& state) {
    return isostat::contact_matrix(state.packing, isostat::DofMap(state.packing), state.contacts);
}

} // namespace bench
