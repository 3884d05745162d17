#include "compare/report.hpp"

#include "contact/words.hpp"
#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/json.hpp"
#include "io/text.hpp"
#include "report/charts.hpp"

#include <isostat/io/state_file.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <functional>
#include <ranges>

namespace isostat::compare {

namespace {

using json::Json;
using json::or_null;

/// One column with its name and its value.
template <class Row> struct Column {
    std::string name;
    std::function<Json(const Row&)> value;
};

Json names(const std::vector<Contact>& contacts, int dimension) {
    return fmt::format("{}", fmt::join(contact_names(contacts, dimension), " "));
}

/// sigma2, eps2; for spheres sigma3, eps3.
std::string loaded(const std::string& name, int dimension) {
    return name + std::to_string(dimension);
}

/// eps1, eps2, ...
template <PerAxis<double> FrameResult::*strain>
void add_strains(std::vector<Column<FrameResult>>& columns, const std::string& name, int dimension) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        columns.push_back(
            {name + std::to_string(a + 1), [a](const FrameResult& f) { return or_null((f.*strain)[a]); }});
    }
}

std::vector<Column<FrameResult>> of_frames(int dimension) {
    using F = FrameResult;
    std::vector<Column<F>> columns{{"frame", [](const F& f) { return f.frame; }},
                                   {"timestep", [](const F& f) { return f.timestep; }},
                                   {loaded("sigma", dimension), [](const F& f) { return or_null(f.stress); }},
                                   {"unbalanced", [](const F& f) { return or_null(f.unbalanced); }},
                                   {"listed", [](const F& f) { return f.listed; }},
                                   {"overlapping", [](const F& f) { return f.overlapping; }},
                                   {"twice", [](const F& f) { return f.twice; }},
                                   {"missing_rows", [](const F& f) { return f.missing_rows; }},
                                   {"dofs", [](const F& f) { return f.counting.dof_count; }},
                                   {"contacts", [](const F& f) { return f.counting.contact_count; }},
                                   {"rank", [](const F& f) { return f.counting.rank; }},
                                   {"h", [](const F& f) { return f.counting.hyperstaticity; }},
                                   {"k", [](const F& f) { return f.counting.mechanisms; }},
                                   {"rattlers", [](const F& f) { return f.rattlers; }},
                                   {"snap", [](const F& f) { return f.snapped; }},
                                   {"distance", [](const F& f) { return or_null(f.distance); }},
                                   {"walls", [](const F& f) { return or_null(f.walls); }},
                                   {"expected", [](const F& f) { return f.expected; }},
                                   {"found", [](const F& f) { return f.found; }},
                                   {"node", [](const F& f) { return f.node; }},
                                   {"status", [](const F& f) { return to_string(f.status); }},
                                   {"missing", [dimension](const F& f) { return names(f.missing, dimension); }},
                                   {"extra", [dimension](const F& f) { return names(f.extra, dimension); }},
                                   {"law", [](const F& f) { return or_null(f.law); }},
                                   {"ratio", [](const F& f) { return or_null(f.ratio); }},
                                   {"rest", [](const F& f) { return or_null(f.rest); }},
                                   {"stiffness", [](const F& f) { return or_null(f.stiffness); }},
                                   {"downhill", [](const F& f) { return or_null(f.downhill); }},
                                   {"self_stress", [](const F& f) { return or_null(f.self_stress); }}};
    add_strains<&F::strain>(columns, "eps", dimension);
    add_strains<&F::true_strain>(columns, "true_eps", dimension);
    columns.push_back({"local", [](const F& f) { return f.local; }});
    columns.push_back({"nearest_arc", [](const F& f) { return f.nearest_arc; }});
    columns.push_back({"reason", [](const F& f) { return f.reason; }});
    return columns;
}

std::vector<Column<PathEquilibrium>> of_path(int dimension) {
    using E = PathEquilibrium;
    return {{"number", [](const E& e) { return e.number; }},
            {loaded("sigma", dimension), [](const E& e) { return or_null(e.stress); }},
            {loaded("eps", dimension), [](const E& e) { return or_null(e.strain); }},
            {loaded("sigma", dimension) + "_low", [](const E& e) { return or_null(e.low); }},
            {loaded("sigma", dimension) + "_high", [](const E& e) { return or_null(e.high); }},
            {"arcs", [](const E& e) { return e.arcs; }},
            {"contacts", [](const E& e) { return e.contacts.size(); }},
            {"proved", [](const E& e) { return e.proved ? 1 : 0; }},
            {"opens", [dimension](const E& e) { return e.opens.i < 0 ? Json() : Json(to_string(e.opens, dimension)); }},
            {"soft_limit", [](const E& e) { return or_null(e.soft_limit); }},
            {"stiffness_needed", [](const E& e) { return or_null(e.stiffness_needed); }}};
}

