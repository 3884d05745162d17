// isostat snap, isostat compare and isostat inspect --at as a user runs them: exit statuses, what is printed and
// written.
#include "cli/program.hpp"

#include <cstdio>

using namespace program;
namespace fs = std::filesystem;

namespace {

/// snap of a frame of the series, with its walls and loads as frames.csv has them.
Outcome snap(int frame, const std::string& box, const std::string& stress, const fs::path& output,
             const Arguments& more = {}) {
    return run(plus({"snap", scratch::data("series/disks.dump"), "--frame", std::to_string(frame), "--box", box,
                     "--contacts", scratch::data("series/contacts.dump"), "--contact-columns", "i,j,force", "--stress",
                     stress, "-o", output.string()},
                    more));
}

/// What the forces of the answer leave unbalanced.
double rest_of(const Outcome& outcome) {
    const auto answer = json_of(outcome);
    BOOST_TEST_REQUIRE(answer.contains("forces"), outcome.out);
    return answer["forces"]["rest"];
}

const std::string first_box = "0:15.4590235640695,0:14.8856200965158";

} // namespace

BOOST_FIXTURE_TEST_CASE(a_soft_frame_snaps_to_a_state_that_certify_takes, scratch::InFolder) {
    const fs::path state = folder / "state.json";
    says(snap(0, first_box, "1,1", state), 0,
         {"156 pairs with a force", "h = 0, k = 0, 7 rattlers", "snap      vertex"});
    expect(run({"certify", state.string(), "-o", folder.at("certificate.json")}), 0);
    expect(run({"verify", folder.at("certificate.json")}), 0);
}

BOOST_FIXTURE_TEST_CASE(a_frame_of_soft_spheres_snaps_to_the_rigid_packing_that_it_stands_for, scratch::InFolder) {
    const std::string pressure = "1.0006650184686099e-06", state = folder.at("state.json");
    const auto snap_spheres = [&](Arguments more) {
        return run(plus({"snap", scratch::data("spheres/soft/spheres.dump"), "-o", state}, more));
    };
    const std::vector<std::string> listed{"--contacts", scratch::data("spheres/soft/contacts.dump"),
                                          "--contact-columns", "c_ids[1],c_ids[2],c_forces"};
    for (const bool by_overlaps : {false, true}) {
        const Arguments stated{"--cell", "isotropic", "--stress", pressure + "," + pressure + "," + pressure};
        says(snap_spheres(plus(by_overlaps ? Arguments() : listed, stated)), 0,
             {"N_f = 163, N = 163, rank 163, h = 0, k = 0, 5 rattlers", "of a sphere with a force"});
    }
    expect(run({"certify", state, "-o", folder.at("certificate.json")}), 0);
    says(run({"verify", folder.at("certificate.json"), "--input", state}), 0, {"equilibrium    proved"});
    // Forces of the wrong law are far from those that balance.
    for (const auto& [law, right] : {std::pair("linear", true), std::pair("hertz", false)}) {
        const Outcome made = snap_spheres({"--cell", "isotropic", "--stiffness", "1", "--law", law, "--json"});
        BOOST_TEST((rest_of(made) < 1e-2) == right, made.out);
    }
    // Two periods more give way, and the list has two contacts less than they need.
    says(snap_spheres({"--cell", "rectangular"}), 1, {"k = 2", "snap      moving"});
    expect(snap_spheres({"--cell", "isotropic", "--stress", "1,1"}), 64, {"S1,S2,S3, three positive numbers"});
    expect(snap_spheres({"--cell", "isotropic", "--law", "hertz"}), 64, {"--stiffness"});
    expect(run({"snap", scratch::data("spheres/box_uniform_100_1.txt"), "--box", "0:15,0:15.064,0:13.93", "-o", state}),
           65, {"no sphere is near the right wall"});
}

BOOST_FIXTURE_TEST_CASE(a_stiffness_says_the_forces_that_the_file_does_not, scratch::InFolder) {
    for (const auto& [stiffness, right] : {std::pair{"1e5", true}, std::pair{"1.1e5", false}}) {
        const Outcome made = run({"snap", scratch::data("series/disks.dump"), "--frame", "0", "--box", first_box,
                                  "--stiffness", stiffness, "-o", folder.at("state.json"), "--json"});
        BOOST_TEST((rest_of(made) < 1e-2) == right, made.out);
    }
    expect(run({"snap", scratch::data("series/disks.dump"), "--stiffness", "-1", "-o", "x.json"}), 64,
           {"--stiffness", "is -1: expected a number from 1e-100 to"});
}

