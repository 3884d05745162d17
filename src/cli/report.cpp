#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "report/run_report.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

namespace isostat::cli {

int report(const ReportArguments& arguments) {
    namespace fs = std::filesystem;
    const fs::path input = arguments.input;
    const bool is_run = fs::is_directory(input);
    fs::path output = arguments.output;
    if (output.empty()) {
        output = is_run ? input / "figures" : input.has_parent_path() ? input.parent_path() : fs::path(".");
    }
    ReportOptions options;
    options.vtk = arguments.vtk;
    options.charts = !arguments.no_charts;
    const ReportResult result = is_run ? report_run(input, output, options) : report_state(input, output, options);
    if (arguments.common.json) {
        Json object;
        object["input"] = arguments.input;
        object["files"] = Json::array();
        for (const fs::path& file : result.files) {
            object["files"].push_back(file.string());
        }
        object["notes"] = result.notes;
        object["text"] = result.text;
        print_json(object);
        return done;
    }
    if (!arguments.common.quiet) {
        fmt::print("{}\n", result.text);
        for (const fs::path& file : result.files) {
            fmt::print("{}\n", file.string());
        }
    }
    for (const std::string& note : result.notes) {
        fmt::print(stderr, "isostat: {}\n", note);
    }
    return done;
}

} // namespace isostat::cli