Json numbers(const std::vector<int>& values) {
    return fmt::format("{}", fmt::join(values, " "));
}

std::vector<Column<BundleNode>> of_nodes(int dimension) {
    using N = BundleNode;
    return {{"node", [](const N& n) { return n.equilibrium.number; }},
            {loaded("sigma", dimension), [](const N& n) { return or_null(n.equilibrium.stress); }},
            {loaded("eps", dimension), [](const N& n) { return or_null(n.equilibrium.strain); }},
            {loaded("sigma", dimension) + "_low", [](const N& n) { return or_null(n.equilibrium.low); }},
            {loaded("sigma", dimension) + "_high", [](const N& n) { return or_null(n.equilibrium.high); }},
            {"contacts", [](const N& n) { return n.equilibrium.contacts.size(); }},
            {"proved", [](const N& n) { return n.equilibrium.proved ? 1 : 0; }},
            {"members", [](const N& n) { return numbers(n.members); }},
            {"frames", [](const N& n) { return numbers(n.frames); }}};
}

std::vector<Column<BundleMember>> of_members() {
    using M = BundleMember;
    return {{"rule", [](const M& m) { return word_of(m.rule, opening_rule_words); }},
            {"seed", [](const M& m) { return m.seed; }},
            {"rattlers", [](const M& m) { return m.rest; }},
            {"nodes", [](const M& m) { return numbers(m.nodes); }},
            {"end", [](const M& m) { return m.end; }}};
}

/// The text of a value, "nan" for null.
std::string cell(const Json& value) {
    if (value.is_null()) {
        return "nan";
    }
    if (!value.is_string()) {
        return value.is_number_float() ? fmt::format("{}", value.get<double>()) : value.dump();
    }
    return text::csv(value.get_ref<const std::string&>());
}

template <class Row> std::string csv(const std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
    std::string text = fmt::format("{}\n", fmt::join(columns | std::views::transform(&Column<Row>::name), ","));
    for (const Row& row : rows) {
        const auto cell_of = [&row](const Column<Row>& column) { return cell(column.value(row)); };
        text += fmt::format("{}\n", fmt::join(columns | std::views::transform(cell_of), ","));
    }
    return text;
}

template <class Row> Json objects(const std::vector<Column<Row>>& columns, const std::vector<Row>& rows) {
    return json::array_of(rows, [&](const Row& row) {
        Json object;
        for (const auto& column : columns) {
            object[column.name] = column.value(row);
        }
        return object;
    });
}

/// Whether an error has a point on the logarithmic axis.
bool shown(double error) {
    return error > 0 && std::isfinite(error);
}

/// Data of the figure in blocks. gnuplot does not count a block
/// without lines, so that such a block is left out, with its curve.
class Blocks {
  public:
    /// Adds a block and returns its clause of `plot`; empty without lines. {} in `clause`: the file and the block.
    std::string add(const std::string& title, const std::string& lines, const std::string& clause) {
        if (lines.empty()) {
            return {};
        }
        data_ += fmt::format("{}# {}\n{}", count_ > 0 ? "\n\n" : "", title, lines);
        return fmt::format(fmt::runtime(clause), fmt::format("\"comparison.dat\" index {}", count_++));
    }
    [[nodiscard]] const std::string& data() const { return data_; }

  private:
    std::string data_;
    int count_ = 0;
};

template <class Row, class Line> std::string lines_of(const std::vector<Row>& rows, const Line& line) {
    std::string text;
    for (const Row& row : rows) {
        text += line(row);
    }
    return text;
}

std::string plot(const std::vector<std::string>& clauses) {
    std::string text;
    for (const std::string& clause : clauses) {
        text += clause.empty() ? "" : (text.empty() ? "plot " : ", ") + clause;
    }
    return text.empty() ? text : text + "\n";
}

std::string staircase(const std::vector<PathEquilibrium>& path) {
    std::string text;
    for (std::size_t k = 0; k < path.size(); ++k) {
        text += k > 0 ? fmt::format("{} {}\n", path[k - 1].strain, path[k].stress) : "";
        text += fmt::format("{} {}\n", path[k].strain, path[k].stress);
    }
    return text;
}

