// Vertices found again from the records of a run, and the page made of them.
#include "cli/program.hpp"
#include "report/page.hpp"
#include "report/run_walk.hpp"
#include "report/statistics.hpp"
#include "support/clumps.hpp"

#include <tuple>

using namespace program;
using namespace isostat;
namespace fs = std::filesystem;

namespace {

/// A run with every state stored, a branch included.
void make_run(const scratch::Folder& folder, const std::string& start, const std::string& highest = "1.035") {
    scratch::write_scene(folder / "s.toml", scene_from(start,
                                                       "[[programme]]\ndo = \"up\"\nequilibria = 5\n"
                                                       "[[programme]]\ndo = \"down\"\nfrom = 2\nequilibria = 3\n"
                                                       "[[programme]]\ndo = \"up\"\nfrom = 1\nto = " +
                                                           highest + "\n",
                                                       "states_every = 1\n"));
    expect(run({"run", folder.at("s.toml"), "-o", folder.at("run"), "-q"}), 0);
}

checker::RunRecords records_of(const fs::path& run) {
    return checker::read_records(run, LastLine::may_be_cut);
}

EquilibriumRow row(int number, int previous, int segment, double ratio, double strain, int arcs) {
    EquilibriumRow r;
    r.number = number;
    r.previous = previous;
    r.segment = segment;
    r.ratio = ratio;
    r.strain2 = strain;
    r.arcs = arcs;
    return r;
}

/// Up twice, then back to 1 (one rearrangement and a stop inside an interval), then a branch down from 1.
const std::vector<EquilibriumRow> rows{row(0, -1, 0, 1.0, 0.0, 0),    row(1, 0, 0, 1.25, 0.5, 1),
                                       row(2, 1, 0, 1.75, 0.625, 3),  row(3, 2, 1, 1.5, 0.375, 2),
                                       row(4, 3, 1, 1.0, 0.375, 0),   row(5, 1, 2, 1.125, 0.25, 4),
                                       row(6, 5, 2, 1.0625, 0.125, 1)};

} // namespace

BOOST_FIXTURE_TEST_CASE(a_walk_along_the_records_passes_through_every_stored_state, scratch::InFolder) {
    make_run(folder, scratch::data("vertex100.txt"));
    const checker::RunRecords records = records_of(folder / "run");
    int equilibria = 0;
    std::size_t arcs = 0;
    int relisted = 0;
    const std::vector<std::string> left_out = walk_run(records, [&](const WalkedVertex& vertex) {
        arcs += vertex.arc != nullptr ? 1 : 0;
        relisted += vertex.relisted ? 1 : 0;
        if (vertex.equilibrium != nullptr) {
            ++equilibria;
            const State stored = records.stored(vertex.state.equilibrium)->state;
            double most = 0;
            for (std::size_t k = 0; k < stored.packing.q.size(); ++k) {
                most = std::max(most, std::abs(stored.packing.q[k] - vertex.state.packing.q[k]));
            }
            BOOST_TEST(most < 1e-10, "equilibrium " << vertex.state.equilibrium << ": " << most);
            BOOST_TEST((stored.contacts == vertex.state.contacts));
            BOOST_TEST((stored.load.stress == vertex.state.load.stress));
        }
        return true;
    });
    BOOST_TEST(left_out.empty());
    BOOST_TEST(equilibria == 10);
    BOOST_TEST(arcs == records.events.size());
    BOOST_TEST(relisted == 1); // the others were reached along arcs
}

BOOST_FIXTURE_TEST_CASE(what_cannot_be_followed_is_left_out_up_to_the_next_stored_state, scratch::InFolder) {
    make_run(folder, scratch::data("vertex100.txt"));
    checker::RunRecords records = records_of(folder / "run");
    const auto broken =
        std::ranges::find_if(records.events, [](const checker::EventRecord& event) { return event.equilibrium == 2; });
    broken->opened = "0-99"; // no contact there
    std::vector<int> relisted;
    const std::vector<std::string> left_out = walk_run(records, [&](const WalkedVertex& vertex) {
        BOOST_TEST((vertex.arc == nullptr || vertex.arc->equilibrium != 2));
        if (vertex.relisted) {
            relisted.push_back(vertex.state.equilibrium);
        }
        return true;
    });
    BOOST_TEST(left_out == std::vector<std::string>{"equilibrium 2 from its arc 1 on"},
               boost::test_tools::per_element());
    BOOST_TEST((relisted == std::vector<int>{0, 2}));
}

