#include "answers/state.hpp"
#include "certificate/averages.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "core/refuse.hpp"
#include "crafted/enclosed_bases.hpp"
#include "io/files.hpp"

#include <isostat/crafted/exact_packing.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::cli {

namespace {

/// A crafted packing with exact numbers (TOML, examples/packings): prints the exact results and compares them with the
/// file's [expected]; an entry that does not hold is named and gives 1, a rank that is not proved 2.
int inspect_packing(const InspectArguments& arguments) {
    const crafted::PackingFile file = crafted::read_packing(arguments.file);
    const Result<crafted::Inspection> result = crafted::inspect_file(file, arguments.file);
    if (!result.ok()) {
        refuse(arguments.file, result.failure().message(file.packing.dimension()));
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

} // namespace

int inspect(const InspectArguments& arguments) {
    if (arguments.file.ends_with(".toml")) {
        if (arguments.at || !arguments.contacts.empty() || arguments.singular_values) {
            throw Error(ErrorKind::usage, arguments.file + " is a crafted packing: expected no --at, no --contacts, "
                                                           "no --singular-values");
        }
        return inspect_packing(arguments);
    }
    if (!arguments.contacts.empty()) {
        check_output(arguments.contacts, contact_table_mark, {arguments.file});
    }
    StateFile file = read_any_state(arguments.file, Dimensions::any_bodies);
    file.state = with_free_motions_held(std::move(file.state));
    if (arguments.at) {
        file.state.load.set_loaded_stress(*arguments.at);
        file.forces.clear(); // of another load
    }
    const answers::StateAnswer answer = answers::answer_of(file, arguments.singular_values);
    if (!arguments.contacts.empty()) {
        write_output(arguments.contacts, contact_table(file.state, answer.truth), contact_table_mark);
    }
    print(answers::to_answer(answer, arguments.file, arguments.at.has_value(), arguments.common.json),
          arguments.common);
    return answer.result.ok() ? status_of(answer.result.value().record.verdict)
                              : status_of(answer.result.failure().kind);
}

} // namespace isostat::cli