/// Curves over the strain: supported loads of the bundle, the exact run, the frames.
std::string path_panel(const Comparison& comparison, Blocks& blocks) {
    const std::string bundle = lines_of(comparison.bundle.nodes, [](const BundleNode& node) {
        const PathEquilibrium& e = node.equilibrium;
        return std::isfinite(e.high) ? fmt::format("{} {} {} {}\n", e.strain, e.low, e.high, node.members.size())
                                     : std::string();
    });
    const int d = comparison.dimension;
    const auto a = static_cast<std::size_t>(d) - 1;
    const std::string frames = lines_of(comparison.frames, [a](const FrameResult& f) {
        return fmt::format("{} {}\n", std::isfinite(f.true_strain[a]) ? f.true_strain[a] : f.strain[a], f.stress);
    });
    return plot({blocks.add(fmt::format("bundle: eps{0} sigma{0}_low sigma{0}_high members", d), bundle,
                            "{} using 1:2:(0):($3-$2) with vectors nohead lw 4 lc \"#c3d3e3\" title \"bundle: "
                            "supported loads\""),
                 blocks.add(fmt::format("exact run: eps{0} sigma{0}", d), staircase(comparison.path),
                            "{} with lines lw 2 lc \"#1f4e79\" title \"exact run\""),
                 blocks.add(fmt::format("frames: eps{0} of the true vertex or of the frame, sigma{0}", d), frames,
                            "{} with points pt 6 lc \"#c55a11\" title \"frames\"")});
}

/// Curves over the load: exact limits, and the status of each frame.
std::string status_panel(const Comparison& comparison, Blocks& blocks) {
    const std::string limits =
        lines_of(comparison.path, [](const PathEquilibrium& e) { return fmt::format("{}\n", e.stress); });
    const std::string statuses = lines_of(comparison.frames, [](const FrameResult& f) {
        return fmt::format("{} {}\n", f.stress, static_cast<int>(f.status));
    });
    return plot(
        {blocks.add(fmt::format("exact limits: sigma{}", comparison.dimension), limits,
                    fmt::format("{{}} using 1:(-0.5):(0):({}) with vectors nohead lc \"#bbbbbb\"", frame_statuses)),
         blocks.add(fmt::format("statuses: sigma{} status", comparison.dimension), statuses,
                    "{} with points pt 7 ps 0.7 lc \"#c55a11\"")});
}

/// The errors of the forces that have points on the axis.
std::string errors_panel(const Comparison& comparison, Blocks& blocks) {
    struct Curve {
        const char* name;
        double FrameResult::*error;
        const char* style;
    };
    const std::array<Curve, 4> all{{{"law", &FrameResult::law, "pt 4 lc \"#548235\""},
                                    {"rest", &FrameResult::rest, "pt 6 lc \"#1f4e79\""},
                                    {"stiffness", &FrameResult::stiffness, "pt 7 lc \"#c55a11\""},
                                    {"against the vertex downhill", &FrameResult::downhill, "pt 2 lc \"#7f7f7f\""}}};
    std::vector<std::string> curves;
    for (const Curve& curve : all) {
        const std::string lines = lines_of(comparison.frames, [&](const FrameResult& f) {
            return shown(f.*curve.error) ? fmt::format("{} {}\n", f.stress, f.*curve.error) : std::string();
        });
        curves.push_back(blocks.add(fmt::format("errors of the forces: sigma{}, {}", comparison.dimension, curve.name),
                                    lines, fmt::format("{{}} with points {} title \"{}\"", curve.style, curve.name)));
    }
    const std::string panel = plot(curves);
    return panel.empty() ? panel
                         : "set key below horizontal\nset yrange [*:*] noreverse\nset ytics auto\nset logscale "
                           "y\nset format y \"10^{%L}\"\nset ylabel \"error / mean force\"\n" +
                               panel;
}

