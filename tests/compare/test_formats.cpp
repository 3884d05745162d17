// Frames in other formats than dumps: extended XYZ, tables; walls in the list of contacts; bad input in each.
#include "compare/path.hpp"
#include "compare/report.hpp"
#include "compare/series_copy.hpp"
#include "support/bad_input.hpp"
#include "support/crafted.hpp"

using namespace isostat;
using compare::Comparison;
using compare::FrameStatus;
using series::Copy;
using series::Lines;

namespace {

/// Time step, names of columns and rows of each frame of a dump.
struct DumpFrame {
    std::string timestep;
    Lines names;
    std::vector<Lines> rows;
};
std::vector<DumpFrame> frames_of(const Lines& dump) {
    std::vector<DumpFrame> out;
    for (std::size_t at = 0; at < dump.size(); at += 9 + out.back().rows.size()) {
        out.push_back({dump[at + 1], series::words_of(dump[at + 8]), {}});
        out.back().names.erase(out.back().names.begin(), out.back().names.begin() + 2);
        for (int k = 0; k < std::stoi(dump[at + 3]); ++k) {
            out.back().rows.push_back(series::words_of(dump[at + 9 + static_cast<std::size_t>(k)]));
        }
    }
    return out;
}

Lines table_of(const Lines& dump, char separator) {
    Lines out{"# made by a test"};
    for (const DumpFrame& frame : frames_of(dump)) {
        if (out.size() == 1) {
            out.push_back("timestep" + std::string(1, separator) + series::joined(frame.names, separator));
        }
        for (const Lines& row : frame.rows) {
            out.push_back(frame.timestep + std::string(1, separator) + series::joined(row, separator));
        }
    }
    return out;
}

Lines xyz_of(const Lines& dump) {
    Lines out;
    for (const DumpFrame& frame : frames_of(dump)) {
        std::string properties;
        for (const std::string& name : frame.names) {
            properties += name == "x"   ? ":pos:R:2"
                          : name == "y" ? ""
                                        : fmt::format(":{}:{}:1", name, name == "id" || name == "type" ? "I" : "R");
        }
        out.push_back(std::to_string(frame.rows.size()));
        out.push_back(fmt::format("Lattice=\"20 0 0 0 20 0 0 0 1\" pbc=\"F F F\" Timestep={} Properties={}",
                                  frame.timestep, properties.substr(1)));
        for (const Lines& row : frame.rows) {
            out.push_back(series::joined(row, ' '));
        }
    }
    return out;
}

Copy table_copy(char separator) {
    Copy copy(2);
    copy.disks = table_of(copy.disks, separator);
    copy.contacts = table_of(copy.contacts, separator);
    return copy;
}

Copy xyz_copy() {
    Copy copy(2);
    copy.disks = xyz_of(copy.disks);
    return copy;
}

/// The forces of walls in the list of contacts, by name or number, instead of columns of the disks.
Copy with_listed_walls(bool by_name) {
    Copy copy(2);
    std::vector<DumpFrame> frames = frames_of(copy.contacts);
    const std::vector<DumpFrame> disks = frames_of(copy.disks);
    const Lines walls = by_name ? Lines{"left", "right", "bottom", "top"} : Lines{"-1", "-3", "-2", "-4"};
    copy.contacts = {"timestep,i,j,force"};
    for (std::size_t k = 0; k < 2; ++k) {
        for (const Lines& row : disks[k].rows) {
            for (std::size_t w = 0; w < 4; ++w) {
                if (const double force = std::stod(row[5 + w]); force != 0) {
                    const Lines pair = w < 2 ? Lines{row[0], walls[w]} : Lines{walls[w], row[0]}; // either order
                    frames[k].rows.push_back({pair[0], pair[1], fmt::format("{}", std::abs(force))});
                }
            }
        }
        for (const Lines& row : frames[k].rows) {
            copy.contacts.push_back(frames[k].timestep + "," + series::joined(row, ','));
        }
    }
    const std::size_t at = copy.manifest.find("wall_force");
    copy.manifest.erase(at, copy.manifest.find('\n', at) + 1 - at);
    return copy;
}

void expect_error(Copy copy, const std::vector<std::string>& words) {
    expect_bad_input([&] { (void)copy.compare(); }, words);
}

Copy changed(Copy copy, const std::function<void(Copy&)>& change) {
    change(copy);
    return copy;
}

} // namespace

