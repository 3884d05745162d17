// Where output may go, and which files a file may name.
#include "io/files.hpp"
#include "io/folders.hpp"
#include "io/section.hpp"
#include "support/bad_input.hpp"
#include "support/scratch.hpp"

#include <isostat/io/run_directory.hpp>

#include <sys/stat.h>

using namespace isostat;
namespace fs = std::filesystem;

namespace {

const std::string a_run = "{\"format\": \"isostat-run\", \"version\": 1}";

/// Taking the folder is refused, and nothing in it or beside it has changed.
void not_taken(const fs::path& folder, const FolderKind& kind, FolderMode mode, const std::vector<std::string>& words) {
    const auto listed = [&] {
        std::map<std::string, std::string> all;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            all[entry.path().string()] = entry.is_regular_file() ? scratch::read(entry.path()) : "";
        }
        return all;
    };
    const auto before = listed();
    expect_error([&] { (void)take_folder(folder, kind, mode); }, ErrorKind::usage, words);
    BOOST_TEST((listed() == before));
}

} // namespace

BOOST_AUTO_TEST_CASE(the_names_of_a_run_are_those_that_it_writes) {
    for (const char* name : {"run.json", "lock", "states/eq_000000.json", "states/eq_1234567.json", "states/last.json",
                             "certificates/arcs.jsonl", "figures/forces_eq_000012.svg", "figures/staircase.gp.log",
                             "figures/cycles.png"}) {
        BOOST_TEST(run_folder.owns(name), name);
        BOOST_TEST(ensemble_folder.owns("samples/seed_000001/" + std::string(name)), name);
    }
    for (const char* name : {"", "run.jsonl", "notes.txt", "states", "states/", "states/eq_00000.json",
                             "states/eq_0123456.json", "states/eq_00001x.json", "states/notes.json", "eq_000000.json",
                             "../run.json", "states/../run.json", "/run.json", "figures/mine.svg", "scene.toml"}) {
        BOOST_TEST(!run_folder.owns(name), name);
    }
    BOOST_TEST(run_folder.owns_folder("states"));
    BOOST_TEST(!run_folder.owns_folder("state"));
    BOOST_TEST(comparison_folder.owns("bundle/node_0012.json"));
    BOOST_TEST(run_folder.owns(state_name(3)));
    BOOST_TEST(run_folder.owns(certificate_name(1234567)));
}

BOOST_AUTO_TEST_CASE(a_folder_with_files_of_somebody_is_not_taken) {
    for (const char* name : {"equilibria.csv", "events.jsonl", "start.json", "states/eq_000000.json", "notes.txt",
                             "figures/staircase.svg", "samples.csv", "comparison.csv", "report.txt", "run.json.part"}) {
        const scratch::Folder folder;
        fs::create_directories((folder / name).parent_path());
        scratch::write(folder / name, "precious");
        for (const FolderMode mode : {FolderMode::fresh, FolderMode::force}) {
            not_taken(folder.path(), run_folder, mode, {"expected an empty folder"});
            not_taken(folder.path(), ensemble_folder, mode, {"expected an empty folder"});
        }
        for (const FolderKind* kind : {&report_folder, &comparison_folder}) {
            expect_error([&] { make_folder_for(folder.path(), *kind); }, ErrorKind::usage,
                         {"expected an empty folder"});
        }
    }
}

BOOST_AUTO_TEST_CASE(a_folder_is_a_run_when_its_run_json_says_so) {
    for (const char* text : {"{\"of\":\"another program\"}", "{\"format\": \"isostat-ensemble\", \"version\": 1}",
                             "{\"format\": \"isostat-run\", \"version\": 2}", "{\"format\": \"isostat-run\"}", "[]",
                             "{\"format\": \"isostat-run\", \"version\": 1"}) {
        const scratch::Folder folder;
        fs::create_directories(folder / "states");
        scratch::write(folder / "run.json", text);
        scratch::write(folder / "states/last.json", "precious");
        not_taken(folder.path(), run_folder, FolderMode::force, {"run.json", "expected an empty folder"});
        expect_bad_input([&] { (void)take_folder(folder.path(), run_folder, FolderMode::resume); }, {"run.json"});
    }
}

BOOST_FIXTURE_TEST_CASE(force_removes_what_a_run_writes_and_nothing_else, scratch::InFolder) {
    fs::create_directories(folder / "states");
    fs::create_directories(folder / "certificates");
    fs::create_directories(folder / "figures/sources");
    scratch::write(folder / "run.json", a_run);
    const std::vector<std::string> own{"events.jsonl", "states/eq_000003.json", "certificates/eq_000003.json",
                                       "figures/staircase.svg", "run.json.0123456789abcdef.part"};
    const std::vector<std::string> mine{"figures/mine.svg", "states/thesis.json", "figures/sources/a.dat", "a.part"};
    for (const auto* names : {&own, &mine}) {
        for (const std::string& name : *names) {
            scratch::write(folder / name, "text");
        }
    }
    (void)take_folder(folder.path(), run_folder, FolderMode::force);
    for (const std::string& name : own) {
        BOOST_TEST(!fs::exists(folder / name), name);
    }
    for (const std::string& name : mine) {
        BOOST_TEST(scratch::read(folder / name) == "text", name);
    }
    BOOST_TEST(!fs::exists(folder / "certificates")); // empty
}

