#pragma once
/// \file
/// Sparse LU (KLU) of a contact matrix that was proved regular.

#include <isostat/rigidity/isostatic.hpp>

#include <memory>
#include <span>

namespace isostat {

/// LU factors of H. Solutions are approximate: their error is bounded by whoever uses them, from residuals (room
/// verified). A solver's own success flag is never a statement about rank; the structure is.
class Factorisation {
  public:
    template <int Dim> explicit Factorisation(const IsostaticStructure<Dim>& structure);
    ~Factorisation();
    Factorisation(Factorisation&&) noexcept;
    Factorisation& operator=(Factorisation&&) noexcept;

    /// Solves H f = F in place for `count` right-hand sides stored one after the other (size N_f each). Up to 4 at a
    /// time is the fast path.
    void solve_forces(std::span<double> rhs, int count = 1) const;
    /// Solves G v = dV (G = H^T) in place: velocities with given approach velocities.
    void solve_velocities(std::span<double> rhs, int count = 1) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

extern template Factorisation::Factorisation(const IsostaticStructure<2>&);

} // namespace isostat
