#pragma once
/// \file
/// Certificates of the equilibria of a run, as they come (level `states`).

#include <isostat/io/state_file.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <filesystem>
#include <optional>
#include <string>

namespace isostat {

/// Writes certificates/eq_000012.json for every equilibrium, then hands the record, with its verdict, to the next
/// observer: when that one has written its checkpoint, the certificate is there. A certificate that refutes its
/// equilibrium ends the run; one that is undecided is counted.
class StateCertifier final : public RunObserver {
  public:
    StateCertifier(const std::filesystem::path& run, std::string program, RunCounters& counters, RunObserver& next);
    void on_segment(int number, const Segment& goal, int made, const State& from) override {
        next_.on_segment(number, goal, made, from);
    }
    void on_arc(const ArcRecord& arc) override { next_.on_arc(arc); }
    void on_structure(const ProvedStructure& proved) override { proved_ = &proved; }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override;
    [[nodiscard]] std::optional<Failure> objection() const override { return objection_; }

  private:
    std::filesystem::path folder_;
    std::string program_;
    RunCounters& counters_;
    RunObserver& next_;
    const ProvedStructure* proved_ = nullptr; ///< of the next equilibrium
    std::optional<Failure> objection_;
};

} // namespace isostat
