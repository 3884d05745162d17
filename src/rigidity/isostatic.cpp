#include "rigidity/isostatic.hpp"

#include "contact/separation.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "core/work.hpp"
#include "exact/rank.hpp"

#include <isostat/core/machine.hpp>
#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <cstdlib>

namespace isostat {

namespace {

template <class Value> sparse::Matrix<Value> empty_matrix(int rows, std::size_t cols) {
    sparse::Matrix<Value> matrix;
    matrix.rows = rows;
    matrix.cols = static_cast<int>(cols);
    matrix.start.reserve(cols + 1);
    matrix.start.push_back(0);
    matrix.row.reserve(4 * cols);
    matrix.value.reserve(4 * cols);
    return matrix;
}

/// Normal from the first disk to the second, with the bits of `gap_gradient`, inline; zero for other contacts.
inline PerAxis<double> unit_normal(const Packing& packing, const Contact& contact) {
    if (!contact.of_disks()) {
        return {};
    }
    PerAxis<double> normal = separation(packing.layout(), packing.q, contact);
    const double length = euclidean_norm(normal);
    if (!(length > 0x1p-450 && length < 0x1p500)) { // squares under- or overflow
        return direction(normal);
    }
    for (double& component : normal) {
        component /= length;
    }
    return normal;
}

/// H with columns scaled by the distance of the centres, over the field with `modulus` elements; `reduce` maps a double
/// to it.
template <class Value, class Reduce>
sparse::Matrix<Value> reduced_contact_matrix(const Packing& packing, const DofMap& dofs,
                                             const std::vector<Contact>& contacts, Value modulus, Reduce reduce) {
    std::vector<Value> residue(packing.q.size());
    for (std::size_t k = 0; k < residue.size(); ++k) {
        residue[k] = reduce(packing.q[k]);
    }
    const auto subtract = [modulus](Value a, Value b) { return a >= b ? a - b : a + (modulus - b); };
    auto matrix = empty_matrix<Value>(dofs.dof_count(), contacts.size());
    for (const Contact& contact : contacts) {
        const Separation separation(contact, packing.layout());
        PerAxis<Value> normal; // times the distance of the centres; 1 for a wall
        normal.fill(1);
        if (contact.of_disks()) {
            normal = separation.of_disks([&](std::size_t k) { return residue[k]; }, subtract);
        }
        separation.for_each_coordinate([&](std::size_t coordinate, std::size_t a, int sign) {
            if (const int dof = dofs.dof_of(coordinate); dof >= 0) {
                matrix.row.push_back(dof);
                Value entry = 0; // minus the gradient of the gap
                for (int times = std::abs(sign); times > 0; --times) {
                    entry = sign > 0 ? subtract(entry, normal[a]) : subtract(entry, subtract(0, normal[a]));
                }
                matrix.value.push_back(entry);
            }
        });
        matrix.start.push_back(static_cast<int>(matrix.row.size()));
    }
    return matrix;
}

} // namespace

/// Rows ascend with the coordinates, and a separation names its coordinates in order.
sparse::Matrix<double> contact_matrix(const Packing& packing, const DofMap& dofs,
                                      const std::vector<Contact>& contacts) {
    sparse::Matrix<double> matrix;
    matrix.rows = dofs.dof_count();
    matrix.cols = static_cast<int>(contacts.size());
    matrix.start.resize(contacts.size() + 1);
    const std::size_t most =
        2 * packing.axes() + (packing.cell.any() ? packing.axes() + packing.tilts() : std::size_t{0});
    matrix.row.resize(most * contacts.size());
    matrix.value.resize(most * contacts.size());
    std::size_t end = 0;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& contact = contacts[l];
        Separation(contact, packing.layout())
            .for_each_entry(dofs, unit_normal(packing, contact), [&](int dof, double entry) {
                matrix.row[end] = dof;
                matrix.value[end] = entry;
                ++end;
            });
        matrix.start[l + 1] = static_cast<int>(end);
    }
    matrix.row.resize(end);
    matrix.value.resize(end);
    return matrix;
}

sparse::Matrix<std::uint64_t> exact_contact_matrix(const Packing& packing, const DofMap& dofs,
                                                   const std::vector<Contact>& contacts) {
    return reduced_contact_matrix(packing, dofs, contacts, exact::mersenne61, exact::residue);
}

Result<IsostaticStructure> IsostaticStructure::prove(const Packing& packing, std::vector<Contact> contacts) {
    require_floating_point();
    auto proof = RankProof::begin(packing, std::move(contacts));
    return proof.ok() ? proof.value().conclude() : proof.failure();
}

