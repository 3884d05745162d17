#include "cli/manual.hpp"

#include "io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace isostat::cli {

namespace {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

/// The options that `--help` shows: positional ones first.
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

/// "-o,--output", or the name of a positional argument.
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

/// " --output -o": each name behind the mark of long or of short ones.
std::string names_of(const CLI::Option& option, const std::string& before_long = " --",
                     const std::string& before_short = " -") {
    std::string names;
    for (const std::string& name : option.get_lnames()) {
        names += before_long + name;
    }
    for (const std::string& name : option.get_snames()) {
        names += before_short + name;
    }
    return names;
}

/// "a b" of "TEXT:{a,b}": the words that an option takes; empty where it takes other values.
std::string values_of(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    const std::size_t begin = type.find('{'), end = type.find('}');
    if (begin == std::string::npos || end == std::string::npos || option.get_positional()) {
        return "";
    }
    std::string words = type.substr(begin + 1, end - begin - 1);
    std::ranges::replace(words, ',', ' ');
    return words;
}

/// The first words, and cases of `case` for the following ones.
struct Completion {
    std::string commands, options, values;
};

Completion completion(const CLI::App& app) {
    Completion made;
    for (const CLI::App* command : commands_of(app)) {
        made.commands += command->get_name() + " ";
        std::string options;
        for (const CLI::Option* option : options_of(*command)) {
            options += names_of(*option);
            for (const std::string& name : option->get_lnames()) {
                made.values += values_of(*option).empty() ? ""
                                                          : fmt::format("        \"{} --{}\") choices=\"{}\" ;;\n",
                                                                        command->get_name(), name, values_of(*option));
            }
        }
        made.options += fmt::format("        {}) choices=\"{}\" ;;\n", command->get_name(), options);
    }
    for (const CLI::Option* option : options_of(app)) {
        made.commands += names_of(*option).substr(1) + " ";
    }
    return made;
}

std::string fish_completion(const CLI::App& app) {
    const auto quoted = [](std::string text) {
        std::erase_if(text, [](char c) { return c == '\'' || c == '\\'; });
        return "'" + text + "'";
    };
    std::string text = "# fish completion of isostat\n";
    for (const CLI::App* command : commands_of(app)) {
        text += fmt::format("complete -c isostat -n __fish_use_subcommand -a {} -d {}\n", command->get_name(),
                            quoted(command->get_description()));
        for (const CLI::Option* option : options_of(*command)) {
            const std::string names = names_of(*option, " -l ", " -s ");
            const std::string values = values_of(*option);
            text += names.empty() ? ""
                                  : fmt::format("complete -c isostat -n '__fish_seen_subcommand_from {}'{}{} -d {}\n",
                                                command->get_name(), names,
                                                !values.empty()                        ? " -x -a " + quoted(values)
                                                : option->get_items_expected_max() > 0 ? " -r"
                                                                                       : "",
                                                quoted(option->get_description()));
        }
    }
    return text;
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

std::string shell_completion(const CLI::App& app, const std::string& shell) {
    if (shell == "fish") {
        return fish_completion(app);
    }
    const Completion made = completion(app);
    const std::string cases = fmt::format("    [ \"$at\" -eq 1 ] && choices=\"{}\"\n"
                                          "    [ \"$at\" -gt 1 ] && [[ $word == -* ]] && case $command in\n{}    esac\n"
                                          "    [ \"$at\" -gt 2 ] && case \"$command $before\" in\n{}    esac\n",
                                          made.commands, made.options, made.values);
    if (shell == "zsh") {
        return fmt::format("#compdef isostat\nlocal at=$((CURRENT - 1)) word=${{words[CURRENT]}} command=${{words[2]}} "
                           "before=${{words[CURRENT - 1]}} choices=\n{}"
                           "if [ -n \"$choices\" ]; then compadd -- ${{(s: :)choices}}; else _files; fi\n",
                           cases);
    }
    return fmt::format("# bash completion of isostat\n_isostat() {{\n"
                       "    local at=$COMP_CWORD word=${{COMP_WORDS[COMP_CWORD]}} command=${{COMP_WORDS[1]}} choices=\n"
                       "    local before=${{COMP_WORDS[COMP_CWORD - 1]}}\n{}"
                       "    COMPREPLY=()\n"
                       "    [ -n \"$choices\" ] && mapfile -t COMPREPLY < <(compgen -W \"$choices\" -- \"$word\")\n"
                       "    return 0 # otherwise names of files\n}}\n"
                       "complete -o default -F _isostat isostat\n",
                       cases);
}

} // namespace isostat::cli
