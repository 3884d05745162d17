// Scenes with other radii than the uniform ones, and ties of equal radii with and without jitter.
#include "cli/program.hpp"

#include <nlohmann/json.hpp>

#include <set>

using namespace program;
namespace fs = std::filesystem;

namespace {

std::string scene(const std::string& packing, int equilibria) {
    return "[packing]\ndisks = 100\n" + packing +
           "[[programme]]\ndo = \"up\"\nequilibria = " + std::to_string(equilibria) + "\n[output]\npictures = false\n";
}

/// Runs a scene in a folder of its own; the folder of the run is `run` in it.
Outcome run_scene(const scratch::Folder& folder, const std::string& text) {
    scratch::write(folder / "s.toml", text);
    return run({"run", (folder / "s.toml").string(), "-o", (folder / "run").string(), "-q", "--force"});
}

std::string mixture(int seed, const std::string& jitter) {
    return scene("law = \"bidisperse\"\nseed = " + std::to_string(seed) + "\njitter = " + jitter + "\n", 30) +
           "[run]\nties = \"stop\"\n";
}

} // namespace

BOOST_AUTO_TEST_SUITE(cli)

BOOST_AUTO_TEST_CASE(every_law_is_prepared_and_run) {
    for (const std::string law : {"law = \"equal\"\njitter = 1e-6\n", "law = \"bidisperse\"\njitter = 1e-6\n",
                                  "law = \"lognormal\"\n", "law = \"normal\"\n", "law = \"power\"\n"}) {
        BOOST_TEST_CONTEXT(law) {
            const scratch::Folder folder;
            expect(run_scene(folder, scene(law, 3)), 0);
        }
    }
}

BOOST_AUTO_TEST_CASE(a_mixture_of_two_radii_ties_and_a_jitter_leaves_no_tie) {
    const scratch::Folder folder;
    for (const int seed : {2, 3, 9}) {
        BOOST_TEST_CONTEXT("seed " << seed) {
            expect(run_scene(folder, mixture(seed, "0.0")), 2, {"tie", "equal radii: try [packing] jitter = 1e-9"});
            BOOST_TEST(contains(scratch::read(folder / "run/summary.json"), "jitter = 1e-9"));
            expect(run_scene(folder, mixture(seed, "1e-9")), 0);
        }
    }
    const auto start = nlohmann::json::parse(scratch::read(folder / "run/start.json"));
    BOOST_TEST(start.at("provenance").at("settings").at("packing").at("jitter").get<double>() == 1e-9);
    std::set<double> radii;
    for (const auto& disk : start.at("disks")) {
        const double radius = disk.at(2).get<double>();
        const double base = radius < 0.6 ? 0.5 : 0.7;
        BOOST_TEST(std::abs(radius / base - 1) <= 1.0000001e-9);
        radii.insert(radius);
    }
    BOOST_TEST(radii.size() == 100U);
}

BOOST_AUTO_TEST_CASE(nearly_equal_disks_are_followed_where_contacts_are_nearly_singular_and_verified) {
    for (const int seed : {8, 12}) {
        BOOST_TEST_CONTEXT("seed " << seed) {
            const scratch::Folder folder;
            const std::string text = "law = \"equal\"\njitter = 1e-9\nseed = " + std::to_string(seed) + "\n";
            expect(run_scene(folder, scratch::replaced(scene(text, 12), "disks = 100", "disks = 36")), 0);
            const Outcome verified = run({"verify", (folder / "run").string()});
            expect(verified, 0);
            BOOST_TEST(contains(verified.out, "ends proved"));
        }
    }
}

BOOST_AUTO_TEST_CASE(the_plan_offers_a_jitter_for_equal_radii_only) {
    const scratch::Folder folder;
    const auto planned = [&](const std::string& packing) {
        scratch::write(folder / "s.toml", "[packing]\n" + packing);
        const Outcome outcome = run({"plan", (folder / "s.toml").string()});
        expect(outcome, 0);
        return outcome.out;
    };
    for (const std::string packing : {"disks = 9\nlaw = \"bidisperse\"\n", "radii = [1, 2, 1]\n"}) {
        BOOST_TEST(contains(planned(packing), "equal radii, so that ties are common: jitter = 1e-9"), packing);
    }
    for (const std::string packing :
         {"disks = 9\nlaw = \"equal\"\n", "disks = 9\ndiameters = [2, 2]\n", "radii = [1, 1, 1]\n"}) {
        BOOST_TEST(contains(planned(packing), "equal radii, so that ties are common: jitter = 1e-4"), packing);
    }
    BOOST_TEST(contains(planned("radii = [1, 2, 3]\n"), "jitter = 0; no radii are equal"));
    BOOST_TEST(contains(planned("radii = [1, 2, 1]\njitter = 1e-6\n"), "R_i (1 + 1e-06 rho_i)"));
}

BOOST_AUTO_TEST_SUITE_END()
