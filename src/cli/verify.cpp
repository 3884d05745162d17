#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/progress.hpp"

#include <isostat/checker/verify.hpp>
#include <isostat/checker/verify_run.hpp>
#include <isostat/core/error.hpp>
#include <isostat/io/files.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <cstdio>

namespace isostat::cli {

namespace {

int status_of_verdict(Verdict verdict) {
    switch (verdict) {
    case Verdict::proved: return done;
    case Verdict::refuted: return failed;
    case Verdict::undecided: return undecided;
    }
    return undecided;
}

/// Whether a file has the bytes that the certificate names, and the state that it speaks of.
ClaimCheck check_input(const Certificate& certificate, const std::string& input) {
    ClaimCheck check;
    check.claim = "input";
    check.claimed = true;
    const std::string hash = sha256(read_text(input));
    const std::string difference = state_difference(read_state<2>(input).state, certificate.state);
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

/// One row per equilibrium, as `run` prints them, and a line for the arcs on the way.
class VerifyTable {
  public:
    explicit VerifyTable(bool quiet) : quiet_(quiet), line_(quiet) {}
    void show(const VerificationProgress& at) {
        if (quiet_) {
            return;
        }
        const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
        const int done = at.arcs + at.equilibria;
        const double rest = done == 0 ? NAN : elapsed / done * (at.all_arcs + at.all_equilibria - done);
        if (!at.closed) {
            line_.show(fmt::format("equilibrium {} of {}: arc {} of {}, {} left", at.equilibrium, at.all_equilibria - 1,
                                   at.arcs, at.all_arcs, clock_text(rest)));
            return;
        }
        line_.clear();
        if (at.equilibria == 1) {
            fmt::print("{:>7} {:>6} {:>12} {:>9} {:>8} {:>8}\n", "equil", "arcs", "all arcs", "undecided", "elapsed",
                       "rest");
        }
        fmt::print("{:>7} {:>6} {:>12} {:>9} {:>8} {:>8}\n", at.equilibrium, at.arcs_here,
                   fmt::format("{}/{}", at.arcs, at.all_arcs), at.undecided, clock_text(elapsed), clock_text(rest));
        std::fflush(stdout);
    }
    void end() { line_.clear(); }

  private:
    bool quiet_;
    StatusLine line_;
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// A finished run from its records alone.
int verify_folder(const VerifyArguments& arguments) {
    VerifyTable table(arguments.common.json || arguments.common.quiet);
    const RunVerification run =
        verify_run(arguments.certificate, [&table](const VerificationProgress& at) { table.show(at); });
    table.end();
    if (arguments.common.json) {
        Json object;
        object["folder"] = arguments.certificate;
        object["arcs"] = run.arcs;
        object["ends_proved"] = run.arcs_proved;
        object["ways_proved"] = run.ways_proved;
        object["power_turns_checked"] = run.turns_checked;
        object["ties_checked"] = run.ties_checked;
        object["equilibria"] = run.equilibria;
        object["equilibria_proved"] = run.equilibria_proved;
        object["wrong"] = run.wrong.empty() ? Json(nullptr) : Json(run.wrong);
        object["undecided"] = run.undecided;
        object["finished"] = run.finished;
        object["verdict"] = words(run);
        print_json(object);
        return status_of_verdict(run.verdict);
    }
    if (!run.finished) {
        fmt::print(
            "run            not finished: run.json says that it goes on, or was killed (`isostat run --resume`)\n");
        return undecided;
    }
    fmt::print("arcs           ends of {} of {} proved, ways of {}\n", run.arcs_proved, run.arcs, run.ways_proved);
    if (run.turns_checked > 0 || run.ties_checked > 0) {
        fmt::print("power turns    {} checked\nties           {} first-order decisions checked\n", run.turns_checked,
                   run.ties_checked);
    }
    fmt::print("equilibria     {} of {} proved\n", run.equilibria_proved, run.equilibria);
    for (const std::string& open : run.undecided) {
        fmt::print("undecided      {}\n", open);
    }
    if (!run.wrong.empty()) {
        fmt::print("first wrong    {}\n", run.wrong);
    }
    fmt::print("run            {}\n", words(run));
    return status_of_verdict(run.verdict);
}

} // namespace

int verify(const VerifyArguments& arguments) {
    if (std::filesystem::is_directory(arguments.certificate)) {
        if (!arguments.input.empty()) {
            throw Error(ErrorKind::usage, "--input belongs to a certificate, not to the folder of a run");
        }
        return verify_folder(arguments);
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
        return status_of_verdict(verification.verdict);
    }
    fmt::print("{}: claims of {} about {} ({} disks, {} contacts)\n", arguments.certificate, certificate.program,
               certificate.input, certificate.state.packing.disk_count(), certificate.state.contacts.size());
    for (const ClaimCheck& check : verification.checks) {
        fmt::print("{:<14} {:<9} {}\n", check.claim, check.claimed ? to_string(check.verdict) : "absent", check.detail);
    }
    for (const std::string& reason : certificate.claims.undecided) {
        fmt::print("not claimed by the program: {}\n", reason);
    }
    fmt::print("{:<14} {}\n", "equilibrium", to_string(verification.verdict));
    return status_of_verdict(verification.verdict);
}

} // namespace isostat::cli
