// Commands and states of clumps: what they answer, and who refuses them.
#include "cli/program.hpp"
#include "support/clumps.hpp"

using namespace program;

BOOST_FIXTURE_TEST_CASE(clumps_are_inspected_certified_verified_and_drawn, scratch::InFolder) {
    const std::string state = ISOSTAT_TEST_DATA "/clumps/dimer2_20_2.json";
    const std::string certificate = folder.at("certificate.json");
    says(run({"inspect", state}), 0,
         {"40 in 20 bodies", "mechanisms k             6", "1 bodies without force, 3 more",
          "isostatic equilibrium    proved"});
    says(run({"certify", state, "-o", certificate}), 0, {"k = 6", "but for motions that change no force"});
    says(run({"verify", certificate, "--input", state}), 0, {"equilibrium    proved"});
    isostat::State other = isostat::test::clumps("dimer2_20_2");
    other.packing.bars[0].length *= 1 + 0x1p-50;
    isostat::write_state(folder.at("other.json"), other);
    says(run({"verify", certificate, "--input", folder.at("other.json")}), 1, {"a bar of the state"});
    expect(run({"report", ISOSTAT_TEST_DATA "/clumps/dimer_20_1.json", "-o", folder.at("report")}), 0);
    const std::string picture = scratch::read(folder / "report/forces_dimer_20_1.svg");
    BOOST_TEST(contains(picture, "class=\"force\""));
    BOOST_TEST(!contains(picture, "class=\"traction\"")); // bars under tension are no contacts
}

BOOST_FIXTURE_TEST_CASE(eigenvalues_of_the_second_variation_are_said_where_a_minimum_is_proved, scratch::InFolder) {
    isostat::write_state(folder.at("oval.json"), isostat::test::oval_in_a_box(1, 1));
    isostat::write_state(folder.at("falls.json"), isostat::test::oval_in_a_box(3, 1));
    says(run({"inspect", folder.at("oval.json")}), 1, {"W'' in (X, Y, angle)     2 +- "});
    const auto seen = nlohmann::json::parse(run({"inspect", folder.at("oval.json"), "--json"}).out);
    BOOST_TEST_REQUIRE(seen["second_variation"].size() == 1U);
    BOOST_TEST(std::abs(seen["second_variation"][0][0].get<double>() - 2) < 1e-9);
    BOOST_TEST(!contains(run({"inspect", folder.at("falls.json")}).out, "W'' in"));
}

BOOST_FIXTURE_TEST_CASE(a_run_of_clumps_goes_on_where_it_was_stopped_and_is_verified_and_reported, scratch::InFolder) {
    isostat::State state = isostat::test::lying_dimer(12, 12);
    state.load.refer_to(state.packing);
    state.load.stress = {12 / 2.0, 12 / 2.875};
    isostat::write_state(folder.at("dimer.json"), state);
    const std::string loop =
        "[packing]\nfile = \"dimer.json\"\n[[programme]]\nname = \"rises\"\ndo = \"down\"\nequilibria = 1\n"
        "[[programme]]\nname = \"lies\"\ndo = \"up\"\nequilibria = 1\n[run]\nmax_strain = 2\n";
    scratch::write(folder / "loop.toml", loop);
    expect(run({"run", folder.at("loop.toml"), "-o", folder.at("out")}), 0);
    expect(run({"run", folder.at("loop.toml"), "-o", folder.at("out"), "--resume"}), 0);
    expect(run({"report", folder.at("out"), "-o", folder.at("report")}), 0);
    expect(run({"report", folder.at("out"), "-o", folder.at("page"), "--html"}), 0);
    BOOST_TEST(scratch::read(folder / "page/trajectory.html").find(R"("body":[0,0])") != std::string::npos);
    says(run({"verify", folder.at("out")}), 0, {"ends proved", "3 of 3 proved"});
}