BOOST_AUTO_TEST_CASE(a_walk_holds_and_releases_coordinates) {
    const scratch::Folder out;
    expect(run({"run", scratch::data("../../examples/turns/power-turn.toml"), "-o", out.path().string(), "-q"}), 0);
    const checker::RunRecords records = records_of(out);
    int held = 0;
    const auto left_out = walk_run(records, [&](const WalkedVertex& vertex) {
        held += std::ranges::any_of(vertex.state.contacts,
                                    [](const Contact& contact) { return contact.kind == ContactKind::held; })
                    ? 1
                    : 0;
        return true;
    });
    BOOST_TEST(left_out.empty());
    BOOST_TEST(held == 2); // after the turn, and after the arc between turn and release
}

BOOST_FIXTURE_TEST_CASE(the_page_of_a_run_that_was_killed_has_what_was_recorded, scratch::InFolder) {
    make_run(folder, scratch::data("vertex100.txt"));
    const std::string whole = run_page(folder / "run", {}).html;
    BOOST_TEST(contains(whole, "completed"));
    const std::string events = scratch::read(folder / "run/events.jsonl");
    scratch::write(folder / "run/events.jsonl", events + "{\"step\":99,\"equil"); // in the middle of a line
    const std::string header = scratch::read(folder / "run/run.json");
    scratch::write(folder / "run/run.json", scratch::replaced(header, "\"completed\"", "\"running\""));
    const Page page = run_page(folder / "run", {});
    BOOST_TEST(page.left_out.empty());
    BOOST_TEST(page.html == scratch::replaced(whole, "\"status\":\"completed\"", "\"status\":\"running\""));
}

BOOST_FIXTURE_TEST_CASE(the_page_of_a_run_in_a_cell_has_its_packing_its_images_and_its_arcs, scratch::InFolder) {
    make_run(folder, scratch::data("cells/rect_16.json"), "1.4");
    const Page page = run_page(folder / "run", {});
    BOOST_TEST(page.left_out.empty());
    BOOST_TEST(contains(page.html, "\"periodic\":[true,true]"));
    const std::string arcs = std::to_string(records_of(folder / "run").events.size());
    BOOST_TEST(contains(page.html, "\"arcs\":" + arcs + ","));
    fs::remove(folder / "run/states/eq_000000.json");
    const Page bare = run_page(folder / "run", {});
    BOOST_TEST(contains(bare.html, "\"arcs\":" + arcs + ","));
    BOOST_REQUIRE(bare.left_out.size() == 1U);
    BOOST_TEST(contains(bare.left_out[0], "eq_000000.json is not there"));
}

BOOST_FIXTURE_TEST_CASE(the_page_of_a_run_without_an_equilibrium_says_so, scratch::InFolder) {
    make_run(folder, scratch::data("vertex100.txt"));
    scratch::write(folder / "run/events.jsonl", "");
    const std::string rows = scratch::read(folder / "run/equilibria.csv");
    scratch::write(folder / "run/equilibria.csv", rows.substr(0, rows.find('\n') + 1));
    fs::remove_all(folder / "run/states");
    BOOST_TEST(contains(run_page(folder / "run", {}).html, "\"number\":[]"));
}

BOOST_FIXTURE_TEST_CASE(no_name_can_end_the_script_that_holds_the_data, scratch::InFolder) {
    make_run(folder, scratch::data("vertex100.txt"));
    const std::string header = scratch::read(folder / "run/run.json");
    scratch::write(folder / "run/run.json",
                   scratch::replaced(header, "\"scene_file\": \"", "\"scene_file\": \"</script><script>alert(1)//"));
    const std::string page = run_page(folder / "run", {}).html;
    BOOST_TEST(!contains(page, "</script><script>alert"));
    BOOST_TEST(contains(page, "\\u003c/script\\u003e\\u003cscript\\u003ealert(1)"));
}

