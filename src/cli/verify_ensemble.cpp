#include "cli/progress.hpp"
#include "cli/verify.hpp"
#include "ensemble/ensemble.hpp"
#include "io/files.hpp"

#include <isostat/core/result.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace isostat::cli {

namespace {

namespace fs = std::filesystem;

long lines_of(const fs::path& file) {
    if (!fs::is_regular_file(file) || fs::file_size(file) == 0) {
        return 0;
    }
    const std::string text = read_text(file);
    return std::ranges::count(text, '\n');
}

/// Records of the runs: those checked so far, and an estimate of the remaining time.
class Clock {
  public:
    explicit Clock(const std::vector<Member>& members) {
        for (const Member& member : members) {
            all_.push_back(lines_of(member.folder / "events.jsonl") + lines_of(member.folder / "equilibria.csv"));
            left_ += all_.back();
        }
    }
    void ended(std::size_t member) {
        done_ += all_[member];
        left_ -= all_[member];
    }
    [[nodiscard]] double elapsed() const { return pace_.elapsed(); }
    /// `here`: records of the current member.
    [[nodiscard]] double rest(long here) const {
        return pace_.rest(static_cast<double>(done_ + here), static_cast<double>(left_ - here));
    }

  private:
    std::vector<long> all_;
    long done_ = 0;
    long left_ = 0;
    Pace pace_;
};

struct MemberVerification {
    RunVerification run;
    std::string unreadable; ///< why a run could not be checked
};

void add(RunVerification& total, const MemberVerification& member) {
    const RunVerification& run = member.run;
    total.arcs += run.arcs;
    total.arcs_proved += run.arcs_proved;
    total.ways_proved += run.ways_proved;
    total.ties_checked += run.ties_checked;
    total.choices_checked += run.choices_checked;
    total.turns_checked += run.turns_checked;
    total.equilibria += run.equilibria;
    total.equilibria_proved += run.equilibria_proved;
    total.finished = total.finished && run.finished;
    total.verdict = total.verdict == Verdict::refuted || run.verdict == Verdict::refuted ? Verdict::refuted
                    : total.verdict == Verdict::proved && member.unreadable.empty()      ? run.verdict
                                                                                         : Verdict::undecided;
}

std::string word_of(const MemberVerification& member, const Member& of) {
    const std::string more = of.further > 0 ? fmt::format(", and {} after it", of.further) : "";
    return !of.begun ? "missing" + more : !member.unreadable.empty() ? "cannot be read" : words(member.run);
}

void print_row(const Member& of, const MemberVerification& member, const Clock& clock) {
    const RunVerification& run = member.run;
    say("{:>8} {:>14} {:>14} {:>14} {:>9} {:>8} {:>8}  {}\n", of.seed,
        fmt::format("{}/{}", run.equilibria_proved, run.equilibria), fmt::format("{}/{}", run.arcs_proved, run.arcs),
        fmt::format("{}/{}", run.ways_proved, run.arcs), run.undecided.size(), clock_text(clock.elapsed()),
        clock_text(clock.rest(0)), word_of(member, of));
    for (const std::string& text : {run.wrong, member.unreadable}) {
        if (!text.empty()) {
            say("         {}\n", text);
        }
    }
    std::fflush(stdout);
}

MemberVerification verify_member(const Member& member, const std::function<void(const VerificationProgress&)>& show) {
    MemberVerification result;
    if (!member.begun) {
        result.run.finished = false;
        return result;
    }
    try {
        result.run = verify_run(member.folder, show);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::bad_input) {
            throw;
        }
        result.unreadable = error.what(); // the other runs are still checked
    }
    return result;
}

} // namespace

int verify_ensemble(const std::string& folder, const Common& common) {
    const std::vector<Member> members = members_of(folder);
    const bool quiet = common.json || common.quiet;
    StatusLine line(quiet);
    Clock clock(members);
    RunVerification total;
    total.verdict = Verdict::proved;
    Json list = Json::array();
    bool readable = true;
    if (!quiet) {
        say("{:>8} {:>14} {:>14} {:>14} {:>9} {:>8} {:>8}\n", "seed", "equilibria", "ends of arcs", "ways", "undecided",
            "elapsed", "rest");
    }
    for (std::size_t k = 0; k < members.size(); ++k) {
        const MemberVerification member = verify_member(members[k], [&](const VerificationProgress& at) {
            line.show(fmt::format("seed {}, {} of {}: equilibrium {} of {}, {} left", members[k].seed, k + 1,
                                  members.size(), at.equilibrium, at.all_equilibria - 1,
                                  clock_text(clock.rest(at.arcs + at.equilibria))));
        });
        clock.ended(k);
        add(total, member);
        readable = readable && member.unreadable.empty();
        line.clear();
        if (!quiet) {
            print_row(members[k], member, clock);
        }
        Json object = json_of(member.run, members[k].folder.string());
        object["seed"] = members[k].seed;
        object["verdict"] = word_of(member, members[k]);
        object["unreadable"] = member.unreadable.empty() ? Json(nullptr) : Json(member.unreadable);
        list.push_back(object);
    }
    if (common.json) {
        Json object = json_of(total, folder);
        object["members"] = list;
        print_json(object);
    } else {
        print_totals(total);
    }
    const bool refuted = total.verdict == Verdict::refuted;
    return refuted || readable ? status_of(total.verdict) : Error(ErrorKind::bad_input, "").exit_status();
}

} // namespace isostat::cli
