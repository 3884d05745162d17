#include "cli/progress.hpp"
#include "cli/verify.hpp"
#include "io/text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

namespace isostat::cli {

namespace {

namespace fs = std::filesystem;

/// The theorems with their script, and the program that writes
/// their input: beside an installed program, and in a build folder.
struct CoqFiles {
    fs::path script;
    fs::path writer;
};

CoqFiles coq_files() {
    const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
    const CoqFiles installed{here / ISOSTAT_COQ_FOLDER / "prove.py", here / ISOSTAT_COQ_WRITER};
    return fs::exists(installed.script)
               ? installed
               : CoqFiles{here / "coq/prove.py", here / "examples/example_equilibrium_certificate"};
}

/// The last line that a command prints; earlier lines are shown while it works.
std::string last_line(const std::string& command, bool quiet) {
    StatusLine line(quiet);
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "re"), ::pclose);
    if (!pipe) {
        return {};
    }
    std::string last; // the end of a long line is no separate line
    std::array<char, 4096> part{};
    for (bool whole = true; std::fgets(part.data(), static_cast<int>(part.size()), pipe.get()) != nullptr;) {
        last = (whole ? "" : last) + part.data();
        whole = last.ends_with('\n');
        if (whole) {
            last.pop_back();
            line.show(last);
        }
    }
    return last;
}

} // namespace

ClaimCheck ask_coq(CoqChecker checker, const std::string& certificate, const std::string& digest, double limit,
                   bool quiet) {
    const bool extracted = checker == CoqChecker::extracted;
    const CoqFiles files = coq_files();
    ClaimCheck check;
    check.claim = extracted ? "coq-extracted" : "coq";
    check.claimed = true;
    if (!fs::exists(files.script) || !fs::exists(files.writer)) {
        check.detail =
            fmt::format("not asked: {} is not there",
                        (fs::exists(files.script) ? files.writer : files.script).lexically_normal().string());
        return check;
    }
    const std::string answer = last_line(
        fmt::format("exec python3 -I -B {} {} {} --sha256 {} --limit {}{}", text::shell(files.script.string()),
                    text::shell(files.writer.string()), text::shell(fs::absolute(certificate).string()), digest, limit,
                    extracted ? " --extracted" : ""),
        quiet);
    constexpr std::string_view proved = "proved ";
    constexpr std::string_view undecided = "undecided ";
    if (answer.starts_with(proved)) {
        check.verdict = Verdict::proved;
        check.detail = answer.substr(proved.size());
    } else {
        check.detail = answer.starts_with(undecided)
                           ? answer.substr(undecided.size())
                           : fmt::format("no answer from {} (is python3 there?): {}", files.script.string(), answer);
    }
    return check;
}

} // namespace isostat::cli
