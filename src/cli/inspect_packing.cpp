#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/terminal.hpp"
#include "crafted/enclosed_bases.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>

namespace isostat::cli {

int inspect_packing(const InspectArguments& arguments) {
    const crafted::PackingFile file = crafted::read_packing(arguments.file);
    const Result<crafted::Inspection> result = crafted::inspect(file.packing);
    if (!result.ok()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {}", arguments.file, result.failure().message()));
    }
    const crafted::Inspection& inspection = result.value();
    if (arguments.common.json) {
        Json out = Json::parse(crafted::to_json(inspection, file.packing));
        if (inspection.bases_exact != Verdict::proved) {
            out["enclosed_bases"] = Json::parse(crafted::enclosed_json(file.packing, inspection));
        }
        print_json(out);
    } else {
        say_lines(crafted::to_text(inspection, file.packing) + "\n");
        if (inspection.bases_exact != Verdict::proved) {
            say_lines(crafted::enclosed_text(file.packing, inspection));
        }
    }
    const std::vector<std::string> differences = crafted::check_expected(inspection, file, arguments.file);
    for (const std::string& difference : differences) {
        say(stderr, "{}\n", difference);
    }
    if (!differences.empty()) {
        return failed;
    }
    return inspection.rank_exact == Verdict::proved ? done : undecided;
}

} // namespace isostat::cli
