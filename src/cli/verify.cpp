#include "cli/verify.hpp"

#include "cli/terminal.hpp"
#include "ensemble/ensemble.hpp"
#include "io/files.hpp"
#include "packing/words.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/core/result.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace isostat::cli {

namespace {

/// Whether a file has the bytes that the certificate names, and the state of the certificate.
ClaimCheck check_input(const Certificate& certificate, const std::string& input) {
    ClaimCheck check;
    check.claim = "input";
    check.claimed = true;
    const std::string hash = sha256(read_text(input));
    const std::string difference = state_difference(
        with_free_motions_held(read_any_state(input, Dimensions::any_bodies).state), certificate.state);
    const bool same = hash == certificate.input_hash;
    check.verdict = same && difference.empty() ? Verdict::proved : Verdict::refuted;
    check.detail = !difference.empty()
                       ? fmt::format("{} of the state in the certificate is not that of {}", difference, input)
                   : same ? fmt::format("{} has the state of the certificate and the SHA-256 that is named", input)
                          : fmt::format("{} has the SHA-256 {}, not {}", input, hash, certificate.input_hash);
    return check;
}

Json json_of(const ClaimCheck& check) {
    Json object;
    object["claim"] = check.claim;
    object["claimed"] = check.claimed;
    object["verdict"] = to_string(check.verdict);
    object["detail"] = check.detail;
    Json& numbers = object["numbers"] = Json::object();
    for (const auto& [name, value] : check.numbers) {
        numbers[name] = or_null(value);
    }
    return object;
}

/// Refuted before undecided before proved.
Verdict worst(Verdict a, Verdict b) {
    return a == Verdict::refuted || b == Verdict::refuted ? Verdict::refuted : std::max(a, b);
}

/// Verifies a certificate; the output of `--json` goes into `object`.
Verdict verify_certificate(const std::string& file, const VerifyArguments& arguments, Json& object) {
    const std::string text = read_text(file);
    const Certificate certificate = parse_certificate(text, file);
    Verification verification = isostat::verify(certificate);
    const std::size_t claims = verification.checks.size();
    if (!arguments.input.empty()) {
        verification.checks.push_back(check_input(certificate, arguments.input));
    }
    const bool quiet = arguments.common.json || arguments.common.quiet;
    for (const auto& [asked, checker] :
         {std::pair(arguments.coq, CoqChecker::kernel), std::pair(arguments.coq_extracted, CoqChecker::extracted)}) {
        if (asked) {
            verification.checks.push_back(ask_coq(checker, file, sha256(text), arguments.coq_limit, quiet));
        }
    }
    for (std::size_t k = claims; k < verification.checks.size(); ++k) {
        verification.verdict = worst(verification.verdict, verification.checks[k].verdict);
    }
    object["certificate"] = file;
    object["program"] = certificate.program;
    object["input"] = certificate.input;
    object["input_hash"] = certificate.input_hash;
    for (const ClaimCheck& check : verification.checks) {
        object["checks"].push_back(json_of(check));
    }
    object["verdict"] = to_string(verification.verdict);
    if (arguments.common.json) {
        return verification.verdict;
    }
    say("{}: claims of {} about {} ({} {}s, {} contacts)\n", file, certificate.program, certificate.input,
        certificate.state.packing.disk_count(), grain_word(certificate.state.packing.dimension),
        certificate.state.contacts.size());
    for (const ClaimCheck& check : verification.checks) {
        say("{:<14} {:<9} {}\n", check.claim, check.claimed ? to_string(check.verdict) : "absent", check.detail);
    }
    for (const std::string& reason : certificate.claims.undecided) {
        say("not claimed by the program: {}\n", reason);
    }
    const bool mechanisms = certificate.claims.minimum && verification.verdict == Verdict::proved;
    say("{:<14} {}{}\n", "equilibrium", to_string(verification.verdict),
        mechanisms ? ": not isostatic, with mechanisms along which the potential has a minimum" : "");
    std::fflush(stdout);
    return verification.verdict;
}

} // namespace

int verify(const VerifyArguments& arguments) {
    end_at_interrupts();
    const std::string& first = arguments.certificates.front();
    const bool asks_coq = arguments.coq || arguments.coq_extracted;
    if (arguments.coq_limit > 0 && !asks_coq) {
        throw Error(ErrorKind::usage, "--coq-limit belongs to --coq or --coq-extracted");
    }
    const bool one = arguments.certificates.size() == 1;
    if (one && std::filesystem::is_directory(first)) {
        if (!arguments.input.empty() || asks_coq) {
            throw Error(ErrorKind::usage,
                        "--input, --coq and --coq-extracted belong to a certificate, not to a folder");
        }
        return is_ensemble(first) ? verify_ensemble(first, arguments.common) : verify_folder(first, arguments.common);
    }
    if (!one && !arguments.input.empty()) {
        throw Error(ErrorKind::usage, "--input belongs to one certificate");
    }
    Json all;
    Verdict verdict = Verdict::proved;
    for (const std::string& file : arguments.certificates) {
        verdict = worst(verdict, verify_certificate(file, arguments, all["certificates"].emplace_back()));
    }
    all["verdict"] = to_string(verdict);
    if (arguments.common.json) {
        print_json(one ? all["certificates"].front() : all);
    }
    return status_of(verdict);
}

} // namespace isostat::cli
