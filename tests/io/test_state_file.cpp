#include "io/files.hpp"
#include "io/json.hpp"
#include "support/bad_input.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <bit>
#include <csignal>

using namespace isostat;
using scratch::replaced;

namespace {

void check_bits(const std::vector<double>& a, const std::vector<double>& b) {
    BOOST_REQUIRE_EQUAL(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) {
        BOOST_TEST((std::bit_cast<std::uint64_t>(a[k]) == std::bit_cast<std::uint64_t>(b[k])),
                   a[k] << " became " << b[k]);
    }
}

void check_same(const State& a, const State& b) {
    check_bits(a.packing.radius, b.packing.radius);
    check_bits(a.packing.q, b.packing.q);
    check_bits(a.load.infinitesimal, b.load.infinitesimal);
    check_bits(a.load.disk_force, b.load.disk_force);
    check_bits({a.load.stress.begin(), a.load.stress.end()}, {b.load.stress.begin(), b.load.stress.end()});
    check_bits({a.load.reference_length.begin(), a.load.reference_length.end()},
               {b.load.reference_length.begin(), b.load.reference_length.end()});
    BOOST_TEST((a.load.kind == b.load.kind));
    BOOST_TEST(a.load.loaded_axis == b.load.loaded_axis);
    BOOST_TEST((a.load.path == b.load.path));
    BOOST_TEST((a.packing.walls == b.packing.walls));
    BOOST_TEST((a.packing.fixed == b.packing.fixed));
    BOOST_TEST((a.contacts == b.contacts));
    BOOST_TEST(a.equilibrium == b.equilibrium);
    BOOST_TEST(a.provenance == b.provenance);
}

/// Text of the two-disk case, to be spoilt.
std::string two_disk_text() {
    return state_text(::crafted::two_disks(1, 2, 1, 1));
}

void refuses_state(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_state(text, "crafted.json"); }, words);
}

} // namespace

BOOST_AUTO_TEST_CASE(a_number_of_a_row_is_written_as_a_document_writes_it) {
    std::mt19937_64 random(1);
    std::vector<double> values{0.0, -0.0, 1.0, -1e15, 1e16, 1e300, 5e-324, 0.1, 123456789.0};
    while (values.size() < 20000) {
        const double any = std::bit_cast<double>(random());
        values.push_back(std::isfinite(any) ? any : std::ldexp(static_cast<double>(random() >> 11), -50));
    }
    for (const double value : values) {
        std::string text;
        json::append_number(text, value);
        BOOST_TEST_REQUIRE(text == json::Json(value).dump());
    }
}

BOOST_AUTO_TEST_CASE(rows_of_disks_are_in_the_order_of_their_version) {
    const auto text = [](const std::string& version, const std::string& disks) {
        return R"({"format": "isostat-state", "version": )" + version + R"(, "length": [12, 11], "disks": [)" + disks +
               R"(], "contacts": [[0, "left"]]})";
    };
    const Packing packing = parse_state(text("2", "[3, 4, 1], [9, 5, 2]"), "s").state.packing;
    BOOST_TEST((packing.radius == std::vector<double>{1, 2}));
    BOOST_TEST((packing.q == std::vector<double>{3, 4, 9, 5, 12, 11}));
    const Packing old = parse_state(text("1", "[1, 3, 4], [2, 9, 5]"), "s").state.packing;
    BOOST_TEST((old.radius == packing.radius));
    BOOST_TEST((old.q == packing.q));
    State state;
    state.packing = packing;
    const std::string written = state_text(state);
    BOOST_TEST(written.find("\"version\": 2") != std::string::npos);
    BOOST_TEST(written.find("[3.0,4.0,1.0],\n") != std::string::npos);
    refuses_state(text("2", "[3, 4, 0]"), {"disks[0][2]", "positive radius"});
    refuses_state(text("2", "[3, 4]"), {"disks[0]", "[x, y, radius]"});
    refuses_state(text("1", "[0, 3, 4]"), {"disks[0][0]", "positive radius"});
    refuses_state(text("3", "[3, 4, 1]"), {"version", "3", "1 or 2"});
}