BOOST_AUTO_TEST_CASE(tables_and_xyz_are_the_same_frames_as_dumps) {
    const std::string dumps = compare::frames_csv(Copy(2).compare());
    BOOST_TEST(compare::frames_csv(table_copy(',').compare()) == dumps);
    BOOST_TEST(compare::frames_csv(table_copy(' ').compare()) == dumps);
    BOOST_TEST(compare::frames_csv(table_copy('\t').compare()) == dumps);
    BOOST_TEST(compare::frames_csv(xyz_copy().compare()) == dumps);
    const auto other_ends = [](Copy& c) {
        for (Lines* lines : {&c.disks, &c.contacts}) {
            for (std::string& line : *lines) {
                line += "\r";
            }
            lines->front() = "\xef\xbb\xbf" + lines->front();
        }
    };
    BOOST_TEST(compare::frames_csv(changed(table_copy(','), other_ends).compare()) == dumps);
    BOOST_TEST(compare::frames_csv(changed(xyz_copy(), other_ends).compare()) == dumps);
    // Frames of XYZ without time steps are counted from 0.
    const auto counted = [](Copy& c) {
        for (Lines* lines : {&c.disks, &c.contacts, &c.table}) {
            for (std::string& line : *lines) {
                line = line == "43000" ? "0" : line == "175000" ? "1" : line;
                for (const auto& [from, to] : {std::pair{" Timestep=43000", ""},
                                               {" Timestep=175000", ""},
                                               {"43000,0,", "0,0,"},
                                               {"175000,0,", "1,0,"}}) {
                    line = line.find(from) == std::string::npos ? line : scratch::replaced(line, from, to);
                }
            }
        }
    };
    BOOST_TEST(changed(xyz_copy(), counted).compare().status == 0);
}

BOOST_AUTO_TEST_CASE(walls_may_stand_in_the_list_of_contacts) {
    const Comparison columns = Copy(2).compare();
    for (const bool by_name : {true, false}) {
        const Comparison listed = with_listed_walls(by_name).compare();
        BOOST_TEST(listed.status == 0);
        for (std::size_t k = 0; k < 2; ++k) {
            BOOST_TEST(listed.frames[k].listed == columns.frames[k].listed);
            BOOST_TEST(listed.frames[k].rest == columns.frames[k].rest, boost::test_tools::tolerance(1e-3));
        }
    }
    // One of them missing is missing, as among disks.
    Copy copy = with_listed_walls(true);
    const auto last = std::find_if(copy.contacts.rbegin(), copy.contacts.rend(),
                                   [](const std::string& row) { return row.find("left") != std::string::npos; });
    copy.contacts.erase(std::next(last).base());
    const Comparison missing = copy.compare();
    BOOST_TEST((missing.frames[1].status == FrameStatus::file), missing.frames[1].reason);
    BOOST_TEST(missing.frames[1].reason.find("left wall overlap by") != std::string::npos, missing.frames[1].reason);
    BOOST_TEST(missing.frames[1].missing_rows == 1);
}

BOOST_AUTO_TEST_CASE(bad_tables_are_named_with_file_and_row) {
    const auto table = [](const std::function<void(Copy&)>& change) { return changed(table_copy(','), change); };
    expect_error(table([](Copy& c) { c.disks[1] = scratch::replaced(c.disks[1], ",radius,", ",size,"); }),
                 {"disks.dump:2", "no column 'radius'"});
    expect_error(table([](Copy& c) { c.disks.erase(c.disks.begin() + 1); }), {"disks.dump:2", "names of the columns"});
    expect_error(table([](Copy& c) { c.disks[140] = scratch::replaced(c.disks[140], ",1,", ",1;"); }),
                 {"disks.dump:141", "one value per column"});
    expect_error(table([](Copy& c) { c.disks[140].resize(20); }), {"disks.dump:141", "one value per column"});
    expect_error(table([](Copy& c) { c.disks[140] = scratch::replaced(c.disks[140], "175000,", "175000,nan"); }),
                 {"disks.dump:141", "id is 'nan"});
    expect_error(table([](Copy& c) { std::rotate(c.disks.begin() + 2, c.disks.begin() + 102, c.disks.end()); }),
                 {"disks.dump:103", "43000 after 175000", "in their order"});
    expect_error(table([](Copy& c) { c.disks[1] = scratch::replaced(c.disks[1], "timestep", "time"); }),
                 {"disks.dump", "no time step 43000"});
    expect_error(table([](Copy& c) { c.disks.resize(190); }), {"disks.dump:", "no disk 89"});
    expect_error(table([](Copy& c) { c.contacts[40] = scratch::replaced(c.contacts[40], "43000,", "43000,roof"); }),
                 {"contacts.dump:41", "i is 'roof", "left, bottom, right, top"});
    expect_error(table([](Copy& c) { c.disks[0] = "ITEM:"; }), {"disks.dump:1", "ITEM: TIMESTEP"});
    expect_error(table([](Copy& c) { c.restate("f_wl[2]", "f_w"); }), {"disks.dump:2", "no column 'f_w'"});
}

