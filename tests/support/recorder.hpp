#pragma once
// An observer that keeps what a run records.

#include <isostat/trajectory/trajectory.hpp>

#include <vector>

namespace crafted {

/// Collects the records of a run.
struct Recorder : isostat::RunObserver {
    std::vector<isostat::ArcRecord> arcs;
    std::vector<isostat::EquilibriumRecord> equilibria;
    std::vector<isostat::State> states;
    void on_arc(const isostat::ArcRecord& arc) override { arcs.push_back(arc); }
    void on_equilibrium(const isostat::EquilibriumRecord& record, const isostat::State& state,
                        const std::vector<double>&) override {
        equilibria.push_back(record);
        states.push_back(state);
    }
};

} // namespace crafted