BOOST_AUTO_TEST_CASE(a_state_comes_back_bit_for_bit) {
    State state = ::crafted::two_disks(1, 2, 0.1, 1.0 / 3);
    state.load.infinitesimal = {5e-324, -0.0, 1e308, std::nextafter(0.3, 1.0)};
    state.load.disk_force = {1e-300, 0.1 + 0.2, -7, 2.5};
    state.load.kind = LoadKind::true_stress;
    state.load.loaded_axis = 0;
    state.packing.fixed = {0, 1};
    state.packing.walls.upper[0] = WallKind::fixed;
    state.contacts.push_back({ContactKind::held, 3, 0});
    state.equilibrium = 12;
    state.provenance = R"({"command":"isostat run \"a b\"","seed":18446744073709551615})";
    const std::vector<double> forces{1, 1e-17, 3, 0, -0.0, 0.1, 7};
    const StateFile back = parse_state(state_text(state, forces), "text");
    check_same(state, back.state);
    check_bits(forces, back.forces);
}

BOOST_AUTO_TEST_CASE(the_direction_of_the_radii_and_first_order_terms_come_back) {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    RadiusPerturbation& p = state.perturbation.emplace();
    p.seed = 7;
    p.rho = {0x1.8p-5, -0.25};
    BOOST_TEST(!parse_state(state_text(::crafted::two_disks(1, 2, 1, 1)), "s").state.perturbation.has_value());
    BOOST_TEST(parse_state(state_text(state), "s").state.perturbation->load_zero.i == -1);
    p.load_zero = ::crafted::bottom(1);
    p.stress_rate = {0.1, 1e-17};
    p.open = {{::crafted::top(0), {0.3, 1e-15}}};
    p.zero = {{::crafted::pair(0, 1), {1.5, 0}}, {::crafted::left(0), {2, 3e-11}}};
    const State back = parse_state(state_text(state), "s").state;
    BOOST_TEST_REQUIRE(back.perturbation.has_value());
    const RadiusPerturbation& r = *back.perturbation;
    BOOST_TEST(r.seed == 7U);
    check_bits(r.rho, p.rho);
    BOOST_TEST((r.load_zero == p.load_zero));
    BOOST_TEST(r.stress_rate.value == 0.1);
    BOOST_TEST(r.stress_rate.radius == 1e-17);
    BOOST_TEST(r.open.size() == 1U);
    BOOST_TEST((r.open[0].first == ::crafted::top(0)));
    BOOST_TEST(r.open[0].second.value == 0.3);
    BOOST_TEST(r.zero.size() == 2U);
    BOOST_TEST(r.zero[1].second.radius == 3e-11);
    refuses_state(replaced(state_text(state), "\"rho\":[", "\"rho\":[1,"),
                  {"crafted.json", "rho", "one number per disk"});
    refuses_state(replaced(state_text(state), "\"seed\":7", "\"seed\":-7"), {"crafted.json", "seed"});
    refuses_state(replaced(state_text(state), "\"seed\"", "\"sed\""), {"crafted.json", "sed"});
}

BOOST_AUTO_TEST_CASE(every_bit_pattern_of_a_finite_number_comes_back) {
    State state = ::crafted::one_disk(1, 1);
    std::uint64_t bits = 88172645463325252ULL;
    for (int k = 0; k < 2000; ++k) {
        bits ^= bits << 13U;
        bits ^= bits >> 7U;
        bits ^= bits << 17U;
        const auto g = std::bit_cast<double>(bits);
        if (std::isfinite(g)) {
            state.load.infinitesimal = {g, -g};
            check_bits(state.load.infinitesimal, parse_state(state_text(state), "text").state.load.infinitesimal);
        }
    }
}

BOOST_FIXTURE_TEST_CASE(a_sample_survives_the_way_through_a_file, scratch::InFolder) {
    const State sample = read_state(scratch::data("vertex100.txt")).state;
    write_state(folder / "state.json", sample);
    check_same(sample, read_state(folder / "state.json").state);
}

BOOST_AUTO_TEST_CASE(hexadecimal_floats_are_numbers) {
    const std::string text =
        R"({"format": "isostat-state", "version": 1, "length": ["0x1p+1", 2], "disks": [["0x1p0", 1, "0x1.0p-0"]],
        "contacts": [[0, "left"], [0, "right"], [0, "bottom"], [0, "top"]], "infinitesimal": [["-0x1.8p-3", 1]]})";
    const State state = parse_state(text, "text").state;
    BOOST_TEST(state.packing.q[0] == 1.0);
    BOOST_TEST(state.packing.length(0) == 2.0);
    BOOST_TEST(state.load.infinitesimal[0] == -0.1875);
    BOOST_TEST(state.load.reference_length[0] == 2.0);
    refuses_state(replaced(text, "0x1p+1", "0x1p+1 "), {"length[0]", "finite number"});
    refuses_state(replaced(text, "0x1p+1", "two"), {"length[0]", "two", "finite number"});
}