BOOST_AUTO_TEST_CASE(bad_xyz_is_named_with_file_and_row) {
    const auto xyz = [](const std::function<void(Copy&)>& change) { return changed(xyz_copy(), change); };
    expect_error(xyz([](Copy& c) { c.disks[102] = "99"; }), {"disks.dump:104", "no disk 100"});
    expect_error(xyz([](Copy& c) { c.disks[102] = "101"; }),
                 {"disks.dump:204", "the file ends here", "row 101 of 101"});
    expect_error(xyz([](Copy& c) { c.disks.resize(190); }), {"disks.dump:190", "the file ends here"});
    expect_error(xyz([](Copy& c) { c.disks[103] = scratch::replaced(c.disks[103], "pbc=\"F F F\"", ""); }),
                 {"disks.dump:104", "periodic along x", "F F F"});
    expect_error(xyz([](Copy& c) { c.disks[103] = scratch::replaced(c.disks[103], "=175000", "=later"); }),
                 {"disks.dump:104", "Timestep is 'later'"});
    expect_error(xyz([](Copy& c) { c.disks[103] = scratch::replaced(c.disks[103], "pos:R:2", "place:R:2"); }),
                 {"disks.dump:104", "no column 'x'"});
    expect_error(xyz([](Copy& c) { c.disks[103] = scratch::replaced(c.disks[103], "radius:R:1", "radius:R:2"); }),
                 {"disks.dump:105", "9 values", "10 values"});
    Copy dump(2);
    dump.disks.erase(dump.disks.begin());
    expect_error(dump, {"disks.dump:1", "ITEM: TIMESTEP"});
}

BOOST_AUTO_TEST_CASE(a_list_without_a_law_says_which_disks_are_out_of_balance) {
    Copy copy(2);
    copy.restate("kind = \"linear\"\nstiffness = 1e5", "kind = \"none\"");
    BOOST_TEST(copy.compare().status == 0);
    const Lines words = series::words_of(copy.contact(1, 30));
    Copy::change(copy.contact(1, 30), 2, 1.05);
    const Comparison result = copy.compare();
    BOOST_TEST((result.frames[1].status == FrameStatus::moving));
    for (const std::string& word : {words[0], words[1], std::string("missing, or its force wrong")}) {
        BOOST_TEST(result.frames[1].reason.find(word) != std::string::npos, result.frames[1].reason);
    }
}

BOOST_AUTO_TEST_CASE(a_frame_in_motion_is_on_the_arc_of_the_exact_run_whose_contacts_it_has) {
    compare::SeriesReader reader(Copy(9).write());
    compare::CompareOptions options;
    options.bundle = 0;
    options.nearest_arc = true;
    const Comparison result = compare::compare(reader, options);
    for (const compare::FrameResult& f : result.frames) {
        BOOST_TEST((f.status == FrameStatus::moving) == !f.nearest_arc.empty());
    }
    // Of a run from the vertex of the first frame, told arc by arc: the frame that has the contacts of one of them.
    const crafted::Played told = crafted::play(result.path.front().state, +1, 4);
    BOOST_TEST(told.outcome.completed, told.why());
    const std::vector<ArcRecord>& arcs = told.records.arcs;
    BOOST_TEST_REQUIRE(arcs.size() > 3);
    const State& start = told.records.states.front();
    std::vector<Contact> kept = compare::carrying(start);
    std::vector<compare::JudgedFrame> frames(3);
    for (std::size_t k = 0; k < 3; ++k) { // frame k is on arc 1, 2, 3: one contact each
        std::erase(kept, arcs[k].opened);
        frames[k].result.status = FrameStatus::moving;
        frames[k].pressed = kept;
        std::ranges::sort(frames[k].pressed);
        kept.push_back(arcs[k].closed);
    }
    const Contact first = frames[1].pressed.front();
    frames[1].pressed.erase(frames[1].pressed.begin());
    compare::NearestArcs nearest(frames);
    nearest.start(start);
    for (std::size_t k = 0; k < arcs.size(); ++k) {
        nearest.add(arcs[k], 7);
    }
    nearest.tell(frames, 2);
    BOOST_TEST(frames[0].result.nearest_arc ==
               fmt::format("arc {} on the way to equilibrium 7, the same contacts", arcs[0].arc));
    BOOST_TEST(frames[1].result.nearest_arc == fmt::format("arc {} on the way to equilibrium 7, without{}, with none",
                                                           arcs[1].arc, compare::names_of({first})));
    BOOST_TEST(frames[2].result.nearest_arc ==
               fmt::format("arc {} on the way to equilibrium 7, the same contacts", arcs[2].arc));
}
