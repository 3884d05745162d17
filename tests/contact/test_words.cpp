// Failures carry the contacts and disks that their words name.

#include "contact/words.hpp"
#include "support/test.hpp"

using namespace isostat;

namespace {

constexpr Contact disks{ContactKind::disk_disk, 3, 8};
constexpr Contact wall{ContactKind::lower_wall, 5, 0};

} // namespace

BOOST_AUTO_TEST_CASE(a_failure_names_the_contacts_among_its_words) {
    std::string owner = "an owner that goes away";
    const Failure failure =
        failed(FailureKind::tie, "{}: {} and {} (f = {:.3g})", owner, named(disks), named(wall), 0.12345);
    owner.assign(owner.size(), '?');
    BOOST_TEST(failure.message() == "an owner that goes away: 3-8 and 5-left (f = 0.123)");
    BOOST_TEST((failure.contacts() == std::vector<Contact>{disks, wall}));
    BOOST_TEST(failure.disks().empty());
}

BOOST_AUTO_TEST_CASE(words_within_words_keep_what_they_name) {
    Words list;
    for (const Contact& contact : {disks, wall}) {
        list += words("{}{}", list.empty() ? "" : ", ", named(contact));
    }
    const Failure inner = failed(FailureKind::undecided, "zero: {}", list);
    const Failure outer = located(failed(inner.kind, "class of {}: {}", 2, inner), words("arc {}", 4));
    BOOST_TEST(outer.message() == "arc 4: class of 2: zero: 3-8, 5-left");
    BOOST_TEST((outer.contacts() == std::vector<Contact>{disks, wall}));
}
