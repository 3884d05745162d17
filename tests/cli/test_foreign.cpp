// isostat plateau and isostat genericity, as a user runs them.

#include "cli/program.hpp"

namespace {

using namespace program;

const std::string packings = ISOSTAT_EXAMPLES "/packings/";

/// The three disks of the closed form, written as another program would; 0.5 to the left and 3 below the origin.
std::string three_disks(const std::string& header, const std::string& size) {
    return header + "0.5,-2," + size + "\n2.5,-2," + size + "\n1.5,-0.26794919243112259," + size + "\n";
}

} // namespace

BOOST_AUTO_TEST_CASE(plateau_of_a_state_and_of_a_crafted_packing) {
    says(run({"plateau", scratch::data("vertex100.txt")}), 0,
         {"backbone isostatic, proved", "from N = 188 with 7 rattlers", "the contact list of the file is not used"});
    says(run({"plateau", packings + "square_lattice_3.toml", "--thresholds=-1e-3:1e-2"}), 1, {"at no threshold"});
}

BOOST_AUTO_TEST_CASE(plateau_says_what_is_wrong_with_walls_and_pseudo_atoms) {
    const std::string dump = scratch::data("series/disks.dump");
    const auto with = [&dump](Arguments more) {
        return run(plus({"plateau", dump, "--frame", "0", "--walls", "box"}, more));
    };
    says(with({}), 1, {"no disk is near the left wall, the nearest gap is"});
    const auto exact = with({"--box", "0:15.4590235640695,0:14.8856200965158"});
    expect(exact, 0);
    BOOST_TEST(!contains(exact.out, "no disk is near"), exact.out);
    BOOST_TEST(!contains(exact.out, "digits down to"), exact.out);
    // Rounded to one decimal, walls close contacts far too early.
    const auto rounded = with({"--box", "0:15.4,0:14.8"});
    BOOST_TEST(contains(rounded.out, "--box has digits down to 0.1"), rounded.out);
    // Overlaps stand in three rows at most, not in every second one.
    const auto table = exact.out.substr(exact.out.find("threshold candidates"));
    const auto rows = table.substr(0, table.find("\n\n"));
    const auto negative = std::ranges::count(rows, '|') == 0 ? 99 : [&rows] {
        int count = 0;
        for (std::size_t at = 0; (at = rows.find('\n', at)) != std::string::npos; ++at) {
            const std::size_t first = rows.find_first_not_of(" \n", at);
            count += first != std::string::npos && rows[first] == '-' ? 1 : 0;
        }
        return count;
    }();
    BOOST_TEST(negative >= 2);
    BOOST_TEST(negative <= 5);
}

BOOST_FIXTURE_TEST_CASE(rows_are_selected_by_a_column, scratch::InFolder) {
    const std::string file = folder.file(
        "start.data", "disks and a wall\n\n3 atoms\n2 atom types\n\n-4 9 xlo xhi\n-4 9 ylo yhi\n-0.5 0.5 zlo zhi\n\n"
                      "Atoms # sphere\n\n1 1 2 1 1 1 0\n2 1 2 1 3 1 0\n3 2 1 1 8 -2 0\n");
    const auto all = run({"plateau", file});
    BOOST_TEST(contains(all.out, "types 1 (2 rows), 2 (1 rows): every row is taken for a disk"), all.out);
    BOOST_TEST(contains(all.out, "disks                       3,"), all.out);
    expect(run({"plateau", file, "--walls", "box", "--box", "0:4,0:2"}), 65,
           {"centre between the walls", "--select type=1 takes one type"});
    const auto some = run({"plateau", file, "--select", "type=1"});
    BOOST_TEST(contains(some.out, "disks                       2,"), some.out);
    BOOST_TEST(!contains(some.out, "every row is taken"), some.out);
    expect(run({"plateau", file, "--select", "kind=1"}), 65, {"start.data", "no column 'kind'", "type"});
    expect(run({"plateau", file, "--select", "type=3"}), 65, {"no row has '3'"});
    expect(run({"plateau", file, "--select", "type"}), 64, {"COLUMN=VALUE"});
    expect(run({"plateau", scratch::data("vertex100.txt"), "--select", "type=1"}), 64, {"--select"});
}

