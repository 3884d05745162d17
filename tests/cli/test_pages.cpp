// What the pages say of keys, columns, fields, commands and exit statuses is what the program has; the commands of
// README run as they stand.
// The page for man and the completion for bash come from what `--help` says.
#include "cli/program.hpp"
#include "compare/report.hpp"
#include "io/equilibria.hpp"
#include "io/record_text.hpp"

#include <isostat/io/run_directory.hpp>

#include <fmt/ranges.h>

#include <regex>

using namespace program;
namespace fs = std::filesystem;

namespace {

/// What the first group of a pattern matches: in the order of the text, or as a set.
template <class Words = std::vector<std::string>> Words matches(const std::string& text, const std::string& pattern) {
    const std::regex expression(pattern);
    return {std::sregex_token_iterator(text.begin(), text.end(), expression, 1), {}};
}

const fs::path project = fs::path(ISOSTAT_EXAMPLES).parent_path();

std::vector<std::string> lines(const std::string& text) {
    return scratch::split(text, '\n');
}

/// The part of a page from a line that begins with `heading` to the next heading.
std::string section(const std::string& page, const std::string& heading) {
    std::string text;
    bool inside = false;
    for (const std::string& line : lines(page)) {
        if (line.starts_with("#")) {
            inside = line.starts_with(heading);
        } else if (inside) {
            text += line + "\n";
        }
    }
    BOOST_TEST_REQUIRE(!text.empty(), "no section '" << heading << "'");
    return text;
}

/// Words in backticks in the first column of the tables of a text, in their order.
std::vector<std::string> first_column(const std::string& text) {
    std::string cells;
    for (const std::string& line : lines(text)) {
        cells += line.starts_with("| `") ? line.substr(0, line.find('|', 1)) : "";
    }
    return matches(cells, "`([^`]+)`");
}

/// The names that the program has are those of a page.
void same(const std::set<std::string>& known, const std::vector<std::string>& page, const std::string& what) {
    const std::set<std::string> told(page.begin(), page.end());
    BOOST_TEST((known == told), what << ": of the program: " << fmt::to_string(fmt::join(known, " "))
                                     << "; of the page: " << fmt::to_string(fmt::join(told, " ")));
}

/// The rows of one table of a page: from its row of names, which begins with `head`, to the first line that is no row.
std::string table(const std::string& page, const std::string& head) {
    const std::size_t begin = page.find("| " + head + " |");
    BOOST_TEST_REQUIRE((begin != std::string::npos), "no table '" << head << "'");
    return page.substr(begin, page.find("\n\n", begin) - begin);
}

/// What a message about the unknown `no_such_key` lists behind "expected one of".
std::set<std::string> expected_names(const Outcome& outcome, const std::string& where) {
    expect(outcome, 65, {"'no_such_key'" + where});
    const std::string marker = "expected one of ";
    const std::string list = outcome.err.substr(outcome.err.find(marker) + marker.size());
    return matches<std::set<std::string>>(list.substr(0, list.find('\n')), "([a-z0-9_]+)");
}

/// The keys that a section of a scene knows.
std::set<std::string> known_keys(const std::string& name, const std::string& scene) {
    const scratch::Folder folder;
    scratch::write(folder / "s.toml", scene);
    return expected_names(run({"plan", folder.at("s.toml")}), " in [" + name + "]");
}

/// What a page has between a line "```LANGUAGE" and the next "```"; from the first such line after `after`.
std::string block(const std::string& page, const std::string& language, const std::string& after) {
    const std::size_t from = page.find(after);
    BOOST_TEST_REQUIRE((from != std::string::npos), "no '" << after << "' on the page");
    const std::string fence = "```" + language + "\n";
    const std::size_t begin = page.find(fence, from);
    BOOST_TEST_REQUIRE((begin != std::string::npos), "no block of " << language << " after '" << after << "'");
    const std::size_t text = begin + fence.size();
    return page.substr(text, page.find("```", text) - text);
}

/// Commands of a section: the words behind `build/release/isostat` in lines that are set in by four blanks.
std::vector<Arguments> commands_of(const std::string& text) {
    std::vector<Arguments> found;
    const std::string program = "    build/release/isostat ";
    for (const std::string& line : lines(text)) {
        if (line.starts_with(program)) {
            found.push_back(scratch::split(line.substr(program.size(), line.find('#') - program.size())));
        }
    }
    return found;
}

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

BOOST_AUTO_TEST_CASE(the_page_of_scenes_has_every_key) {
    const std::string page = scratch::read(project / "src/scene/README.md");
    const std::string disks = "[packing]\ndisks = 10\n";
    const std::string choose = "[run]\nties = \"choose\"\nno_such_key = 1\n";
    const std::vector<std::array<std::string, 3>> sections{
        {"packing", "## `[packing]`", disks + "no_such_key = 1\n"},
        {"preparation", "## `[preparation]`", disks + "[preparation]\nno_such_key = 1\n"},
        {"load", "## `[load]`", disks + "[load]\nno_such_key = 1\n"},
        {"programme", "## `[[programme]]`", disks + "[[programme]]\ndo = \"up\"\nno_such_key = 1\n"},
        {"cell", "## `[cell]`", disks + "[cell]\nno_such_key = 1\n"},
        {"run", "## `[run]`", disks + choose},
        {"output", "## `[output]`", disks + "[output]\nno_such_key = 1\n"}};
    for (const auto& [name, heading, scene] : sections) {
        same(known_keys(name == "programme" ? "[programme]" : name, scene), first_column(section(page, heading)), name);
    }
}

BOOST_FIXTURE_TEST_CASE(the_page_of_files_has_every_column_and_every_field, scratch::InFolder) {
    const std::string page = scratch::read(project / "src/io/README.md");
    const std::vector<std::string> columns = isostat::equilibria_columns({true, true});
    BOOST_TEST(first_column(section(page, "### Columns of `equilibria.csv`")) == columns,
               boost::test_tools::per_element()); // in their order
    const isostat::compare::Comparison none;
    const std::vector<std::pair<std::string, std::string>> tables{
        {"comparison.csv", isostat::compare::frames_csv(none)},
        {"path.csv", isostat::compare::path_csv(none)},
        {"bundle/nodes.csv", isostat::compare::bundle_csv(none)},
        {"bundle/members.csv", isostat::compare::members_csv(none)}};
    for (const auto& [file, csv] : tables) {
        const std::vector<std::string> names = scratch::split(lines(csv).front(), ',');
        same({names.begin(), names.end()}, first_column(table(page, "column of `" + file + "`")), file);
    }
    isostat::ArcRecord arc;
    arc.opened = arc.closed = {isostat::ContactKind::disk_disk, 0, 1};
    arc.power_turn = true;
    arc.certificate.emplace();
    arc.perturbed.push_back({"force", arc.opened, {}, {isostat::ContactKind::disk_disk, -1, -1}, {}});
    std::set<std::string> written;
    const nlohmann::json line =
        nlohmann::json::parse(isostat::event_line(arc, isostat::record_columns(isostat::MoreColumns())));
    for (const auto& field : line.items()) {
        written.insert(field.key());
    }
    const std::string fields = section(page, "### Fields of `events.jsonl`");
    same(written, first_column(fields), "events.jsonl");
    const std::set<std::string> kinds(isostat::arc_kind_words.begin(), isostat::arc_kind_words.end());
    const std::string row = table(fields, "`kind`");
    same(kinds, matches(row.substr(row.find("| ", 3), row.find('\n') - row.find("| ", 3)), "`([^`]+)`"), "kinds");
    same(expected_names(
             run({"inspect", folder.file("s.json", R"({"format": "isostat-state", "version": 2, "no_such_key": 1})")}),
             ""),
         first_column(section(page, "## States")), "states");
}

BOOST_AUTO_TEST_CASE(the_page_of_files_has_every_key_of_a_manifest) {
    const fs::path series = project / "tests/data/series";
    const std::string manifest = scratch::read(series / "series.toml");
    std::map<std::string, std::set<std::string>>
        told; // by section, in the order of the page: `[files] disks`, `select`
    std::string name = "manifest";
    for (const std::string& key :
         first_column(table(scratch::read(project / "src/io/README.md"), "key | needed | content"))) {
        const bool begins = key.starts_with("[");
        name = begins ? key.substr(1, key.find(']') - 1) : name;
        told[name].insert(begins ? key.substr(key.find(']') + 2) : key);
    }
    for (const char* other : {"files", "columns", "cell", "law", "load", "rest", "units"}) {
        told["manifest"].insert(other);
    }
    for (const auto& [section, keys] : told) {
        const scratch::Folder folder;
        fs::copy(series, folder.path(), fs::copy_options::recursive | fs::copy_options::overwrite_existing);
        std::string text = manifest;
        const std::size_t at = text.find("[" + section + "]\n");
        if (section == "manifest") {
            text.insert(0, "no_such_key = 1\n");
        } else if (at == std::string::npos) {
            text += "\n[" + section + "]\nno_such_key = 1\n";
        } else {
            text.insert(text.find('\n', at) + 1, "no_such_key = 1\n");
        }
        scratch::write(folder / "series.toml", text);
        const auto known = expected_names(run({"compare", folder.at("series.toml")}), " in [" + section + "]");
        same(known, {keys.begin(), keys.end()}, section);
    }
}

BOOST_AUTO_TEST_CASE(the_pages_and_the_help_have_the_same_exit_statuses) {
    const auto sentence = [](const std::string& text) {
        const std::size_t begin = text.find("Exit status");
        BOOST_TEST_REQUIRE((begin != std::string::npos));
        return matches(text.substr(begin, text.find("Ctrl-C", begin) - begin), R"((?:^|[\s|])(\d+)\s)");
    };
    const std::vector<std::string> told = sentence(run({"--help"}).out);
    const std::set<std::string> known(told.begin(), told.end());
    BOOST_TEST(known.size() >= 6U);
    same(known, sentence(scratch::read(project / "README.md")), "README");
    same(known, matches(section(scratch::read(project / "src/io/README.md"), "## Exit status"), R"(\| (\d+) \|)"),
         "table");
}

BOOST_FIXTURE_TEST_CASE(the_first_run_of_the_readme_does_what_it_shows, scratch::InFolder) {
    const std::string page = scratch::read(project / "README.md");
    scratch::write(folder / "first.toml", block(page, "toml", "## A first run"));
    const std::string here = "cd " + quoted(folder.path().string()) + "; ";
    const auto known = commands_of(section(page, "## A first run"));
    BOOST_TEST_REQUIRE(known.size() == 5U);
    std::string shown;
    for (const Arguments& command : known) {
        const Outcome outcome = run(command, here);
        BOOST_TEST(outcome.status == 0, command[0] << ": " << outcome.status << "; " << outcome.err);
        shown += outcome.out + outcome.err;
    }
    for (const std::string& line : lines(block(page, "", "build/release/isostat run first.toml"))) {
        const std::string without_times = line.substr(0, line.find(" 0:00:00"));
        BOOST_TEST(contains(shown, without_times), "README shows '" << line << "', the program: " << shown);
    }
    BOOST_TEST(run({"plan", "first.toml"}, here).status == 0);
}

BOOST_AUTO_TEST_CASE(the_readme_names_every_command) {
    const std::string page = scratch::read(project / "README.md");
    const std::string help = run({"--help"}).out;
    const std::size_t begin = help.find("Subcommands:");
    BOOST_REQUIRE(begin != std::string::npos);
    const std::vector<std::string> commands_found = matches(help.substr(begin), R"(\n  ([a-z]+) )");
    for (const std::string& command : commands_found) {
        const bool named = contains(page, "`" + command + "`") || contains(page, "isostat " + command) ||
                           contains(page, "`" + command + " ");
        BOOST_TEST(named, "README does not name " << command);
    }
    BOOST_TEST(commands_found.size() >= 11U);
}

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
        const std::string line = std::string("! command -v ") + shell + " >/dev/null || " + shell + " -n " +
                                 folder.file("completion", *text);
        BOOST_TEST(std::system(line.c_str()) == 0, shell);
    }
}
