// isostat inspect, plateau, certify, run, verify, import, export and snap of periodic cells.

#include "cli/program.hpp"
#include "support/cells.hpp"

#include <isostat/io/state_file.hpp>

namespace {

using namespace program;

const std::string rectangle = scratch::data("cells/rect_16.json");

/// The disks of a state as LAMMPS would dump soft grains: every length but the radii shorter by this part.
std::string soft_dump(const std::string& state, double part, const std::string& along_y = "pp") {
    const isostat::Packing p = isostat::read_any_state(state).state.packing;
    const double tilt = (1 - part) * p.lattice(0, 1);
    const bool tilted = p.cell.tilt_moves[0];
    std::string text = fmt::format(
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n{}\nITEM: BOX BOUNDS {}pp {} pp\n0 {}{}\n0 {}{}\n-1 1{}\n"
        "ITEM: ATOMS id x y radius\n",
        p.disk_count(), tilted ? "xy xz yz " : "", along_y, (1 - part) * p.length(0) + tilt,
        tilted ? fmt::format(" {}", tilt) : "", (1 - part) * p.length(1), tilted ? " 0" : "", tilted ? " 0" : "");
    for (std::size_t i = 0; i < p.radius.size(); ++i) {
        text += fmt::format("{} {} {} {}\n", i + 1, (1 - part) * p.q[2 * i], (1 - part) * p.q[2 * i + 1], p.radius[i]);
    }
    return text;
}

/// The disks of the rectangle.
std::string dump() {
    return soft_dump(rectangle, 0);
}

} // namespace

BOOST_AUTO_TEST_CASE(inspect_counts_and_proves_a_rectangle) {
    says(run({"inspect", rectangle}), 0,
         {"9.596462314332681 (periodic) x 10.938004019205389 (periodic), tilt 0; x, y move, disk 0 "
          "is pinned",
          "degrees of freedom N_f   32", "isostatic equilibrium    proved", "backbone, 15 disks",
          "jammed collectively      proved", "jammed strictly          refuted",
          "29 for a bulk modulus, 31 for all moduli"});
    const auto json = json_of(run({"inspect", rectangle, "--json"}));
    BOOST_TEST(json.at("cell").at("backbone").at("fixed cell").at("h") == 2);
    BOOST_TEST(json.at("cell").at("backbone").at("full strain").at("k") == 1);
    BOOST_TEST(json.at("cell").at("jammed").at("strict").at("verdict") == "refuted");
    BOOST_TEST(std::abs(json.at("interval_high")[0].get<double>() - 1.3794962837050024) < 1e-9);
}

BOOST_FIXTURE_TEST_CASE(a_step_that_is_no_number_is_none_and_its_message_has_a_reason, scratch::InFolder) {
    // Rows of equal disks, unloaded along y: a pass of the path follower divides by 0. Disk 0 was "nan periods from the
    // origin".
    const std::string scene = folder.at("rows.toml");
    scratch::write_scene(
        scene, "[packing]\nfile = \"" + scratch::data("cells/rows_unloaded.json") +
                   "\"\n[run]\nties = \"choose\"\nmax_choices = 0\nties_seed = 1\n[[programme]]\ndo = \"down\"\n"
                   "equilibria = 6\n");
    const Outcome run_down = done(run({"run", scene, "-o", folder.at("out")}), 2);
    BOOST_TEST(!contains(run_down.out + run_down.err, "nan"), run_down.err);
    BOOST_TEST(contains(run_down.err, "at sigma = 0"), run_down.err);
}

BOOST_FIXTURE_TEST_CASE(plateau_of_a_periodic_dump, scratch::InFolder) {
    const std::string file = folder.file("disks.dump", dump());
    says(run({"plateau", file, "--cell", "diagonal"}), 0, {"periodic along x and y", "from N = 30 with 1 rattlers"});
    const auto json = json_of(run({"plateau", file, "--cell", "diagonal", "--json"}));
    BOOST_TEST(json.at("cell").at("backbone").at("isotropic").at("h") == 1);
    has(json, {{"strain", "diagonal"}});
    expect(run({"plateau", file, "--cell", "diagonal", "--not-periodic"}), 1);
    BOOST_TEST(run({"plateau", file, "--periodic", "--not-periodic"}).status == 64);
}

