#pragma once
/// \file
/// Structures whose contact matrix was proved regular; solvers accept nothing else.

#include "core/parallel.hpp"
#include "sparse/pattern.hpp"

#include <isostat/contact/state.hpp>
#include <isostat/core/contact.hpp>
#include <isostat/core/result.hpp>
#include <isostat/packing/packing.hpp>

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace isostat {

/// Contact matrix H (N_f x N, column l = minus the gap gradient of contact l, unit normals, rows = degrees of freedom).
/// The pattern follows from the contacts alone: a component that is 0 here is stored as 0. H f = F_ext; G = H^T gives
/// approach velocities.
sparse::Matrix<double> contact_matrix(const Packing& packing, const DofMap& dofs, const std::vector<Contact>& contacts);

/// The same matrix exactly, mod 2^61 - 1: every column is multiplied by the distance of the centres, which keeps the
/// rank (entries x_j - x_i of the stored doubles, no rounding, no square root). Same pattern as `contact_matrix`.
sparse::Matrix<std::uint64_t> exact_contact_matrix(const Packing& packing, const DofMap& dofs,
                                                   const std::vector<Contact>& contacts);

/// The ordering of a matrix, made on the first request; other threads that request it wait.
class OrderingOnDemand {
  public:
    explicit OrderingOnDemand(std::shared_ptr<const sparse::Matrix<double>> matrix) : matrix_(std::move(matrix)) {}
    const sparse::Ordering& get() {
        std::call_once(made_, [this] { ordering_.emplace(*matrix_); });
        return *ordering_;
    }

  private:
    std::shared_ptr<const sparse::Matrix<double>> matrix_;
    std::once_flag made_;
    std::optional<sparse::Ordering> ordering_;
};

/// Contact list and matrix after the exchange of one contact. Nothing is proved of them: they are the input of a proof.
class ExchangedContacts {

  public:
    [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
    [[nodiscard]] const DofMap& dofs() const { return *dofs_; }
    [[nodiscard]] const sparse::Matrix<double>& matrix() const { return *matrix_; }
    /// Column matched to each row.
    [[nodiscard]] const std::vector<int>& matching() const { return matching_; }
    /// Place of the new contact in the list (and of its column).
    [[nodiscard]] int slot() const { return slot_; }
    /// The contacts, and so the pattern and the matching, equal those of the guess given to `exchange`.
    [[nodiscard]] bool predicted() const { return predicted_; }

  private:
    friend class IsostaticStructure;
    std::vector<Contact> contacts_;
    std::shared_ptr<const DofMap> dofs_;
    std::shared_ptr<const sparse::Matrix<double>> matrix_;
    std::vector<int> matching_;
    int slot_ = 0;
    bool predicted_ = false;
};

/// Evidence that one matrix is regular: a proved positive lower bound of the smallest singular value of the exact
/// unit-normal matrix (statements V1, V2, V8). Only the room verified makes these, each for one matrix.
class RegularityProof {
  public:
    [[nodiscard]] double sigma_min() const { return sigma_min_; }

  private:
    friend struct RegularityProver; // of the room verified
    friend class IsostaticStructure;
    RegularityProof(const sparse::Matrix<double>& matrix, double sigma_min) : matrix_(&matrix), sigma_min_(sigma_min) {}
    const sparse::Matrix<double>* matrix_;
    double sigma_min_;
};

/// How the regularity of a structure was proved.
enum class RegularityEvidence : std::uint8_t {
    elimination,    ///< full rank mod p of the stored coordinates
    singular_value, ///< smallest singular value bounded away from 0, also for the stored coordinates
    none            ///< not proved: for steering, whose ends are proved separately
};

/// Largest number of coordinates of a packing, and so of contacts of a structure, because error bounds allow for sums
/// of so many terms (statement B1).
inline constexpr std::size_t most_coordinates = 2'500'000;

/// A configuration with N = N_f contacts (held coordinates count as contacts) whose contact matrix is proved regular,
/// for the *stored* coordinates (dyadic rationals) without any rounding. So h = k = 0. `prove` and `exchanged` make one
/// from a proof, and every double-precision solve takes a structure, so no solve is possible without a proof. Nothing
/// follows for the true equilibrium near the stored configuration. The one exception to the need of a proof is
/// `without_proof`, which the evidence shows.
class IsostaticStructure {

  public:
    /// Proves by elimination mod p (statement T4), the full exact check. Failure: `not_isostatic`
    /// when N != N_f, when the pattern is structurally singular, or when the rank mod 2^61 - 1 is
    /// deficient (the message gives N_f, N and the rank found; a deficiency mod p is evidence, chance
    /// n/p ~ 4e-15 of being false, not proof). Throws `Error(bad_input)` beyond `most_coordinates`.
    /// Cost: one symbolic analysis + one elimination mod p, about 10 ms at n = 4900.
    static Result<IsostaticStructure> prove(const Packing& packing, std::vector<Contact> contacts);

    /// The list of `previous` with the contact at `slot` replaced, at a new configuration of the same grains. Nothing
    /// when the new pattern is structurally singular. `guess`: the same exchange at another configuration, if known;
    /// the result does not depend on the guess. Cost: the matrix, and one augmenting path unless the guess has it.
    static std::optional<ExchangedContacts> exchange(const IsostaticStructure& previous, const Packing& packing,
                                                     ContactId slot, const Contact& contact,
                                                     const ExchangedContacts* guess = nullptr);
    /// Proves by a positive lower bound of the smallest singular value of the matrix (statement T3 with V8, or V1).
    /// \pre the proof is of this matrix.
    static IsostaticStructure exchanged(ExchangedContacts contacts, const RegularityProof& proof);
    /// Assumes regularity without proof (`evidence() == RegularityEvidence::none`): for steering ahead of the proofs.
    /// Bounds of the inverse of such a structure are still proved, or not given.
    static IsostaticStructure without_proof(ExchangedContacts contacts);

    [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }
    [[nodiscard]] const DofMap& dofs() const { return *dofs_; }
    [[nodiscard]] const sparse::Matrix<double>& matrix() const { return *matrix_; }
    /// The matrix for owners that may outlive the structure.
    [[nodiscard]] const std::shared_ptr<const sparse::Matrix<double>>& shared_matrix() const { return matrix_; }
    [[nodiscard]] int size() const { return matrix_->rows; }
    [[nodiscard]] RegularityEvidence evidence() const { return evidence_; }
    /// Column matched to each row.
    [[nodiscard]] const std::vector<int>& matching() const { return matching_; }
    /// Made on the first request, once for all copies and threads,
    /// because an exchanged structure mostly needs only its matching.
    [[nodiscard]] const sparse::Ordering& ordering() const { return ordering_->get(); }

  private:
    friend class RankProof;
    IsostaticStructure() = default;
    std::vector<Contact> contacts_;
    std::shared_ptr<const DofMap> dofs_;
    std::shared_ptr<const sparse::Matrix<double>> matrix_;
    std::vector<int> matching_;
    RegularityEvidence evidence_ = RegularityEvidence::elimination;
    std::shared_ptr<OrderingOnDemand> ordering_;
};

/// `IsostaticStructure::prove` as a task, while other work goes on with the same matrix.
class RankProof {
  public:
    /// Failures that need no elimination: N != N_f, or a structurally singular pattern. Throws as `prove` does.
    static Result<RankProof> begin(const Packing& packing, std::vector<Contact> contacts);
    /// The structure with evidence `none`: results from it must be discarded unless `conclude` succeeds.
    [[nodiscard]] const IsostaticStructure& unproved() const { return structure_; }
    /// Whether the rank is full; waits for the elimination.
    [[nodiscard]] bool is_regular();
    /// The same structure, with the same shared matrix, proved regular, or the failure of `prove`.
    [[nodiscard]] Result<IsostaticStructure> conclude();

  private:
    RankProof() = default;
    IsostaticStructure structure_;
    Future<int> elimination_;
    int rank_ = -1;
};

} // namespace isostat
