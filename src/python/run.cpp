// Runs a scene from Python, with functions that are called for each arc and each equilibrium.
#include "checker/run_records.hpp"
#include "convert.hpp"
#include "core/refuse.hpp"
#include "io/equilibria.hpp"
#include "report/run_walk.hpp"

#include <isostat/core/result.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/preparation/preparation.hpp>
#include <isostat/scene/scene.hpp>

#include <atomic>
#include <optional>

namespace isostat::python {

namespace {

constexpr const char* program = "isostat " ISOSTAT_VERSION;
constexpr const char* command = "isostat.Run";

/// One equilibrium as passed to Python.
struct Equilibrium {
    EquilibriumRecord record;
    std::shared_ptr<PyState> state;
};

/// Calls the functions of Python; an exception of these, or Ctrl-C, is kept and stops the run.
class Watcher final : public RunObserver {
  public:
    Watcher(const py::object& on_arc, const py::object& on_equilibrium, std::atomic<bool>& stop)
        : on_arc_(on_arc), on_equilibrium_(on_equilibrium), stop_(stop) {}
    void on_arc(const ArcRecord& arc) override {
        call([&] {
            if (!on_arc_.is_none()) {
                on_arc_(arc);
            }
        });
    }
    void on_equilibrium(const EquilibriumRecord& record, const State& state,
                        const std::vector<double>& forces) override {
        call([&] {
            if (!on_equilibrium_.is_none()) {
                on_equilibrium_(Equilibrium{record, std::make_shared<PyState>(PyState{state, forces})});
            }
        });
    }
    /// Polls for signals.
    void poll() {
        call([] {});
    }
    /// \pre the interpreter is locked
    void raise_again() {
        if (raised_) {
            throw py::error_already_set(*raised_);
        }
    }

  private:
    template <class Work> void call(Work work) {
        const py::gil_scoped_acquire acquire;
        if (raised_) {
            return;
        }
        try {
            if (PyErr_CheckSignals() != 0) {
                throw py::error_already_set();
            }
            work();
        } catch (const py::error_already_set& error) {
            raised_.emplace(error);
            stop_ = true;
        }
    }
    const py::object& on_arc_;
    const py::object& on_equilibrium_;
    std::atomic<bool>& stop_;
    std::optional<py::error_already_set> raised_;
};

/// A run in its folder. Each `play` opens the folder, goes on from its checkpoint, and closes it.
class Run {
  public:
    Run(const std::string& text, const std::string& name, const std::filesystem::path& folder,
        std::filesystem::path output, const std::optional<PyState>& start)
        : scene_(parse_scene(text, name, folder)), output_(std::move(output)) {
        if (scene_.programme.empty()) {
            refuse(name, "has no [[programme]]: expected at least one segment to run");
        }
        if (start) {
            start_ = start_of_scene(start->state, scene_, name);
        }
    }

    void play(const std::string& mode, const As<"Optional[Callable[[Arc], object]]">& on_arc,
              const As<"Optional[Callable[[Equilibrium], object]]">& on_equilibrium) {
        stop_ = false;
        Watcher watcher(on_arc, on_equilibrium, stop_);
        const SceneEnding ending = unlocked([&] { return carry_out(mode, watcher); });
        status_ = to_string(ending.status);
        reason_ = ending.reason;
        watcher.raise_again();
        if (ending.failure && ending.failure->kind != FailureKind::interrupted) {
            raise({ending.failure->kind, ending.reason}, plane); // the reason is text already
        }
        if (ending.status == RunStatus::failed) {
            throw Error(ErrorKind::bad_input, ending.reason);
        }
    }

    void stop() { stop_ = true; }
    [[nodiscard]] const std::string& status() const { return status_; }
    [[nodiscard]] const std::string& reason() const { return reason_; }
    [[nodiscard]] const std::filesystem::path& path() const { return output_; }

