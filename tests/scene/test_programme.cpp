#include "support/bad_input.hpp"

#include <isostat/scene/scene.hpp>

using namespace isostat;

namespace {

const std::string prepared_scene = "[packing]\ndisks = 10\n";
const std::string given = "[packing]\nfile = \"v.txt\"\n";

std::string step(const std::string& keys) {
    return "[[programme]]\n" + keys + "\n";
}

Scene parse(const std::string& text) {
    return parse_scene(text, "s.toml", "");
}

void accepts(const std::string& text) {
    BOOST_CHECK_NO_THROW((void)parse(text));
}

void refuses(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse(text); }, words);
}

} // namespace

BOOST_AUTO_TEST_CASE(a_segment_needs_an_end) {
    refuses(prepared_scene + step("do = \"up\""), {"s.toml:3:", "\"up\"", "no end", "equilibria", "to"});
    refuses(prepared_scene + step("do = \"to\""), {"s.toml:3:", "without a ratio"});
    refuses(prepared_scene + step("do = \"to\"\nto = 1.1\nequilibria = 3"), {"s.toml:3:", "no 'equilibria'"});
    refuses(prepared_scene + step("equilibria = 3"), {"s.toml:3:", "'do'"});
    refuses(prepared_scene + step("do = \"sideways\"\nequilibria = 3"), {"s.toml:4:", "sideways", "up"});
    refuses(prepared_scene + step("do = \"up\"\nequilibria = 0"), {"s.toml:5:", "equilibria", "0"});
    refuses(prepared_scene + step("do = \"down\"\nto = -0.5"), {"s.toml:5:", "-0.5", "not negative"});
}

BOOST_AUTO_TEST_CASE(ratios_behind_the_start_are_refused) {
    refuses(prepared_scene + step("do = \"up\"\nto = 0.9"), {"s.toml:3:", "0.9", "ratio at its start is 1", "larger"});
    refuses(prepared_scene + step("do = \"up\"\nto = 1.0"), {"s.toml:3:", "larger"});
    refuses(prepared_scene + step("do = \"down\"\nto = 1.1"), {"s.toml:3:", "1.1", "smaller"});
    refuses(prepared_scene + step("do = \"to\"\nto = 1.0"), {"s.toml:3:", "nothing to do"});
    refuses(prepared_scene + step("do = \"up\"\nto = 1.2") + step("do = \"up\"\nto = 1.1"),
            {"s.toml:6:", "1.1", "is 1.2", "larger"});
    // After some equilibria upwards the ratio is at least that of the start.
    refuses(prepared_scene + step("do = \"up\"\nequilibria = 5") + step("do = \"up\"\nto = 0.9"),
            {"s.toml:6:", "at least 1", "larger"});
    refuses(prepared_scene + step("do = \"up\"\nto = 1.2\nequilibria = 5") + step("do = \"down\"\nto = 1.3"),
            {"from 1 to 1.2", "smaller"});
    accepts(prepared_scene + step("do = \"up\"\nequilibria = 5") +
            step("do = \"down\"\nto = 1.3")); // may be above: only the run knows
    accepts(prepared_scene + step("do = \"up\"\nequilibria = 5") + step("do = \"to\"\nto = 1.0"));
    accepts(prepared_scene + step("do = \"up\"\nto = 1.2") + step("do = \"down\"\nto = 1.1"));
}

BOOST_AUTO_TEST_CASE(starting_from_an_equilibrium_that_will_not_exist_is_refused) {
    refuses(prepared_scene + step("do = \"up\"\nequilibria = 5") + step("do = \"down\"\nfrom = 6\nto = 1.0"),
            {"s.toml:6:", "equilibrium 6", "number 5"});
    refuses(prepared_scene + step("do = \"up\"\nfrom = 1\nequilibria = 5"), {"s.toml:3:", "equilibrium 1", "number 0"});
    accepts(prepared_scene + step("do = \"up\"\nequilibria = 5") + step("do = \"down\"\nfrom = 5\nto = 1.0"));
    accepts(prepared_scene + step("do = \"up\"\nequilibria = 5") + step("do = \"up\"\nequilibria = 5") +
            step("do = \"down\"\nfrom = 10\nto = 1.0"));
    // A segment that ends at a ratio makes a number of equilibria that is not known in advance.
    accepts(prepared_scene + step("do = \"up\"\nto = 1.1") + step("do = \"down\"\nfrom = 1000\nto = 1.0"));
    // Known numbers stay known after it: equilibrium 0 is the start, at ratio 1.
    refuses(prepared_scene + step("do = \"up\"\nto = 1.1") + step("do = \"up\"\nfrom = 0\nto = 1.0"),
            {"s.toml:6:", "start is 1"});
}

