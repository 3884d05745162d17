#pragma once
/// \file
/// The gate: a contact list whose matrix was proved regular.

#include <isostat/contact/contact.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>
#include <isostat/sparse/pattern.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace isostat {

/// Contact matrix H (N_f x N, column l = minus the gap gradient of contact l, unit normals, rows = degrees of freedom;
/// exact zeros are not stored). H f = F_ext; G = H^T gives approach velocities.
template <int Dim>
sparse::Matrix<double> contact_matrix(const Packing<Dim>& packing, const DofMap<Dim>& dofs,
                                      const std::vector<Contact>& contacts);

/// The same matrix exactly, mod 2^61 - 1: every column multiplied by the distance of the centres (entries x_j - x_i of
/// the stored doubles, no rounding, no square root), which keeps the rank. Same pattern as `contact_matrix`.
template <int Dim>
sparse::Matrix<std::uint64_t> exact_contact_matrix(const Packing<Dim>& packing, const DofMap<Dim>& dofs,
                                                   const std::vector<Contact>& contacts);

/// A configuration with N = N_f contacts (held coordinates count as contacts) whose contact matrix, built from the
/// *stored* coordinates (dyadic rationals) without any rounding, has full rank: proved by elimination mod p (statement
/// T4). So h = k = 0. Only `prove` makes one: every double-precision solve asks for it, hence none can be done without
/// the proof. It says nothing of the true equilibrium near the stored configuration.
template <int Dim> class IsostaticStructure {
  public:
    /// `not_isostatic` when N != N_f, when the pattern is structurally singular, or when the rank mod 2^61 - 1 is
    /// deficient (the message gives N_f, N and the rank found; a deficiency mod p is evidence, chance n/p ~ 4e-15 of
    /// being false, not proof). Cost: one symbolic analysis + one elimination mod p, about 10 ms at n = 4900.
    static Result<IsostaticStructure> prove(const Packing<Dim>& packing, std::vector<Contact> contacts);

    [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
    [[nodiscard]] const DofMap<Dim>& dofs() const { return *dofs_; }
    [[nodiscard]] const sparse::Matrix<double>& matrix() const { return matrix_; }
    [[nodiscard]] const sparse::Ordering& ordering() const { return *ordering_; }
    [[nodiscard]] int size() const { return matrix_.rows; }

  private:
    IsostaticStructure() = default;
    std::vector<Contact> contacts_;
    std::shared_ptr<const DofMap<Dim>> dofs_;
    std::shared_ptr<const sparse::Ordering> ordering_;
    sparse::Matrix<double> matrix_;
};

extern template sparse::Matrix<double> contact_matrix<2>(const Packing<2>&, const DofMap<2>&,
                                                         const std::vector<Contact>&);
extern template sparse::Matrix<std::uint64_t> exact_contact_matrix<2>(const Packing<2>&, const DofMap<2>&,
                                                                      const std::vector<Contact>&);
extern template class IsostaticStructure<2>;

} // namespace isostat