BOOST_AUTO_TEST_CASE(integers_take_a_byte_when_they_are_small) {
    const auto bytes = [](std::int64_t value) {
        std::string text;
        append_varint(text, value);
        return text;
    };
    BOOST_TEST((bytes(0) == std::string(1, '\0')));
    BOOST_TEST((bytes(-1) == "\x01"));
    BOOST_TEST((bytes(1) == "\x02"));
    BOOST_TEST((bytes(63) == "\x7e"));
    BOOST_TEST((bytes(-64) == "\x7f"));
    BOOST_TEST((bytes(64) == "\x80\x01"));
    BOOST_TEST((bytes(-1000000) == "\xff\x88\x7a"));
}

/// A ParaView file has members as points with radii, the picture the arcs.
BOOST_FIXTURE_TEST_CASE(a_report_draws_bodies_bounded_by_arcs_and_writes_no_disks_of_them, scratch::InFolder) {
    scratch::write(folder / "oval.json", state_text(isostat::test::oval_in_a_box(1, 1)));
    const auto drawn = [&](std::vector<std::string> extra) {
        std::vector<std::string> words{"report", folder.at("oval.json"), "-o", folder.at("pictures")};
        words.insert(words.end(), extra.begin(), extra.end());
        return run(words);
    };
    expect(drawn({"--vtk"}), 65);
    BOOST_TEST(!fs::exists(folder / "pictures" / "forces_oval.vtk"));
    expect(drawn({}), 0);
    BOOST_TEST(fs::exists(folder / "pictures" / "forces_oval.svg"));
}

BOOST_AUTO_TEST_CASE(a_triaxial_test_has_logarithmic_strains_and_q_over_p) {
    Load load;
    load.dimension = 3;
    load.stress = {1, 1, 1};
    load.reference_length = {2, 2, 4};
    const auto of = [&](int number, double stress, std::vector<double> length) {
        EquilibriumRow r = row(number, number - 1, 0, 0, 0, 1);
        r.stress = stress;
        r.length = std::move(length);
        return r;
    };
    const std::vector<EquilibriumRow> two{of(0, 0, {2, 2, 4}), of(1, 0.25, {3, 2, 2})};
    load.follow({-1, -1, 2});
    std::vector<TriaxialPoint> points = triaxial_points(two, load);
    BOOST_TEST(points[1].p == 1);
    BOOST_TEST(points[1].q == 0.75);
    BOOST_TEST(points[1].axial == std::log(2.0));
    BOOST_TEST(points[1].volumetric == std::log(4.0 / 3), boost::test_tools::tolerance(1e-15));
    load.follow({1, 0, 0}); // one axis: its stress is what the rows have
    points = triaxial_points(two, load);
    BOOST_TEST(points[1].q == 1 - (0.25 + 1) / 2);
    const Chart chart = triaxial_chart(triaxial_branches(two, load, {"up"}), false);
    BOOST_TEST((chart.data.find("# up\n# number axial_strain volumetric_strain p q q/p sin_phi\n0 0 0 ") == 0),
               chart.data);
    const std::string page = sphere_page("a & @TABLE@", json::Json::array(), {true, two, load, {"<up>"}});
    BOOST_TEST((page.find("<title>&lt;up&gt;</title>") != std::string::npos));
    BOOST_TEST((page.find("a &amp; @TABLE@") != std::string::npos));
}