BOOST_FIXTURE_TEST_CASE(certificates_of_a_cell_verify_and_forged_ones_do_not, scratch::InFolder) {
    const std::string made = folder.at("made.json");
    expect(run({"certify", rectangle, "-o", made}), 0);
    expect(run({"verify", made, "--input", rectangle}), 0);
    // Another pin: the claims hold, but of another state than that of the file.
    isostat::Certificate certificate = isostat::read_certificate(made);
    certificate.state.packing.cell.pin = 3;
    isostat::write_certificate(made, certificate);
    says(run({"verify", made, "--input", rectangle}), 1, {"the cell of the state in the certificate is not that of"});
    certificate.state.packing.cell.pin = 0;
    certificate.state.contacts[0].image.m[0] = 1;
    isostat::write_certificate(made, certificate);
    BOOST_TEST(run({"verify", made}).status != 0);
}

BOOST_FIXTURE_TEST_CASE(a_run_of_a_cell_is_written_resumed_and_replayed, scratch::InFolder) {
    const std::string out = ran(folder, "[packing]\nfile = \"" + scratch::data("cells/tilt_16.json") +
                                            "\"\n[[programme]]\ndo = \"up\"\nequilibria = 2\n");
    says(run({"verify", out}), 0, {"ends proved, way looked at"});
    BOOST_TEST(contains(scratch::read(folder / "run/events.jsonl"), "\"opened\":\"3-8(1,0)\""));
    const auto state = isostat::read_any_state(out + "/states/last.json").state;
    BOOST_TEST(std::abs(state.packing.lattice(0, 1) - -0.9095404261907584) < 1e-9);
}

BOOST_FIXTURE_TEST_CASE(states_and_arcs_of_a_run_in_a_cell_are_certified, scratch::InFolder,
                        *boost::unit_test::label("slow")) {
    const std::string scene = folder.at("cell.toml");
    const auto verified = [&](const std::string& level) {
        scratch::write_scene(scene,
                             fmt::format("[packing]\nfile = \"{}\"\n[run]\ncertify = \"{}\"\n[[programme]]\ndo = "
                                         "\"up\"\nequilibria = 4\n",
                                         scratch::data("cells/rect_16.json"), level));
        expect(run({"run", scene, "-o", (folder / level).string()}), 0);
        return run({"verify", (folder / level).string()});
    };
    says(verified("states"), 0, {"ends proved, way looked at"});
    const auto certificate = folder / "states" / "certificates" / "eq_000003.json";
    expect(run({"verify", certificate.string()}), 0);
    std::filesystem::remove(certificate);
    BOOST_TEST(run({"verify", folder.at("states")}).status != 0);
    says(verified("arcs"), 0, {"verdict        proved"});
    scratch::write(folder / "arcs" / "certificates" / "arcs.jsonl", "");
    BOOST_TEST(run({"verify", folder.at("arcs")}).status != 0);
}

BOOST_FIXTURE_TEST_CASE(a_run_that_changes_the_shear_is_written_resumed_and_replayed, scratch::InFolder) {
    const std::string scene = folder.at("cell.toml");
    const auto play = [&](const std::string& load, const std::string& start) {
        scratch::write_scene(scene,
                             fmt::format("[packing]\nfile = \"{}\"\n[load]\n{}\n[run]\ncertify = "
                                         "\"arcs\"\n[[programme]]\ndo = \"up\"\nequilibria = 3\n[[programme]]\ndo = "
                                         "\"to\"\nto = -0.01\n",
                                         start, load));
        return run({"run", scene, "-o", folder.at("out"), "--force"});
    };
    const std::string tilted = scratch::data("cells/tilt_16.json");
    BOOST_TEST(play("", tilted).status == 65); // of sigma2 no ratio is negative
    BOOST_TEST(contains(play("loaded = \"tilt\"", rectangle).err, "no tilt moves"));
    says(play("loaded = \"tilt\"", tilted), 0, {"shear/sigma2"});
    says(run({"verify", folder.at("out")}), 0, {"verdict        proved"});
    const auto last = folder / "out" / "states" / "last.json";
    const auto state = isostat::read_any_state(last).state;
    BOOST_TEST(state.load.loaded_axis == 2);
    BOOST_TEST(state.load.shear[0] == -0.01 * state.load.stress[1]);
    BOOST_TEST(contains(scratch::read(folder / "out" / "figures" / "staircase.gp"), "shear strain"));
    expect(run({"certify", last.string(), "-o", folder.at("last.cert.json")}), 0);
    expect(run({"verify", folder.at("last.cert.json")}), 0);
}