BOOST_FIXTURE_TEST_CASE(plateau_of_a_table_with_walls_in_text_json_and_csv, scratch::InFolder) {
    const std::string file = folder.file("disks.csv", three_disks("x,y,diameter\n", "2"));
    // 0-0-0: the box fits to rounding; the top wall touches disk 2.
    Arguments arguments{"plateau", file, "--walls", "box", "--box=-0.5:3.5,-3:0.7320508075688774"};
    arguments = plus(arguments, {"--thresholds=-1e-9:1e-3", "--csv", folder.at("table.csv")});
    says(run(arguments), 0, {"diameter from column 'diameter'", "left and bottom fixed, right and top movable"});
    const std::string table = scratch::read(folder / "table.csv");
    BOOST_TEST(table.starts_with("threshold,candidates,rattlers,N_f,N,rank,h,k,"));
    arguments = plus(arguments, {"--json"});
    const auto json = says(run(arguments), 0, {"\"format\":\"isostat-plateau 1\"", "\"N\":8"});
    BOOST_TEST(std::ranges::count(json.out, '\n') == 1);
    // The same numbers as radii: disks of twice the size overlap and leave the box of their walls.
    BOOST_TEST(
        contains(run(plus(arguments, {"--radius", "diameter"})).out, "radius from column 'diameter', as stated"));
}

BOOST_FIXTURE_TEST_CASE(what_the_user_must_state_is_asked_for, scratch::InFolder) {
    const std::string file = folder.file("disks.txt", three_disks("", "1"));
    expect(run({"plateau", file}), 65, {"disks.txt:1", "--columns x,y,r"});
    expect(run({"plateau", file, "--columns", "x,y,r"}), 1);
    expect(run({"plateau", file, "--columns", "x,y,s"}), 65, {"disks.txt", "--radius COLUMN"});
    expect(run({"plateau", file, "--columns", "x,y,r", "--walls", "box"}), 65, {"--box"});
    for (const Arguments& wrong : std::vector<Arguments>{{"--thresholds", "1"},
                                                         {"--thresholds", "2:1"},
                                                         {"--thresholds", "a:b"},
                                                         {"--thresholds", "nan:1"},
                                                         {"--radius", "-1"},
                                                         {"--radius", "1", "--diameter", "2"},
                                                         {"--walls", "round"},
                                                         {"--box", "1:2"},
                                                         {"--frame", "-1"},
                                                         {"--frame", "1.5"},
                                                         {"--format", "pdf"},
                                                         {"--rows", "-1"}}) {
        expect(run(plus({"plateau", file, "--columns", "x,y,r"}, wrong)), 64);
    }
    expect(run({"plateau", scratch::data("vertex100.txt"), "--walls", "box"}), 64, {"vertex", "--walls"});
    expect(run({"plateau", folder.at("none.txt")}), 65, {"none.txt"});
    expect(run({"plateau", file, "--columns", "x,y,r", "--csv", folder.at("no/where.csv")}), 74);
    BOOST_TEST(!std::filesystem::exists(folder / "no"));
}

BOOST_FIXTURE_TEST_CASE(genericity_of_a_lattice_of_equal_disks, scratch::InFolder) {
    const std::string lattice = packings + "square_lattice_3.toml";
    says(run({"genericity", lattice, "--samples", "10", "--size", "1e-3,1e-12", "--csv", folder.at("g.csv")}), 0,
         {"h = 4, k = 0"});
    const std::string table = scratch::read(folder / "g.csv");
    BOOST_TEST(std::ranges::count(table, '\n') == 21);
    BOOST_TEST(contains(table, "proved"));
    // Equal radii that stay equal: a true tie, and never called isostatic.
    says(run({"genericity", lattice, "--samples", "3", "--size", "1e-3", "--keep-equal", "--json"}), 2,
         {"\"proved_isostatic\":0", "\"ties\":3"});
}

BOOST_AUTO_TEST_CASE(genericity_of_a_state_keeps_its_contacts) {
    says(run({"genericity", scratch::data("vertex100.txt"), "--samples", "3", "--size", "1e-9", "--json"}), 0,
         {"\"proved_isostatic\":3", "\"distinct_networks\":1", "\"within_original\":3"});
}

BOOST_FIXTURE_TEST_CASE(genericity_refuses_what_it_cannot_perturb, scratch::InFolder) {
    expect(run({"genericity", packings + "arch.toml"}), 65, {"movable"});
    expect(run({"genericity", packings + "two_disks.toml", "--size", "0.7"}), 65, {"size"});
    expect(run({"genericity", packings + "two_disks.toml", "--samples", "0"}), 64, {"--samples", "is 0"});
    expect(run({"genericity", folder.file("x.csv", "x,y,r\n1,1,1\n")}), 65,
           {"isostat import makes a state of a packing of another program"});
}