BOOST_AUTO_TEST_CASE(the_ratio_of_a_start_file_is_checked_when_it_is_known) {
    const Scene scene = parse(given + step("do = \"down\"\nto = 1.5"));
    BOOST_CHECK_NO_THROW(check_programme(scene, 2.0));
    expect_bad_input([&] { check_programme(scene, 1.5); }, {"s.toml:3:", "start is 1.5", "smaller"});
    expect_bad_input([&] { check_programme(scene, 1.0); }, {"s.toml:3:", "start is 1", "smaller"});
}

namespace {

Load stresses(double sigma1, double sigma2) {
    Load load;
    load.stress = {sigma1, sigma2};
    return load;
}

} // namespace

BOOST_AUTO_TEST_CASE(segments_get_a_direction_and_a_stress) {
    ProgrammeStep to;
    to.action = Action::to;
    to.to = 1.5;
    BOOST_TEST(segment_of(to, stresses(2, 4), "s").direction == -1);
    BOOST_TEST(segment_of(to, stresses(2, 2), "s").direction == +1);
    BOOST_TEST(*segment_of(to, stresses(2, 2), "s").to_stress == 3.0);
    expect_bad_input([&] { (void)segment_of(to, stresses(2, 3), "s"); }, {"1.5"});
    ProgrammeStep down;
    down.action = Action::down;
    down.equilibria = 3;
    BOOST_TEST(segment_of(down, stresses(2, 4), "s").direction == -1);
    BOOST_TEST(!segment_of(down, stresses(2, 4), "s").to_stress.has_value());
    down.to = 1.0;
    BOOST_TEST(*segment_of(down, stresses(2, 4), "s").to_stress == 2.0);
    expect_bad_input([&] { (void)segment_of(down, stresses(2, 1), "s"); }, {"smaller ratio than 1"});
}

BOOST_AUTO_TEST_CASE(the_plan_follows_the_scene) {
    const auto used = [](const Scene& scene, const std::string& name) {
        for (const PlanEntry& entry : make_plan(scene)) {
            if (entry.name.find(name) != std::string::npos) {
                BOOST_TEST(!entry.reason.empty());
                return entry.used;
            }
        }
        BOOST_ERROR("not in the plan: " + name);
        return false;
    };
    const Scene a = parse(prepared_scene + step("do = \"up\"\nequilibria = 5"));
    const Scene b =
        parse(given + "[load]\nkind = \"true\"\n[run]\nrule = \"random\"\n[output]\npictures = false\nvtk = true\n" +
              step("do = \"up\"\nequilibria = 5"));
    const Scene c = parse(prepared_scene);
    for (const auto& [name, in_a, in_b, in_c] : {std::tuple{"damped dynamics", true, false, true},
                                                 {"Clp", true, false, true},
                                                 {"read the start", false, true, false},
                                                 {"trajectory", true, true, false},
                                                 {"descent of W", true, false, false},
                                                 {"random choice", false, true, false},
                                                 {"figures/*.svg", true, false, false},
                                                 {"vtk", false, true, false},
                                                 {"events.jsonl", true, true, false}}) {
        BOOST_TEST(used(a, name) == in_a, name);
        BOOST_TEST(used(b, name) == in_b, name);
        BOOST_TEST(used(c, name) == in_c, name);
    }
}

BOOST_AUTO_TEST_CASE(the_plan_says_how_packings_of_a_size_are_prepared) {
    for (const auto& [disks, dynamics, programmes, simplex] :
         {std::tuple{8192, "to a relaxed soft packing", "rows of the basis", true},
          {8193, "to a relaxed soft packing", "interior-point descent", true},
          {50000, "to a relaxed soft packing", "interior-point descent", true},
          {50001, "Newton steps", "interior-point descent", false}}) {
        const Scene scene = parse("[packing]\ndisks = " + std::to_string(disks) + "\n");
        for (const PlanEntry& entry : make_plan(scene)) {
            if (entry.name == "damped dynamics") {
                BOOST_TEST(entry.reason.find(dynamics) != std::string::npos, entry.reason);
            } else if (entry.name == "sequential linear programmes") {
                BOOST_TEST(entry.reason.find(programmes) != std::string::npos, entry.reason);
            } else if (entry.name == "dual simplex (Clp)") {
                BOOST_TEST(entry.used == simplex, entry.reason);
            }
        }
    }
}
