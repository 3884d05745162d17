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
    scratch::write(folder / "completion", run({"--completion"}).out);
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

BOOST_AUTO_TEST_SUITE(cli)

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
}

BOOST_AUTO_TEST_SUITE_END()
