// What a file is comes before what else is missing on the command line; a file of no format is described.
#include "cli/program.hpp"

using namespace program;

BOOST_AUTO_TEST_CASE(a_file_that_is_not_there_or_is_for_others_is_told_before_a_missing_option) {
    const scratch::Folder folder;
    const std::string none = folder.at("none.toml"), scene = folder.at("s.toml");
    scratch::write(scene, "[packing]\ndisks = 10\n");
    for (const char* command : {"run", "ensemble", "certify", "import", "export"}) {
        expect(run({command, none}), 65, {none, "does not exist"});
    }
    expect(run({"certify", scene}), 65, {"is a scene", "not for certify"});
    expect(run({"run", scene}), 64, {"--output is required"});
    expect(run({"run"}), 64, {"required"});
}

BOOST_AUTO_TEST_CASE(a_file_of_no_format_is_shown_by_its_beginning) {
    const scratch::Folder folder;
    scratch::write(folder / "junk", "hello\x1b[2J, this is a letter and no packing at all\n1 2 3\n");
    for (const char* command : {"inspect", "report"}) {
        expect(run({command, folder.at("junk")}), 65, {"neither a state", "'hello\\x1b[2J, this is a letter and"});
    }
    scratch::write(folder / "s.toml", "[packing]\ndisks = 10\n");
    expect(run({"report", folder.at("s.toml")}), 65, {"neither a state", "'[packing]'", "is a scene"});
}
