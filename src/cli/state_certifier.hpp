#pragma once
/// \file
/// Certificates of the equilibria of a run, as they come (level `states`).

#include <isostat/io/certificate_file.hpp>
#include <isostat/trajectory/trajectory.hpp>

#include <filesystem>

namespace isostat::cli {

/// Writes certificates/eq_000012.json for every equilibrium, then hands the record, with its verdict, to the next
/// observer: when that one has written its checkpoint, the certificate is there. A certificate that is not proved does
/// not end the run: it is counted.
class StateCertifier final : public RunObserver<2> {
  public:
    StateCertifier(const std::filesystem::path& run, bool asked, RunCounters& counters, RunObserver<2>& next);
    void on_arc(const ArcRecord<2>& arc) override { next_.on_arc(arc); }
    void on_equilibrium(const EquilibriumRecord<2>& record, const State<2>& state,
                        const std::vector<double>& forces) override;

  private:
    std::filesystem::path folder_;
    bool asked_;
    RunCounters& counters_;
    RunObserver<2>& next_;
};

} // namespace isostat::cli
