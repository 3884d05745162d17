#include "report/run_report.hpp"

#include "certificate/averages.hpp"
#include "core/refuse.hpp"
#include "core/work.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/json.hpp"
#include "io/record_digests.hpp"
#include "packing/arc_bodies.hpp"
#include "report/charts.hpp"
#include "report/page.hpp"
#include "report/picture.hpp"
#include "report/statistics.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/io/run_directory.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>

namespace isostat {

namespace {

namespace fs = std::filesystem;

class Writer {
  public:
    /// \pre the folder exists. `owned`: all its files are those of a report; otherwise it may contain other files
    Writer(fs::path output, ReportOptions options, bool owned)
        : output_(std::move(output)), options_(std::move(options)), owned_(owned) {}

    /// `mark` as in `write_output`.
    void write(const std::string& name, const std::string& text, const std::string& mark = "") {
        write_output(output_ / name, text, owned_ ? "" : mark);
        result_.files.push_back(output_ / name);
    }
    void note(const std::string& text) {
        if (std::ranges::find(result_.notes, text) == result_.notes.end()) {
            result_.notes.push_back(text);
        }
    }
    /// Reads a state with its forces, if it is an equilibrium; bars are drawn without forces.
    StateFile read(const fs::path& path) {
        StateFile file = read_any_state(path, Dimensions::any_bodies);
        if (file.forces.empty()) {
            file.state = with_free_motions_held(std::move(file.state));
            file.forces = solve_forces(file.state, path);
        }
        for (std::size_t l = 0; l < file.forces.size(); ++l) {
            file.forces[l] = file.state.contacts[l].kind == ContactKind::bar ? 0 : file.forces[l];
        }
        return file;
    }
    void picture(const fs::path& path, const std::string& name) {
        const StateFile file = read(path);
        const State& state = file.state;
        if (options_.vtk) { // the file has the grains as points with radii
            require_no_arcs(state.packing, path.string(), "--vtk");
        }
        const std::string caption =
            state.packing.dimension != plane
                ? fmt::format("{} spheres", state.packing.disk_count())
                : fmt::format("equilibrium {}, {} disks, {} = {:.6g}", state.equilibrium, state.packing.disk_count(),
                              load_words(state.load).ratio_sign, state.load.ratio());
        if (options_.pictures) {
            count_work(Work::pictures);
            const auto draw = state.packing.dimension == plane ? force_picture : sphere_picture;
            write(name + ".svg", draw(state, file.forces, caption), " by isostat ");
        }
        if (options_.contacts) {
            write("contacts_" + name.substr(name.find('_') + 1) + ".csv", contact_table(state, certify(state)),
                  contact_table_mark);
        }
        if (options_.vtk) {
            count_work(Work::vtk_files);
            write(name + ".vtk",
                  vtk_text(state, file.forces, fmt::format("isostat: equilibrium {}", state.equilibrium),
                           displacement(state)),
                  "\nisostat: ");
            series_.emplace_back(state.equilibrium, name + ".vtk");
        }
    }
    void chart(const Chart& chart) {
        write(chart.name + ".dat", chart.data);
        write(chart.name + ".gp", chart.script);
        if (!options_.charts) {
            return;
        }
        count_work(Work::charts);
        const std::string trouble = run_gnuplot(output_, chart.name + ".gp");
        if (!trouble.empty()) {
            note(trouble);
            return;
        }
        for (const char* suffix : {".svg", ".png", ".pdf"}) {
            if (fs::exists(output_ / (chart.name + suffix))) {
                result_.files.push_back(output_ / (chart.name + suffix));
            }
        }
    }
    /// Writes the ParaView files as one series in the order of equilibria; returns in words how many of how many.
    std::string vtk_series(std::size_t equilibria) {
        std::ranges::sort(series_);
        json::Json files = json::Json::array();
        for (const auto& [equilibrium, name] : series_) {
            if (files.empty() || files.back()["time"] != equilibrium) { // the last state is stored twice
                files.push_back({{"name", name}, {"time", equilibrium}});
            }
        }
        if (!files.empty()) {
            write("forces.vtk.series", json::dumped({{"file-series-version", "1.0"}, {"files", files}}, 2) + "\n");
        }
        return files.empty()
                   ? ""
                   : fmt::format("\nParaView files of {} equilibria, of {} (states_every = 1 in a scene stores all)\n",
                                 files.size(), equilibria);
    }
    ReportResult take(std::string text) {
        result_.text = std::move(text);
        return std::move(result_);
    }

