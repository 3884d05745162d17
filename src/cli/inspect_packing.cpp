#include "cli/commands.hpp"
#include "cli/common.hpp"

#include <isostat/core/error.hpp>
#include <isostat/crafted/inspection.hpp>
#include <isostat/crafted/packing_file.hpp>

#include <fmt/format.h>

namespace isostat::cli {

int inspect_packing(const InspectArguments& arguments) {
    const crafted::PackingFile file = crafted::read_packing(arguments.file);
    const Result<crafted::Inspection> result = crafted::inspect(file.packing);
    if (!result.ok()) {
        throw Error(ErrorKind::bad_input, fmt::format("{}: {}", arguments.file, result.failure().message));
    }
    const crafted::Inspection& inspection = result.value();
    fmt::print("{}\n", arguments.common.json ? crafted::to_json(inspection, file.packing)
                                             : crafted::to_text(inspection, file.packing));
    const std::vector<std::string> differences = crafted::check_expected(inspection, file, arguments.file);
    for (const std::string& difference : differences) {
        fmt::print(stderr, "{}\n", difference);
    }
    if (!differences.empty()) {
        return failed;
    }
    return inspection.rank_exact == Verdict::proved ? done : undecided;
}

} // namespace isostat::cli
