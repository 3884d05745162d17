#pragma once
// Forces, ranks and inverses of contact matrices over the rationals, by FLINT: shares nothing with the library.

#include "oracle/random.hpp"

#include <isostat/contact/state.hpp>

#include <flint/fmpz_mat.h>
#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
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
        for (std::size_t l = 0; l < cols_; ++l) {
            const Contact& c = contacts[l];
            std::vector<std::pair<int, mpq_class>> column;
            mpq_class square = 1;
            if (c.kind == ContactKind::disk_disk) {
                const mpq_class dx = mpq_class(packing.q[at(2 * c.j)]) - mpq_class(packing.q[at(2 * c.i)]);
                const mpq_class dy = mpq_class(packing.q[at(2 * c.j + 1)]) - mpq_class(packing.q[at(2 * c.i + 1)]);
                square = dx * dx + dy * dy;
                column = {{2 * c.i, dx}, {2 * c.i + 1, dy}, {2 * c.j, -dx}, {2 * c.j + 1, -dy}};
            } else if (c.kind == ContactKind::lower_wall) {
                column = {{2 * c.i + c.j, mpq_class(-1)}};
            } else if (c.kind == ContactKind::upper_wall) {
                column = {{2 * c.i + c.j, mpq_class(1)}, {2 * packing.disk_count() + c.j, mpq_class(-1)}};
            } else {
                column = {{c.i, mpq_class(-1)}};
            }
            mpz_class common = 1;
            for (const auto& entry : column) {
                common = lcm(common, mpz_class(entry.second.get_den()));
            }
            for (const auto& [coordinate, value] : column) {
                const int dof = dofs.dof_of(at(coordinate));
                if (dof >= 0) {
                    const mpq_class integer = value * common;
                    fmpz_set_mpz(fmpz_mat_entry(a_, dof, static_cast<slong>(l)), integer.get_num_mpz_t());
                }
            }
            scale_.emplace_back(common);
            square_.push_back(square);
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
        fmpz_mat_t b;
        fmpz_mat_t x;
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
            mpz_class n;
            mpz_class d;
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
    static std::size_t at(int k) { return static_cast<std::size_t>(k); }
    std::size_t rows_ = 0;
    std::size_t cols_ = 0;
    fmpz_mat_t a_;
    std::vector<mpz_class> scale_;
    std::vector<mpq_class> square_;
};

/// Forces of a structure in which every free disk rests on two earlier ones (contacts 2k and 2k + 1 belong to the k-th
/// free disk), from the last disk to the first, two equations at a time. Relative error about cond 2^-bits.
inline std::vector<mpf_class> resting_forces(const Packing& packing, const std::vector<Contact>& contacts,
                                             const std::vector<double>& force, unsigned bits) {
    const DofMap dofs(packing);
    std::vector<mpf_class> load(packing.q.size(), mpf_class(0, bits)); // still to be carried, by coordinate
    for (std::size_t mu = 0; mu < force.size(); ++mu) {
        load[static_cast<std::size_t>(dofs.coordinate_of(static_cast<int>(mu)))] = force[mu];
    }
    std::vector<mpf_class> f(contacts.size(), mpf_class(0, bits));
    for (std::size_t k = contacts.size() / 2; k-- > 0;) {
        // Both contacts are (support, disk): H has -d/|d| in the rows of the disk, d from support to disk.
        std::array<std::array<mpf_class, 2>, 2> normal;
        for (std::size_t c = 0; c < 2; ++c) {
            const Contact& contact = contacts[2 * k + c];
            const auto i = static_cast<std::size_t>(2 * contact.i);
            const auto j = static_cast<std::size_t>(2 * contact.j);
            mpf_class x(packing.q[j], bits);
            mpf_class y(packing.q[j + 1], bits);
            x -= packing.q[i];
            y -= packing.q[i + 1];
            const mpf_class square = x * x + y * y;
            const mpf_class length = sqrt(square);
            normal[c] = {mpf_class(x / length), mpf_class(y / length)};
        }
        const auto j = static_cast<std::size_t>(2 * contacts[2 * k].j);
        const mpf_class determinant = normal[0][0] * normal[1][1] - normal[1][0] * normal[0][1];
        f[2 * k] = -(load[j] * normal[1][1] - load[j + 1] * normal[1][0]) / determinant;
        f[2 * k + 1] = -(load[j + 1] * normal[0][0] - load[j] * normal[0][1]) / determinant;
        for (std::size_t c = 0; c < 2; ++c) {
            const auto i = static_cast<std::size_t>(2 * contacts[2 * k + c].i);
            load[i] -= f[2 * k + c] * normal[c][0];
            load[i + 1] -= f[2 * k + c] * normal[c][1];
        }
    }
    return f;
}

} // namespace isostat::oracle