BOOST_AUTO_TEST_CASE(a_segment_begins_at_the_equilibrium_that_it_starts_from) {
    const std::vector<Chart> charts = make_charts(rows, {"up", "back"});
    BOOST_TEST_REQUIRE(charts.size() >= 2U);
    const auto has = [](const std::string& text, const std::string& part) {
        return text.find(part) != std::string::npos;
    };
    BOOST_TEST(charts[0].name == "staircase");
    BOOST_TEST(has(charts[0].data, ": up\n0 1\n0 1.25\n0.5 1.25\n0.5 1.75\n0.625 1.75\n\n\n"), charts[0].data);
    BOOST_TEST(has(charts[0].data, ": back\n0.625 1.75\n0.625 1.5\n0.375 1.5\n0.375 1\n0.375 1\n\n\n"), charts[0].data);
    BOOST_TEST(charts[1].name == "cycles");
    BOOST_TEST(has(charts[1].data, ": path to equilibrium 1\n0 1\n0 1.25\n0.5 1.25\n\n\n"), charts[1].data);
    BOOST_TEST(has(charts[1].data, ": segment 3\n0.5 1.25\n0.5 1.125\n0.25 1.125\n"), charts[1].data);
    const std::string table = run_tables(rows, {"up", "back", "branch", "later"}, "completed");
    const auto line = [&](const std::string& name) {
        const std::size_t at = table.find(name + " ", table.find("ratio from"));
        return table.substr(at, table.find('\n', at) - at);
    };
    const auto words = [](const std::string& text) {
        std::istringstream stream(text);
        return std::vector<std::string>{std::istream_iterator<std::string>(stream), {}};
    };
    const auto number = [&](const std::string& name, std::size_t k) { return std::stod(words(line(name)).at(k)); };
    for (const auto& [name, from, made, arcs] :
         {std::tuple{"up", 0, 2, 4}, std::tuple{"back", 2, 2, 2}, std::tuple{"branch", 1, 2, 5}}) {
        BOOST_TEST(number(name, 1) == from, table);
        BOOST_TEST(number(name, 2) == made, table);
        BOOST_TEST(number(name, 7) == arcs, table);
    }
    BOOST_TEST(number("back", 3) == 1.75, table);
    BOOST_TEST(has(line("later"), "not run"), table);
}

BOOST_AUTO_TEST_CASE(stress_increments_are_between_two_rearrangements_of_one_segment) {
    const Increments increments = stress_increments(rows);
    BOOST_TEST((increments.loading == std::vector<double>{0.5}));
    BOOST_TEST((increments.unloading == std::vector<double>{0.0625}));
}

BOOST_AUTO_TEST_CASE(strain_increments_are_those_of_every_rearrangement) {
    const Increments increments = strain_increments(rows);
    BOOST_TEST((increments.loading == std::vector<double>{0.5, 0.125}));
    BOOST_TEST((increments.unloading == std::vector<double>{0.25, 0.25, 0.125}));
}

BOOST_AUTO_TEST_CASE(the_path_to_an_equilibrium_leaves_branches_out) {
    const auto numbers = [](int to) {
        std::vector<int> list;
        for (const EquilibriumRow& r : path_to(rows, to)) {
            list.push_back(r.number);
        }
        return list;
    };
    BOOST_TEST((numbers(4) == std::vector<int>{0, 1, 2, 3, 4}));
    BOOST_TEST((numbers(6) == std::vector<int>{0, 1, 5, 6}));
    BOOST_TEST((numbers(9).empty()));
}

BOOST_AUTO_TEST_CASE(the_complementary_distribution_counts_ties_once) {
    using Points = std::vector<std::pair<double, double>>;
    BOOST_TEST((complementary_distribution({3, 1, 2, 2}) == Points{{1, 1}, {2, 0.75}, {3, 0.25}}));
    BOOST_TEST((complementary_distribution({}) == Points{}));
}

BOOST_AUTO_TEST_CASE(a_histogram_integrates_to_the_share_inside) {
    const std::vector<double> values{0, 0.1, 0.5, 0.9, 1.0, 7};
    double sum = 0;
    for (const auto& [centre, density] : histogram(values, 0, 1, 4)) {
        sum += density * 0.25;
    }
    BOOST_TEST(sum == 5.0 / 6, boost::test_tools::tolerance(1e-15));
    BOOST_TEST(histogram(values, 0, 1, 4).front().first == 0.125);
    BOOST_TEST(histogram(values, 0, 1, 4).back().second == 2 / (6 * 0.25), boost::test_tools::tolerance(1e-15));
}

BOOST_AUTO_TEST_CASE(a_histogram_whose_bins_have_no_width_keeps_its_values) {
    constexpr double tiny = 5e-324, huge = 1.7e308;
    for (const auto& [low, high] : {std::pair{0.0, tiny}, {tiny, tiny}, {-huge, huge}, {0.0, HUGE_VAL}}) {
        BOOST_TEST(histogram({low, high}, low, high, 4).size() == 4U);
    }
}