BOOST_FIXTURE_TEST_CASE(a_prepared_cell_begins_at_no_shear_strain_and_the_words_are_those_of_a_shear,
                        scratch::InFolder) {
    const std::string scene =
        folder.file("cell.toml", "[packing]\ndisks = 60\n[cell]\nkind = \"tilted\"\n[load]\nloaded = \"tilt\"\n"
                                 "[[programme]]\ndo = \"up\"\nequilibria = 4\n[[programme]]\ndo = \"to\"\nto = 0\n");
    const auto out = folder / "out";
    expect(run({"run", scene, "-o", out.string()}), 0);
    const auto start = isostat::read_any_state(out / "states" / "eq_000000.json").state;
    BOOST_TEST(start.packing.lattice(0, 1) != 0);
    BOOST_TEST(start.load.reference_tilt[0] == start.packing.lattice(0, 1));
    const auto first = scratch::row_of(out / "equilibria.csv", 0), later = scratch::row_of(out / "equilibria.csv", 4);
    BOOST_TEST(std::abs(std::stod(first.at("eps2"))) < 1e-12);
    BOOST_TEST(std::stod(later.at("eps2")) > 0); // the shear does work
    const double height = start.load.reference_length[1];
    BOOST_TEST(std::abs(std::stod(first.at("L2")) - std::stod(later.at("L2")) - height * std::stod(later.at("eps2"))) <
               1e-9);
    BOOST_TEST(std::abs(std::stod(first.at("L3")) - start.packing.length(0)) < 1e-9);
    expect(run({"verify", out.string()}), 0);

    const std::string report = scratch::read(out / "figures" / "report.txt");
    for (const char* words : {"shear/sigma2, shear strain", "shear up", "jumps of strain"}) {
        BOOST_TEST(contains(report, words), report);
    }
    expect(run({"report", out.string(), "--html", "-q"}), 0);
    const std::string page = scratch::read(out / "figures" / "trajectory.html");
    BOOST_TEST(contains(page, "\"ratio\":\"τ/σ₂\""));
    BOOST_TEST(!contains(page, "σ₂/σ₁"));
    const std::string chart = scratch::read(out / "figures" / "staircase.gp");
    for (const char* words : {"eps2", "sigma2/sigma1", "loading", "σ_2/σ_1"}) { // of the biaxial test
        BOOST_TEST(!contains(report, words), report);
        BOOST_TEST(!contains(chart, words), chart);
    }
}