BOOST_AUTO_TEST_CASE(a_state_cut_short_anywhere_is_refused) {
    const std::string text = two_disk_text();
    const std::size_t end = text.rfind('}');
    for (std::size_t length = 0; length <= end; ++length) {
        BOOST_CHECK_THROW((void)parse_state(text.substr(0, length), "cut.json"), Error);
    }
    BOOST_CHECK_NO_THROW((void)parse_state(text.substr(0, end + 1), "whole.json"));
    refuses_state(text.substr(0, text.size() / 2), {"crafted.json:", "truncated"});
    refuses_state(text + "}", {"crafted.json:", "JSON"});
    refuses_state(text + '\0' + "more", {"crafted.json:", "byte 0"});
}

BOOST_AUTO_TEST_CASE(an_empty_list_of_fixed_disks_is_none) {
    const std::string none = replaced(two_disk_text(), "\"contacts\"", "\"fixed\": [], \"contacts\"");
    BOOST_TEST(parse_state(none, "s").state.packing.fixed.empty());
}

BOOST_AUTO_TEST_CASE(a_path_of_stresses_comes_back_and_contradictions_are_refused) {
    State state;
    Packing& p = state.packing;
    p.dimension = p.cell.dimension = state.load.dimension = 3;
    p.walls = Walls::box(3);
    p.radius = {1};
    p.q = {1, 1, 1, 2, 2, 2};
    for (int axis = 0; axis < 3; ++axis) {
        state.contacts.push_back({ContactKind::lower_wall, 0, axis});
        state.contacts.push_back({ContactKind::upper_wall, 0, axis});
    }
    state.load.stress = {1.1, 1.3, 1.2};
    state.load.refer_to(p);
    state.load.follow({-1, 0, 1.0 / 3});
    state.load.set_loaded_stress(0.1);
    state.provenance = "{}";
    const std::string text = state_text(state);
    const auto read = [](const std::string& changed) {
        return parse_any_state(changed, "crafted.json", Dimensions::any).state;
    };
    check_same(state, read(text));
    check_same(state, read(replaced(text, "\"loaded_axis\":2,", "")));
    for (const auto& [from, to, word] : {std::array{"\"t\":0.1", "\"t\":0.2", "path.stress + t path.direction"},
                                         {"\"t\":0.1", "\"t\":1e308", "1e+308: expected 0, or a magnitude"},
                                         {"\"t\":0.1", "\"t\":5e-324", "expected 0, or a magnitude"},
                                         {"\"loaded_axis\":2", "\"loaded_axis\":1", "the last axis"},
                                         {"\"direction\":[-1.0,0.0,", "\"direction\":[-1.0,1e-9,", "1e-09: expected 0"},
                                         {"\"direction\":[-1.0,0.0,", "\"direction\":[", "1 numbers: expected three"},
                                         {"\"stress\":[1.1,", "\"stress\":[-9.0,", "mean stress above 0"},
                                         {"\"t\":0.1", "\"s\":0.1", "unknown field 's'"}}) {
        std::string changed = text;
        const std::size_t path = changed.find("\"path\"");
        const std::size_t at = changed.find(from, std::string(from).find("stress") == 1 ? path : 0);
        changed.replace(at, std::string(from).size(), to);
        expect_bad_input([&] { (void)read(changed); }, {word});
    }
}

BOOST_AUTO_TEST_CASE(a_state_of_spheres_is_refused_in_words) {
    refuses_state(R"({"format": "isostat-state", "version": 2, "dimension": 3, "length": [4, 4, 4],
                      "disks": [[1, 1, 1, 1], [1, 1, 3, 1]], "contacts": [[0, 1], [0, "left"]]})",
                  {"dimension 3", "a packing of spheres", "takes disks only"});
}

