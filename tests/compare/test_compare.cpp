// A series of LAMMPS against the exact run: what each frame is, where the series departs, and damaged files by name.
#include "compare/report.hpp"
#include "compare/series_copy.hpp"
#include "support/bad_input.hpp"

#include <isostat/io/state_file.hpp>

#include <tuple>

using namespace isostat;
using compare::Comparison;
using compare::FrameStatus;
using series::Copy;

namespace {

bool contains(const std::string& text, const std::string& what) {
    return text.find(what) != std::string::npos;
}

/// Frame 1 of two is damaged: it is `file`, with words; the other one stays the equilibrium.
void expect_file(const std::function<void(Copy&)>& damage, const std::vector<std::string>& words) {
    Copy copy(2);
    damage(copy);
    const Comparison result = copy.compare();
    BOOST_TEST(result.status == 1);
    BOOST_TEST((result.frames[0].status == FrameStatus::same), result.frames[0].reason);
    BOOST_TEST((result.frames[1].status == FrameStatus::file), to_string(result.frames[1].status));
    for (const std::string& word : words) {
        BOOST_TEST(contains(result.frames[1].reason, word), "'" << word << "' is not in: " << result.frames[1].reason);
    }
    BOOST_TEST_REQUIRE(result.departure.has_value());
    BOOST_TEST(result.departure->reason == "file");
}

/// What is done to two frames, and words of what is said.
struct Damage {
    const char* name;
    std::function<void(Copy&)> apply;
    std::vector<std::string> words;
};

} // namespace

/// Both stresses and all forces of frame k are 2^k times those of the series: rigid grains do not know the difference.
BOOST_AUTO_TEST_CASE(frames_whose_stresses_all_vary_are_placed_by_their_ratio) {
    Copy copy(9);
    for (std::size_t k = 0; k < copy.table.size(); ++k) {
        series::Lines row = series::words_of(copy.table[k], ',');
        const double factor = std::ldexp(1.0, static_cast<int>(k) - 1);
        for (std::size_t column = 5; k > 0 && column < row.size(); ++column) {
            row[column] = fmt::format("{}", std::stod(row[column]) * factor);
        }
        row.push_back(k == 0 ? "sigma1" : fmt::format("{}", factor));
        copy.table[k] = series::joined(row, ',');
    }
    const auto scale_forces = [&](series::Lines& dump, const std::vector<std::size_t>& columns) {
        for (std::size_t k = 0; k < 9; ++k) {
            for (std::size_t at = Copy::line(dump, k, 0); at < dump.size() && dump[at].find("ITEM") != 0; ++at) {
                for (const std::size_t column : columns) {
                    Copy::change(dump[at], column, std::ldexp(1.0, static_cast<int>(k)));
                }
            }
        }
    };
    const auto columns_of = [](const series::Lines& dump, const series::Lines& names) {
        const series::Lines header = series::words_of(dump[Copy::line(dump, 0, 0) - 1]);
        std::vector<std::size_t> out;
        for (const std::string& name : names) {
            out.push_back(static_cast<std::size_t>(std::ranges::find(header, name) - header.begin()) - 2);
        }
        return out;
    };
    scale_forces(copy.disks, columns_of(copy.disks, {"f_wl[2]", "f_wr[2]", "f_wb[3]", "f_wt[3]"}));
    scale_forces(copy.contacts, columns_of(copy.contacts, {"force"}));
    copy.restate("kind = \"linear\"\nstiffness = 1e5", "kind = \"none\"");
    const std::string varying = scratch::replaced(copy.manifest, "sigma1 = 1.0\n", "");
    Copy plain(9);
    plain.manifest = copy.manifest;
    copy.manifest = varying;
    const compare::CompareOptions options{.start = {}, .bundle = 4, .local = true};
    const Comparison expected = plain.compare(options), found = copy.compare(options);
    BOOST_TEST(found.status == expected.status);
    BOOST_TEST_REQUIRE(found.frames.size() == expected.frames.size());
    for (std::size_t k = 0; k < found.frames.size(); ++k) {
        const compare::FrameResult &f = found.frames[k], &e = expected.frames[k];
        BOOST_TEST((f.status == e.status), k << ": " << compare::to_string(f.status) << ": " << f.reason);
        BOOST_TEST((f.stress == e.stress && f.expected == e.expected && f.found == e.found && f.node == e.node));
        BOOST_TEST(f.local == e.local);
    }
    BOOST_TEST_REQUIRE(found.departure.has_value());
    BOOST_TEST(
        (found.departure->to == expected.departure->to && found.departure->reason == expected.departure->reason));
    copy.table[2].resize(copy.table[2].rfind(',') + 1);
    copy.table[2] += "-1";
    expect_bad_input([&] { (void)copy.compare(); }, {"frames.csv:3", "sigma1", "a positive number"});
    for (std::string& row : copy.table) {
        row.resize(row.rfind(','));
    }
    expect_bad_input([&] { (void)copy.compare(); }, {"no column 'sigma1'", "[load]"});
}

