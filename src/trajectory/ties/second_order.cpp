#include "trajectory/ties/second_order.hpp"

#include "contact/words.hpp"
#include "statics/quotient.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace isostat {

namespace {

struct Sharer {
    ContactId contact;
    Enclosure share;
    Enclosure force;
    [[nodiscard]] Enclosure bears() const { return quotient(force, share); }
};

/// When rattlers move, the infinitesimal loads decide, and the finite loads only among contacts that bear finite
/// forces. `may_leave`: per contact.
std::vector<Sharer> sharers(const Vertex& from, const Opening& opening, const Contact& pair, double stress,
                            const std::vector<bool>& may_leave) {
    constexpr double seen = 1e-8; // smaller coefficients count as 0
    const std::vector<double> shares = from.perturbed->first.shares(pair);
    std::vector<Sharer> all;
    bool rattles = false;
    for (std::size_t l = 0; l < shares.size(); ++l) {
        const ContactId id(l);
        if (id == opening.contact || shares[l] < seen || !may_leave[l] ||
            from.structure.contacts()[l].kind == ContactKind::held) {
            continue;
        }
        const Enclosure share = from.perturbed->first.rate(id, +1, pair);
        if (share.positive()) {
            const bool idle = opening.infinitesimal && from.statics.is_structural_zero(id);
            all.push_back({id, share, idle ? from.statics.infinitesimal(id) : from.statics.force(id, stress)});
            rattles = rattles || idle;
        }
    }
    if (rattles) {
        std::erase_if(all, [&](const Sharer& s) { return !from.statics.is_structural_zero(s.contact); });
    }
    const auto pulled = [](const Sharer& s) { return s.force.negative(); };
    if (!std::all_of(all.begin(), all.end(), pulled)) {
        std::erase_if(all, pulled);
    }
    return all;
}

/// The exchange for the contact that bears least; of quotients not told apart the first by name. \pre there is one
ListExchange exchange_for(const Vertex& from, const std::vector<Sharer>& all, TieDecision decision) {
    const auto& contacts = from.structure.contacts();
    const auto unbeaten = [&](const Sharer& a) {
        return std::none_of(all.begin(), all.end(),
                            [&](const Sharer& b) { return (a.bears() - b.bears()).positive(); });
    };
    std::vector<Sharer> least;
    std::copy_if(all.begin(), all.end(), std::back_inserter(least), unbeaten);
    const auto first = std::min_element(least.begin(), least.end(), [&](const Sharer& a, const Sharer& b) {
        return contacts[a.contact.index()] < contacts[b.contact.index()];
    });
    decision.against = contacts[first->contact.index()];
    decision.other = first->share;
    decision.choice = least.size() > 1 ? TieChoice::names : TieChoice::none;
    return ListExchange{first->contact, decision.chosen, std::move(decision)};
}

/// Rates of gaps, a row for each contact; nothing for walls that cannot move.
Eigen::MatrixXd rates_of(const Packing& at, const DofMap& dofs, const std::vector<Contact>& contacts) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(contacts.size()), dofs.dof_count());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        gap_gradient(at, contacts[l]).for_each_dof(dofs, [&](std::size_t dof, double value) {
            rows(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(dof)) = value;
        });
    }
    return rows;
}

/// Columns x with m x = 0 in double precision, the largest entry of each 1.
Eigen::MatrixXd kernel_of(const Eigen::MatrixXd& m) {
    constexpr double dependent = 1e-6; // double locates an end with dependent contacts no better
    Eigen::FullPivLU<Eigen::MatrixXd> lu(m);
    lu.setThreshold(dependent);
    if (lu.isInvertible()) {
        return Eigen::MatrixXd(m.rows(), 0);
    }
    Eigen::MatrixXd x = lu.kernel();
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
        x.col(k) /= x.col(k).cwiseAbs().maxCoeff();
    }
    return x;
}

/// The rows that are not 0.
std::vector<bool> not_zero(const Eigen::MatrixXd& m) {
    constexpr double seen = 1e-3; // a guess: another row would serve as well
    std::vector<bool> is;
    for (Eigen::Index k = 0; k < m.rows(); ++k) {
        is.push_back(m.row(k).cwiseAbs().maxCoeff() > seen);
    }
    return is;
}

} // namespace

Result<ListExchange> give_way(const Vertex& from, const Opening& opening, const BentPair& bent, double stress) {
    const auto& contacts = from.structure.contacts();
    const std::vector<Sharer> all = sharers(from, opening, bent.pair, stress, std::vector<bool>(contacts.size(), true));
    if (all.empty()) {
        return failed(FailureKind::undecided,
                      "{} touch without being a contact, and would overlap when {} opens, at second order; no contact "
                      "is proved to give way",
                      named(bent.pair), named(contacts[opening.contact.index()]));
    }
    const double zero = std::abs(bent.rate.value) + bent.rate.radius;
    return exchange_for(from, all, {"second order", bent.pair, bent.bend, {}, {}, std::log2(zero), 0});
}

std::optional<ListExchange> list_for_the_end(const Vertex& from, const ArcProposal& arc, double stress) {
    constexpr std::size_t most_contacts = 1000; // for a dense matrix
    const ContactId opened = arc.opening.contact;
    std::vector<Contact> contacts = from.structure.contacts();
    if (contacts[opened.index()].kind == ContactKind::held || contacts.size() > most_contacts) {
        return {};
    }
    contacts[opened.index()] = arc.record.closed;
    const Eigen::MatrixXd rates = rates_of(arc.end, from.structure.dofs(), contacts);
    const Eigen::MatrixXd motions = kernel_of(rates);
    if (motions.cols() == 0) {
        return {};
    }
    const std::vector<bool> may_leave = not_zero(kernel_of(rates.transpose())); // these bear a self-stress
    std::vector<Contact> touching = arc.kept_touching;
    touching.insert(touching.end(), arc.assumed_touching.begin(), arc.assumed_touching.end());
    std::sort(touching.begin(), touching.end());
    const std::vector<bool> holds = not_zero(rates_of(arc.end, from.structure.dofs(), touching) * motions);
    for (std::size_t m = 0; m < touching.size(); ++m) {
        const auto all = holds[m] ? sharers(from, arc.opening, touching[m], stress, may_leave) : std::vector<Sharer>();
        if (!all.empty()) {
            const Enclosure rate = from.perturbed->first.rate(opened, +1, touching[m]);
            return exchange_for(from, all, {"end", touching[m], rate, {}, {}, 0, 0});
        }
    }
    return {};
}

} // namespace isostat
