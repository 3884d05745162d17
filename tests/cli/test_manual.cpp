// The page for man and the completion for bash come from what `--help` says.
#include "cli/matches.hpp"
#include "cli/program.hpp"

using namespace program;

namespace {

std::set<std::string> all_commands() {
    const std::string help = run({"--help"}).out;
    return matches<std::set<std::string>>(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
}

std::set<std::string> options_of(const std::string& command) {
    return matches<std::set<std::string>>(run({command, "--help"}).out, "\n  (?:-[a-zA-Z],)?(--[a-z][a-z-]*)");
}

/// What bash offers for the last of the words.
std::set<std::string> offered(const std::string& words, int at) {
    const scratch::Folder folder;
    scratch::write(folder / "completion", run({"--completion", "bash"}).out);
    const std::string out = folder.at("out");
    const std::string line = "bash -c 'source " + folder.at("completion") + "; COMP_WORDS=(" + words +
                             "); COMP_CWORD=" + std::to_string(at) +
                             "; _isostat; printf \"%s\\n\" \"${COMPREPLY[@]}\"' >" + out;
    BOOST_TEST_REQUIRE(std::system(line.c_str()) == 0);
    return matches<std::set<std::string>>(scratch::read(out), "([^\n]+)\n");
}

std::string without_backslashes(std::string text) {
    std::erase(text, '\\');
    return text;
}

} // namespace

BOOST_AUTO_TEST_CASE(the_manual_has_every_command_and_every_option) {
    const std::string man = run({"--man"}).out;
    BOOST_TEST(man.starts_with(".TH ISOSTAT 1 "));
    const std::set<std::string> commands = all_commands();
    BOOST_TEST(commands.size() >= 14U);
    for (const std::string& command : commands) {
        const std::size_t begin = man.find("\n.SS " + command + "\n");
        BOOST_TEST_REQUIRE((begin != std::string::npos), command);
        const std::size_t end = std::min(man.find("\n.SS ", begin + 1), man.find("\n.SH ", begin + 1));
        const std::string section = without_backslashes(man.substr(begin, end - begin));
        BOOST_TEST(contains(section, "Example"), command);
        std::string entries; // what the text around them says of options does not count
        for (const std::string& entry : matches<std::set<std::string>>(section, "\n\\.TP\n([^\n]+)")) {
            entries += entry + "\n";
        }
        const std::set<std::string> options = options_of(command);
        BOOST_TEST(options.contains("--json"), command);
        for (const std::string& option : options) {
            BOOST_TEST(contains(entries, option), command << " " << option);
        }
    }
    for (const char* line : {"EXIT STATUS", "65 bad input"}) {
        BOOST_TEST(contains(man, line));
    }
    BOOST_TEST(!contains(man, "--man")); // hidden, like --completion
}

BOOST_AUTO_TEST_CASE(bash_completes_every_command_and_every_option) {
    const std::set<std::string> commands = all_commands();
    const std::set<std::string> first = offered("isostat \"\"", 1);
    for (const std::string& command : commands) {
        BOOST_TEST(first.contains(command), command);
    }
    BOOST_TEST((offered("isostat ver", 1) == std::set<std::string>{"verify"}));
    for (const std::string& command : commands) {
        const std::set<std::string> options = offered("isostat " + command + " --", 2);
        BOOST_TEST(options.contains("--help"), command);
        BOOST_TEST(options.contains("--json"), command);
    }
    BOOST_TEST((offered("isostat run --res", 2) == std::set<std::string>{"--resume"}));
    BOOST_TEST(offered("isostat run sc", 2).empty()); // files: by bash itself
    BOOST_TEST(
        (offered("isostat export out --format \"\"", 4) == std::set<std::string>{"lammps-data", "xyz", "csv", "vtk"}));
    BOOST_TEST((offered("isostat export out --format c", 4) == std::set<std::string>{"csv"}));
    BOOST_TEST(offered("isostat export out -o c", 4).empty());
}

BOOST_AUTO_TEST_CASE(zsh_and_fish_have_every_command_option_and_value) {
    const std::string zsh = run({"--completion", "zsh"}).out, fish = run({"--completion", "fish"}).out;
    BOOST_TEST(zsh.starts_with("#compdef isostat\n"));
    for (const std::string& command : all_commands()) {
        BOOST_TEST(contains(fish, "-n __fish_use_subcommand -a " + command + " "), command);
        const std::vector<std::string> row = matches(zsh, "\n        " + command + "\\) choices=\"([^\"]*)\"");
        BOOST_TEST_REQUIRE(row.size() == 1U, command);
        for (const std::string& option : options_of(command)) {
            BOOST_TEST(contains(row[0] + " ", " " + option + " "), command << " " << option);
            const std::string line = "'__fish_seen_subcommand_from " + command + "' -l " + option.substr(2);
            BOOST_TEST(contains(fish, line), command << " " << option);
        }
    }
    BOOST_TEST(contains(zsh, "\"export --format\") choices=\"lammps-data xyz csv vtk\""));
    BOOST_TEST(contains(fish, "-l format -x -a 'lammps-data xyz csv vtk'"));
    BOOST_TEST(run({"--completion", "tcsh"}).status == 64);
    for (const auto& [shell, text] : {std::pair{"zsh", &zsh}, {"fish", &fish}}) { // where they are, they read it
        const scratch::Folder folder;
        scratch::write(folder / "completion", *text);
        const std::string line =
            std::string("! command -v ") + shell + " >/dev/null || " + shell + " -n " + folder.at("completion");
        BOOST_TEST(std::system(line.c_str()) == 0, shell);
    }
}