BOOST_AUTO_TEST_CASE(frames_of_a_loading_have_their_statuses_and_the_departure_its_reason) {
    const Comparison result = Copy(9).compare();
    const std::vector<std::string> expected{"same", "same", "same", "early", "same", "other", "soft", "moving", "soft"};
    BOOST_TEST_REQUIRE(result.frames.size() == expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
        BOOST_TEST(compare::to_string(result.frames[k].status) == expected[k],
                   "frame " << k << ": " << compare::to_string(result.frames[k].status) << ": "
                            << result.frames[k].reason);
    }
    for (const std::size_t k : {0U, 1U, 2U, 4U}) {
        const compare::FrameResult& f = result.frames[k];
        BOOST_TEST(f.missing.empty());
        BOOST_TEST(f.extra.empty());
        BOOST_TEST(f.expected == f.found);
        BOOST_TEST(f.distance > 1e-4);
        BOOST_TEST(f.distance < 1e-3);
        BOOST_TEST(f.law < 1e-8);
        BOOST_TEST(f.rest < 1e-7);
        BOOST_TEST(f.stiffness > 1e-3);
        BOOST_TEST(f.stiffness < 3e-2);
        BOOST_TEST(std::abs(f.true_strain[1] - f.strain[1]) < 1e-4);
    }
    BOOST_TEST(result.frames[3].found == result.frames[3].expected + 1);
    BOOST_TEST(result.frames[8].counting.hyperstaticity == 1);
    BOOST_TEST(result.frames[8].rest < 1e-7);
    BOOST_TEST(std::isnan(result.frames[8].stiffness)); // its list has no vertex
    BOOST_TEST(result.frames[8].downhill == 0.0852, boost::test_tools::tolerance(1e-2));
    BOOST_TEST(result.frames[8].self_stress < result.frames[8].downhill);
    BOOST_TEST(std::isnan(result.frames[5].downhill));
    BOOST_TEST(result.status == 1);
    BOOST_TEST_REQUIRE(result.departure.has_value());
    BOOST_TEST(result.departure->reason == "stiffness");
    BOOST_TEST(result.departure->from == 2);
    BOOST_TEST(result.departure->to == 3);
    // LAMMPS left this structure between 1.1490 and 1.1495.
    const compare::PathEquilibrium& left = result.path[3];
    BOOST_TEST(left.soft_limit > 1.1490);
    BOOST_TEST(left.soft_limit < 1.1495);
    BOOST_TEST(left.high > 1.1744);
    BOOST_TEST(left.stiffness_needed > 2e6);
    BOOST_TEST(left.stiffness_needed < 6e6);
    for (const compare::PathEquilibrium& e : result.path) {
        BOOST_TEST(e.proved);
    }
}

/// Frames of LAMMPS, 40 disks at kn / P = 1e4, that came to rest beside the start: both have one contact for another.
BOOST_AUTO_TEST_CASE(a_contact_that_nearly_closes_for_rigid_grains_is_a_tie_and_others_are_dynamics) {
    for (const auto& [name, reason, words] :
         {std::tuple("tied", "tie", "the gaps of 5-20 are 0.0018 at most"), std::tuple("moved_on", "dynamics", "")}) {
        const std::string folder = scratch::data("departures/" + std::string(name));
        compare::SeriesReader reader(folder + "/series.toml");
        compare::CompareOptions options{.start = read_any_state(folder + "/start.json").state, .bundle = 0};
        const Comparison result = compare::compare(reader, options);
        BOOST_TEST_REQUIRE(result.departure.has_value());
        BOOST_TEST(result.departure->opened.size() == 1U);
        BOOST_TEST(result.departure->closed.size() == 1U);
        BOOST_TEST(result.departure->reason == reason, result.departure->words);
        BOOST_TEST(contains(result.departure->words, words), result.departure->words);
    }
}