BOOST_FIXTURE_TEST_CASE(empty_folders_new_ones_and_those_of_a_sample_are_taken, scratch::InFolder) {
    for (const char* name : {"a/b", "empty", "sample"}) {
        fs::create_directories(folder / name);
    }
    scratch::write(folder / "sample/scene.toml", "scene");
    scratch::write(folder / "sample/log.txt", "");
    for (const char* name : {"a/b/new", "empty", "sample"}) {
        BOOST_TEST(!take_folder(folder / name, run_folder, FolderMode::fresh).begun);
        BOOST_TEST(fs::exists(folder / name / "lock"), name);
    }
    BOOST_TEST(scratch::read(folder / "sample/scene.toml") == "scene");
}

BOOST_FIXTURE_TEST_CASE(temporary_files_take_no_name_that_somebody_has, scratch::InFolder) {
    scratch::write(folder / "victim", "precious");
    fs::create_symlink(folder / "victim", folder / "a.json.part");
    scratch::write(folder / "b.json.part", "precious");
    write_atomically(folder / "a.json", "new");
    write_atomically(folder / "b.json", "new");
    BOOST_TEST(scratch::read(folder / "victim") == "precious");
    BOOST_TEST(scratch::read(folder / "b.json.part") == "precious");
    BOOST_TEST(!fs::is_symlink(folder / "a.json"));
    BOOST_TEST(!Descriptor::make(folder / "a.json.part").has_value());
    BOOST_TEST(!Descriptor::make(folder / "victim").has_value());
    BOOST_TEST(Descriptor::make(folder / "free").has_value());
    BOOST_TEST(name_of_temporary("a.json.0123456789abcdef.part") == "a.json");
    BOOST_TEST(name_of_temporary("a.json.part") == "a.json");
    for (const char* name : {"a.json", "a.json.0123456789abcdef", "a.part.json", ""}) {
        BOOST_TEST(name_of_temporary(name).empty(), name);
    }
    BOOST_TEST(name_of_temporary("a.json.0123456789abcdeX.part") == "a.json.0123456789abcdeX");
}

BOOST_FIXTURE_TEST_CASE(a_file_of_the_user_is_not_written_over, scratch::InFolder) {
    scratch::write(folder / "in", "format");
    scratch::write(folder / "old", "format");
    scratch::write(folder / "empty", "");
    scratch::write(folder / "notes", "precious");
    fs::create_hard_link(folder / "in", folder / "hard");
    fs::create_symlink(folder / "in", folder / "soft");
    for (const char* name : {"in", "hard", "soft"}) {
        expect_error([&] { check_output(folder / name, "format", {folder / "in"}); }, ErrorKind::usage,
                     {"is the input"});
    }
    for (const char* name : {"new", "empty", "old"}) {
        check_output(folder / name, "format", {folder / "in"});
        write_output(folder / name, "format 2", "format");
        BOOST_TEST(scratch::read(folder / name) == "format 2");
    }
    expect_error([&] { write_output(folder / "notes", "format 2", "format"); }, ErrorKind::usage, {"notes", "exists"});
    BOOST_TEST(scratch::read(folder / "notes") == "precious");
}

BOOST_AUTO_TEST_CASE(a_file_names_regular_files_beside_it_or_below) {
    const scratch::Folder outer;
    const fs::path folder = outer / "inner";
    fs::create_directories(folder / "below");
    scratch::write(outer / "outside", "text");
    scratch::write(folder / "beside", "text");
    scratch::write(folder / "below/b", "text");
    fs::create_symlink("beside", folder / "near");
    fs::create_symlink(outer / "outside", folder / "far");
    fs::create_directory_symlink(outer.path(), folder / "up");
    BOOST_REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    for (const char* name : {"beside", "./beside", "below/b", "near", "absent"}) {
        BOOST_TEST(named_input(folder, name, "file") == folder / name);
    }
    for (const std::string& name :
         {std::string("../outside"), (outer / "outside").string(), std::string("far"), std::string("up/outside"),
          std::string("below/../beside"), std::string("pipe"), std::string("/dev/zero"), std::string("..")}) {
        expect_bad_input([&] { (void)named_input(folder, name, "s.toml:2: file in [packing]"); },
                         {"s.toml:2: file in [packing]", name, "regular file beside"});
    }
}
