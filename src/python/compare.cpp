// Binds snap and compare, for soft grains of other programs.
#include "compare/report.hpp"
#include "convert.hpp"
#include "snap/force_split.hpp"
#include "snap/soft_list.hpp"

#include <isostat/compare/compare.hpp>
#include <isostat/core/result.hpp>

#include <atomic>

namespace isostat::python {

namespace {

/// The result of `snap` for a state of soft grains.
struct Snapped {
    compare::Snap snap;
    compare::ForceSplit forces;
    std::shared_ptr<PyState> state; ///< null when there is no state
    std::string reason;
};

Snapped snapped(const PyState& file, double stiffness, const std::string& law) {
    const auto known = value_of<compare::ForceLaw>(law, compare::force_law_words);
    if (!known || *known == compare::ForceLaw::none) {
        throw Error(ErrorKind::bad_input, "law is '" + law + "': expected \"linear\" or \"hertz\"");
    }
    require_single_grains(file.state.packing, "state", "snap");
    Snapped out;
    compare::SoftForces grains = compare::soft_grains(file, "state");
    if (finite(stiffness, "stiffness") < 0) {
        throw Error(ErrorKind::bad_input, "stiffness is " + std::to_string(stiffness) + ": expected a positive number");
    }
    if (stiffness > 0) {
        compare::add_law(grains, {*known, stiffness});
    }
    out.snap = compare::snap(grains.soft);
    out.reason = out.snap.reason;
    if (!grains.forces.empty() && out.snap.counting.hyperstaticity == 0 && out.snap.counting.mechanisms == 0) {
        out.forces = compare::split_forces(grains.soft, grains.forces, compare::mean_force(grains.forces), out.snap);
    }
    if (out.snap.outcome == compare::SnapOutcome::vertex) {
        auto state = compare::with_resting_rattlers(out.snap, 1);
        if (state.ok()) {
            out.state = std::make_shared<PyState>(PyState{std::move(state.value()), {}});
        } else {
            out.reason = state.failure().message(file.state.packing.dimension);
        }
    }
    return out;
}

void bind_snap(py::module_& module) {
    py::class_<Snapped>(module, "Snap", "What became of soft grains: see `snap`.")
        .def_property_readonly(
            "outcome", [](const Snapped& self) { return to_string(self.snap.outcome); },
            "\"vertex\", \"hyperstatic\", \"moving\", \"refuted\" or \"undecided\".")
        .def_readonly("reason", &Snapped::reason, "Why there is no vertex, or no state.")
        .def_property_readonly(
            "h", [](const Snapped& self) { return self.snap.counting.hyperstaticity; }, "Of the list.")
        .def_property_readonly(
            "k", [](const Snapped& self) { return self.snap.counting.mechanisms; }, "Of the list.")
        .def_property_readonly(
            "rattlers", [](const Snapped& self) { return self.snap.rattlers; }, "Grains without a contact in the list.")
        .def_property_readonly(
            "distance", [](const Snapped& self) { return self.snap.distance; },
            "Proved bound of the way of a grain with a force to the true vertex; length, inf without one.")
        .def_property_readonly(
            "walls", [](const Snapped& self) { return self.snap.walls; }, "The same of the walls, or the periods.")
        .def_property_readonly(
            "rest", [](const Snapped& self) { return self.forces.rest; },
            "Largest |f - forces that balance there|, in mean forces, an upper bound; nan: not known.")
        .def_property_readonly(
            "stiffness", [](const Snapped& self) { return self.forces.stiffness; },
            "Largest |those - forces at the vertex|, likewise.")
        .def_property_readonly(
            "state", [](const Snapped& self) -> As<"Optional[State]"> { return py::cast(self.state); },
            "State: the vertex, rattlers at rest. None.");
    module.def(
        "snap",
        [](const PyState& state, double stiffness, const std::string& law) {
            return interruptible([state, stiffness, law] { return snapped(state, stiffness, law); });
        },
        py::arg("state"), py::kw_only(), py::arg("stiffness") = 0.0, py::arg("law") = "linear",
        "Snap: from soft grains (a State with their contacts; overlaps are allowed) to the vertex of rigid ones with "
        "the same contacts, proved. `stiffness`: force / overlap, where the state has no forces; with `law` \"hertz\" "
        "force / (overlap^(3/2) sqrt(R_i R_j / (R_i + R_j))). Disks and spheres. Ctrl-C leaves it.");
}

/// The results of `isostat compare`, as the text of comparison.json.
std::string compared(const std::filesystem::path& series, const std::optional<PyState>& reference, int bundle,
                     bool local, bool nearest_arc, const std::optional<std::filesystem::path>& output) {
    std::atomic<bool> stop{false};
    compare::CompareOptions options;
    options.bundle = bundle;
    options.local = local;
    options.nearest_arc = nearest_arc;
    options.stop = &stop;
    if (reference) {
        require_single_grains(reference->state.packing, "reference", "compare");
        options.start = reference->state;
    }
    auto task = std::async(std::launch::async, [&] {
        compare::SeriesReader reader(series);
        const compare::Comparison comparison = compare::compare(reader, options);
        if (output && !stop) {
            (void)compare::write_comparison(*output, reader.series(), comparison);
        }
        return compare::comparison_json(reader.series(), comparison);
    });
    try {
        const py::gil_scoped_release release;
        while (task.wait_for(std::chrono::milliseconds{50}) != std::future_status::ready) {
            check_signals();
        }
    } catch (...) {
        stop = true;
        task.wait();
        throw;
    }
    return task.get();
}

} // namespace

void bind_compare(py::module_& module) {
    bind_snap(module);
    module.def("_compare", &compared, py::arg("series"), py::arg("reference"), py::arg("bundle"), py::arg("local"),
               py::arg("nearest_arc"), py::arg("output"), "The text of comparison.json.");
}

} // namespace isostat::python