BOOST_AUTO_TEST_CASE(every_frame_is_compared_with_the_exact_run_from_the_frame_before_when_asked) {
    const Copy copy(5);
    const Comparison result = copy.compare({.start = {}, .bundle = 0, .local = true});
    const std::vector<std::string> expected{"", "same", "same", "other", "same"};
    for (std::size_t k = 0; k < expected.size(); ++k) {
        BOOST_TEST(result.frames[k].local == expected[k], "frame " << k << ": " << result.frames[k].local);
    }
    const Comparison without = copy.compare({.start = {}, .bundle = 0, .local = false});
    for (std::size_t k = 0; k < expected.size(); ++k) {
        BOOST_TEST(without.frames[k].local.empty());
        BOOST_TEST((without.frames[k].status == result.frames[k].status));
    }
}

BOOST_AUTO_TEST_CASE(
    exact_runs_with_other_rules_and_resting_places_have_their_first_equilibria_in_common_and_make_a_tree) {
    const Copy copy(9);
    compare::CompareOptions options;
    options.bundle = 6; // most_negative: start, up, left, right; least_index: down, up
    const Comparison result = copy.compare(options);
    const compare::Bundle& bundle = result.bundle;
    BOOST_TEST_REQUIRE(bundle.members.size() == 6U);
    BOOST_TEST(bundle.members[2].rest == "left");
    BOOST_TEST((bundle.members[5].rule == OpeningRule::least_index));
    // Rattlers carry nothing: before the first rearrangement that meets one, where they rest changes no equilibrium.
    BOOST_TEST(bundle.common >= 8);
    for (const compare::BundleMember& member : bundle.members) {
        BOOST_TEST(member.end == "");
        BOOST_TEST_REQUIRE(member.at_load.size() == result.frames.size());
        for (int k = 0; k < bundle.common; ++k) {
            BOOST_TEST(member.nodes[static_cast<std::size_t>(k)] ==
                       bundle.members[0].nodes[static_cast<std::size_t>(k)]);
        }
    }
    BOOST_TEST(bundle.nodes.size() > static_cast<std::size_t>(bundle.common)); // they part in the end
    for (const compare::BundleNode& node : bundle.nodes) {
        BOOST_TEST(node.equilibrium.proved);
        BOOST_TEST(!node.members.empty());
        BOOST_TEST((certify(node.equilibrium.state).verdict == Verdict::proved));
        for (const int frame : node.frames) {
            BOOST_TEST(result.frames[static_cast<std::size_t>(frame)].node == node.equilibrium.number);
        }
    }
    BOOST_TEST(result.frames[0].node == 0);
    BOOST_TEST(result.frames[3].node == bundle.members[0].nodes[4]); // early: the next one of the exact run
    // A bundle changes no status.
    options.bundle = 0;
    const Comparison alone = copy.compare(options);
    BOOST_TEST(alone.bundle.members.empty());
    for (std::size_t k = 0; k < result.frames.size(); ++k) {
        BOOST_TEST((alone.frames[k].status == result.frames[k].status));
        BOOST_TEST(alone.frames[k].node == -1);
    }
}

