#include "contact/contact_set.hpp"

namespace isostat {

ContactSet::ContactSet(const std::vector<Contact>& contacts, int disk_count) {
    // Held coordinates are left out, because their first index is no disk.
    start_.assign(static_cast<std::size_t>(disk_count) + 2, 0);
    const auto counted = [](const Contact& contact) { return contact.kind != ContactKind::held; };
    for (const Contact& contact : contacts) {
        if (counted(contact)) {
            ++start_[static_cast<std::size_t>(contact.i) + 2];
        }
    }
    for (std::size_t i = 2; i < start_.size(); ++i) {
        start_[i] += start_[i - 1];
    }
    members_.resize(static_cast<std::size_t>(start_.back()));
    for (const Contact& contact : contacts) {
        if (counted(contact)) {
            members_[static_cast<std::size_t>(start_[static_cast<std::size_t>(contact.i) + 1]++)] = contact;
        }
    }
    start_.pop_back();
}

std::vector<Contact> ContactSet::take_sorted() {
    for (std::size_t i = 0; i + 1 < start_.size(); ++i) {
        std::sort(members_.begin() + start_[i], members_.begin() + start_[i + 1]);
    }
    std::ranges::fill(start_, 0);
    return std::move(members_);
}

std::vector<int> contacts_per_disk(int disks, const std::vector<Contact>& contacts) {
    std::vector<int> count(static_cast<std::size_t>(disks), 0);
    for (const Contact& contact : contacts) {
        if (contact.kind != ContactKind::held) { // the number of a held coordinate is not that of a disk
            ++count[static_cast<std::size_t>(contact.i)];
            if (contact.of_disks()) {
                ++count[static_cast<std::size_t>(contact.j)];
            }
        }
    }
    return count;
}

int most_held(int disks, const std::vector<Contact>& contacts) {
    const std::vector<int> count = contacts_per_disk(disks, contacts);
    return static_cast<int>(std::ranges::max_element(count) - count.begin());
}

std::vector<Contact> unmarked(const std::vector<Contact>& contacts, const std::vector<unsigned char>& marks) {
    std::vector<Contact> out;
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        if (marks[l] == 0) {
            out.push_back(contacts[l]);
        }
    }
    return out;
}

} // namespace isostat
