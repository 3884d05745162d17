#pragma once
/// \file
/// Counters and observer of a run: private to the room.

#include "trajectory/prover.hpp"

namespace isostat {

/// Counts decisions and passes records to the observer. For the recording thread only.
class Recorder {
  public:
    /// All arguments must outlive the recorder.
    Recorder(const RunOptions& asked, RunCounters& counted, RunObserver& told)
        : options(asked), counters(counted), observer(told) {}

    const RunOptions& options;
    RunCounters& counters;
    RunObserver& observer;

    [[nodiscard]] bool stopped() const { return options.stop != nullptr && options.stop->load(); }
    void count(const Decision& decision);
    /// Counts the decisions of the proof.
    void count(const ArcProof& proof);
    /// Numbers, counts and shows a proved arc. Failure: the arc is
    /// based on more choices than are left; then it is not recorded.
    std::optional<Failure> record(ArcProof& proof, int arc, double stress);
    /// Smallest margin and highest rung of the decisions since the last call, into the record of an equilibrium.
    void take_margin(EquilibriumRecord& record);

  private:
    void count(const ArcCertificate& certificate, double seconds);
    double margin_ = std::numeric_limits<double>::infinity();
    Rung rung_ = Rung::combinatorial;
};

} // namespace isostat
