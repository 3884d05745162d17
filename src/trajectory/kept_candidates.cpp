#include "trajectory/vertex.hpp"

#include <algorithm>

namespace isostat {

void KeptCandidates::set(const Contact& contact, unsigned char flag) {
    const auto at = std::lower_bound(candidates_.begin(), candidates_.end(), contact);
    if (at != candidates_.end() && *at == contact) { // held coordinates are no candidates
        kept_[static_cast<std::size_t>(at - candidates_.begin())] = flag;
    }
}

const std::vector<unsigned char>& KeptCandidates::of(const std::vector<Contact>& candidates,
                                                     const std::vector<Contact>& contacts) {
    if (candidates_ != candidates || contacts_.size() != contacts.size()) {
        candidates_ = candidates;
        kept_.assign(candidates.size(), 0);
        contacts_ = contacts;
        for (const Contact& contact : contacts) {
            set(contact, 1);
        }
        return kept_;
    }
    std::vector<std::size_t> changed;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (contacts_[l] != contacts[l]) {
            changed.push_back(l);
            set(contacts_[l], 0);
        }
    }
    for (const std::size_t l : changed) { // after all others left, because a contact may have changed its place
        contacts_[l] = contacts[l];
        set(contacts[l], 1);
    }
    return kept_;
}

} // namespace isostat
