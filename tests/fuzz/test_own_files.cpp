// Our own files: states, vertex texts, certificates, scenes, crafted packings, radii.

#include "fuzz/harness.hpp"
#include "io/state_json.hpp"
#include "io/vertex_text.hpp"
#include "scene/seed.hpp"
#include "scene/settings.hpp"
#include "support/cells.hpp"
#include "support/crafted.hpp"
#include "support/scratch.hpp"

#include <isostat/certificate/certify.hpp>
#include <isostat/checker/verify.hpp>
#include <isostat/crafted/exact_packing.hpp>
#include <isostat/io/state_file.hpp>
#include <isostat/scene/scene.hpp>

#include <cstring>

using namespace fuzz;

namespace {

/// The same numbers, bit for bit, when they are written and read again.
std::string comes_back(const StateFile& file) {
    const State again = parse_state(state_text(file.state, file.forces), "FILE").state;
    const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
        return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
    };
    return same(again.packing.q, file.state.packing.q) && same(again.packing.radius, file.state.packing.radius) &&
                   again.contacts == file.state.contacts
               ? ""
               : "it is not what is read again";
}

std::string check_state(const std::string& text) {
    const StateFile file = parse_state(text, "FILE");
    const std::string wrong = unsound(file.state);
    return wrong.empty() ? comes_back(file) : wrong;
}

std::string check_vertex(const std::string& text) {
    const State state = parse_vertex_text(text, "FILE");
    std::size_t rows = 0;
    for (const std::string& line : lines_of(text)) {
        rows += has_content(line, " \t\r,") ? 1 : 0;
    }
    const std::string wrong = unsound(state);
    return wrong.empty() ? rows_differ(state.packing.radius.size() + state.contacts.size() + 3, rows) : wrong;
}

State small() {
    State state = ::crafted::two_disks(1, 2, 1, 1);
    state.packing.fixed = {0, 0};
    return state;
}

} // namespace

BOOST_AUTO_TEST_CASE(mutated_states_and_vertices_are_refused_by_name_or_are_sound) {
    const std::string vertex = scratch::read(scratch::data("vertex100.txt"));
    const std::string text = state_text(small(), std::vector<double>(small().contacts.size(), 1.0));
    BOOST_TEST(fuzz::fuzz("state", text, 8000, check_state).refused > 1000);
    BOOST_TEST(fuzz::fuzz("state of 100", state_text(parse_vertex_text(vertex, "FILE")), 400, check_state).refused >
               50);
    BOOST_TEST(fuzz::fuzz("vertex", vertex, 1000, check_vertex).refused > 100);
    BOOST_TEST(
        fuzz::fuzz("small vertex", "1\n1 1 1 0.1 0.2\n2 2\n4\n1 0 -1\n2 0 -1\n3 0 -1\n4 0 -1\n", 4000, check_vertex)
            .refused > 500);
}

BOOST_AUTO_TEST_CASE(mutated_states_of_cells_are_refused_by_name_or_are_sound_and_can_be_certified) {
    const auto check = [](const std::string& changed) {
        const StateFile file = parse_any_state(changed, "FILE");
        const std::string written = state_text(file.state, file.forces);
        const StateFile again = parse_any_state(written, "FILE");
        if (state_text(again.state, again.forces) != written) {
            return std::string("it is not what is read again");
        }
        Certificate certificate;
        certificate.state = file.state;
        certificate.claims = certify(file.state).claims;
        return verify(certificate).verdict == Verdict::refuted ? std::string("proved and refuted")
                                                               : unsound(file.state);
    };
    const std::vector<double> forces(3, 1.0);
    BOOST_TEST(fuzz::fuzz("tilted cell", state_text(cells::one_tilted_disk(2, 1, 0.25), forces), 3000, check).refused >
               500);
    BOOST_TEST(fuzz::fuzz("rectangular cell", state_text(cells::two_disks(false, 1, 1)), 3000, check).refused > 500);
}

BOOST_AUTO_TEST_CASE(mutated_states_that_are_accepted_can_be_certified) {
    fuzz::fuzz("certified state", state_text(small()), 1000, [](const std::string& changed) {
        const State state = parse_state(changed, "FILE").state;
        Certificate certificate;
        certificate.state = state;
        certificate.claims = certify(state).claims;
        return verify(certificate).verdict == Verdict::refuted ? std::string("proved and refuted") : std::string();
    });
}

