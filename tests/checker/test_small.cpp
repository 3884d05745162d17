// Certificates of small packings whose answers are known in closed form.
#include "checker/maker.hpp"
#include "support/crafted.hpp"

#include <isostat/checker/verify.hpp>

#include <boost/test/unit_test.hpp>

using namespace isostat;

namespace {

void is_proved(const Certificate& certificate, CheckerArithmetic arithmetic = CheckerArithmetic::automatic) {
    const Verification verification = verify(certificate, arithmetic);
    for (const ClaimCheck& check : verification.checks) {
        BOOST_TEST((check.verdict == Verdict::proved),
                   check.claim << ": " << to_string(check.verdict) << ": " << check.detail);
    }
    BOOST_TEST((verification.verdict == Verdict::proved));
}

} // namespace

BOOST_AUTO_TEST_SUITE(checker)

BOOST_AUTO_TEST_CASE(one_disk_between_four_walls) {
    is_proved(maker::certificate(crafted::one_disk(1, 2)));
}

BOOST_AUTO_TEST_CASE(two_disks) {
    is_proved(maker::certificate(crafted::two_disks(1, 2, 1, 1)));
}

BOOST_AUTO_TEST_CASE(three_disks) {
    is_proved(maker::certificate(crafted::three_disks(1, 1.1, 1.3, 1, 1)));
}

BOOST_AUTO_TEST_SUITE_END()
