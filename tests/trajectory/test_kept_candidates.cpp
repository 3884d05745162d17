// Flags of candidates kept from vertex to vertex, against sets made anew.
#include "contact/contact_set.hpp"
#include "oracle/random.hpp"
#include "support/test.hpp"
#include "trajectory/vertex.hpp"

using namespace isostat;

BOOST_AUTO_TEST_CASE(flags_of_kept_candidates_follow_exchanges_moves_within_the_list_and_new_lists) {
    oracle::Random random(3);
    constexpr int disks = 30;
    std::vector<Contact> candidates;
    const auto new_candidates = [&] {
        candidates.clear();
        for (int i = 0; i < disks; ++i) {
            for (int j = i + 1; j < disks; ++j) {
                if (random.integer(4) == 0) {
                    candidates.push_back({ContactKind::disk_disk, i, j});
                }
            }
            candidates.push_back({ContactKind::lower_wall, i, 0});
        }
        std::ranges::sort(candidates);
    };
    const auto any = [&] {
        return candidates[static_cast<std::size_t>(random.integer(static_cast<int>(candidates.size())))];
    };
    new_candidates();
    std::vector<Contact> contacts;
    while (contacts.size() < 40) {
        const Contact contact = any();
        if (std::ranges::find(contacts, contact) == contacts.end()) {
            contacts.push_back(contact);
        }
    }
    KeptCandidates kept;
    for (int step = 0; step < 300; ++step) {
        const auto slot = static_cast<std::size_t>(random.integer(40));
        switch (random.integer(step % 50 == 49 ? 4 : 3)) {
        case 0: { // an exchange
            const Contact contact = any();
            if (std::ranges::find(contacts, contact) == contacts.end()) {
                contacts[slot] = contact;
            }
            break;
        }
        case 1: contacts[slot] = {ContactKind::held, static_cast<int>(slot), 0}; break; // no candidate
        case 2: std::swap(contacts[slot], contacts[static_cast<std::size_t>(random.integer(40))]); break;
        default: new_candidates();
        }
        const std::vector<unsigned char>& flags = kept.of(candidates, contacts);
        const ContactSet set(contacts, 2 * disks);
        BOOST_TEST_REQUIRE(flags.size() == candidates.size());
        for (std::size_t k = 0; k < flags.size(); ++k) {
            BOOST_TEST((flags[k] != 0) == set.contains(candidates[k]));
        }
    }
}