BOOST_FIXTURE_TEST_CASE(nominal_stresses_of_a_later_frame_press_on_the_lengths_that_are_stated, scratch::InFolder) {
    const auto rest = [&](const Arguments& more) {
        return rest_of(
            snap(4, "0:15.4667845567222,0:14.8785794068429", "1,1.18", folder / "state.json", plus({"--json"}, more)));
    };
    BOOST_TEST(rest({}) > 1e-4);
    BOOST_TEST(rest({"--reference-length", "15.459368964433708,14.885842749060064"}) < 1e-6);
    for (const char* wrong : {"15", "15,0", "15,-1", "15,nan", "15,x"}) {
        expect(run({"snap", scratch::data("series/disks.dump"), "--box", first_box, "--reference-length", wrong, "-o",
                    folder.at("state.json")}),
               64, {"--reference-length is '", "L1,L2, two positive numbers"});
    }
}

BOOST_FIXTURE_TEST_CASE(a_wall_whose_digits_are_rounded_is_named, scratch::InFolder) {
    const fs::path state = folder / "state.json";
    says(snap(0, "0:15.46,0:14.8856200965158", "1,1", state), 1,
         {"none with the right wall, which is ", "are digits of its position rounded?"});
    BOOST_TEST(!fs::exists(state));
}

BOOST_FIXTURE_TEST_CASE(contacts_are_a_dump_or_a_table_and_each_pair_stands_there_once, scratch::InFolder) {
    const std::string dump = scratch::read(scratch::data("series/contacts.dump"));
    const std::size_t names = dump.find("ITEM: ENTRIES"), first = dump.find('\n', names) + 1;
    const std::string rows = dump.substr(first, dump.find("ITEM:", first) - first), header = "i j force\n";
    const auto made = [&](const std::string& text) {
        return run({"snap", scratch::data("series/disks.dump"), "--frame", "0", "--box", first_box, "--contacts",
                    folder.file("pairs.txt", text), "--contact-columns", "i,j,force", "-o", folder.at("state.json")});
    };
    says(made(header + rows), 0, {"156 pairs with a force"});
    fs::remove(folder / "state.json");
    expect(made(header + rows + rows.substr(0, rows.find('\n') + 1)), 65,
           {"pairs.txt:158", "disks 58 and 87 come twice"});
    BOOST_TEST(!fs::exists(folder / "state.json"));
}

BOOST_FIXTURE_TEST_CASE(soft_limits_of_a_run_in_a_cell_go_to_the_exact_ones_as_1_over_the_stiffness,
                        scratch::InFolder) {
    scratch::write(folder / "cell.toml", "[packing]\ndisks = 30\nseed = 3\n[cell]\n[[programme]]\ndo = \"up\"\n"
                                         "equilibria = 2\n[output]\npictures = false\nstates_every = 1\n");
    const std::string out = folder.at("out");
    expect(run({"run", folder.at("cell.toml"), "-o", out, "--quiet"}), 0);
    std::array<std::vector<double>, 2> off; // soft - exact, where soft grains of both have a limit
    for (const std::size_t k : {0U, 1U}) {
        expect(run({"report", out, "--stiffness", k == 0 ? "1e6" : "1e7"}), 0);
        std::istringstream table(scratch::read(folder / "out" / "figures" / "soft_limits.csv"));
        std::string line;
        for (std::getline(table, line); std::getline(table, line);) {
            int number = 0;
            std::array<char, 8> end{};
            double exact = 0, soft = 0;
            BOOST_TEST_REQUIRE(std::sscanf(line.c_str(), "%d,%4[a-z],%lf,%lf", &number, end.data(), &exact, &soft) ==
                               4);
            off[k].push_back(soft - exact);
        }
    }
    BOOST_TEST_REQUIRE(off[0].size() >= 4U);
    BOOST_TEST_REQUIRE(off[1].size() == off[0].size());
    for (std::size_t k = 0; k < off[0].size(); ++k) {
        BOOST_TEST(off[0][k] / off[1][k] == 10, boost::test_tools::tolerance(0.02));
    }
}

BOOST_AUTO_TEST_CASE(some_frames_of_a_series_are_compared_alone) {
    const std::string series = scratch::data("series/series.toml");
    says(run({"compare", series, "--frames", "5:6", "--bundle", "4", "--local"}), 1,
         {"2 frames: 1 same, 1 soft", "FIRST DEPARTURE: frames 5 -> 6"});
    expect(run({"compare", series, "--frames", "9:11"}), 64, {"--frames is '9:11'", "no such frame"});
    expect(run({"compare", series, "--frames", "3"}), 64, {"--frames", "A:B"});
}

BOOST_FIXTURE_TEST_CASE(a_state_at_rest_snaps_to_itself_whatever_its_rattlers_rest_on, scratch::InFolder) {
    const std::string state = folder.at("state.json");
    expect(run({"import", scratch::data("vertex100.txt"), "-o", state}), 0);
    const auto made = says(run({"snap", state, "-o", folder.at("snapped.json")}), 0,
                           {"snap      vertex", "202 contacts of the state"});
    BOOST_TEST(!contains(made.out, ", 0 rattlers"), made.out); // they touch and carry nothing
    expect(run({"certify", folder.at("snapped.json"), "-o", folder.at("c.json")}), 0);
}

