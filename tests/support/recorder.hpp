#pragma once
// An observer that keeps what a run records.

#include <isostat/trajectory/trajectory.hpp>

#include <vector>

namespace crafted {

/// Collects the records of a run.
struct Recorder : isostat::RunObserver<2> {
    std::vector<isostat::ArcRecord<2>> arcs;
    std::vector<isostat::EquilibriumRecord<2>> equilibria;
    std::vector<isostat::State<2>> states;
    void on_arc(const isostat::ArcRecord<2>& arc) override { arcs.push_back(arc); }
    void on_equilibrium(const isostat::EquilibriumRecord<2>& record, const isostat::State<2>& state,
                        const std::vector<double>&) override {
        equilibria.push_back(record);
        states.push_back(state);
    }
};

} // namespace crafted
