// Certificates of equilibria of other programs, made from approximations.
#include "checker/maker.hpp"
#include "support/scratch.hpp"

#include <isostat/checker/verify.hpp>

using namespace isostat;

BOOST_AUTO_TEST_CASE(a_sample_of_another_program_is_proved_with_every_arithmetic) {
    const Certificate certificate = maker::certificate(read_state(scratch::data("vertex100.txt")).state);
    for (const CheckerArithmetic arithmetic :
         {CheckerArithmetic::singular_value, CheckerArithmetic::fixed64, CheckerArithmetic::gmp}) {
        const Verification verification = verify(certificate, arithmetic);
        for (const ClaimCheck& check : verification.checks) {
            BOOST_TEST((check.verdict == Verdict::proved), check.claim << ": " << check.detail);
            BOOST_TEST_MESSAGE(check.claim << ": " << check.detail);
        }
    }
}