BOOST_FIXTURE_TEST_CASE(a_rectangle_is_prepared_and_followed_under_true_stresses, scratch::InFolder) {
    const std::string scene = folder.at("cell.toml");
    std::map<std::string, std::map<std::string, std::string>> last;
    for (const std::string kind : {"true", "nominal"}) {
        scratch::write(scene, fmt::format("[packing]\ndisks = 40\n[cell]\n[load]\nkind = \"{}\"\n[[programme]]\ndo = "
                                          "\"up\"\nequilibria = 3\n",
                                          kind));
        expect(run({"run", scene, "-o", (folder / kind).string()}), 0);
        expect(run({"verify", (folder / kind).string()}), 0);
        last[kind] = scratch::row_of(folder / kind / "equilibria.csv", 3);
    }
    const auto of = [&](const char* kind, const char* name) { return std::stod(last[kind].at(name)); };
    // The same way: sigma2 L1 / (sigma1 L2) is the ratio of the forces, of the lengths of the moment or of the start.
    const double strains = (1 - of("true", "eps1")) / (1 - of("true", "eps2"));
    BOOST_TEST(of("true", "eps2") == of("nominal", "eps2"), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(of("true", "sigma2_high") * strains == of("nominal", "sigma2_high"), boost::test_tools::tolerance(1e-9));
    BOOST_TEST(of("true", "sigma2_high") != of("nominal", "sigma2_high"));
}

BOOST_FIXTURE_TEST_CASE(a_dead_shear_that_flows_ends_as_flows, scratch::InFolder) {
    isostat::State state = cells::one_tilted_disk(1, 1, 0.5);
    state.load.reference_length = {2, std::sqrt(3.0)};
    isostat::write_state(folder / "disk.json", state);
    const std::string scene =
        folder.file("flow.toml", "[packing]\nfile = \"disk.json\"\n[[programme]]\ndo = \"down\"\nequilibria = 3\n");
    BOOST_TEST(run({"run", scene, "-o", folder.at("out")}).status != 0);
    BOOST_TEST(contains(scratch::read(folder / "out" / "run.json"), "flows: a shear of 1.1547"));
}

BOOST_FIXTURE_TEST_CASE(periodic_packings_of_other_programs_become_states, scratch::InFolder) {
    const std::string file = folder.at("disks.dump"), made = folder.at("made.json");
    for (const char* name : {"rect_16", "tilt_16"}) {
        for (const double part : {1e-12, 1e-6, 1e-4}) {
            BOOST_TEST_INFO_SCOPE(name << ", overlap " << part);
            const std::string from = scratch::data(std::string("cells/") + name + ".json");
            const isostat::State state = isostat::read_any_state(from).state;
            scratch::write(file, soft_dump(from, part));
            const auto json = json_of(run({"import", file, "-o", made, "--json"}));
            BOOST_TEST(json.at("verdict") == "proved");
            const isostat::Packing found = isostat::read_any_state(made).state.packing;
            BOOST_TEST((found.cell.tilt_moves == state.packing.cell.tilt_moves));
            for (std::size_t k = 32; k < 35; ++k) {
                BOOST_TEST(std::abs(found.q[k] - state.packing.q[k]) < 1e-11);
            }
            expect(run({"certify", made, "-o", folder.at("c.json")}), 0);
            expect(run({"verify", folder.at("c.json"), "--input", made}), 0);
        }
    }
    expect(run({"import", file, "-o", made, "--cell", "rectangular"}), 0); // its tilt stays
    BOOST_TEST(isostat::read_any_state(made).state.contacts.size() == 32);
    const std::string moved = folder.at("moved.json");
    expect(run({"import", made, "-o", moved, "--jitter", "1e-6"}), 0); // a state has its own cell
    BOOST_TEST(!isostat::read_any_state(moved).state.packing.cell.tilt_moves[0]);
}

BOOST_FIXTURE_TEST_CASE(a_cell_that_keeps_its_shape_is_prepared_read_and_not_followed, scratch::InFolder) {
    const auto in = [&](const char* name) { return (folder / name).string(); };
    scratch::write(in("s.toml"), "[packing]\ndisks = 40\ndiameters = [1.0, 2.0]\n[cell]\nkind = \"isotropic\"\n");
    expect(run({"prepare", in("s.toml"), "-o", in("made.json"), "-q"}), 0);
    says(run({"inspect", in("made.json")}), 0, {"it keeps its shape", "N_f   79", "jammed collectively      proved"});
    expect(run({"certify", in("made.json"), "-o", in("c.json")}), 0);
    expect(run({"verify", in("c.json"), "--input", in("made.json")}), 0);
    const isostat::Packing made = isostat::read_any_state(in("made.json")).state.packing;
    // Soft grains of it, and the list of the widest range of thresholds: the same shape, and the same size.
    for (const double part : {1e-9, 1e-5}) {
        scratch::write(in("soft.dump"), soft_dump(in("made.json"), part));
        expect(run({"import", in("soft.dump"), "-o", in("back.json"), "--cell", "isotropic", "--contacts", "plateau"}),
               0);
        const isostat::State back = isostat::read_any_state(in("back.json")).state;
        BOOST_TEST(back.packing.cell.keeps_shape);
        BOOST_TEST(back.contacts.size() == 79);
        BOOST_TEST(std::abs(back.packing.length(0) - made.length(0)) < 1e-11);
        BOOST_TEST(std::abs(back.packing.length(1) - made.length(1)) < 1e-11);
    }
    scratch::write(in("run.toml"), "[packing]\nfile = \"made.json\"\n[[programme]]\ndo = \"up\"\nequilibria = 1\n");
    expect(run({"run", in("run.toml"), "-o", in("out")}), 65, {"keeps its shape", "no contact ever opens"});
}

BOOST_FIXTURE_TEST_CASE(lists_and_channels_of_other_programs_become_states, scratch::InFolder) {
    const auto in = [&](const char* name) { return (folder / name).string(); };
    for (const char* name : {"rect_16", "tilt_16"}) {
        const isostat::State state =
            isostat::read_any_state(scratch::data(std::string("cells/") + name + ".json")).state;
        scratch::write(in("soft.dump"), soft_dump(scratch::data(std::string("cells/") + name + ".json"), 1e-7));
        expect(run({"import", in("soft.dump"), "-o", in("made.json"), "--contacts", "plateau"}), 0);
        const isostat::Packing made = isostat::read_any_state(in("made.json")).state.packing;
        BOOST_TEST((made.cell.tilt_moves == state.packing.cell.tilt_moves));
        expect(run({"import", in("soft.dump"), "-o", in("made.json"), "--threshold", "1e-9"}), 0);
    }
    // Periodic along x, walls at the bounds along y.
    const isostat::State channel = isostat::read_any_state(scratch::data("cells/channel_16.json")).state;
    const isostat::Packing& p = channel.packing;
    BOOST_TEST_REQUIRE(p.cell.periodic[0]);
    scratch::write(in("channel.dump"), soft_dump(scratch::data("cells/channel_16.json"), 1e-7, "ff"));
    for (const char* contacts : {"nearest", "plateau"}) {
        says(run({"import", in("channel.dump"), "-o", in("made.json"), "--contacts", contacts}), 0, {"walls along y"});
        const isostat::Packing found = isostat::read_any_state(in("made.json")).state.packing;
        BOOST_TEST((found.cell.periodic == p.cell.periodic));
        BOOST_TEST((found.walls == p.walls));
        BOOST_TEST(std::abs(found.length(0) - p.length(0)) < 1e-11);
        BOOST_TEST(std::abs(found.length(1) - p.length(1)) < 1e-11);
        expect(run({"certify", in("made.json"), "-o", in("c.json")}), 0);
    }
    expect(run({"import", in("channel.dump"), "-o", in("made.json"), "--cell", "rectangular"}), 64,
           {"along one axis only"});
    expect(run({"import", in("channel.dump"), "-o", in("made.json"), "--box", "-1:3,1:2"}), 65, {"between the walls"});
}

BOOST_FIXTURE_TEST_CASE(what_is_exported_of_a_cell_is_imported_again, scratch::InFolder) {
    const std::string made = folder.at("made.json");
    const isostat::Packing stored = isostat::read_any_state(rectangle).state.packing;
    for (const std::string end : {"data", "xyz"}) {
        const std::string file = (folder / ("disks." + end)).string();
        expect(run({"export", rectangle, "-o", file}), 0);
        expect(run({"import", file, "-o", made, end == "data" ? "--periodic" : "--json"}), 0);
        const isostat::Packing found = isostat::read_any_state(made).state.packing;
        BOOST_TEST(std::abs(found.length(0) - stored.length(0)) < 1e-12);
        BOOST_TEST(std::abs(found.length(1) - stored.length(1)) < 1e-12);
    }
    expect(run({"export", rectangle, "-o", folder.at("disks.csv")}), 0);
    BOOST_TEST(contains(scratch::read(folder / "disks.csv"), "periodic along xy"));
    expect(run({"report", rectangle, "-o", folder.path().string(), "--vtk"}), 0);
    BOOST_TEST(contains(scratch::read(folder / "forces_rect_16.svg"), "class=\"cell\""));
    BOOST_TEST(contains(scratch::read(folder / "forces_rect_16.vtk"), "LINES 33 "));
}

BOOST_FIXTURE_TEST_CASE(statements_that_do_not_fit_a_cell_are_refused, scratch::InFolder) {
    const std::string out = folder.at("out.json");
    const std::string file = folder.file("disks.dump", dump());
    expect(run({"import", file, "-o", out, "--box", "0:9,0:9"}), 65, {"walls or a box were stated of a periodic"});
    expect(run({"import", file, "-o", out, "--load", "true", "--cell", "tilted"}), 65, {"nominal stresses"});
    expect(run({"import", file, "-o", out, "--load", "true"}), 0);
    expect(run({"import", file, "-o", out, "--walls", "fixed"}), 65, {"walls or a box were stated of a periodic"});
    expect(run({"import", file, "-o", out, "--not-periodic", "--box", "-1:14,-1:14", "--cell", "tilted"}), 64,
           {"--cell", "not periodic"});
    scratch::write(file, scratch::replaced(dump(), "pp pp pp", "pp ff pp"));
    expect(run({"import", file, "-o", out}), 65, {"expected a centre between the walls"});
    scratch::write(file, scratch::replaced(dump(), "\n0 9.", "\n0 8."));
    expect(run({"import", file, "-o", out}), 65, {"overlap"});
}

BOOST_FIXTURE_TEST_CASE(soft_frames_of_a_cell_snap_with_their_contacts_and_forces, scratch::InFolder) {
    expect(run({"snap", scratch::data("cells/channel_16.json"), "-o", folder.at("t.json")}), 0);
    const std::string file = folder.at("disks.dump"), made = folder.at("made.json");
    for (const char* name : {"rect_16", "tilt_16"}) {
        BOOST_TEST_INFO_SCOPE(name);
        const std::string from = scratch::data(std::string("cells/") + name + ".json");
        scratch::write(file, soft_dump(from, 1e-5)); // the pairs that overlap are the contacts
        const auto snapped = says(run({"snap", file, "-o", made}), 0, {"snap      vertex"});
        BOOST_TEST(!contains(snapped.out, "forces "), snapped.out); // the file has none
        const isostat::Packing found = isostat::read_any_state(made).state.packing;
        const isostat::Packing stored = isostat::read_any_state(from).state.packing;
        for (std::size_t k = 32; k < 35; ++k) {
            BOOST_TEST(std::abs(found.q[k] - stored.q[k]) < 1e-11);
        }
        expect(run({"certify", made, "-o", folder.at("c.json")}), 0);
        // A state: its forces are compared.
        isostat::StateFile state = isostat::read_any_state(from);
        const auto forces_of = [&] {
            isostat::write_state(folder / "state.json", state.state, state.forces);
            return json_of(run({"snap", folder.at("state.json"), "-o", made, "--json"})).at("forces");
        };
        BOOST_TEST(forces_of().at("rest").get<double>() < 1e-9);
        const auto strongest = std::ranges::max_element(state.forces);
        *strongest *= 1.25;
        const auto wrong = forces_of();
        BOOST_TEST(wrong.at("rest").get<double>() * wrong.at("mean").get<double>() == 0.2 * *strongest,
                   boost::test_tools::tolerance(1e-6));
        BOOST_TEST(
            wrong.at("contact") ==
            isostat::to_string(state.state.contacts[static_cast<std::size_t>(strongest - state.forces.begin())]));
    }
}

BOOST_FIXTURE_TEST_CASE(crafted_packings_in_cells_become_states_or_the_reason_is_said, scratch::InFolder) {
    const std::string packings = ISOSTAT_EXAMPLES "/packings/";
    const std::string state = folder.at("state.json");
    for (const char* name : {"channel_two_disks_low", "channel_two_disks_high", "cell_one_disk_tilted"}) {
        says(run({"import", packings + name + ".toml", "-o", state}), 0, {"those of the crafted packing, exactly"});
        says(run({"inspect", state}), 0, {"isostatic equilibrium    proved"});
    }
    // The shear stress of the file is that of the state: F2/sqrt(3) + T, F2/sqrt(3) - T.
    const auto forces = isostat::read_any_state(state).state.load;
    BOOST_TEST(std::abs(forces.shear[0] * forces.reference_length[0] - 0.5) < 1e-15);
    expect(run({"import", packings + "cell_hexagonal_largest.toml", "-o", state}), 1, {"h = 5, k = 0"});
    expect(run({"import", packings + "cell_one_disk_tilted.toml", "-o", state, "--cell", "tilted"}), 64, {"no --cell"});
    expect(run({"plan", packings + "cell_one_disk_tilted.toml"}), 65, {"is a crafted packing"});
    says(run({"inspect", packings + "cell_hexagonal_saddle.toml"}), 0,
         {"isotropic              N_f = 5, N = 6, h = 2, k = 1"});
    const auto json = json_of(run({"inspect", packings + "cell_two_disks_tilted.toml", "--json"}));
    BOOST_TEST(json.at("strains").at("diagonal").at("h") == 1);
    BOOST_TEST(json.at("strains").at("full strain").at("h") == 0);
}

BOOST_AUTO_TEST_CASE(genericity_of_radii_and_tilt) {
    const std::string two = ISOSTAT_EXAMPLES "/packings/counterexample_t7_centred_rectangle.toml";
    says(run({"genericity", two, "--samples", "2", "--size", "1e-3", "--json"}), 2, {"\"ties\":2"});
    says(run({"genericity", two, "--samples", "2", "--size", "1e-3", "--tilt", "--json"}), 0,
         {"\"proved_isostatic\":2"});
    expect(run({"genericity", rectangle, "--samples", "2", "--size", "1e-9"}), 0);
    expect(run({"genericity", ISOSTAT_EXAMPLES "/packings/two_disks.toml", "--tilt"}), 65,
           {"a period along each axis"});
}
