// What `plan` says that a scene leaves out is not done, and what it says to be used is: counted by the program itself.
#include "cli/program.hpp"

using namespace program;
using nlohmann::json;
namespace fs = std::filesystem;

BOOST_AUTO_TEST_CASE(what_plan_leaves_out_is_not_done, *boost::unit_test::label("slow")) {
    // Entries of the plan that a counter tells of.
    const std::map<std::string, std::vector<std::string>> counters{
        {"damped dynamics", {"dynamics_steps"}},
        {"dual simplex (Clp)", {"linear_programmes"}},
        {"regular triangulation (CGAL)", {"candidate_searches"}},
        {"elimination mod 2^61 - 1", {"rank_proofs"}},
        {"sparse LU (KLU)", {"factorisations", "inverse_bounds"}},
        {"figures/*.svg, *.png (gnuplot), force pictures", {"pictures", "charts"}},
        {"figures/*.vtk", {"vtk_files"}}};
    std::set<std::string> seen_used, seen_unused;
    int runs = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(ISOSTAT_EXAMPLES "/plans")) {
        if (entry.path().extension() != ".toml") {
            continue;
        }
        BOOST_TEST_INFO_SCOPE(entry.path().filename().string());
        const auto plan = json_of(run({"plan", entry.path().string(), "--json"}));
        if (plan["programme"].empty()) {
            continue; // for `isostat prepare`
        }
        const scratch::Folder folder;
        expect(run({"run", entry.path().string(), "-o", folder.at("r"), "-q"}), 0);
        const json work = json::parse(scratch::read(folder / "r/work.json"))["counts"];
        ++runs;
        for (const json& part : plan["plan"]) {
            const auto found = counters.find(part["name"].get<std::string>());
            if (found == counters.end()) {
                continue;
            }
            (part["used"].get<bool>() ? seen_used : seen_unused).insert(found->first);
            for (const std::string& counter : found->second) {
                BOOST_TEST((work[counter].get<long>() > 0) == part["used"].get<bool>(),
                           found->first << ": " << counter << " = " << work[counter]);
            }
        }
    }
    BOOST_TEST(runs >= 10);
    BOOST_TEST(seen_used.size() == counters.size()); // every entry was met, and each optional one both ways
    BOOST_TEST(seen_unused.size() == 4U);
}

// Exact numbers: work that is done twice, or not at all, shows. What cannot be told beforehand is how often a
// checkpoint is written, which depends on seconds.
BOOST_AUTO_TEST_CASE(two_small_scenes_cost_what_they_did_with_any_number_of_threads) {
    const std::map<std::string, std::map<std::string, long>> known{{"loading",
                                                                    {{"candidate_searches", 13},
                                                                     {"overlap_proofs", 14},
                                                                     {"rank_proofs", 13},
                                                                     {"factorisations", 14},
                                                                     {"inverse_bounds", 40},
                                                                     {"states_written", 4}}},
                                                                   {"certified-arcs",
                                                                    {{"candidate_searches", 26},
                                                                     {"overlap_proofs", 14},
                                                                     {"rank_proofs", 19},
                                                                     {"factorisations", 106},
                                                                     {"inverse_bounds", 81},
                                                                     {"states_written", 4}}}};
    for (const auto& [scene, expected] : known) {
        for (const char* threads : {"1", "3"}) {
            const scratch::Folder folder;
            expect(run({"run", ISOSTAT_EXAMPLES "/plans/" + scene + ".toml", "-o", folder.at("r"), "-q", "--threads",
                        threads}),
                   0);
            const json work = json::parse(scratch::read(folder / "r/work.json"))["counts"];
            BOOST_TEST_INFO_SCOPE(scene << ", threads " << threads);
            for (const auto& [counter, count] : work.items()) {
                const auto found = expected.find(counter);
                if (counter == "checkpoints") {
                    BOOST_TEST(count.get<long>() > 0);
                } else {
                    BOOST_TEST(count.get<long>() == (found == expected.end() ? 0 : found->second), counter);
                }
            }
        }
    }
}