BOOST_AUTO_TEST_CASE(rattlers_rest_where_the_member_says) {
    const Copy copy(1);
    compare::CompareOptions options;
    options.bundle = 4;
    const Comparison result = copy.compare(options);
    const State& start = result.path.front().state;
    compare::Snap snap = compare::snap({start.packing, result.path.front().contacts, start.load});
    BOOST_TEST_REQUIRE((snap.outcome == compare::SnapOutcome::vertex), snap.reason);
    const auto heights = [&](double up) {
        std::vector<double> g(2 * start.packing.radius.size());
        const std::vector<double> generic = generic_infinitesimal(start.packing.radius, 1);
        for (std::size_t i = 0; i < g.size(); ++i) {
            g[i] = -up * generic[i];
        }
        const auto rested = required(compare::with_resting_rattlers(snap, g));
        double sum = 0;
        for (const int i : snap.rattlers) {
            sum += rested.packing.q[2 * static_cast<std::size_t>(i) + 1];
        }
        return sum;
    };
    BOOST_TEST(heights(1) > heights(-1));
}

BOOST_AUTO_TEST_CASE(frames_that_are_all_the_exact_equilibrium_give_0) {
    const Copy copy(3);
    const Comparison result = copy.compare();
    BOOST_TEST(result.status == 0);
    BOOST_TEST(!result.departure.has_value());
    const std::string text = compare::frames_csv(result);
    BOOST_TEST(std::ranges::count(text, '\n') == 4);
    // Another order of the rows of a dump is the same frame.
    Copy turned(3);
    std::swap(turned.disk(1, 3), turned.disk(1, 60));
    std::swap(turned.contact(1, 3), turned.contact(1, 60));
    BOOST_TEST(compare::frames_csv(turned.compare()) == text);
}

BOOST_AUTO_TEST_CASE(a_frame_whose_files_contradict_each_other_is_told_from_one_in_motion) {
    const std::string twice = fmt::format("contacts.dump:{}:", Copy::line(Copy(2).contacts, 1, 7) + 1);
    const std::vector<Damage> damages{
        {"a disk moved by a thousandth", [](Copy& c) { Copy::change(c.disk(1, 2), 3, 1, 1e-3); }, {"overlap"}},
        {"another one", [](Copy& c) { Copy::change(c.disk(1, 30), 3, 1, 1e-3); }, {"overlap"}},
        {"a third one", [](Copy& c) { Copy::change(c.disk(1, 66), 3, 1, 1e-3); }, {"overlap"}},
        {"two ids exchanged, the radii with them",
         [](Copy& c) {
             series::Lines third = series::words_of(c.disk(1, 2)), last = series::words_of(c.disk(1, 66));
             std::swap_ranges(third.begin(), third.begin() + 3, last.begin());
             c.disk(1, 2) = series::joined(third, ' ');
             c.disk(1, 66) = series::joined(last, ' ');
         },
         {"disks"}},
        {"a contact twice", [](Copy& c) { c.contact(1, 7) = c.contact(1, 5); }, {twice, "come twice"}},
        {"forces in other units",
         [](Copy& c) {
             for (std::size_t k = Copy::line(c.contacts, 1, 0); k < c.contacts.size(); ++k) {
                 Copy::change(c.contacts[k], 2, 1000);
             }
         },
         {"contacts.dump:", "stiffness x overlap", "ratio 1000"}},
        {"a wall moved",
         [](Copy& c) {
             series::Lines cells = series::words_of(c.table[2], ',');
             cells[3] = fmt::format("{}", std::stod(cells[3]) + 1e-4);
             c.table[2] = series::joined(cells, ',');
         },
         {"right wall", "frames.csv:3"}},
        {"a missing contact",
         [](Copy& c) {
             c.contacts.erase(c.contacts.begin() + static_cast<long>(Copy::line(c.contacts, 1, 3)));
             std::string& count = c.contacts[Copy::line(c.contacts, 1, 0) - 6];
             count = std::to_string(std::stoi(count) - 1);
         },
         {"overlap by", "no contact in the files", "disks 6 and 19"}},
        {"the load of another frame",
         [](Copy& c) {
             series::Lines words = series::words_of(c.table[2], ',');
             const series::Lines before = series::words_of(c.table[1], ',');
             std::copy(before.begin() + 5, before.end(), words.begin() + 5);
             c.table[2] = series::joined(words, ',');
         },
         {"frames.csv:3", "top wall", "load of another frame"}}};
    for (const Damage& damage : damages) {
        BOOST_TEST_INFO_SCOPE(damage.name);
        expect_file(damage.apply, damage.words);
    }
}

