// Binds the folder of an ensemble, which Python fills sample by sample.
#include "ensemble/ensemble.hpp"

#include "convert.hpp"
#include "core/refuse.hpp"

#include <isostat/core/result.hpp>
#include <isostat/scene/scene.hpp>

namespace isostat::python {

namespace {

std::unique_ptr<EnsembleDirectory> ensemble_folder(const std::string& text, const std::filesystem::path& scene,
                                                   const std::filesystem::path& output, std::uint64_t seed, int samples,
                                                   const std::string& mode) {
    if (samples < 1 || samples > most_samples) {
        throw Error(ErrorKind::usage,
                    "samples is " + std::to_string(samples) + ": expected 1 to " + std::to_string(most_samples));
    }
    if (parse_scene(text, scene.string(), scene.parent_path()).programme.empty()) {
        refuse(scene.string(), "has no [[programme]]: expected at least one segment");
    }
    EnsembleHeader header;
    header.program = "isostat " ISOSTAT_VERSION;
    header.command = "isostat.ensemble";
    header.scene = scene;
    header.scene_text = text;
    header.first_seed = seed;
    header.samples = samples;
    return std::make_unique<EnsembleDirectory>(output, header,
                                               value_of(mode, folder_mode_words).value_or(FolderMode::fresh));
}

} // namespace

void bind_ensemble(py::module_& module) {
    using Directory = EnsembleDirectory;
    py::class_<Directory>(module, "_Ensemble")
        .def(py::init(&ensemble_folder), py::arg("text"), py::arg("scene"), py::arg("output"), py::arg("seed"),
             py::arg("samples"), py::arg("mode"))
        .def("folder", [](const Directory& self, std::size_t number) { return self.samples().folder(number); })
        .def("prepare", [](const Directory& self, std::size_t number) { return self.samples().prepare(number); })
        .def("finished",
             [](const Directory& self, std::size_t number) { return self.samples().sample(number).finished(); })
        .def("note",
             [](const Directory& self, std::size_t number, bool stopped, const std::string& reason) {
                 self.samples().note(number, stopped ? SampleStatus::interrupted : SampleStatus::crashed, reason);
             })
        .def(
            "merge", [](const Directory& self) -> As<"list[tuple[int, str, str]]"> {
                py::list rows;
                for (const Sample& sample : self.merge()) {
                    rows.append(py::make_tuple(sample.seed, to_string(sample.status), sample.reason));
                }
                return rows;
            });
    module.def(
        "_members", [](const std::filesystem::path& folder) -> As<"list[tuple[int, os.PathLike[str]]]"> {
            if (!is_ensemble(folder)) {
                refuse(folder.string(), "holds no ensemble: expected ensemble.json");
            }
            py::list rows;
            for (const Member& member : members_of(folder)) {
                if (member.begun) {
                    rows.append(py::make_tuple(member.seed, member.folder));
                }
            }
            return rows;
        });
}

} // namespace isostat::python