Result<RankProof> RankProof::begin(const Packing& packing, std::vector<Contact> contacts) {
    if (packing.q.size() > most_coordinates) { // all structures begin here; an exchange keeps the size
        throw Error(
            ErrorKind::bad_input,
            fmt::format("{} disks have {} coordinates: at most {} were expected, as error bounds allow for no more",
                        packing.disk_count(), packing.q.size(), most_coordinates));
    }
    RankProof proof;
    IsostaticStructure& structure = proof.structure_;
    structure.dofs_ = std::make_shared<const DofMap>(packing);
    const int dof_count = structure.dofs_->dof_count();
    const int contact_count = static_cast<int>(contacts.size());
    if (dof_count == 0) {
        return Failure{FailureKind::not_isostatic, "N_f = 0: there are no degrees of freedom, no grain can move"};
    }
    if (dof_count != contact_count) {
        return failed(FailureKind::not_isostatic,
                      "N_f = {} degrees of freedom and N = {} contacts: an isostatic structure has N = N_f", dof_count,
                      contact_count);
    }
    structure.matrix_ =
        std::make_shared<const sparse::Matrix<double>>(contact_matrix(packing, *structure.dofs_, contacts));
    structure.ordering_ = std::make_shared<OrderingOnDemand>(structure.matrix_);
    const sparse::Ordering& ordering = structure.ordering();
    if (!ordering.structurally_regular()) {
        return failed(FailureKind::not_isostatic,
                      "the contact matrix is structurally singular: N_f = N = {}, structural rank {}", dof_count,
                      ordering.structural_rank());
    }
    proof.elimination_ = Future<int>([packing, dofs = structure.dofs_, contacts, ordering = structure.ordering_] {
        count_work(Work::rank_proofs);
        // Full rank over any prime field is a proof; the small field is tried first because it costs half.
        const int rank = exact::rank(
            reduced_contact_matrix(packing, *dofs, contacts, exact::mersenne31, exact::residue31), ordering->get());
        return rank == dofs->dof_count() ? rank
                                         : exact::rank(exact_contact_matrix(packing, *dofs, contacts), ordering->get());
    });
    structure.contacts_ = std::move(contacts);
    structure.evidence_ = RegularityEvidence::none;
    structure.matching_.resize(static_cast<std::size_t>(dof_count));
    for (std::size_t k = 0; k < structure.matching_.size(); ++k) {
        structure.matching_[static_cast<std::size_t>(ordering.row_order()[k])] = ordering.column_order()[k];
    }
    return proof;
}

bool RankProof::is_regular() {
    if (elimination_.pending()) {
        rank_ = elimination_.get();
    }
    return rank_ == structure_.size();
}

Result<IsostaticStructure> RankProof::conclude() {
    if (!is_regular()) {
        return failed(FailureKind::not_isostatic,
                      "the rank of the contact matrix mod 2^61-1 is {}, N_f = N = {}: not proved regular", rank_,
                      structure_.size());
    }
    IsostaticStructure proved = structure_;
    proved.evidence_ = RegularityEvidence::elimination;
    return proved;
}

std::optional<ExchangedContacts> IsostaticStructure::exchange(const IsostaticStructure& previous,
                                                              const Packing& packing, ContactId slot,
                                                              const Contact& contact, const ExchangedContacts* guess) {
    ExchangedContacts next;
    next.slot_ = static_cast<int>(slot.index());
    next.contacts_ = previous.contacts_;
    next.contacts_[slot.index()] = contact;
    next.dofs_ = previous.dofs_;
    next.matrix_ = std::make_shared<const sparse::Matrix<double>>(contact_matrix(packing, *next.dofs_, next.contacts_));
    next.predicted_ = guess != nullptr && guess->contacts_ == next.contacts_; // then the pattern is the same
    next.matching_ = next.predicted_ ? guess->matching_
                                     : sparse::repaired_matching(previous.matching_, next.matrix_->start,
                                                                 next.matrix_->row, next.slot_);
    return next.matching_.empty() ? std::nullopt : std::optional(std::move(next));
}

IsostaticStructure IsostaticStructure::exchanged(ExchangedContacts contacts,
                                                 [[maybe_unused]] const RegularityProof& proof) {
    assert(proof.matrix_ == contacts.matrix_.get() && proof.sigma_min() > 0);
    IsostaticStructure structure = without_proof(std::move(contacts));
    structure.evidence_ = RegularityEvidence::singular_value;
    return structure;
}

IsostaticStructure IsostaticStructure::without_proof(ExchangedContacts contacts) {
    IsostaticStructure structure;
    structure.contacts_ = std::move(contacts.contacts_);
    structure.dofs_ = std::move(contacts.dofs_);
    structure.matrix_ = std::move(contacts.matrix_);
    structure.matching_ = std::move(contacts.matching_);
    structure.ordering_ = std::make_shared<OrderingOnDemand>(structure.matrix_);
    structure.evidence_ = RegularityEvidence::none;
    return structure;
}

} // namespace isostat
