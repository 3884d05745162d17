#include "cli/progress.hpp"

#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace isostat::cli {

StatusLine::StatusLine(bool quiet) : active_(!quiet && ::isatty(STDERR_FILENO) == 1) {}

void StatusLine::show(const std::string& text) {
    constexpr auto pause = std::chrono::milliseconds(100);
    constexpr std::size_t width = 100;
    const auto now = std::chrono::steady_clock::now();
    if (!active_ || now - last_ < pause) {
        return;
    }
    last_ = now;
    shown_ = true;
    say(stderr, "\r{:<{}}", text.substr(0, width), width);
    std::fflush(stderr);
}

void StatusLine::clear() {
    if (shown_) {
        say(stderr, "\r\033[K");
        std::fflush(stderr);
        shown_ = false;
    }
}

std::string clock_text(double seconds) {
    if (!std::isfinite(seconds) || seconds < 0) {
        return "?";
    }
    const long whole = std::lround(seconds);
    return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

RunTable::RunTable(const std::vector<ProgrammeStep>& programme, bool quiet)
    : programme_(programme), quiet_(quiet), line_(quiet) {}

void RunTable::on_segment(int number, const Segment& /*goal*/, int made, const State& from) {
    segment_ = number;
    made_ = made;
    start_equilibrium_ = from.equilibrium;
    start_ratio_ = from.load.ratio();
    stress_name_ = from.load.stress_name();
    strain_name_ = from.load.strain_name() == "shear strain" ? "strain" : from.load.strain_name();
    if (quiet_) {
        return;
    }
    line_.clear();
    if (!header_shown_) {
        header_shown_ = true;
        say("{:>7} {:>13} {:>12} {:>6} {:>2} {:>8} {:<13} {:>8} {:>8}\n", "equil", from.load.ratio_name(),
            from.load.strain_name(), "arcs", "h", "margin", "precision", "elapsed", "rest");
    }
    say("segment {} of {}: {}\n", number + 1, programme_.size(), programme_[static_cast<std::size_t>(number)].name);
    std::fflush(stdout);
}

double RunTable::remaining(double ratio) const {
    double rest = 0;
    for (auto s = static_cast<std::size_t>(segment_); s < programme_.size(); ++s) {
        const ProgrammeStep& step = programme_[s];
        const bool current = s == static_cast<std::size_t>(segment_);
        const int done = current ? made_ : 0;
        if (step.equilibria) {
            rest += *step.equilibria - done;
            continue;
        }
        // By the share of the change in sigma2/sigma1; before the
        // segment starts, all equilibria up to its start are counted.
        const double whole = *step.to - start_ratio_;
        const double part = current && whole != 0 ? (ratio - start_ratio_) / whole : 0;
        constexpr double enough = 0.05; // of the change, before its rate is used
        rest += part > enough
                    ? done * (1 - part) / part
                    : std::max(1, step.from.value_or(current ? start_equilibrium_ : start_equilibrium_ + made_));
    }
    return rest;
}

void RunTable::on_arc(const ArcRecord& arc) {
    if (!quiet_) {
        line_.show(fmt::format("towards equilibrium {}: arc {} at {} = {:.9g}, {} = {:.6g}", arc.equilibrium, arc.arc,
                               stress_name_, arc.stress, strain_name_, arc.strain));
    }
}

void RunTable::on_equilibrium(const EquilibriumRecord& record, const State& state,
                              const std::vector<double>& /*forces*/) {
    if (record.number != 0) {
        ++made_;
        ++here_;
    }
    if (quiet_) {
        return;
    }
    const double ratio = record.stress / record.sigma1;
    const double rest = pace_.rest(here_, remaining(ratio));
    line_.clear();
    say("{:>7} {:>13.9f} {:>12.5e} {:>6} {:>2} {:>8.1e} {:<13} {:>8} {:>8}\n", record.number, ratio,
        record.strain[static_cast<std::size_t>(state.load.loaded_axis)], record.arcs, record.hyperstaticity,
        record.margin, to_string(record.decided_by), clock_text(record.seconds), clock_text(rest));
    std::fflush(stdout);
}

} // namespace isostat::cli
