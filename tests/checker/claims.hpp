#pragma once
// What `certify` claims of a state, as a certificate, and what the checker says of it.

#include "support/test.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>

namespace claims {

using namespace isostat;

inline constexpr std::array every_arithmetic{CheckerArithmetic::automatic, CheckerArithmetic::singular_value,
                                             CheckerArithmetic::rows,      CheckerArithmetic::fixed64,
                                             CheckerArithmetic::gmp,       CheckerArithmetic::rational};

inline Certificate certificate_of(const State& state, CertificateClaims claims) {
    Certificate made;
    made.state = state;
    made.input = "state";
    made.input_hash = sha256("state");
    made.program = "certify";
    made.claims = std::move(claims);
    return made;
}

/// \pre every claim is proved
inline Certificate certified(const State& state) {
    const Certification result = certify(state);
    BOOST_TEST((result.verdict == Verdict::proved),
               (result.claims.undecided.empty() ? "" : result.claims.undecided[0]));
    return certificate_of(state, result.claims);
}

/// As `isostat verify` does it: from the text of a file whose digest is right.
inline Verification read_and_verified(const Certificate& certificate,
                                      CheckerArithmetic arithmetic = CheckerArithmetic::automatic) {
    return verify(parse_certificate(certificate_text(certificate), "certificate"), arithmetic);
}

/// Undecided where there is no such claim.
inline ClaimCheck answer_to(const Verification& verification, const std::string& claim) {
    const auto found =
        std::ranges::find_if(verification.checks, [&claim](const ClaimCheck& check) { return check.claim == claim; });
    return found == verification.checks.end() ? ClaimCheck{} : *found;
}

inline Verdict verdict_on(const Verification& verification, const std::string& claim) {
    return answer_to(verification, claim).verdict;
}

inline void are_proved(const Verification& verification) {
    for (const ClaimCheck& check : verification.checks) {
        BOOST_TEST((check.verdict == Verdict::proved),
                   check.claim << ": " << to_string(check.verdict) << ": " << check.detail);
    }
    BOOST_TEST((verification.verdict == Verdict::proved));
}

} // namespace claims
