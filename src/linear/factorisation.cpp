#include <isostat/core/work.hpp>
#include <isostat/linear/factorisation.hpp>

#include <klu.h>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace isostat {

struct Factorisation::Implementation {
    klu_common common{};
    std::shared_ptr<void> analysis; ///< keeps `symbolic` alive
    klu_symbolic* symbolic = nullptr;
    klu_numeric* numeric = nullptr;
    int n = 0;
    Implementation() = default;
    Implementation(const Implementation&) = delete;
    Implementation& operator=(const Implementation&) = delete;
    ~Implementation() { klu_free_numeric(&numeric, &common); }
};

template <int Dim>
Factorisation::Factorisation(const IsostaticStructure<Dim>& structure)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    const sparse::Matrix<double>& matrix = structure.matrix();
    count_work(Work::factorisations);
    klu_defaults(&self.common);
    // Unit columns need no scaling, and without it nothing depends on the size of the numbers.
    self.common.scale = 0;
    // A regular matrix may still underflow to a zero pivot: keep going, the residual bounds of the users will tell.
    self.common.halt_if_singular = 0;
    self.n = matrix.rows;
    // KLU's interface is not const-correct; it does not write to the pattern or the values.
    auto* start = const_cast<int*>(matrix.start.data());    // NOLINT(cppcoreguidelines-pro-type-const-cast)
    auto* row = const_cast<int*>(matrix.row.data());        // NOLINT(cppcoreguidelines-pro-type-const-cast)
    auto* value = const_cast<double*>(matrix.value.data()); // NOLINT(cppcoreguidelines-pro-type-const-cast)
    self.analysis = structure.ordering().symbolic();
    self.symbolic = static_cast<klu_symbolic*>(self.analysis.get());
    self.numeric = klu_factor(start, row, value, self.symbolic, &self.common);
}

Factorisation::~Factorisation() = default;
Factorisation::Factorisation(Factorisation&&) noexcept = default;
Factorisation& Factorisation::operator=(Factorisation&&) noexcept = default;

void Factorisation::solve_forces(std::span<double> rhs, int count) const {
    assert(rhs.size() == static_cast<std::size_t>(implementation_->n) * static_cast<std::size_t>(count));
    if (implementation_->numeric == nullptr) {
        std::fill(rhs.begin(), rhs.end(), std::nan("")); // out of memory: every bound fails, nothing is decided
        return;
    }
    klu_solve(implementation_->symbolic, implementation_->numeric, implementation_->n, count, rhs.data(),
              &implementation_->common);
}

void Factorisation::solve_velocities(std::span<double> rhs, int count) const {
    assert(rhs.size() == static_cast<std::size_t>(implementation_->n) * static_cast<std::size_t>(count));
    if (implementation_->numeric == nullptr) {
        std::fill(rhs.begin(), rhs.end(), std::nan(""));
        return;
    }
    klu_tsolve(implementation_->symbolic, implementation_->numeric, implementation_->n, count, rhs.data(),
               &implementation_->common);
}

template Factorisation::Factorisation(const IsostaticStructure<2>&);

} // namespace isostat