BOOST_AUTO_TEST_CASE(diameters_for_radii) {
    const auto doubled = [](Copy& c) {
        for (std::size_t frame : {0U, 1U}) {
            for (std::size_t row = 0; row < 100; ++row) {
                Copy::change(c.disk(frame, row), 2, 2);
            }
        }
    };
    Copy copy(2);
    doubled(copy);
    const Comparison result = copy.compare();
    BOOST_TEST((result.frames[0].status == FrameStatus::file));
    BOOST_TEST(contains(result.frames[0].reason, "diameters"), result.frames[0].reason);
    copy.restate("[columns]", "[columns]\ndiameter = \"radius\"");
    BOOST_TEST(copy.compare().status == 0);
}

void swap_frames(series::Lines& dump, std::size_t frame) {
    std::vector<long> starts;
    for (std::size_t at = 0; at < dump.size(); ++at) {
        if (dump[at] == "ITEM: TIMESTEP") {
            starts.push_back(static_cast<long>(at));
        }
    }
    starts.push_back(static_cast<long>(dump.size()));
    const auto begin = dump.begin();
    std::rotate(begin + starts[frame], begin + starts[frame + 1], begin + starts[frame + 2]);
}

BOOST_AUTO_TEST_CASE(bad_input_is_named_with_file_and_row) {
    const auto text = [](std::string& line, const std::string& from, const std::string& to) {
        line = scratch::replaced(line, from, to);
    };
    const std::vector<Damage> damages{
        {"an id for another",
         [](Copy& c) { c.disk(1, 2) = Copy::field(c.disk(1, 2), 0, "67"); },
         {"disks.dump:", "id is '67'"}},
        {"another radius",
         [](Copy& c) { c.disk(1, 4) = Copy::field(c.disk(1, 4), 2, "0.5"); },
         {"disks.dump:", "radius is '0.5'", "first frame"}},
        {"a row of the table twice",
         [](Copy& c) { c.table.push_back(c.table.back()); },
         {"frames.csv:4", "timestep is '175000'", "above"}},
        {"a frame twice",
         [](Copy& c) {
             const auto begin = c.disks.begin();
             const series::Lines first(begin, begin + static_cast<long>(Copy::line(c.disks, 1, 0)) - 9);
             c.disks.insert(begin, first.begin(), first.end());
         },
         {"disks.dump:118", "after", "each once"}},
        {"frames in another order",
         [](Copy& c) { swap_frames(c.contacts, 0); },
         {"contacts.dump:", "after 175000", "in their order"}},
        {"a disk that is not there",
         [](Copy& c) {
             c.disks.erase(c.disks.begin() + static_cast<long>(Copy::line(c.disks, 1, 5)));
             c.disks[Copy::line(c.disks, 1, 0) - 6] = "99";
         },
         {"disks.dump:", "id is '7'", "6 next"}},
        {"a periodic box",
         [&](Copy& c) { text(c.disks[Copy::line(c.disks, 1, 0) - 5], "ff ff", "ff pp"); },
         {"disks.dump:", "periodic along y"}},
        {"a name misspelt",
         [&](Copy& c) { text(c.table[0], "right", "rihgt"); },
         {"frames.csv:1", "no column 'right'", "bounds of a dump are not taken"}},
        {"no id of a disk",
         [](Copy& c) { c.contact(1, 3) = Copy::field(c.contact(1, 3), 1, "101"); },
         {"contacts.dump:", "j is '101'", "id of a disk"}},
        {"no number",
         [](Copy& c) { c.contact(1, 3) = Copy::field(c.contact(1, 3), 2, "1.0x"); },
         {"contacts.dump:", "force is '1.0x'"}},
        {"no such time step",
         [&](Copy& c) { text(c.table[2], "175000", "175001"); },
         {"disks.dump", "no time step 175001"}},
        {"no such column",
         [&](Copy& c) { text(c.table[2], ",1.03", ",1.04"); },
         {"frames.csv:3", "force_top", "column 7"}},
        {"a key misspelt",
         [](Copy& c) { c.restate("stiffness = 1e5", "stifness = 1e5"); },
         {"series.toml", "stiffness"}},
        {"an unknown key", [](Copy& c) { c.restate("[law]", "colour = 1\n[law]"); }, {"unknown key 'colour'"}},
        {"another version", [](Copy& c) { c.restate("isostat-series 1", "isostat-series 2"); }, {"isostat-series 1"}},
        {"spheres, where the manifest speaks of disks",
         [&](Copy& c) {
             c.restate("select = \"type 1\"", "");
             text(c.disks[8], "type", "z");
             c.disks[11] = Copy::field(c.disks[11], 1, "1.5");
         },
         {"disks.dump:12", "z is '1.5'", "three lengths in reference_length"}}};
    for (const Damage& damage : damages) {
        BOOST_TEST_INFO_SCOPE(damage.name);
        Copy copy(2);
        damage.apply(copy);
        expect_bad_input([&] { (void)copy.compare(); }, damage.words);
    }
}

