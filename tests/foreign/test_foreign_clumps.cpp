// Rigid bodies in packings of other programs: which rows are members, which bars are made, and what is refused.

#include "support/bad_input.hpp"

#include <isostat/foreign/foreign.hpp>
#include <isostat/rigidity/counting.hpp>

namespace foreign_clumps { // names of its own, beside test_foreign.cpp

namespace {

using namespace isostat;

ForeignPacking read(const std::string& text, const std::string& bodies = "") {
    ForeignOptions options{.bodies = bodies, .cells = true};
    return parse_foreign(text, "FILE", options);
}

bool says(const ForeignPacking& packing, const std::string& words) {
    return std::any_of(packing.notes.begin(), packing.notes.end(),
                       [&](const std::string& note) { return note.find(words) != std::string::npos; });
}

/// Four disks, the molecules of which are as stated.
std::string dump(const std::string& column, const std::array<int, 4>& molecules) {
    return fmt::format("ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4\nITEM: BOX BOUNDS pp ff pp\n0 16\n0 9\n-0.5 0.5\n"
                       "ITEM: ATOMS id {} x y radius\n1 {} 15 1 1\n2 {} 5 5 1\n3 {} 2 5 0.5\n4 {} 8.5 5 0.5\n",
                       column, molecules[0], molecules[1], molecules[2], molecules[3]);
}

const std::vector<Bar> none;

/// Rows of a table, in the plane or in space.
std::string table(const std::string& names, const std::vector<std::string>& rows) {
    std::string text = names + "\n";
    for (const std::string& row : rows) {
        text += row + "\n";
    }
    return text;
}

/// As many bars as make the body rigid, and no self-stress of them.
void expect_rigid(const ForeignPacking& file, std::size_t bars) {
    BOOST_TEST(file.packing.bars.size() == bars);
    validate(file.packing, "FILE");
    std::vector<Contact> list;
    for (const Bar& bar : file.packing.bars) {
        list.emplace_back(ContactKind::bar, bar.i, bar.j);
    }
    BOOST_TEST(count_contacts(file.packing, list).hyperstaticity == 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(rows_with_the_same_body_are_kept_at_their_distance) {
    const std::string text = "x,y,r,body\n0,0,1,4\n3,4,1,4\n9,9,1,5\n20,0,1,0\n30,0,1,0\n40,0,1,-1\n50,0,1,-1\n";
    const ForeignPacking file = read(text);
    BOOST_TEST((file.packing.bars == std::vector<Bar>{{0, 1, 5}}));
    BOOST_TEST(says(file, "bodies from column 'body'"));
    BOOST_TEST(says(file, "1 rigid bodies of several disks"));
    BOOST_TEST((read(text, "none").packing.bars == none));
    BOOST_TEST((read("#format x_y_z_r_clumpId\n0 0 0 1 7\n2 3 6 1 7\n5 5 9 1 -1\n").packing.bars ==
                std::vector<Bar>{{0, 1, 7}})); // YADE
}

BOOST_AUTO_TEST_CASE(molecules_are_bodies_where_that_is_stated) {
    const std::string text = dump("mol", {3, 8, 8, 3});
    BOOST_TEST((read(text).packing.bars == none));
    BOOST_TEST(
        says(read(text), "column 'mol' is not used, though several rows have the same number there: --bodies mol"));
    BOOST_TEST(!says(read(dump("mol", {1, 1, 1, 1})), "is not used"));
    BOOST_TEST(!says(read(dump("mol", {0, 0, 1, 2})), "is not used"));
    BOOST_TEST((read(dump("mol", {0, 8, 8, 0}), "mol").packing.bars == std::vector<Bar>{{1, 2, 3}}));
}

BOOST_AUTO_TEST_CASE(bars_make_bodies_of_any_number_of_members_rigid) {
    const std::vector<std::string> plane{"0,0,1,1", "4,0,1,1", "2,0,1,1", "0,3,1,1", "0,0,0.5,1", "1,1,1,1"};
    expect_rigid(read(table("x,y,r,body", plane)), 9);
    const std::vector<std::string> space{"0,0,0,1,1", "4,0,0,1,1", "2,0,0,1,1", "0,3,0,1,1",
                                         "0,0,5,1,1", "0,0,5,2,1", "1,1,0,1,1"};
    expect_rigid(read(table("x,y,z,r,body", space)), 15);
    expect_rigid(read(table("x,y,z,r,body", {space.begin() + 2, space.begin() + 5})), 3);
}

BOOST_AUTO_TEST_CASE(members_that_no_bars_keep_together_are_refused) {
    const auto refused = [](const std::string& names, const std::vector<std::string>& rows,
                            const std::vector<std::string>& words) {
        expect_bad_input([&] { read(table(names, rows)); }, words);
    };
    refused("x,y,r,body", {"9,9,1,2", "1,2,1,1", "1,2,2,1"}, {"FILE", "2 members of the body of disk 1", "one place"});
    refused("x,y,r,body", {"0,0,1,1", "1,0.3,1,1", "3,0.9,1,1"}, {"3 members of the body of disk 0", "on one line"});
    refused("x,y,r,body", {"0,0,1,1", "1.00001,1.00001,1,1", "3.00001,3.00002,1,1"}, {"on one line", "e-05"});
    refused("x,y,z,r,body", {"0,0,0,1,1", "1,0,0,1,1", "0,1,0,1,1", "1,1,0,1,1", "5,5,5,1,0"}, {"in one plane"});
    refused("x,y,r,body", {"0,0,1,1.5", "3,0,1,1.5"}, {"FILE:2", "body of disk 0", "1.5"});
    refused("x,y,r,body", {"0,0,1,-2", "3,0,1,-2"}, {"FILE:2", "-2"});
    expect_bad_input([] { read("x,y,r\n0,0,1\n", "mol"); }, {"no column 'mol' for the bodies", "x y r"});
}

BOOST_AUTO_TEST_CASE(members_are_put_together_across_the_boundary_of_a_cell) {
    const ForeignPacking file = read(dump("mol", {3, 8, 8, 0}), "mol");
    BOOST_TEST((file.packing.bars == std::vector<Bar>{{1, 2, 3}}));
    const std::string apart = dump("mol", {3, 8, 3, 0}); // x = 15 and 2 of a period of 16
    const ForeignPacking joined = read(apart, "mol");
    BOOST_TEST(joined.packing.coordinate(DiskId(2), 0) == 18);
    BOOST_TEST((joined.packing.bars == std::vector<Bar>{{0, 2, 5}}));
    expect_bad_input([&] { read(dump("mol", {3, 8, 0, 3}), "mol"); }, {"disk 3", "0.406 periods"});
}

} // namespace foreign_clumps
