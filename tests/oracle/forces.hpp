#pragma once
// Forces, ranks and inverses of contact matrices over the rationals, by FLINT: shares nothing with the library.

#include "oracle/geometry.hpp"

#include <flint/fmpz_mat.h>
#include <gmpxx.h>

#include <vector>

namespace isostat::oracle {

/// The contact matrix with column l multiplied by `scale[l]` and by the distance of the centres: integers. So
/// f_l = scale_l sqrt(square_l) x_l when A x = F, square_l the squared distance.
class IntegerSystem {
  public:
    IntegerSystem(const Packing& packing, const std::vector<Contact>& contacts) {
        const DofMap dofs(packing);
        rows_ = static_cast<std::size_t>(dofs.dof_count());
        cols_ = contacts.size();
        fmpz_mat_init(a_, static_cast<slong>(rows_), static_cast<slong>(cols_));
        const Geometry<mpq_class> geometry(packing);
        for (std::size_t l = 0; l < cols_; ++l) {
            const Contact& c = contacts[l];
            const bool pair = Geometry<mpq_class>::is_pair(c);
            mpz_class common = 1;
            geometry.gradient(c, mpq_class(1), [&](std::size_t, const mpq_class& value) {
                common = lcm(common, mpz_class(value.get_den()));
            });
            geometry.gradient(c, mpq_class(1), [&](std::size_t coordinate, const mpq_class& value) {
                const int dof = dofs.dof_of(coordinate);
                if (dof >= 0) {
                    const mpq_class integer = -value * common;
                    fmpz_set_mpz(fmpz_mat_entry(a_, dof, static_cast<slong>(l)), integer.get_num_mpz_t());
                }
            });
            scale_.emplace_back(common);
            square_.push_back(pair ? Geometry<mpq_class>::square(geometry.between(c)) : mpq_class(1));
        }
    }
    IntegerSystem(const IntegerSystem&) = delete;
    IntegerSystem& operator=(const IntegerSystem&) = delete;
    ~IntegerSystem() { fmpz_mat_clear(a_); }

    [[nodiscard]] int rank() const { return static_cast<int>(fmpz_mat_rank(a_)); }

    /// x with f_l = x_l sqrt(square_l); only for regular square systems. Empty when FLINT finds it singular.
    [[nodiscard]] std::vector<mpq_class> solve(const std::vector<mpq_class>& force) const {
        mpz_class common = 1;
        for (const mpq_class& f : force) {
            common = lcm(common, mpz_class(f.get_den()));
        }
        fmpz_mat_t b, x;
        fmpz_t denominator;
        fmpz_mat_init(b, static_cast<slong>(rows_), 1);
        fmpz_mat_init(x, static_cast<slong>(cols_), 1);
        fmpz_init(denominator);
        for (std::size_t i = 0; i < rows_; ++i) {
            const mpq_class integer = force[i] * common;
            fmpz_set_mpz(fmpz_mat_entry(b, static_cast<slong>(i), 0), integer.get_num_mpz_t());
        }
        std::vector<mpq_class> solution;
        if (fmpz_mat_solve(x, denominator, a_, b) != 0) {
            mpz_class n, d;
            fmpz_get_mpz(d.get_mpz_t(), denominator);
            d *= common;
            for (std::size_t l = 0; l < cols_; ++l) {
                fmpz_get_mpz(n.get_mpz_t(), fmpz_mat_entry(x, static_cast<slong>(l), 0));
                mpq_class value(mpz_class(n * scale_[l]), d);
                value.canonicalize();
                solution.push_back(value);
            }
        }
        fmpz_mat_clear(b);
        fmpz_mat_clear(x);
        fmpz_clear(denominator);
        return solution;
    }
    [[nodiscard]] const std::vector<mpq_class>& square() const { return square_; }

    static constexpr unsigned bits = 4600; ///< of references: any two doubles and their sums, and as much again
    /// x sqrt(square), to about `bits` bits.
    [[nodiscard]] mpf_class value(const mpq_class& x, std::size_t l) const {
        mpf_class root(square_[l], bits);
        root = sqrt(root);
        return mpf_class(mpf_class(x, bits) * root);
    }
    /// Sign of f_l - f_m.
    [[nodiscard]] int compare(const mpq_class& x, std::size_t l, const mpq_class& y, std::size_t m) const {
        const mpq_class a = x * abs(x) * square_[l];
        const mpq_class b = y * abs(y) * square_[m];
        return cmp(a, b) < 0 ? -1 : cmp(a, b) > 0 ? 1 : 0;
    }

  private:
    std::size_t rows_ = 0, cols_ = 0;
    fmpz_mat_t a_;
    std::vector<mpz_class> scale_;
    std::vector<mpq_class> square_;
};

} // namespace isostat::oracle
