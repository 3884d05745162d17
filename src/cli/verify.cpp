#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/interrupt.hpp"
#include "cli/terminal.hpp"
#include "cli/verify_run.hpp"
#include "ensemble/members.hpp"
#include "io/files.hpp"
#include "packing/words.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <filesystem>

namespace isostat::cli {

namespace {

/// Whether a file has the bytes that the certificate names, and the state that it speaks of.
ClaimCheck check_input(const Certificate& certificate, const std::string& input) {
    ClaimCheck check;
    check.claim = "input";
    check.claimed = true;
    const std::string hash = sha256(read_text(input));
    const std::string difference = state_difference(read_any_state(input, Dimensions::any).state, certificate.state);
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
        numbers[name] = number(value);
    }
    return object;
}

} // namespace

int verify(const VerifyArguments& arguments) {
    end_at_interrupts();
    if (std::filesystem::is_directory(arguments.certificate)) {
        if (!arguments.input.empty()) {
            throw Error(ErrorKind::usage, "--input belongs to a certificate, not to a folder");
        }
        return is_ensemble(arguments.certificate) ? verify_ensemble(arguments) : verify_folder(arguments);
    }
    const Certificate certificate = read_certificate(arguments.certificate);
    Verification verification = isostat::verify(certificate);
    if (!arguments.input.empty()) {
        verification.checks.push_back(check_input(certificate, arguments.input));
        if (verification.checks.back().verdict == Verdict::refuted) {
            verification.verdict = Verdict::refuted;
        }
    }
    if (arguments.common.json) {
        Json object;
        object["certificate"] = arguments.certificate;
        object["program"] = certificate.program;
        object["input"] = certificate.input;
        object["input_hash"] = certificate.input_hash;
        for (const ClaimCheck& check : verification.checks) {
            object["checks"].push_back(json_of(check));
        }
        object["verdict"] = to_string(verification.verdict);
        print_json(object);
        return status_of(verification.verdict);
    }
    say("{}: claims of {} about {} ({} {}s, {} contacts)\n", arguments.certificate, certificate.program,
        certificate.input, certificate.state.packing.disk_count(), grain_word(certificate.state.packing.dimension),
        certificate.state.contacts.size());
    for (const ClaimCheck& check : verification.checks) {
        say("{:<14} {:<9} {}\n", check.claim, check.claimed ? to_string(check.verdict) : "absent", check.detail);
    }
    for (const std::string& reason : certificate.claims.undecided) {
        say("not claimed by the program: {}\n", reason);
    }
    say("{:<14} {}\n", "equilibrium", to_string(verification.verdict));
    return status_of(verification.verdict);
}

} // namespace isostat::cli
