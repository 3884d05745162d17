#pragma once
// The units of the tables: what other codes take for the same matrix.

#include "sparse/pattern.hpp"

#include <isostat/contact/state.hpp>

#include <umfpack.h>

#include <array>

namespace bench {

/// UMFPACK's own choice of an order, or nested dissection.
enum class FillReducing { chosen, metis };
/// Nested dissection for spheres, whose factors fill less with it.
FillReducing order_of(const isostat::State& state);

/// One analysis and one factorisation of the matrix, factors thrown away.
void klu(const isostat::sparse::Matrix<double>& matrix);
void umfpack(const isostat::sparse::Matrix<double>& matrix, FillReducing order = FillReducing::chosen);

/// The analysis alone, and the factorisation with an analysis at hand.
class KluAnalysis {
  public:
    explicit KluAnalysis(const isostat::sparse::Matrix<double>& matrix);
    ~KluAnalysis();
    KluAnalysis(const KluAnalysis&) = delete;
    KluAnalysis& operator=(const KluAnalysis&) = delete;
    /// Entries of L and U; 0 when the matrix was found singular.
    int factorise() const;

  private:
    const isostat::sparse::Matrix<double>& matrix_;
    void* symbolic_;
};
class UmfpackAnalysis {
  public:
    explicit UmfpackAnalysis(const isostat::sparse::Matrix<double>& matrix, FillReducing order = FillReducing::chosen);
    ~UmfpackAnalysis();
    UmfpackAnalysis(const UmfpackAnalysis&) = delete;
    UmfpackAnalysis& operator=(const UmfpackAnalysis&) = delete;
    /// Entries of L and U together.
    long factorise() const;

  private:
    const isostat::sparse::Matrix<double>& matrix_;
    std::array<double, UMFPACK_CONTROL> control_{};
    void* symbolic_ = nullptr;
};

/// Of the contacts of a state.
isostat::sparse::Matrix<double> matrix_of(const isostat::State& state);

} // namespace bench