Chart figure(const Comparison& comparison) {
    std::string tics;
    for (int s = 0; s < frame_statuses; ++s) {
        tics += fmt::format("{}\"{}\" {}", s > 0 ? ", " : "", to_string(static_cast<FrameStatus>(s)), s);
    }
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const FrameResult& f : comparison.frames) {
        low = std::min(low, f.stress);
        high = std::max(high, f.stress);
    }
    const double margin = 0.03 * (high - low) + 1e-6 * high;
    Blocks blocks;
    std::string body = "set multiplot layout 3,1\nset lmargin at screen 0.14\nset rmargin at screen 0.96\nset "
                       "grid\nset key right bottom\n";
    body += fmt::format("set yrange [{}:{}]\nset xlabel \"strain ε_{}\"\nset ylabel \"σ_{}\"\n", low - margin,
                        high + margin, comparison.dimension, comparison.dimension);
    body += path_panel(comparison, blocks);
    body += fmt::format("unset key\nset xrange [{}:{}]\nset xlabel \"σ_{}\"\nset ylabel \"\"\nset yrange [-0.5:{}] "
                        "reverse\nset ytics ({})\n",
                        low - margin, high + margin, comparison.dimension, frame_statuses - 0.5, tics);
    body += status_panel(comparison, blocks);
    body += errors_panel(comparison, blocks);
    body += "unset multiplot\nunset logscale\nset format y\nset xrange [*:*]\n";
    return {"comparison", blocks.data(), chart_script("comparison", 800, 1000, body)};
}

void write_bundle(const std::filesystem::path& folder, const Comparison& comparison) {
    if (comparison.bundle.members.empty()) {
        return;
    }
    make_directory(folder);
    write_atomically(folder / "nodes.csv", bundle_csv(comparison));
    write_atomically(folder / "members.csv", members_csv(comparison));
    for (const BundleNode& node : comparison.bundle.nodes) {
        write_state(folder / fmt::format("node_{:04}.json", node.equilibrium.number), node.equilibrium.state);
    }
}

} // namespace

std::string frames_csv(const Comparison& comparison) {
    return csv(of_frames(comparison.dimension), comparison.frames);
}

std::string path_csv(const Comparison& comparison) {
    return csv(of_path(comparison.dimension), comparison.path);
}

std::string bundle_csv(const Comparison& comparison) {
    return csv(of_nodes(comparison.dimension), comparison.bundle.nodes);
}

std::string members_csv(const Comparison& comparison) {
    return csv(of_members(), comparison.bundle.members);
}

std::string comparison_json(const Series& series, const Comparison& comparison) {
    Json out;
    out["format"] = comparison_folder.format;
    out["version"] = 1;
    if (comparison.dimension != plane) {
        out["dimension"] = comparison.dimension;
    }
    out["title"] = series.title;
    out["made_by"] = series.program;
    out["stiffness"] = series.law != ForceLaw::none ? Json(series.stiffness) : Json();
    if (series.several) {
        out["over_sigma1"] = true; // the values named sigma2, for spheres sigma3
    }
    std::array<int, frame_statuses> counts{};
    for (const FrameResult& f : comparison.frames) {
        ++counts[static_cast<std::size_t>(f.status)];
    }
    for (std::size_t s = 0; s < counts.size(); ++s) {
        out["counts"][to_string(static_cast<FrameStatus>(s))] = counts[s];
    }
    out["departure"] = nullptr;
    if (const auto& d = comparison.departure) {
        out["departure"] = {{"from", d->from},
                            {"to", d->to},
                            {"reason", d->reason},
                            {"words", d->words},
                            {"opened", names(d->opened, comparison.dimension)},
                            {"closed", names(d->closed, comparison.dimension)}};
    }
    out["path_end"] = comparison.path_end;
    out["status"] = comparison.status;
    out["frames"] = objects(of_frames(comparison.dimension), comparison.frames);
    out["path"] = objects(of_path(comparison.dimension), comparison.path);
    out["bundle"] = {{"common", comparison.bundle.common},
                     {"nodes", objects(of_nodes(comparison.dimension), comparison.bundle.nodes)},
                     {"members", objects(of_members(), comparison.bundle.members)}};
    return json::dumped(out, 1) + "\n";
}

std::string write_comparison(const std::filesystem::path& folder, const Series& series, const Comparison& comparison) {
    make_folder_for(folder, comparison_folder);
    const Chart chart = figure(comparison);
    write_atomically(folder / "comparison.csv", frames_csv(comparison));
    write_atomically(folder / "path.csv", path_csv(comparison));
    write_bundle(folder / "bundle", comparison);
    write_atomically(folder / "comparison.json", comparison_json(series, comparison));
    write_atomically(folder / (chart.name + ".dat"), chart.data);
    write_atomically(folder / (chart.name + ".gp"), chart.script);
    return run_gnuplot(folder, chart.name + ".gp");
}

} // namespace isostat::compare