BOOST_FIXTURE_TEST_CASE(clumps_of_another_program_are_imported_with_the_counts_that_they_had, scratch::InFolder) {
    const std::string table = folder.at("grains.csv"), state = folder.at("imported.json");
    for (const auto& [name, digits, k] :
         {std::tuple{"dimer2_20_2", 17, 6}, std::tuple{"dimer2_20_2", 8, 6}, std::tuple{"trimer_20_1", 8, 0}}) {
        BOOST_TEST_INFO_SCOPE(name << " with " << digits << " digits");
        const isostat::Packing packing = isostat::test::clumps(name).packing;
        const int members = packing.disk_count() / 20;
        std::string text = "id,x,y,r,body\n";
        for (int i = 0; i < packing.disk_count(); ++i) {
            const isostat::DiskId disk(i);
            text +=
                fmt::format("{},{:.{}g},{:.{}g},{:.{}g},{}\n", i, packing.coordinate(disk, 0), digits,
                            packing.coordinate(disk, 1), digits, packing.radius[disk.index()], digits, 1 + i / members);
        }
        scratch::write(table, text);
        const std::string box =
            fmt::format("0:{:.{}g},0:{:.{}g}", packing.length(0), digits, packing.length(1), digits);
        says(run({"import", table, "-o", state, "--box", box}), 0, {"proved"});
        says(run({"inspect", state}), 0, {fmt::format("mechanisms k             {}", k), "equilibrium    proved"});
        const isostat::Packing imported = isostat::test::clumps_of(scratch::read(state)).packing;
        BOOST_REQUIRE(imported.bars.size() == packing.bars.size());
        for (std::size_t b = 0; b < imported.bars.size(); ++b) {
            BOOST_TEST(imported.bars[b].i == packing.bars[b].i);
            BOOST_TEST(std::abs(imported.bars[b].length - packing.bars[b].length) < std::pow(10, 3 - digits));
        }
        expect(run({"import", table, "-o", state, "--box", box, "--bodies", "none"}), 65, {"--bodies COLUMN"});
    }
}

BOOST_FIXTURE_TEST_CASE(plateaus_and_genericity_of_clumps_say_what_turns, scratch::InFolder) {
    const std::string state = ISOSTAT_TEST_DATA "/clumps/dimer2_20_2.json";
    const std::string csv = folder.at("table.csv");
    says(run({"plateau", state, "--csv", csv}), 0,
         {"40 in 20 bodies", "from N = 56 with 1 rattlers; h = 0, k = 3 (3 turns)", "turn about the one member"});
    BOOST_TEST(scratch::read(csv).find(",all_isostatic,turns,all_turns\n") != std::string::npos);
    const auto json = json_of(run({"plateau", state, "--json"}));
    BOOST_TEST(json.at("bodies") == 20);
    BOOST_TEST(json.at("widest").at("counts").at("turns") == 3);
    BOOST_TEST(json.at("widest").at("counts").at("N_f") == 59);
    says(run({"genericity", state, "--samples", "3"}), 0,
         {"N = 56", "rank with radii and places of members = 56", "members move", "rotational rattlers turn: 3..3"});
    const auto copies = json_of(run({"genericity", state, "--samples", "3", "--json"}));
    for (const auto& sample : copies.at("sizes").at(0).at("samples")) {
        BOOST_TEST(sample.at("turns") == 3);
        BOOST_TEST(sample.at("carrying") == 56);
    }
    const std::string oval = ISOSTAT_TEST_DATA "/clumps/oval_1.4_16_1.json";
    expect(run({"plateau", oval}), 65, {"arcs"});
    expect(run({"genericity", oval}), 65, {"arcs"});
}

BOOST_FIXTURE_TEST_CASE(what_takes_single_grains_names_clumps, scratch::InFolder) {
    const std::string state = ISOSTAT_TEST_DATA "/clumps/dimer_20_3.json";
    for (const Arguments& command : std::vector<Arguments>{{"snap", state, "-o", folder.at("snapped.json")},
                                                           {"import", state, "-o", folder.at("imported.json")},
                                                           {"export", state, "-o", folder.at("grains.csv")},
                                                           {"export", state, "-o", folder.at("grains.data")}}) {
        expect(run(command), 65, {"dimer_20_3.json", "clumps"});
    }
    BOOST_TEST(!std::filesystem::exists(folder / "grains.csv"));
    BOOST_TEST(!std::filesystem::exists(folder / "imported.json"));
}