  private:
    SceneEnding carry_out(const std::string& mode, Watcher& watcher) {
        if (!start_ && !scene_.start.empty() && mode != "resume") {
            start_ = start_from_file(scene_); // before the folder is made, because the input may be bad
        }
        RunCounters counters;
        RunDirectory directory(output_, header_of(scene_, program, command),
                               value_of(mode, folder_mode_words).value_or(FolderMode::fresh), counters);
        SceneEnding ending;
        if (const Result<State> start = start_in(directory, watcher); start.ok()) {
            ending = play_scene(scene_, start.value(), directory, program, counters, stop_, watcher);
        } else {
            ending = ending_of(start.failure(), "", scene_.preparation.dimension);
        }
        directory.finish(ending.status, ending.reason);
        return ending;
    }

    Result<State> start_in(RunDirectory& directory, Watcher& watcher) {
        if (const auto stored = directory.start()) {
            return *stored;
        }
        if (!start_) {
            PreparationOptions options = scene_.preparation;
            options.stop = &stop_;
            options.progress = [&watcher](const PreparationProgress&) { watcher.poll(); };
            PreparationReport report;
            Result<State> prepared = prepare(options, report);
            if (!prepared.ok()) {
                return prepared;
            }
            prepared.value().provenance = provenance_of(scene_, program, command, report);
            start_ = prepared.value();
        }
        directory.store_start(*start_);
        return *start_;
    }