  private:
    std::vector<double> solve_forces(const State& state, const fs::path& path) {
        const auto inspection = inspect_vertex(state);
        if (!inspection.ok()) {
            note(fmt::format("{}: the picture shows no forces: {}", path.string(),
                             inspection.failure().message(state.packing.dimension)));
            return {};
        }
        std::vector<double> forces = inspection.value().forces;
        forces.resize(state.contacts.size()); // the multipliers of held coordinates are at the end
        return forces;
    }
    /// The displacements from the first state written.
    std::vector<double> displacement(const State& state) {
        const std::vector<double>& q = state.packing.q;
        if (first_.size() != q.size()) {
            first_ = q;
        }
        std::vector<double> moved(q.size());
        std::ranges::transform(q, first_, moved.begin(), std::minus<>());
        return moved;
    }
    std::vector<double> first_;
    std::vector<std::pair<int, std::string>> series_;
    fs::path output_;
    ReportOptions options_;
    bool owned_;
    ReportResult result_;
};

/// Counts of decisions by kind and by the rung that decided.
std::string decision_table(const json::Field& decisions) {
    const auto rung = [](std::size_t k) { return rung_words.at(k); };
    std::string text = fmt::format("\n{:<20} {:>13} {:>9} {:>13} {:>7} {:>7} {:>15}\n", "decisions", rung(0), rung(1),
                                   rung(2), rung(3), rung(4), "smallest margin");
    const auto row = [&](const std::string& name, const json::Field& counts) {
        text += fmt::format("{:<20} {:>13} {:>9} {:>13} {:>7} {:>7} {:>15.3g}\n", name, counts.at(rung(0)).integer(),
                            counts.at(rung(1)).integer(), counts.at(rung(2)).integer(), counts.at(rung(3)).integer(),
                            counts.at(rung(4)).integer(), counts.at("smallest_margin").number());
    };
    for (const char* kind : decision_kind_words) {
        row(kind, decisions.at("kinds").at(kind));
    }
    row("all", decisions);
    text += fmt::format("undecided            {} (ties {}); structural ties ordered by the infinitesimal loads {}\n",
                        decisions.at("undecided").integer(), decisions.at("ties").at("other").integer(),
                        decisions.at("ties").at("structural").integer());
    const json::Field ties = decisions.at("ties"), perturbed = ties.at("perturbed");
    std::string kinds;
    long all = 0;
    for (const char* kind : decision_kind_words) {
        const long count = perturbed.at(kind).integer();
        all += count;
        kinds += fmt::format("{}{} {}", kinds.empty() ? "" : ", ", kind, count);
    }
    text += all == 0 ? "" : fmt::format("settled by first order in the radii {} ({})\n", all, kinds);
    text += ties.has("choices") ? fmt::format("chosen by the rule   {}\n", ties.at("choices").integer()) : "";
    return text;
}

std::vector<fs::path> stored_states(const fs::path& directory, const FolderContent& content) {
    std::vector<fs::path> states;
    for (const std::string& name : content.files) {
        if (name.starts_with("states/")) {
            states.push_back(directory / name);
        }
    }
    return states;
}

/// Whether the stress on an axis changes, and not only that on a tilt.
bool changes_lengths(const Load& load) {
    return load.rate_of(0) != 0 || load.rate_of(1) != 0 || load.rate_of(2) != 0;
}

std::string page_of_disks(const fs::path& directory, const ReportOptions& options, Writer& writer) {
    Page page = run_page(directory, options.progress);
    for (const std::string& left_out : page.left_out) {
        writer.note(fmt::format("trajectory.html: left out: {}", left_out));
    }
    return std::move(page.html);
}

std::string page_of_spheres(const std::vector<fs::path>& states, const std::string& title, const SphereRun& run,
                            Writer& writer) {
    json::Json views = json::Json::array();
    for (const fs::path& path : states) {
        const StateFile file = writer.read(path);
        if (views.empty() || views.back()["equilibrium"] != file.state.equilibrium) { // the last state is stored twice
            views.push_back(sphere_view(file.state, file.forces));
        }
    }
    return sphere_page(title, views, run);
}

/// Makes the folder; figures may go into the folder of their run, or into a folder of reports.
void make_output(const fs::path& directory, const fs::path& output) {
    if (fs::weakly_canonical(output) == fs::weakly_canonical(directory / "figures")) {
        make_directory(output);
    } else {
        make_folder_for(output, report_folder);
    }
}

/// Adds the non-zero forces of a state, divided by their mean.
void add_scaled_forces(const fs::path& state, std::vector<double>& all) {
    const StateFile file = fs::exists(state) ? read_any_state(state, Dimensions::any_clumps) : StateFile();
    std::vector<double> forces;
    for (std::size_t l = 0; l < file.forces.size(); ++l) {
        if (file.forces[l] != 0 && file.state.contacts[l].is_unilateral()) {
            forces.push_back(file.forces[l]);
        }
    }
    const double scale = mean(forces);
    std::ranges::transform(forces, std::back_inserter(all), [scale](double f) { return f / scale; });
}

} // namespace

ReportResult report_run(const fs::path& directory, const fs::path& output, const ReportOptions& options) {
    const fs::path run = directory / "run.json";
    if (!fs::exists(run)) {
        refuse(run.string(), "does not exist: expected the folder of a run");
    }
    check_mark(directory, run_folder);
    const json::Json parsed = json::Field::parse(read_text(run), run.string());
    const json::Field header(parsed, run.string());
    const FolderContent content = content_of(directory, run_folder);
    (void)check_records(directory); // damaged records throw here
    std::vector<std::string> names;
    const json::Field programme = header.at("programme");
    for (std::size_t s = 0; s < programme.size(); ++s) {
        names.push_back(programme.at(s).string());
    }
    const std::vector<EquilibriumRow> rows = read_equilibria(directory / "equilibria.csv");
    const std::vector<fs::path> states = stored_states(directory, content);
    const State first = states.empty() ? State() : read_any_state(states.front(), Dimensions::any_clumps).state;
    make_output(directory, output);
    Writer writer(output, options, true);
    for (const std::string& note : notes_on(content, run_folder)) {
        writer.note(note);
    }
    const Load& load = first.load;
    const bool triaxial = load.dimension != plane && !rows.empty() && changes_lengths(load);
    const LoadWords words = load_words(load);
    std::string drawn;
    if (options.pictures || options.vtk || options.contacts) {
        if (options.pictures) {
            for (const Chart& chart : make_charts(rows, names, words, options.pdf)) {
                writer.chart(chart);
            }
            if (triaxial) {
                writer.chart(triaxial_chart(triaxial_branches(rows, load, names), options.pdf));
            }
        }
        for (const fs::path& path : states) {
            writer.picture(path, "forces_" + path.stem().string());
        }
        drawn = writer.vtk_series(rows.size());
    }
    if (options.html && load.dimension != plane) {
        const std::string title =
            fmt::format("{} spheres: {}", first.packing.disk_count(), header.at("status").string());
        writer.write("trajectory.html", page_of_spheres(states, title, {triaxial, rows, load, names}, writer));
    } else if (options.html) {
        writer.write("trajectory.html", page_of_disks(directory, options, writer));
    }
    std::string text = run_tables(rows, names, header.at("status").string(), words);
    const fs::path summary = directory / "summary.json"; // only runs that ended have one
    if (fs::exists(summary)) {
        const json::Json ended = json::Field::parse(read_text(summary), summary.string());
        text += decision_table(json::Field(ended, summary.string()).at("counters").at("decisions"));
    }
    writer.write("report.txt", text + drawn);
    return writer.take(text + drawn);
}

ReportResult report_state(const fs::path& state, const fs::path& output, const ReportOptions& options) {
    const std::string name = "forces_" + state.stem().string();
    if (options.html && read_any_state(state, Dimensions::any_bodies).state.packing.dimension == plane) {
        refuse(
            ErrorKind::usage,
            "{}: --html of one state is a view of spheres: this file is of disks, and without --html {}.svg shows them",
            state.string(), name);
    }
    make_directory(output);
    Writer writer(output, options, false);
    writer.picture(state, name);
    if (options.html) {
        writer.write(name + ".html", page_of_spheres({state}, "One state", {}, writer), "<title>Isostat</title>");
    }
    return writer.take(fmt::format("force picture of {}\n", state.string()));
}

ReportResult report_forces(const std::vector<fs::path>& runs, const fs::path& output, const ReportOptions& options) {
    constexpr double width = 0.25;
    std::array<std::vector<double>, 2> forces;
    for (const fs::path& run : runs) {
        add_scaled_forces(run / "states/eq_000000.json", forces[0]);
        add_scaled_forces(run / "states/last.json", forces[1]);
    }
    double largest = width;
    Chart chart{"force_distribution",
                fmt::format("# {} samples, {} and {} contacts with a force\n# f/<f> P_first P_last\n", runs.size(),
                            forces[0].size(), forces[1].size()),
                ""};
    for (const std::vector<double>& of : forces) {
        largest = of.empty() ? largest : std::max(largest, *std::ranges::max_element(of));
    }
    const int bins = static_cast<int>(std::ceil(largest / width));
    const auto first = histogram(forces[0], 0, bins * width, bins), last = histogram(forces[1], 0, bins * width, bins);
    for (std::size_t b = 0; b < first.size(); ++b) {
        chart.data += fmt::format("{} {} {}\n", first[b].first, first[b].second, last[b].second);
    }
    chart.script = chart_script(chart.name, 640, 480,
                                "set logscale y\nset format y \"10^{%T}\"\nset xlabel \"f / <f>\"\nset ylabel "
                                "\"P(f / <f>)\"\nset grid lc rgb \"#dddddd\"\nplot \"force_distribution.dat\" using "
                                "1:($2>0?$2:NaN) with points pt 7 title \"first equilibria\", \\\n    \"\" using "
                                "1:($3>0?$3:NaN) with points pt 6 title \"last equilibria\"\n",
                                options.pdf);
    make_directory(output);
    Writer writer(output, options, true);
    writer.chart(chart);
    return writer.take(fmt::format("forces of {} samples: {}\n", runs.size(), (output / chart.name).string()));
}

} // namespace isostat
