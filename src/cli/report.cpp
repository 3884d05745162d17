#include "compare/report.hpp"

#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "core/refuse.hpp"
#include "ensemble/ensemble.hpp"

#include <isostat/io/run_directory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace isostat::cli {

namespace {

namespace fs = std::filesystem;

Json json_of(const std::string& input, const ReportResult& result) {
    Json object;
    object["input"] = input;
    object["files"] = json::array_of(result.files, [](const fs::path& file) { return file.string(); });
    object["notes"] = result.notes;
    object["text"] = result.text;
    return object;
}

void print_notes(const ReportResult& result) {
    for (const std::string& note : result.notes) {
        say(stderr, "isostat: {}\n", note);
    }
}

/// A row of totals.
std::string totals(const Member& member, const ReportResult& result) {
    long arcs = 0;
    const std::vector<EquilibriumRow> rows = read_equilibria(member.folder / "equilibria.csv");
    for (const EquilibriumRow& row : rows) {
        arcs += row.arcs;
    }
    const auto proved = std::ranges::count_if(rows, [](const EquilibriumRow& row) { return row.proved; });
    const EquilibriumRow last = rows.empty() ? EquilibriumRow{} : rows.back();
    return fmt::format("{:>8} {:>11} {:>7} {:>8} {:>12.8f} {:>12.5e} {:>6}", member.seed, rows.size(), proved, arcs,
                       last.ratio, last.strain2, result.files.size());
}

/// Makes one report after the other. 65 when a run cannot be read; the other runs are still reported.
int report_ensemble(const ReportArguments& arguments) {
    const std::vector<Member> members = members_of(arguments.input);
    const bool quiet = arguments.common.json || arguments.common.quiet;
    ReportOptions options = arguments.options;
    options.charts = !arguments.no_charts;
    StatusLine line(quiet);
    Json list = Json::array();
    std::vector<fs::path> reported;
    int status = done;
    const Pace pace;
    if (!quiet) {
        say("{:>8} {:>11} {:>7} {:>8} {:>12} {:>12} {:>6}\n", "seed", "equilibria", "proved", "arcs", "ratio at end",
            "eps2", "files");
    }
    for (std::size_t k = 0; k < members.size(); ++k) {
        const Member& member = members[k];
        const double rest = pace.rest(static_cast<double>(k), static_cast<double>(members.size() - k));
        line.show(fmt::format("seed {}, {} of {}, {} left", member.seed, k + 1, members.size(), clock_text(rest)));
        const fs::path output = arguments.output.empty() ? member.folder / "figures"
                                                         : fs::path(arguments.output) / member.folder.filename();
        try {
            if (!member.begun) {
                refuse(ErrorKind::bad_input, "was not begun{}: `isostat ensemble --resume`",
                       member.further > 0 ? fmt::format(", nor were {} after it", member.further) : "");
            }
            const ReportResult result = report_run(member.folder, output, options);
            line.clear();
            if (!quiet) {
                say("{}\n", totals(member, result));
            }
            print_notes(result);
            list.push_back(json_of(member.folder.string(), result));
            reported.push_back(member.folder);
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::bad_input) {
                throw;
            }
            line.clear();
            say(stderr, "isostat: seed {}: {}\n", member.seed, error.what());
            status = error.exit_status();
        }
    }
    const fs::path together =
        arguments.output.empty() ? fs::path(arguments.input) / "figures" : fs::path(arguments.output) / "figures";
    const ReportResult forces = report_forces(reported, together, options);
    if (arguments.common.json) {
        print_json(Json{{"input", arguments.input}, {"members", list}, {"forces", json_of(arguments.input, forces)}});
    } else if (!quiet) {
        say_lines(forces.text);
    }
    print_notes(forces);
    return status;
}

} // namespace

int report(const ReportArguments& arguments) {
    end_at_interrupts();
    const fs::path input = arguments.input;
    if (is_ensemble(input)) {
        if (arguments.stiffness > 0) {
            throw Error(ErrorKind::usage,
                        "--stiffness belongs to the folder of one run: " + arguments.input + " is an ensemble");
        }
        return report_ensemble(arguments);
    }
    const bool is_run = fs::is_directory(input);
    if (arguments.stiffness > 0 && !is_run) {
        refuse(ErrorKind::usage, "--stiffness belongs to the folder of a run: {} is none", arguments.input);
    }
    fs::path output = arguments.output;
    if (output.empty()) {
        output = is_run ? input / "figures" : input.has_parent_path() ? input.parent_path() : fs::path(".");
    }
    ReportOptions options = arguments.options;
    options.charts = !arguments.no_charts;
    StatusLine line(arguments.common.json || arguments.common.quiet);
    options.progress = [&line](std::size_t done, std::size_t all) {
        line.show(fmt::format("trajectory.html: arc {} of {}", done, all));
    };
    ReportResult result = is_run ? report_run(input, output, options) : report_state(input, output, options);
    if (arguments.stiffness > 0) {
        result.text += "\n" + compare::soft_limits(input, output, arguments.stiffness);
        result.files.push_back(output / "soft_limits.csv");
    }
    line.clear();
    if (arguments.common.json) {
        print_json(json_of(arguments.input, result));
        return done;
    }
    if (!arguments.common.quiet) {
        say_lines(result.text + "\n");
        for (const fs::path& file : result.files) {
            say("{}\n", file.string());
        }
    }
    print_notes(result);
    return done;
}

} // namespace isostat::cli
