#pragma once
/// \file
/// Fast membership in a contact list, and sublists.

#include <isostat/contact/state.hpp>

#include <vector>

namespace isostat {

/// The contacts of a list in buckets by their first index: `contains`
/// compares only with the contacts of one disk. Cost to make: O(N).
class ContactSet {
  public:
    ContactSet(const std::vector<Contact>& contacts, int disk_count);
    [[nodiscard]] bool contains(const Contact& contact) const {
        const auto i = static_cast<std::size_t>(contact.i);
        for (int k = start_[i]; k < start_[i + 1]; ++k) {
            if (members_[static_cast<std::size_t>(k)] == contact) {
                return true;
            }
        }
        return false;
    }

    /// All contacts in their order; each bucket is a few contacts long. The set is empty afterwards.
    [[nodiscard]] std::vector<Contact> take_sorted();

  private:
    std::vector<int> start_;
    std::vector<Contact> members_;
};

/// The number of contacts of each disk; held coordinates do not count, and a disk and its own image count twice.
std::vector<int> contacts_per_disk(int disks, const std::vector<Contact>& contacts);
/// The disk with the most contacts, the first of several.
int most_held(int disks, const std::vector<Contact>& contacts);

/// The contacts without a mark: if structural zeros are marked, those that carry a force.
std::vector<Contact> unmarked(const std::vector<Contact>& contacts, const std::vector<unsigned char>& marks);

} // namespace isostat