BOOST_FIXTURE_TEST_CASE(a_hyperstatic_frame_has_no_state_and_status_1, scratch::InFolder) {
    says(snap(8, "0:16.0045436303101,0:14.4378229180508", "1,1.56", folder / "state.json"), 1,
         {"snap      hyperstatic: the list has N_f = 198, N = 199"});
    BOOST_TEST(!fs::exists(folder / "state.json"));
}

BOOST_FIXTURE_TEST_CASE(what_snap_cannot_read_leaves_nothing, scratch::InFolder) {
    const fs::path state = folder / "state.json";
    expect(run({"snap", folder.at("absent"), "-o", state.string()}), 65, {"absent"});
    expect(snap(0, "0:15", "1,1", state), 64);
    expect(snap(99, first_box, "1,1", state), 65, {"frame 99"});
    BOOST_TEST(!fs::exists(state));
}

BOOST_FIXTURE_TEST_CASE(forces_at_another_load_are_those_of_a_state_under_it, scratch::InFolder) {
    const std::string state = folder.at("state.json");
    expect(snap(0, first_box, "1,1", state), 0);
    const auto inside = says(run({"inspect", state, "--at", "1.03"}), 0, {"sigma = (1, 1.03)"});
    expect(snap(0, first_box, "1,1.03", state), 0);
    const Outcome stored = done(run({"inspect", state, "--at", "1.03"}));
    const auto forces = [](const std::string& text) { return text.substr(text.find("force 0-19")); };
    BOOST_TEST(contains(inside.out, "force 0-19"), inside.out);
    BOOST_TEST(forces(inside.out) == forces(stored.out));
    says(run({"inspect", state, "--at", "1.2"}), 1, {"refuted"}); // beyond 1.0398, where 26-35 opens
    expect(run({"inspect", state, "--at", "high"}), 64);
}

BOOST_FIXTURE_TEST_CASE(a_series_that_departs_has_status_1_and_its_tables, scratch::InFolder) {
    const fs::path output = folder / "comparison";
    says(run({"compare", scratch::data("series/series.toml"), "-o", output.string(), "--bundle", "0"}), 1,
         {"9 frames: 4 same, 1 early, 1 other, 2 soft, 1 moving", "FIRST DEPARTURE: frames 2 -> 3: stiffness"});
    for (const char* name : {"comparison.csv", "comparison.json", "path.csv"}) {
        BOOST_TEST(fs::file_size(output / name) > 100U, name);
    }
    expect(run({"compare", folder.at("absent.toml"), "-o", folder.at("none")}), 65, {"absent.toml"});
    BOOST_TEST(!fs::exists(folder / "none"));
}

BOOST_FIXTURE_TEST_CASE(report_says_where_soft_grains_would_leave_the_structures_of_a_run, scratch::InFolder) {
    const std::string out = ran(folder, scene_from(scratch::data("vertex100.txt"), up(2), "states_every = 1\n"));
    const auto ends = [&](const std::string& stiffness) {
        says(run({"report", out, "--no-charts", "--stiffness", stiffness}), 0, {"K for 1e-3"});
        std::vector<std::array<double, 3>> rows; // exact, soft, stiffness needed
        for (const std::string& line : scratch::lines_of(out + "/figures/soft_limits.csv")) {
            std::array<double, 3> row{};
            if (std::sscanf(line.c_str(), "%*d,%*[a-z],%lf,%lf,%lf", row.data(), &row[1], &row[2]) == 3) {
                rows.push_back(row);
            }
        }
        return rows;
    };
    const auto soft = ends("1e6"), hard = ends("1e7");
    BOOST_TEST_REQUIRE(soft.size() == 6U); // three equilibria, two ends
    BOOST_TEST_REQUIRE(hard.size() == 6U);
    for (std::size_t k = 0; k < soft.size(); ++k) {
        const double far = soft[k][1] - soft[k][0], near = hard[k][1] - hard[k][0];
        BOOST_TEST(std::abs(near / far - 0.1) < 0.02); // as 1 / stiffness
        BOOST_TEST(std::abs(near) * 1e7 / (1e-3 * soft[k][0] * hard[k][2]) > 0.9);
        BOOST_TEST(std::abs(near) * 1e7 / (1e-3 * soft[k][0] * hard[k][2]) < 1.1);
    }
    expect(run({"report", out + "/states/last.json", "--stiffness", "1e6"}), 64, {"--stiffness"});
    expect(run({"report", out, "--stiffness", "-1"}), 64);
}