BOOST_FIXTURE_TEST_CASE(the_files_of_a_comparison_are_complete, scratch::InFolder) {
    const Copy copy(3);
    compare::SeriesReader reader(copy.write());
    const Comparison result = compare::compare(reader);
    (void)compare::write_comparison(folder / "out", reader.series(), result);
    for (const char* name : {"comparison.csv", "path.csv", "comparison.json", "comparison.dat", "comparison.gp"}) {
        BOOST_TEST(!scratch::read((folder / "out") / name).empty(), name);
        BOOST_TEST(!std::filesystem::exists(folder / "out" / (std::string(name) + ".part")));
    }
    BOOST_TEST(contains(scratch::read(folder / "out" / "comparison.json"), "\"same\": 3"));
}

BOOST_FIXTURE_TEST_CASE(the_figure_has_no_curve_without_a_point, scratch::InFolder) {
    Copy copy(2);
    copy.restate("stiffness = 1e5", "stiffness = 2e5");
    compare::SeriesReader reader(copy.write());
    const Comparison result = compare::compare(reader);
    BOOST_TEST((result.frames[0].status == FrameStatus::file));
    (void)compare::write_comparison(folder / "out", reader.series(), result);
    const std::string script = scratch::read(folder / "out" / "comparison.gp");
    BOOST_TEST(contains(script, "title \"law\""));
    BOOST_TEST(!contains(script, "title \"rest\""));
}

BOOST_AUTO_TEST_CASE(a_wall_that_drifts_while_the_disks_balance_is_in_motion) {
    compare::SeriesReader reader(scratch::data("slow_wall/series.toml"));
    const Comparison result = compare::compare(reader, {});
    BOOST_TEST_REQUIRE(result.frames.size() == 1U);
    BOOST_TEST((result.frames[0].status == compare::FrameStatus::moving), result.frames[0].reason);
    BOOST_TEST(result.frames[0].unbalanced > 1e-2);
    BOOST_TEST(result.status == 2); // nothing was compared
}

BOOST_FIXTURE_TEST_CASE(hertzian_contacts_have_their_own_law, scratch::InFolder) {
    // Frames of gran/hertz/history, with contacts of disks and walls.
    for (const char* name : {"disks.dump", "contacts.dump", "frames.csv"}) {
        std::filesystem::copy(scratch::data("hertz/" + std::string(name)), folder / name);
    }
    const std::string manifest = scratch::read(scratch::data("hertz/series.toml"));
    const auto compared = [&](const std::string& text) {
        scratch::write(folder / "series.toml", text);
        compare::SeriesReader reader(folder / "series.toml");
        return compare::compare(reader, {});
    };
    const Comparison right = compared(manifest);
    BOOST_TEST(right.status == 0);
    for (const compare::FrameResult& f : right.frames) {
        BOOST_TEST(f.law < 1e-8);
        BOOST_TEST(f.rest < 1e-6);
    }
    BOOST_TEST(std::isnan(right.path.front().soft_limit)); // predicted for linear contacts only
    for (const auto& [what, with] : {std::pair{"\"hertz\"", "\"linear\""}, std::pair{"1000000.0", "1010000.0"}}) {
        for (const compare::FrameResult& f : compared(scratch::replaced(manifest, what, with)).frames) {
            BOOST_TEST((f.status == compare::FrameStatus::file), f.reason);
        }
    }
}