BOOST_AUTO_TEST_CASE(mutated_certificates_are_refused_by_their_digest) {
    Certificate certificate;
    certificate.state = ::crafted::one_disk(1, 1);
    certificate.input = "one.json";
    certificate.input_hash = sha256("one");
    certificate.program = "test";
    certificate.claims = certify(certificate.state).claims;
    const std::string text = certificate_text(certificate);
    const Count tally = fuzz::fuzz("certificate", text, 6000, [&](const std::string& changed) {
        // What is accepted says what the original said: white space, or a mutation that undid itself.
        return certificate_text(parse_certificate(changed, "FILE")) == text ? "" : "it says something else";
    });
    BOOST_TEST(tally.refused > 3000);

    // The same with a digest that fits: the reader and the checker see what the mutation made.
    const std::string body = text.substr(0, text.rfind("\"digest\"")) + "\"digest\": \"\"}\n";
    const auto read = [](const std::string& changed) {
        json::Json document = json::Json::parse(changed, nullptr, false);
        if (document.is_object()) {
            document["digest"] = json::digest_of(document);
        }
        const Certificate made = parse_certificate(document.is_object() ? json::dumped(document) : changed, "FILE");
        (void)verify(made);
        return unsound(made.state);
    };
    BOOST_TEST(fuzz::fuzz("certificate with its digest", body, 3000, read).refused > 1000);
}

BOOST_AUTO_TEST_CASE(mutated_scenes_are_refused_by_name_or_can_be_read) {
    const std::filesystem::path folder(ISOSTAT_TEST_DATA);
    const auto read = [&](const std::string& changed) {
        const Scene scene = parse_scene(changed, "FILE", folder);
        (void)make_plan(scene);
        (void)settings_json(scene);
        if (!scene.start.empty()) {
            return std::string();
        }
        return parse_scene(with_seed(changed, 77, "FILE", folder), "FILE", folder).preparation.seed == 77
                   ? std::string()
                   : std::string("the seed is not the one asked for");
    };
    const std::string text = scratch::read(scratch::data("biaxial-100.toml"));
    BOOST_TEST(fuzz::fuzz("scene", text, 3000, read).refused > 200);
    const std::string radii = "[packing]\nradii = [1.0, 1.5, 0x10, 2e-1]\nseed = 3\n[load]\nsigma1 = 2.0\n"
                              "[[programme]]\ndo = \"up\"\nequilibria = 3\n[run]\nties = \"choose\"\nmax_choices = 0\n";
    BOOST_TEST(fuzz::fuzz("scene with radii", radii, 3000, read).refused > 200);
    const std::string cell = "[packing]\ndisks = 60\ndiameters = [1.0, 2.0]\n[cell]\nkind = \"tilted\"\n"
                             "[[programme]]\ndo = \"down\"\nequilibria = 2\n";
    BOOST_TEST(fuzz::fuzz("scene with a cell", cell, 3000, read).refused > 200);
}

BOOST_AUTO_TEST_CASE(mutated_crafted_packings_are_refused_by_name_or_inspected) {
    for (const char* name : {"two_disks", "triangular_patch_2x3", "arch", "wedged_between_three", "cell_two_disks_tie",
                             "channel_two_disks_low"}) {
        const std::string text = scratch::read(std::string(ISOSTAT_EXAMPLES) + "/packings/" + name + ".toml");
        const Count tally = fuzz::fuzz(name, text, 1000, [](const std::string& changed) {
            const isostat::crafted::PackingFile file = isostat::crafted::parse_packing(changed, "FILE");
            if (file.packing.radius.size() != file.packing.centre.size()) {
                return "sizes do not fit";
            }
            if (const auto inspected = inspect_file(file, "FILE"); inspected.ok()) {
                (void)check_expected(inspected.value(), file, "FILE");
            }
            return "";
        });
        BOOST_TEST(tally.refused > 130);
        BOOST_TEST(tally.accepted > 100);
    }
}

BOOST_FIXTURE_TEST_CASE(mutated_files_of_radii_are_refused_by_name_or_lose_no_row, scratch::InFolder) {
    const auto read = [&](const std::string& changed) {
        scratch::write(folder / "radii.txt", changed);
        std::vector<double> radii;
        try {
            radii = read_radii(folder / "radii.txt");
        } catch (const Error& error) {
            throw Error(error.kind(), scratch::replaced(error.what(), folder.at("radii.txt"), "FILE"));
        }
        std::size_t rows = 0;
        for (const std::string& line : lines_of(changed)) {
            rows += has_content(line, " \t\r,") ? 1 : 0;
        }
        return rows_differ(radii.size(), rows);
    };
    BOOST_TEST(fuzz::fuzz("radii", "# radii\n1\n1.5\n0.75\n2e-1\n", 3000, read).refused > 100);
}