    Scene scene_;
    std::filesystem::path output_;
    std::optional<State> start_;
    std::atomic<bool> stop_{false};
    std::string status_, reason_;
};

void bind_arc(py::module_& module) {
    using Arc = ArcRecord;
    const auto contact = [](auto member) {
        return [member](const Arc& self) -> As<"Pair"> {
            return contact_pair(self.*member);
        };
    };
    const auto image = [](auto member) {
        return [member](const Arc& self) {
            const auto& periods = (self.*member).image.m;
            return std::pair(int{periods[0]}, int{periods[1]});
        };
    };
    py::class_<Arc>(module, "Arc", "One arc: a contact opened, the mechanism followed, a contact met.")
        .def_readonly("step", &Arc::step, "Number of the arc in the run, from 1.")
        .def_readonly("equilibrium", &Arc::equilibrium, "Number of the equilibrium that it leads to.")
        .def_readonly("arc", &Arc::arc, "Number within the rearrangement, from 1.")
        .def_property_readonly(
            "kind", [](const Arc& self) { return to_string(self.kind); },
            "\"limit\", \"tension\", \"rattler\" or \"release\".")
        .def_property_readonly("opened", contact(&Arc::opened), "Contact opened, (i, j).")
        .def_property_readonly("closed", contact(&Arc::closed), "Contact met, or the coordinate held, (i, -9).")
        .def_property_readonly("opened_image", image(&Arc::opened),
                               "In a cell: periods by which the second disk of the opened contact is moved.")
        .def_property_readonly("closed_image", image(&Arc::closed), "The same of the contact met.")
        .def_readonly("power_turn", &Arc::power_turn, "It ended where the power of the load vanished.")
        .def_readonly("sigma2", &Arc::stress, "Loaded stress.")
        .def_readonly("eps2", &Arc::strain, "Strain at the end, positive in compression.")
        .def_readonly("force", &Arc::force, "In the opened contact; 0 at a limit.")
        .def_readonly("power", &Arc::power, "Force in the new contact.")
        .def_readonly("work", &Arc::work, "Decrease of the potential W along the arc.")
        .def_readonly("displacement", &Arc::displacement, "Largest displacement of a coordinate; length.")
        .def_readonly("margin", &Arc::margin, "Smallest |quantity| / bound of its decisions.")
        .def_readonly("decided_by", &Arc::decided_by, "The arithmetic that it took.");
}

void bind_equilibrium(py::module_& module) {
    using Record = EquilibriumRecord;
    const auto field = [](auto member) { return [member](const Equilibrium& self) { return self.record.*member; }; };
    py::class_<Equilibrium>(module, "Equilibrium", "One equilibrium, checked, with its state and forces.")
        .def_readonly("state", &Equilibrium::state, "State, with its forces.")
        .def_property_readonly("number", field(&Record::number), "0: the start.")
        .def_property_readonly("segment", field(&Record::segment), "Segment of the programme.")
        .def_property_readonly("sigma1", field(&Record::sigma1), "The other stress.")
        .def_property_readonly("sigma2", field(&Record::stress), "Loaded stress at which it was reached.")
        .def_property_readonly("sigma2_low", field(&Record::stress_low), "Lower end of the supported interval.")
        .def_property_readonly("sigma2_high", field(&Record::stress_high), "Upper end of the supported interval.")
        .def_property_readonly("opens_low", field(&Record::opens_low), "Contact that opens there, or None.")
        .def_property_readonly("opens_high", field(&Record::opens_high), "Contact that opens there, or None.")
        .def_property_readonly("strain", field(&Record::strain), "[eps_1, eps_2], positive in compression.")
        .def_property_readonly("length", field(&Record::length), "[Lx, Ly].")
        .def_property_readonly("potential", field(&Record::potential), "W = -sum F q.")
        .def_property_readonly("arcs", field(&Record::arcs), "Arcs of the rearrangement that led here.")
        .def_property_readonly("rank", field(&Record::rank), "Proved rank of the contact matrix.")
        .def_property_readonly("h", field(&Record::hyperstaticity), "N - rank.")
        .def_property_readonly("k", field(&Record::mechanisms), "N_f - rank.")
        .def_property_readonly("rattlers", field(&Record::rattlers), "Disks without force.")
        .def_property_readonly("min_force", field(&Record::min_force), "Smallest force of the backbone.")
        .def_property_readonly("min_gap", field(&Record::min_gap), "Smallest gap of all other pairs; length.")
        .def_property_readonly("margin", field(&Record::margin), "Smallest |quantity| / bound since the one before.")
        .def_property_readonly("verdict", field(&Record::verdict), "Verdict on: every check of it holds.");
}

/// The state of an equilibrium that was not stored, found by following the records.
PyState walked_to(const std::filesystem::path& folder, int number) {
    std::optional<State> found;
    const std::vector<std::string> lost =
        walk_run(checker::read_records(folder, LastLine::may_be_cut), [&](const WalkedVertex& at) {
            if (at.equilibrium != nullptr && at.state.equilibrium == number) {
                found = at.state;
            }
            return !found;
        });
    if (!found) {
        refuse(folder.string(), "equilibrium {} is not stored, and its records were not followed to it{}", number,
               lost.empty() ? "" : ": left out is " + lost.front());
    }
    return {std::move(*found), {}};
}

} // namespace

void bind_run(py::module_& module) {
    module.def(
        "_walked_to",
        [](const std::filesystem::path& folder, int number) {
            return interruptible([folder, number] { return walked_to(folder, number); });
        },
        py::arg("folder"), py::arg("number"));
    module.def(
        "_contact_spelt",
        [](const std::string& name, int dimension) {
            std::vector<int> row;
            if (const auto contact = checker::contact_spelt(name, dimension)) {
                const auto [i, j] = contact_columns(*contact);
                row = {i, j};
                row.insert(row.end(), contact->image.m.begin(), contact->image.m.begin() + dimension);
            }
            return row;
        },
        py::arg("name"), py::arg("dimension"), "i, j and the image of a contact in records; empty: it is none.");
    module.def(
        "_event_numbers",
        [](const std::string& header) {
            const MoreColumns more = header.empty() ? MoreColumns{} : named_columns(header + "\n", "equilibria.csv");
            return event_names(record_columns(more)).numbers;
        },
        py::arg("header"), "Names of the numbers of events.jsonl beside an equilibria.csv with such a first line.");
    bind_arc(module);
    bind_equilibrium(module);
    py::class_<Run>(module, "_Run")
        .def(py::init<const std::string&, const std::string&, const std::filesystem::path&, std::filesystem::path,
                      const std::optional<PyState>&>(),
             py::arg("text"), py::arg("name"), py::arg("folder"), py::arg("output"), py::arg("start"))
        .def("play", &Run::play, py::arg("mode"), py::arg("on_arc"), py::arg("on_equilibrium"))
        .def("stop", &Run::stop)
        .def_property_readonly("status", &Run::status)
        .def_property_readonly("reason", &Run::reason);
}

} // namespace isostat::python