BOOST_AUTO_TEST_CASE(bad_fields_are_named_with_their_value_and_what_was_expected) {
    const std::string text = two_disk_text();
    refuses_state("[1]", {"isostat-state"});
    refuses_state(replaced(text, "isostat-state", "isostat-run"), {"format", "isostat-run"});
    refuses_state(replaced(text, "\"version\": 2", "\"version\": 3"), {"version", "3"});
    refuses_state(replaced(text, "\"contacts\"", "\"contcts\""), {"unknown field 'contcts'"});
    refuses_state(replaced(text, "\"disks\"", "\"disk_force\""), {"'disks' is missing"});
    refuses_state(replaced(text, "\"dimension\": 2", "\"dimension\": 3"), {"disks", "[x, y, z, radius]"});
    refuses_state(replaced(text, "\"nominal\"", "\"dead\""), {"load.kind", "dead", "nominal"});
    refuses_state(replaced(text, "[1.0,1.0]", "[1.0]"), {"load.stress", "2 values"});
    refuses_state(replaced(text, "\"loaded_axis\":1", "\"loaded_axis\":2"), {"load.loaded_axis", "2"});
    refuses_state(replaced(text, "\"fixed\"", "\"frozen\""), {"walls.lower[0]", "frozen"});
    refuses_state(replaced(text, "\"equilibrium\": 0", "\"equilibrium\": -1"), {"equilibrium", "-1"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,0.0]"), {"disks[0][2]", "0.0", "positive radius"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,-1.0]"), {"disks[0][2]", "-1.0", "positive radius"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,1e999]"), {"out of"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,NaN]"), {"crafted.json:", "not valid JSON"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,null]"), {"disks[0][2]", "null", "finite number"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0]"), {"disks[0]", "3 values"});
    refuses_state(replaced(text, "[1.0,1.0,1.0]", "[1.0,1.0,100.0]"), {"disk 0", "200", "larger than the box"});
}

BOOST_AUTO_TEST_CASE(bad_contacts_are_named) {
    const std::string text = two_disk_text();
    refuses_state(replaced(text, "[0,1]", "[0,2]"), {"contacts[2][1]", "2", "from 0 to 1"});
    refuses_state(replaced(text, "[0,1]", "[-1,1]"), {"contacts[2][0]", "-1"});
    refuses_state(replaced(text, "[0,1]", "[1,1]"), {"contacts[2]", "two different disks"});
    refuses_state(replaced(text, "[0,1]", "[0,0.5]"), {"contacts[2][1]", "integer"});
    refuses_state(replaced(text, "[0,1]", "[0,\"ceiling\"]"), {"contacts[2][1]", "ceiling", "left"});
    refuses_state(replaced(text, "[0,1]", "[0,\"left\"]"), {"contacts[2]", "0-left", "contacts[0]", "once"});
    refuses_state(replaced(text, "[0,1]", "[\"held\",6]"), {"contacts[2]", "from 0 to 5"});
    // A contact has one spelling.
    refuses_state(replaced(text, "[0,1]", "[0,1], [0,1]"), {"contacts[3]", "0-1", "contacts[2]"});
    refuses_state(replaced(text, "[0,1]", "[1,0]"), {"contacts[2]", "[1,0]", "[0,1]", "one spelling"});
}

BOOST_AUTO_TEST_CASE(entries_of_a_list_come_once_and_bounds_are_not_negative) {
    const std::string text = two_disk_text();
    refuses_state(replaced(text, "\"contacts\"", "\"fixed\": [1, 1],\n  \"contacts\""), {"fixed[1]", "once"});
    refuses_state(
        replaced(text, "\"contacts\"",
                 "\"perturbation\": {\"seed\": 1, \"rho\": [0, 0], \"zero\": [[[0, 1], 0, -1]]},\n  \"contacts\""),
        {"perturbation.zero[0][2]", "-1", "not negative"});
}

BOOST_FIXTURE_TEST_CASE(a_state_that_is_not_finite_is_not_written, scratch::InFolder) {
    for (const double value : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        State state = ::crafted::two_disks(1, 2, 1, 1);
        state.packing.q[2] = value;
        expect_bad_input([&] { write_state(folder / "state.json", state); }, {"position", "finite"});
        state = ::crafted::two_disks(1, 2, 1, 1);
        state.load.stress[1] = value;
        expect_bad_input([&] { write_state(folder / "state.json", state); }, {"load.stress", "finite"});
    }
    BOOST_TEST(std::filesystem::is_empty(folder.path()));
}

