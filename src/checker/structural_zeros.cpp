#include "checker/structural_zeros.hpp"

#include <algorithm>

namespace isostat::checker {

namespace {

/// Contacts matched to degrees of freedom that they touch, by augmenting paths.
class Matching {
  public:
    explicit Matching(const Problem& problem)
        : contacts_of_(problem.contacts_of), contact_of_(contacts_of_.size(), -1), dof_of_(problem.rows.size(), -1) {
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

} // namespace

std::optional<std::vector<int>> structural_zeros(const Problem& problem, const Forces& load) {
    const Matching matching(problem);
    if (!matching.perfect()) {
        return {};
    }
    std::vector<std::vector<std::size_t>> touched(problem.rows.size());
    std::vector<std::size_t> reached;
    std::vector<bool> loaded(load.size(), false);
    for (std::size_t j = 0; j < load.size(); ++j) {
        for (const int l : problem.contacts_of[j]) {
            touched[static_cast<std::size_t>(l)].push_back(j);
        }
        if (load[j].lower != 0 || load[j].upper != 0) {
            loaded[j] = true;
            reached.push_back(j);
        }
    }
    while (!reached.empty()) { // what balances a load hands it on
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

} // namespace isostat::checker
