#include "cli/manual.hpp"

#include "io/text.hpp"

#include <fmt/format.h>

#include <vector>

namespace isostat::cli {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// Those that `--help` shows: positional ones first.
std::vector<const CLI::Option*> options_of(const CLI::App& app) {
    std::vector<const CLI::Option*> options;
    for (const bool positional : {true, false}) {
        for (const CLI::Option* option :
             app.get_options([](const CLI::Option* o) { return !o->get_group().empty(); })) {
            if (option->get_positional() == positional) {
                options.push_back(option);
            }
        }
    }
    return options;
}

/// "-o,--output", or the name of what has a place.
std::string name_of(const CLI::Option& option) {
    return option.get_name(option.get_positional(), true);
}

/// "N" of "N:INT in [1 - 1024]".
std::string type_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    return type.substr(0, type.find(':'));
}

/// ".TP" entries.
std::string options_text(const CLI::App& app) {
    std::string text;
    for (const CLI::Option* option : options_of(app)) {
        const bool takes = option->get_items_expected_max() > 0;
        text += fmt::format(".TP\n\\fB{}\\fR{}\n{}{}\n", text::man(name_of(*option)),
                            takes ? " \\fI" + text::man(type_of(*option)) + "\\fR" : "",
                            text::man(option->get_description()), option->get_required() ? " (needed)" : "");
    }
    return text;
}

std::string synopsis(const CLI::App& command) {
    std::string text = fmt::format("\\fBisostat {}\\fR", text::man(command.get_name()));
    bool optional = false;
    for (const CLI::Option* option : options_of(command)) {
        if (option->get_positional()) {
            text += fmt::format(" \\fI{}\\fR", text::man(type_of(*option)));
        } else if (option->get_required()) {
            text += fmt::format(" \\fB{}\\fR \\fI{}\\fR", text::man(name_of(*option)), text::man(type_of(*option)));
        } else {
            optional = true;
        }
    }
    return text + (optional ? " [options]\n" : "\n");
}

} // namespace

std::string man_page(const CLI::App& app, const std::string& version) {
    std::string text = fmt::format(".TH ISOSTAT 1 \"\" \"{}\" \"User Commands\"\n.SH NAME\nisostat \\- {}\n", version,
                                   text::man(app.get_description()));
    text += ".SH SYNOPSIS\n\\fBisostat\\fR \\fICOMMAND\\fR [options]\n.SH OPTIONS\n" + options_text(app);
    text += ".SH COMMANDS\n";
    for (const CLI::App* command : commands_of(app)) {
        text += fmt::format(".SS {0}\n{1}.PP\n{2}.\n.PP\n.nf\n{3}\n.fi\n{4}", text::man(command->get_name()),
                            synopsis(*command), text::man(command->get_description()), text::man(command->get_footer()),
                            options_text(*command));
    }
    return text + fmt::format(".SH EXIT STATUS\n.nf\n{}\n.fi\n", text::man(app.get_footer()));
}

std::string bash_completion(const CLI::App& app) {
    std::string names;
    std::string cases;
    for (const CLI::App* command : commands_of(app)) {
        names += (names.empty() ? "" : " ") + command->get_name();
        std::string options;
        for (const CLI::Option* option : options_of(*command)) {
            for (const std::string& name : option->get_lnames()) {
                options += " --" + name;
            }
            for (const std::string& name : option->get_snames()) {
                options += " -" + name;
            }
        }
        cases += fmt::format("        {}) words=\"{}\" ;;\n", command->get_name(),
                             options.substr(std::min<std::size_t>(1, options.size())));
    }
    std::string general;
    for (const CLI::Option* option : options_of(app)) {
        for (const std::string& name : option->get_lnames()) {
            general += " --" + name;
        }
    }
    return fmt::format("# bash completion of isostat\n_isostat() {{\n"
                       "    local word=${{COMP_WORDS[COMP_CWORD]}} words=\n"
                       "    case $COMP_CWORD:${{COMP_WORDS[1]}} in\n        1:*) words=\"{}{}\" ;;\n    esac\n"
                       "    [ \"$COMP_CWORD\" -gt 1 ] && case ${{COMP_WORDS[1]}} in\n{}    esac\n"
                       "    COMPREPLY=()\n"
                       "    if [ \"$COMP_CWORD\" -eq 1 ] || [[ $word == -* ]]; then\n"
                       "        mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$word\")\n"
                       "    fi # otherwise names of files\n}}\n"
                       "complete -o default -F _isostat isostat\n",
                       names, general, cases);
}

} // namespace isostat::cli
