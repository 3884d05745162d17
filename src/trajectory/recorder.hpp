#pragma once
/// \file
/// Counters and observer of a run: private to the room.

#include "trajectory/prover.hpp"

namespace isostat {

/// Counts what was decided, and tells the observer. For the thread that records only.
class Recorder {
  public:
    /// All must outlive the recorder.
    Recorder(const RunOptions& asked, RunCounters& counted, RunObserver& told)
        : options(asked), counters(counted), observer(told) {}

    const RunOptions& options;
    RunCounters& counters;
    RunObserver& observer;

    [[nodiscard]] bool stopped() const { return options.stop != nullptr && options.stop->load(); }
    void count(const Decision& decision);
    /// Its decisions.
    void count(const ArcProof& proof);
    /// An arc that happened: numbered, counted and shown. Failure: it rests on more choices than are left; it is not
    /// recorded then.
    std::optional<Failure> record(ArcProof& proof, int arc, double stress);
    /// Smallest margin and highest rung of the decisions since the last call, into the record of an equilibrium.
    void take_margin(EquilibriumRecord& record);

  private:
    void count(const ArcCertificate& certificate, double seconds);
    double margin_ = std::numeric_limits<double>::infinity();
    Rung rung_ = Rung::combinatorial;
};

} // namespace isostat
