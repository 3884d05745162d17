#include "answers/state.hpp"
#include "certificate/contact_table.hpp"
#include "cli/commands.hpp"
#include "cli/common.hpp"
#include "cli/terminal.hpp"
#include "io/files.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/state_file.hpp>

namespace isostat::cli {

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
    if (arguments.common.json) {
        print_json(answers::to_json(answer, arguments.file));
    } else {
        say_lines(answers::to_text(answer, arguments.at.has_value()));
    }
    return answer.result.ok() ? status_of(answer.result.value().record.verdict)
                              : status_of(answer.result.failure().kind);
}

} // namespace isostat::cli
