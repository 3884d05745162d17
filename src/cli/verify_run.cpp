#include "cli/progress.hpp"
#include "cli/verify.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace isostat::cli {

namespace {

/// Prints one row per equilibrium, as `run` does, and a line for the arcs between equilibria.
class VerifyTable {
  public:
    explicit VerifyTable(bool quiet) : quiet_(quiet), line_(quiet) {}
    void show(const VerificationProgress& at) {
        if (quiet_) {
            return;
        }
        const int done = at.arcs + at.equilibria;
        const double rest = pace_.rest(done, at.all_arcs + at.all_equilibria - done);
        if (!at.closed) {
            line_.show(fmt::format("equilibrium {} of {}: arc {} of {}, {} left", at.equilibrium, at.all_equilibria - 1,
                                   at.arcs, at.all_arcs, clock_text(rest)));
            return;
        }
        line_.clear();
        if (at.equilibria == 1) {
            say("{:>7} {:>6} {:>12} {:>9} {:>8} {:>8}\n", "equil", "arcs", "all arcs", "undecided", "elapsed", "rest");
        }
        say("{:>7} {:>6} {:>12} {:>9} {:>8} {:>8}\n", at.equilibrium, at.arcs_here,
            fmt::format("{}/{}", at.arcs, at.all_arcs), at.undecided, clock_text(pace_.elapsed()), clock_text(rest));
        std::fflush(stdout);
    }
    void end() { line_.clear(); }

  private:
    bool quiet_;
    StatusLine line_;
    Pace pace_;
};

} // namespace

Json json_of(const RunVerification& run, const std::string& folder) {
    Json object;
    object["folder"] = folder;
    object["arcs"] = run.arcs;
    object["ends_proved"] = run.arcs_proved;
    object["ways_proved"] = run.ways_proved;
    object["power_turns_checked"] = run.turns_checked;
    object["ties_checked"] = run.ties_checked;
    object["choices_checked"] = run.choices_checked;
    object["equilibria"] = run.equilibria;
    object["equilibria_proved"] = run.equilibria_proved;
    object["wrong"] = run.wrong.empty() ? Json(nullptr) : Json(run.wrong);
    object["undecided"] = run.undecided;
    object["notes"] = run.notes;
    object["finished"] = run.finished;
    object["verdict"] = words(run);
    return object;
}

void print_totals(const RunVerification& run) {
    say("arcs           ends of {} of {} proved, ways of {}\n", run.arcs_proved, run.arcs, run.ways_proved);
    if (run.turns_checked > 0 || run.ties_checked > 0) {
        say("power turns    {} checked\nties           {} first-order decisions checked\n", run.turns_checked,
            run.ties_checked);
    }
    if (run.choices_checked > 0) {
        say("choices        {} checked: what they are between is not refuted to be tied, which is not \"equal\"\n",
            run.choices_checked);
    }
    say("equilibria     {} of {} proved\n", run.equilibria_proved, run.equilibria);
    for (const std::string& open : run.undecided) {
        say("undecided      {}\n", open);
    }
    for (const std::string& note : run.notes) {
        say("note           {}\n", note);
    }
    if (!run.wrong.empty()) {
        say("first wrong    {}\n", run.wrong);
    }
    say("verdict        {}\n", words(run));
}

int verify_folder(const std::string& folder, const Common& common) {
    VerifyTable table(common.json || common.quiet);
    const RunVerification run = verify_run(folder, [&table](const VerificationProgress& at) { table.show(at); });
    table.end();
    if (common.json) {
        print_json(json_of(run, folder));
    } else if (!run.finished) {
        say("run            not finished: run.json says that it goes on, or was killed (`isostat run --resume`)\n");
    } else {
        print_totals(run);
    }
    return status_of(run.verdict);
}

} // namespace isostat::cli
