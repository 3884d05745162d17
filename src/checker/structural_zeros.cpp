#include "checker/forces.hpp"

#include <algorithm>

namespace isostat::checker {

namespace {

/// Contacts matched to degrees of freedom that they touch, by augmenting paths.
class Matching {
  public:
    Matching(const std::vector<std::vector<int>>& contacts_of, std::size_t contacts)
        : contacts_of_(contacts_of), contact_of_(contacts_of_.size(), -1), dof_of_(contacts, -1) {
        for (std::size_t j = 0; j < contact_of_.size(); ++j) {
            seen_.assign(dof_of_.size(), false);
            perfect_ = augment(j) && perfect_;
        }
    }
    [[nodiscard]] bool perfect() const { return perfect_; }
    [[nodiscard]] int contact_of(std::size_t dof) const { return contact_of_[dof]; }

  private:
    bool augment(std::size_t dof) {
        for (const int l : contacts_of_[dof]) {
            const auto contact = static_cast<std::size_t>(l);
            if (seen_[contact]) {
                continue;
            }
            seen_[contact] = true;
            if (dof_of_[contact] < 0 || augment(static_cast<std::size_t>(dof_of_[contact]))) {
                dof_of_[contact] = static_cast<int>(dof);
                contact_of_[dof] = l;
                return true;
            }
        }
        return false;
    }

    const std::vector<std::vector<int>>& contacts_of_;
    std::vector<int> contact_of_;
    std::vector<int> dof_of_;
    std::vector<bool> seen_;
    bool perfect_ = true;
};

/// The contacts that touch each degree of freedom.
std::vector<std::vector<int>> pattern_of(const Problem& problem) {
    std::vector<std::vector<int>> contacts_of;
    for (std::size_t j = 0; j < problem.contacts_of.size(); ++j) {
        contacts_of.emplace_back(problem.contacts_of[j].begin(), problem.contacts_of[j].end());
    }
    return contacts_of;
}

/// The pattern with the disk of most contacts pinned: its degrees of freedom become those of the pinned disk (C9).
std::vector<std::vector<int>> with_another_pin(const Problem& problem) {
    std::vector<std::vector<int>> contacts_of = pattern_of(problem);
    for (std::size_t a = 0; a < problem.immovable.size(); ++a) {
        const int dof = problem.dof_of[problem.layout.of_disk(problem.most_touched) + a];
        if (problem.immovable[a].periodic && dof >= 0) { // else it is the pinned disk
            contacts_of[static_cast<std::size_t>(dof)] = problem.immovable[a].acting;
        }
    }
    return contacts_of;
}

bool acts_on_disks(const Problem& problem, const Forces& load) {
    for (std::size_t j = 0; j < load.size(); ++j) {
        if (problem.of_disk(problem.coordinate_of[j]) && load.acts(j)) {
            return true;
        }
    }
    return false;
}

/// All structural zeros of this pattern.
std::optional<std::vector<int>> zeros_of(const std::vector<std::vector<int>>& contacts_of, std::size_t contacts,
                                         const Forces& load) {
    const Matching matching(contacts_of, contacts);
    if (!matching.perfect()) {
        return {};
    }
    std::vector<std::vector<std::size_t>> touched(contacts);
    std::vector<std::size_t> reached;
    std::vector<bool> loaded(load.size(), false);
    for (std::size_t j = 0; j < load.size(); ++j) {
        for (const int l : contacts_of[j]) {
            touched[static_cast<std::size_t>(l)].push_back(j);
        }
        if (load.acts(j)) {
            loaded[j] = true;
            reached.push_back(j);
        }
    }
    while (!reached.empty()) { // contacts that balance a load pass it on
        const auto contact = static_cast<std::size_t>(matching.contact_of(reached.back()));
        reached.pop_back();
        for (const std::size_t j : touched[contact]) {
            if (!loaded[j]) {
                loaded[j] = true;
                reached.push_back(j);
            }
        }
    }
    std::vector<int> zeros;
    for (std::size_t j = 0; j < loaded.size(); ++j) {
        if (!loaded[j]) {
            zeros.push_back(matching.contact_of(j));
        }
    }
    std::sort(zeros.begin(), zeros.end());
    return zeros;
}

} // namespace

std::optional<std::vector<int>> structural_zeros(const Problem& problem, const Forces& load) {
    std::optional<std::vector<int>> zeros;
    if (problem.most_touched >= 0 && !acts_on_disks(problem, load)) {
        zeros = zeros_of(with_another_pin(problem), problem.rows.size(), load);
    }
    return zeros ? zeros : zeros_of(pattern_of(problem), problem.rows.size(), load);
}

} // namespace isostat::checker
