// Binds packings to begin with: prepared ones, and those of other programs.
#include "convert.hpp"
#include "core/refuse.hpp"

#include <isostat/core/result.hpp>
#include <isostat/crafted/plateau.hpp>
#include <isostat/foreign/foreign.hpp>
#include <isostat/preparation/preparation.hpp>

namespace isostat::python {

namespace {

/// Handles Ctrl-C in a preparation: its progress polls for signals, its flag stops it, KeyboardInterrupt follows.
template <class Work> std::shared_ptr<PyState> stoppable(int dimension, PreparationOptions options, Work work) {
    std::atomic<bool> stop{false};
    std::optional<py::error_already_set> raised;
    options.stop = &stop;
    options.progress = [&](const PreparationProgress&) {
        const py::gil_scoped_acquire acquire;
        if (!raised && PyErr_CheckSignals() != 0) {
            raised.emplace();
            stop = true;
        }
    };
    PreparationReport report;
    Result<State> result = unlocked([&] { return work(options, report); });
    if (raised) {
        throw py::error_already_set(*raised);
    }
    return std::make_shared<PyState>(PyState{value_or_raise(std::move(result), dimension), {}});
}

std::shared_ptr<PyState> prepare_disks(int disks, int dimension, std::uint64_t seed,
                                       std::pair<double, double> diameters, double jitter,
                                       const std::optional<std::vector<double>>& radii) {
    finite(diameters.first + diameters.second, "diameters");
    for (const double radius : radii.value_or(std::vector<double>())) {
        finite(radius, "radii");
    }
    PreparationOptions options;
    options.disks = disks;
    options.dimension = dimension;
    options.seed = seed;
    options.diameters.smallest = diameters.first;
    options.diameters.largest = diameters.second;
    options.jitter = finite(jitter, "jitter");
    options.radii = radii.value_or(std::vector<double>());
    return stoppable(dimension, options,
                     [](const PreparationOptions& o, PreparationReport& r) { return prepare(o, r); });
}

std::shared_ptr<PyState> vertex_near(const Packing& packing, const std::optional<std::vector<double>>& given,
                                     std::uint64_t seed) {
    require_single_grains(packing, "Packing", "find_vertex");
    const std::vector<double> stress = given.value_or(std::vector<double>(packing.axes(), 1.0));
    if (stress.size() != packing.axes() || stress.front() != stress[packing.axes() - 2]) {
        throw Error(ErrorKind::bad_input, packing.dimension == plane
                                              ? "stress: expected two numbers"
                                              : "stress: expected three numbers, the first two of them equal");
    }
    PreparationOptions options;
    options.stress = finite(stress.front(), "stress");
    options.ratio = finite(stress.back() / stress.front(), "ratio of the stresses");
    options.seed = seed;
    return stoppable(packing.dimension, options, [&packing](const PreparationOptions& o, PreparationReport& r) {
        return find_vertex(packing, o, r);
    });
}

Packing read_any(const std::filesystem::path& path, const std::string& walls,
                 const std::optional<std::vector<double>>& box, const std::string& radius, const std::string& diameter,
                 std::optional<int> dimension, const std::string& bodies) {
    ForeignOptions options;
    options.bodies = bodies;
    const auto known = value_of(walls, foreign_walls_words);
    if (!known || *known == ForeignWalls::square) {
        throw Error(ErrorKind::bad_input, "walls is '" + walls + "': expected \"box\", \"fixed\" or \"none\"");
    }
    options.box = box.value_or(std::vector<double>());
    for (const double side : options.box) {
        finite(side, "box");
    }
    options.walls = *known;
    if (!radius.empty()) {
        options.size = SizeStatement{SizeMeaning::radius, radius, 0};
    } else if (!diameter.empty()) {
        options.size = SizeStatement{SizeMeaning::diameter, diameter, 0};
    }
    options.dimension = dimension;
    return read_foreign(path, options).packing;
}

void bind_plateau(py::module_& module) {
    using crafted::Plateau, crafted::PlateauCounts, crafted::PlateauRange, crafted::PlateauStep;
    py::class_<PlateauCounts>(module, "PlateauCounts", "Counts of one contact list.")
        .def_readonly("dofs", &PlateauCounts::dof_count, "N_f.")
        .def_readonly("contacts", &PlateauCounts::contact_count, "N.")
        .def_readonly("rank", &PlateauCounts::rank, "Of the stored coordinates.")
        .def_readonly("h", &PlateauCounts::hyperstaticity, "N - rank.")
        .def_readonly("k", &PlateauCounts::mechanisms, "N_f - rank.")
        .def_readonly("turns", &PlateauCounts::turns, "Of k: turns of rotational rattlers, held through one member.")
        .def_readonly("isostatic", &PlateauCounts::isostatic,
                      "Verdict on: h = 0 and no internal mechanism but `turns`.");
    py::class_<PlateauStep>(module, "PlateauStep", "Counts at one threshold.")
        .def_readonly("threshold", &PlateauStep::threshold, "Pairs of at most this gap are contacts; length.")
        .def_readonly("rattlers", &PlateauStep::rattlers, "Disks, or bodies, that are not in the backbone.")
        .def_readonly("backbone", &PlateauStep::backbone, "PlateauCounts without rattlers.")
        .def_readonly("all", &PlateauStep::all, "PlateauCounts with all disks.");
    py::class_<PlateauRange>(module, "PlateauRange", "Thresholds t with first <= t < last; both ends are exact.")
        .def_readonly("first", &PlateauRange::first, "Length.")
        .def_readonly("last", &PlateauRange::last, "Length.")
        .def_readonly("open", &PlateauRange::open, "It goes on beyond the largest threshold.")
        .def_readonly("contacts", &PlateauRange::contacts, "N of the backbone at `first`.")
        .def_readonly("rattlers", &PlateauRange::rattlers, "At `first`.")
        .def_readonly("told", &PlateauRange::told, "It is wider than the rounding of gaps tells.");
    py::class_<Plateau>(module, "Plateau", "Counts against the gap threshold.")
        .def_readonly("steps", &Plateau::steps, "PlateauStep of each row asked for.")
        .def_readonly("ranges", &Plateau::ranges,
                      "Where the backbone of the stored doubles is proved isostatic, at every threshold inside.")
        .def_readonly("rounding", &Plateau::rounding, "Gaps that differ by less than twice that are noise; length.")
        .def_property_readonly(
            "widest",
            [](const Plateau& self) { return self.widest ? std::optional(self.widest->range) : std::nullopt; },
            "PlateauRange, the widest on a logarithmic scale with one N - N_f: what the packing says; or None.")
        .def_readonly("special", &Plateau::special, "Where counting says isostatic and the rank does not.")
        .def_readonly("no_self_stress_below", &Plateau::no_self_stress_below,
                      "h = 0 in the backbone at every smaller threshold.")
        .def_readonly("deepest_overlap", &Plateau::deepest_overlap, "The smallest gap; negative: overlap.")
        .def_readonly("changes", &Plateau::changes, "Different gaps: thresholds at which the contact list changes.");
    module.def(
        "plateau",
        [](const Packing& packing, double first, double last, int rows) {
            if (!(finite(first, "first") <= finite(last, "last")) || rows < 0) {
                refuse(ErrorKind::bad_input,
                       "plateau from {} to {}, {} rows: expected first <= last, and no negative number of rows", first,
                       last, rows);
            }
            return crafted::plateau(packing, first, last, rows);
        },
        py::arg("packing"), py::arg("first"), py::arg("last"), py::arg("rows") = 0,
        py::call_guard<py::gil_scoped_release>(),
        "Plateau of the stored coordinates between two thresholds (length; gaps are compared exactly); `rows`: about "
        "how many steps, 0 all.");
    module.def(
        "backbone_at",
        [](const Packing& packing, double threshold) {
            finite(threshold, "threshold");
            return contact_array(unlocked([&] { return crafted::backbone_at(packing, threshold); }));
        },
        py::arg("packing"), py::arg("threshold"), "(N, 2) contacts of the backbone at a threshold.");
}

} // namespace

void bind_preparation(py::module_& module) {
    module.def("prepare", &prepare_disks, py::arg("disks"), py::kw_only(), py::arg("dimension") = 2,
               py::arg("seed") = 1, py::arg("diameters") = std::pair(1.0, 2.0), py::arg("jitter") = 0.0,
               py::arg("radii") = py::none(),
               "State: random disks (`dimension` 3: spheres) to an equilibrium under stresses of 1. `diameters`: "
               "bounds of a uniform "
               "law; `radii`: a list instead. Seconds for a thousand disks; Ctrl-C ends it. Raises a Failure.");
    module.def("find_vertex", &vertex_near, py::arg("packing"), py::kw_only(), py::arg("stress") = py::none(),
               py::arg("seed") = 1,
               "State: the equilibrium downhill from a nearly jammed Packing in a box with a movable wall along each "
               "axis, proved. `stress`: of each axis, by default 1; of spheres the first two are equal. "
               "Raises Tie, Undecided, NotConverged, ... Ctrl-C ends it.");
    module.def(
        "read_packing", &read_any, py::arg("path"), py::kw_only(), py::arg("walls") = "box",
        py::arg("box") = py::none(), py::arg("radius") = "", py::arg("diameter") = "",
        py::arg("dimension") = py::none(), py::arg("bodies") = "", py::call_guard<py::gil_scoped_release>(),
        "Packing from another program: LAMMPS data and dumps, extended XYZ, CSV, tables. `walls`: \"box\" (two "
        "movable, of spheres three), \"fixed\", \"none\"; `box`: (xlo, xhi, ylo, yhi), of spheres zlo and zhi too; "
        "`radius` or `diameter`: the column that holds it, where its name does not say; `dimension` 2 or 3: disks "
        "or spheres (default: spheres where z is not the same for all); `bodies`: the column whose rows with the same "
        "number above 0 are one clump, or \"none\" (default: body, clump or clumpId where there is one).");
    bind_plateau(module);
}

} // namespace isostat::python
