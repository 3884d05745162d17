#pragma once
/// \file
/// Progress of long work for a person: a table of equilibria, and a line that is rewritten on a terminal.

#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <chrono>
#include <string>

namespace isostat::cli {

/// A line on standard error that is rewritten in place: only on a terminal, at most ten times per second.
class StatusLine {
  public:
    explicit StatusLine(bool quiet);
    ~StatusLine() { clear(); }
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;
    void show(const std::string& text);
    /// To be called before anything else is printed.
    void clear();

  private:
    bool active_;
    bool shown_ = false;
    std::chrono::steady_clock::time_point last_;
};

/// "1:02:03".
std::string clock_text(double seconds);

/// Time since construction, and the time that is left at the pace until now.
class Pace {
  public:
    [[nodiscard]] double elapsed() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
    }
    /// \p left: in the unit of `done`. Negative, which `clock_text` does not know, where nothing is done.
    [[nodiscard]] double rest(double done, double left) const { return done > 0 ? elapsed() / done * left : -1; }

  private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Prints one row per equilibrium: number, ratio, strain, arcs, h, smallest margin, precision used, elapsed,
/// estimated rest.
class RunTable final : public RunObserver {
  public:
    RunTable(const std::vector<ProgrammeStep>& programme, bool quiet);
    void on_segment(int number, const Segment& goal, int made, const State& from) override;
    void on_arc(const ArcRecord& arc) override;
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override;
    void end() { line_.clear(); }

  private:
    /// Estimate of equilibria still to come: from their number in segments that have one, from the ratio in others.
    [[nodiscard]] double remaining(double ratio) const;
    const std::vector<ProgrammeStep>& programme_;
    bool quiet_;
    StatusLine line_;
    Pace pace_;
    int segment_ = 0;
    int made_ = 0; ///< in this segment
    int here_ = 0; ///< equilibria made by this process
    int start_equilibrium_ = 0;
    double start_ratio_ = 1;
    std::string stress_name_, strain_name_; ///< names of the loaded stress and strain
    bool header_shown_ = false;
};

} // namespace isostat::cli
