// Commands that take the folder of an ensemble in place of a run.
#include "cli/program.hpp"
#include "support/forger.hpp"

using namespace program;
namespace fs = std::filesystem;

namespace {

/// Three samples of 30 disks.
fs::path ensemble(const scratch::Folder& folder) {
    scratch::write(folder / "s.toml", "[packing]\ndisks = 30\n[[programme]]\ndo = \"up\"\nequilibria = 3\n[output]\n"
                                      "pictures = false\n");
    expect(run({"ensemble", folder.at("s.toml"), "--samples", "3", "-o", folder.at("many"), "-q"}), 0);
    return folder / "many";
}

std::string seed(int number) {
    return "samples/seed_00000" + std::to_string(number);
}

} // namespace

BOOST_FIXTURE_TEST_CASE(verify_takes_an_ensemble_and_adds_up_its_runs, scratch::InFolder) {
    const fs::path many = ensemble(folder);
    const auto answer = json_of(run({"verify", many.string(), "--json"}));
    BOOST_TEST_REQUIRE(answer["members"].size() == 3U);
    int arcs = 0;
    for (const nlohmann::json& member : answer["members"]) {
        const nlohmann::json one = json_of(run({"verify", member["folder"].get<std::string>(), "--json"}));
        BOOST_TEST(one["verdict"] == member["verdict"]);
        BOOST_TEST(one["arcs"] == member["arcs"]);
        arcs += one["arcs"].get<int>();
    }
    has(answer, {{"arcs", arcs}, {"equilibria_proved", 12}, {"verdict", "ends proved, way looked at"}});
    says(run({"verify", many.string()}), 0, {"equilibria     12 of 12 proved", "rest"});
}

BOOST_FIXTURE_TEST_CASE(one_wrong_or_missing_run_decides_the_status_of_an_ensemble, scratch::InFolder) {
    const fs::path many = ensemble(folder);
    const fs::path header = many / seed(2) / "run.json";
    scratch::write(header, scratch::replaced(scratch::read(header), "\"completed\"", "\"running\""));
    says(run({"verify", many.string()}), 2, {"not finished"});
    scratch::write(header, "nothing");
    const auto unreadable = says(run({"verify", many.string()}), 65, {"cannot be read"});
    BOOST_TEST(contains(unreadable.out, "equilibria     8 of 8 proved")); // the others were checked

    const fs::path events = many / seed(3) / "events.jsonl";
    scratch::write(events, scratch::replaced(scratch::read(events), "\"power\":", "\"power\":1"));
    forger::seal(many / seed(3));
    fs::remove_all(many / seed(1));
    says(run({"verify", many.string()}), 1, {"missing", "cannot be read", "refuted", "events.jsonl:1"});
}

BOOST_FIXTURE_TEST_CASE(report_takes_an_ensemble, scratch::InFolder) {
    const fs::path many = ensemble(folder);
    says(run({"report", many.string(), "--no-charts", "--html"}), 0, {"proved"});
    for (int number = 1; number <= 3; ++number) {
        BOOST_TEST(fs::exists(many / seed(number) / "figures/report.txt"));
        BOOST_TEST(fs::exists(many / seed(number) / "figures/trajectory.html"));
    }
    // The forces of all samples together: densities over bins of 1/4.
    double first = 0, last = 0, mean = 0;
    for (const std::string& line : scratch::lines_of(many / "figures/force_distribution.dat")) {
        double centre = 0, of_first = 0, of_last = 0;
        if (std::istringstream(line) >> centre >> of_first >> of_last) {
            first += of_first / 4;
            last += of_last / 4;
            mean += centre * of_first / 4;
        }
    }
    BOOST_TEST(first == 1, boost::test_tools::tolerance(1e-4)); // the file has six digits
    BOOST_TEST(last == 1, boost::test_tools::tolerance(1e-4));
    BOOST_TEST(mean == 1, boost::test_tools::tolerance(0.1)); // forces are over their mean
    says(run({"report", many.string(), "--no-charts", "--contacts", "--quiet"}), 0, {});
    BOOST_TEST(scratch::read(many / seed(1) / "figures/contacts_eq_000000.csv").starts_with("contact,i,j,mx,my"));
    says(run({"ensemble", folder.at("s.toml"), "--samples", "3", "-o", many.string(), "--resume"}), 0, {"3 completed"});
    fs::remove(many / seed(2) / "run.json");
    expect(run({"report", many.string(), "--no-charts", "-o", folder.at("out")}), 65, {"seed 2", "not begun"});
    BOOST_TEST(fs::exists(folder / "out/seed_000003/report.txt")); // the others are reported
    BOOST_TEST(!fs::exists(folder / "out/seed_000002"));
}