BOOST_FIXTURE_TEST_CASE(failed_writing_keeps_the_old_file_and_leaves_nothing_else, scratch::InFolder) {
    scratch::write(folder / "plain", "old");
    expect_error([&] { write_atomically(folder / "plain/state.json", "new"); }, ErrorKind::cannot_write,
                 {"plain/state.json", "cannot write"});
    expect_error([&] { write_atomically(folder / "missing/state.json", "new"); }, ErrorKind::cannot_write,
                 {"missing/state.json"});
    expect_error([&] { write_atomically(folder.path(), "new"); }, ErrorKind::cannot_write, {folder.path().string()});
    expect_error([&] { make_directory(folder / "plain/below"); }, ErrorKind::cannot_write, {"plain/below"});
    expect_error([&] { make_directory(folder / "plain"); }, ErrorKind::cannot_write, {"plain"});
    BOOST_TEST(scratch::read(folder / "plain") == "old");
    BOOST_TEST(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

BOOST_FIXTURE_TEST_CASE(a_disk_that_is_full_leaves_the_old_file_and_no_part_of_the_new_one, scratch::InFolder) {
    scratch::write(folder / "state.json", "old");
    // The system refuses the 101st byte of any file, as it would on a full disk.
    rlimit before{};
    BOOST_REQUIRE(::getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit small = before;
    small.rlim_cur = 100;
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    BOOST_REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
    expect_error([&] { write_atomically(folder / "state.json", std::string(1000, 'x')); }, ErrorKind::cannot_write, {});
    ::setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    BOOST_TEST(scratch::read(folder / "state.json") == "old");
    BOOST_TEST(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

BOOST_FIXTURE_TEST_CASE(links_are_kept_and_pipes_are_not_replaced, scratch::InFolder) {
    scratch::write(folder / "target", "old");
    std::filesystem::create_symlink(folder / "target", folder / "link");
    write_atomically(folder / "link", "new");
    BOOST_TEST(std::filesystem::is_symlink(folder / "link"));
    BOOST_TEST(scratch::read(folder / "target") == "new");

    const std::string pipe = folder.at("pipe");
    BOOST_REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    const int reader = ::open(pipe.c_str(), O_RDONLY | O_NONBLOCK);
    BOOST_REQUIRE(reader >= 0);
    write_atomically(pipe, "through");
    std::array<char, 16> buffer{};
    const auto got = ::read(reader, buffer.data(), buffer.size());
    ::close(reader);
    BOOST_TEST(std::string(buffer.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0))) == "through");
    BOOST_TEST(std::filesystem::is_fifo(pipe));
}

BOOST_AUTO_TEST_CASE(no_stress_presses_over_a_side_whose_wall_is_absent) {
    // The force on the top wall was 4 or 400 with the place of a right wall that is not there.
    const auto state = [](const std::string& lower, const std::string& upper, const std::string& load) {
        return R"({"format": "isostat-state", "version": 2, "disks": [[0.5, 1, 0.5], [2, 1, 1]], "length": [400, 2],
            "walls": {"lower": [")" +
               lower + R"(", "fixed"], "upper": [")" + upper +
               R"(", "movable"]}, "fixed": [0], "contacts": [[1, "bottom"], [1, "top"], [0, 1]], "load": {)" + load +
               R"(, "stress": [1, 1]}})";
    };
    const std::string present = R"("kind": "true", "reference_length": [4, 2])", dead = R"("reference_length": [4, 2])";
    for (const auto& [lower, upper] : {std::pair("fixed", "absent"), std::pair("absent", "fixed")}) {
        expect_bad_input([&, l = lower, u = upper] { (void)parse_state(state(l, u, present), "FILE"); },
                         {"FILE", "\"true\"", "length along x", "absent", "expected nominal"});
        expect_bad_input([&, l = lower, u = upper] { (void)parse_state(state(l, u, R"("kind": "nominal")"), "FILE"); },
                         {"FILE", "no reference_length", "length along x"});
        const State stated = parse_state(state(lower, upper, dead), "FILE").state;
        BOOST_TEST(stated.load.wall_forces(stated.packing).front().length == 4);
        State other = stated; // as [load] of a scene says it
        other.load.kind = LoadKind::true_stress;
        expect_bad_input([&] { isostat::check_start(other, "SCENE"); }, {"SCENE", "length along x"});
    }
    for (const std::string& load : {present, std::string(R"("kind": "nominal")")}) {
        BOOST_TEST(parse_state(state("fixed", "fixed", load), "FILE").state.load.reference_length[1] == 2);
    }
    // The right wall is pressed over the height, which both walls bound.
    const std::string beside =
        R"({"format": "isostat-state", "version": 2, "disks": [[1, 1, 1]], "length": [2, 2], "walls":
        {"lower": ["fixed", "fixed"], "upper": ["movable", "fixed"]}, "contacts": [], "load": {"kind": "true"}})";
    BOOST_TEST((parse_state(beside, "FILE").state.load.kind == LoadKind::true_stress));
}

BOOST_FIXTURE_TEST_CASE(files_that_cannot_be_read_are_named, scratch::InFolder) {
    expect_bad_input([&] { (void)read_state(folder / "absent.json"); }, {"absent.json", "No such file"});
    expect_bad_input([&] { (void)read_state(folder.path()); }, {folder.path().string(), "directory"});
    scratch::write(folder / "empty.json", "");
    expect_bad_input([&] { (void)read_state(folder / "empty.json"); }, {"empty.json", "empty"});
    scratch::write(folder / "blank.json", " \n\n");
    expect_bad_input([&] { (void)read_state(folder / "blank.json"); }, {"blank.json", "empty"});
}

BOOST_FIXTURE_TEST_CASE(what_a_failed_preparation_leaves_is_no_state, scratch::InFolder) {
    write_packing(folder / "left.json", ::crafted::two_disks(1, 2, 1, 1).packing, "stopped");
    expect_bad_input([&] { (void)read_state(folder / "left.json"); }, {"left.json", "isostat-packing"});
}

BOOST_AUTO_TEST_CASE(a_field_that_comes_twice_is_named) {
    const std::string text = two_disk_text();
    expect_bad_input([&] { (void)parse_state(replaced(text, "\"length\"", "\"length\": [9, 9], \"length\""), "FILE"); },
                     {"FILE", "'length'", "twice"});
    expect_bad_input([&] { (void)parse_state(replaced(text, "\"kind\"", "\"kind\": \"true\", \"kind\""), "FILE"); },
                     {"FILE", "'kind'", "twice"});
}

BOOST_AUTO_TEST_CASE(nesting_has_an_end) {
    const std::string open(100'000, '['), close(100'000, ']');
    expect_bad_input([&] { (void)parse_state("{\"format\":" + open + close + "}", "FILE"); },
                     {"FILE", "deeper than 64"});
    expect_bad_input([&] { (void)parse_state("{\"format\":" + open, "FILE"); }, {"FILE"});
    std::string objects;
    for (int k = 0; k < 100'000; ++k) {
        objects += "{\"a\":";
    }
    expect_bad_input([&] { (void)parse_state(objects, "FILE"); }, {"FILE", "deeper than 64"});
}

BOOST_FIXTURE_TEST_CASE(a_byte_order_mark_is_no_part_of_a_state, scratch::InFolder) {
    for (const std::string& text : {two_disk_text(), scratch::read(scratch::data("vertex100.txt"))}) {
        scratch::write(folder / "plain", text);
        scratch::write(folder / "marked", "\xEF\xBB\xBF" + text);
        StateFile plain = read_state(folder / "plain"), marked = read_state(folder / "marked");
        marked.state.provenance = plain.state.provenance; // the name of the file
        check_same(marked.state, plain.state);
    }
    scratch::write(folder / "nothing", "\xEF\xBB\xBF\n");
    expect_bad_input([&] { (void)read_state(folder / "nothing"); }, {"nothing", "empty"});
}

BOOST_AUTO_TEST_CASE(lengths_beyond_the_range_of_the_arithmetic_are_refused) {
    for (const char* radius : {"1e-200", "1e-151", "1e151", "1e200", "1e308", "5e-324"}) {
        expect_bad_input(
            [&] {
                (void)parse_state(replaced(two_disk_text(), "[1.0,1.0,1.0]", std::string("[1.0,1.0,") + radius + "]"),
                                  "FILE");
            },
            {"FILE", "radius of disk 0", "1e-150"});
    }
    expect_bad_input([&] { (void)parse_state(replaced(two_disk_text(), "[1.0,1.0,1.0]", "[-1e200,1.0,1.0]"), "FILE"); },
                     {"FILE", "x of disk 0", "1e+150"});
}
