// isostat certify and the two facts of isostat inspect: exit statuses, what is printed and written.
#include "cli/program.hpp"
#include "support/crafted.hpp"
#include "support/forger.hpp"
#include "support/spheres.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
using isostat::state_text;
namespace fs = std::filesystem;

BOOST_FIXTURE_TEST_CASE(verify_answers_for_every_claim_of_a_certificate, scratch::InFolder) {
    const std::string state = scratch::data("vertex100.txt");
    const std::string good = folder.at("good.json");
    expect(run({"certify", state, "-o", good}), 0);
    expect(run({"verify", good}), 0);
    const auto answer = json_of(run({"verify", good, "--input", state, "--json"}));
    BOOST_TEST(answer["verdict"] == "proved");
    std::vector<std::string> claims;
    for (const nlohmann::json& check : answer["checks"]) {
        claims.push_back(check["claim"]);
        BOOST_TEST(check["verdict"] == "proved");
    }
    const std::vector<std::string> expected{"counting", "vertex", "forces", "gaps", "load_interval", "stable", "input"};
    BOOST_TEST(claims == expected, boost::test_tools::per_element());
    BOOST_TEST(answer["checks"][0]["numbers"]["rank"] == 202);

    // Another input than the one that is named.
    says(run({"verify", good, "--input", folder.file("other.txt", scratch::read(state) + "\n")}), 1, {"refuted"});
}

BOOST_FIXTURE_TEST_CASE(certificates_of_spheres_are_made_and_verified, scratch::InFolder) {
    const std::string file = folder.at("spheres.json");
    const std::string made = folder.at("certificate.json");
    isostat::write_state(file, isostat::test::state_of_spheres(isostat::test::read_spheres("tri_uniform_30_1")));
    says(run({"certify", file, "-o", made}), 0, {"N_f = 93, N = 93, rank 93", "proved"});
    says(run({"verify", made, "--input", file}), 0, {"(30 spheres, 93 contacts)", "input          proved"});
    isostat::Certificate forged = isostat::read_certificate(made);
    forged.claims.gaps->smallest *= 2;
    isostat::write_certificate(made, forged);
    says(run({"verify", made}), 1, {"gaps           refuted", to_string(forged.claims.gaps->where, 3)});
}

BOOST_FIXTURE_TEST_CASE(verify_tells_altered_false_and_incomplete_certificates_apart, scratch::InFolder) {
    const std::string file = folder.at("certificate.json");
    expect(run({"certify", scratch::data("vertex100.txt"), "-o", file}), 0);
    const isostat::Certificate original = isostat::read_certificate(file);

    scratch::write(file, scratch::replaced(isostat::certificate_text(original), "\"rank\":202", "\"rank\":201"));
    expect(run({"verify", file}), 65, {"certificate.json", "digest", "altered"});

    isostat::Certificate altered = original;
    altered.claims.gaps->smallest *= 2;
    isostat::write_certificate(file, altered);
    says(run({"verify", file}), 1, {"gaps           refuted"});

    altered = original;
    altered.claims.load_interval = {};
    isostat::write_certificate(file, altered);
    says(run({"verify", file}), 2, {"load_interval  absent"});

    expect(run({"verify", scratch::data("vertex100.txt")}), 65, {"vertex100.txt", "JSON"});
    expect(run({"verify", folder.at("nothing.json")}), 65, {"nothing.json"});
    expect(run({"verify"}), 64);
}

// A certificate whose state is not that of the file, with the hash of the file.
BOOST_FIXTURE_TEST_CASE(the_state_of_a_certificate_is_compared_with_the_input_itself, scratch::InFolder) {
    const std::string input = folder.at("two.json"), file = folder.at("two.cert.json");
    scratch::write(input, isostat::state_text(crafted::two_disks(1, 2, 1, 1)));
    expect(run({"certify", input, "-o", file}), 0);
    expect(run({"verify", file, "--input", input}), 0);
    scratch::write(input, isostat::state_text(crafted::two_disks(1, 3, 1, 1)));
    isostat::Certificate certificate = isostat::read_certificate(file);
    certificate.input_hash = isostat::sha256(scratch::read(input));
    isostat::write_certificate(file, certificate);
    says(run({"verify", file, "--input", input}), 1,
         {"the list of radii of the state in the certificate is not that of"});
}

BOOST_FIXTURE_TEST_CASE(verify_replays_a_run_and_names_the_first_wrong_record, scratch::InFolder) {
    const std::string out = ran(folder, scene_from(scratch::data("vertex100.txt"), up(6)));
    const auto answer = json_of(run({"verify", out, "--json"}));
    has(answer, {{"verdict", "ends proved, way looked at"},
                 {"ends_proved", answer["arcs"]},
                 {"ways_proved", 0},
                 {"equilibria_proved", 7}});

    const std::string events = scratch::read(folder / "run/events.jsonl");
    scratch::write(folder / "run/events.jsonl", scratch::replaced(events, "\"power\":", "\"power\":1"));
    says(run({"verify", out}), 1, {"events.jsonl: damaged", "refuted"});
    expect(run({"report", out}), 65, {"events.jsonl: damaged"});
    forger::seal(out);
    BOOST_TEST(contains(run({"verify", out}).out, "events.jsonl:1"));

    const std::string header = scratch::read(folder / "run/run.json");
    scratch::write(folder / "run/run.json", scratch::replaced(header, "\"completed\"", "\"running\""));
    says(run({"verify", out}), 2, {"not finished"});
    scratch::write(folder / "run/run.json", header);

    scratch::write(folder / "run/events.jsonl", events.substr(0, events.size() / 2));
    expect(run({"verify", out}), 65, {"events.jsonl:", "truncated"});
    expect(run({"verify", folder.path().string()}), 65, {"run.json"});
}

// An end at a shear of 3e-4 need not be known to a thousandth of that: sigma1 = 1 is what it is measured in.
BOOST_FIXTURE_TEST_CASE(a_shear_near_0_is_known_as_well_as_the_largest_stress_asks, scratch::InFolder) {
    const std::filesystem::path out =
        ran(folder, "[packing]\ndisks = 200\ndiameters = [1.0, 2.0]\nseed = 9\n[cell]\nkind = \"tilted\"\n[load]\n"
                    "loaded = \"tilt\"\n[output]\npictures = false\n" +
                        up(1));
    const std::string first = scratch::lines_of(out / "equilibria.csv").at(1);
    auto row = scratch::row_of(out / "equilibria.csv", 0);
    BOOST_TEST_REQUIRE(std::abs(std::stod(row["sigma2_low"])) < 8e-4);
    const double low = std::stod(row["sigma2_low"]);
    const auto said = [&](double number, const char* bound) {
        std::string other = scratch::replaced(first, "," + row["sigma2_low"] + ",", fmt::format(",{},", number));
        other = scratch::replaced(other, "," + row["sigma2_low_bound"] + ",", std::string(",") + bound + ",");
        return forger::altered(out, "equilibria.csv", first, other).verdict;
    };
    BOOST_TEST(std::stod(row["sigma2_low_bound"]) < 1e-8);
    BOOST_TEST((said(low, "9e-7") == isostat::Verdict::proved));
    // Such a bound says too little: the number itself must be right to 1e-6 of the largest stress.
    BOOST_TEST((said(low, "1e-3") == isostat::Verdict::proved));
    BOOST_TEST((said(low + 5e-7, "1e-3") == isostat::Verdict::proved));
    BOOST_TEST((said(low + 2e-6, "1e-3") == isostat::Verdict::undecided));
    BOOST_TEST((said(low, "1e-18") == isostat::Verdict::refuted));
}

BOOST_FIXTURE_TEST_CASE(a_sample_certifies_and_its_certificate_is_verified, scratch::InFolder) {
    const std::string input = scratch::data("vertex100.txt");
    const std::string output = folder.at("cert.json");
    const auto made = says(run({"certify", input, "-o", output}), 0,
                           {"rank 202, h = 0, k = 0", "exists within", "188 positive, 14 exactly 0", "opens 64-95",
                            "opens 64-73", "strict local minimum", "proved"});
    BOOST_TEST(!contains(made.out, "not claimed"));
    const isostat::Certificate certificate = isostat::read_certificate(output);
    BOOST_TEST(certificate.input == "vertex100.txt");
    BOOST_TEST(certificate.input_hash == isostat::sha256(scratch::read(input)));
    BOOST_TEST((certificate.state.packing.q == isostat::read_state(input).state.packing.q)); // bit for bit
    expect(run({"verify", output}), 0);
    // The same state gives the same bytes.
    const Outcome again = done(run({"certify", input, "-o", folder.at("again.json"), "--json"}));
    BOOST_TEST(scratch::read(folder / "again.json") == scratch::read(output));
    BOOST_TEST((contains(again.out, "\"verdict\":\"proved\"") && contains(again.out, "\"refuted\":[]")));
}

BOOST_FIXTURE_TEST_CASE(forces_in_the_file_are_compared_and_never_used, scratch::InFolder) {
    const auto state = isostat::read_any_state(scratch::data("vertex100.txt")).state;
    nlohmann::json file = nlohmann::json::parse(state_text(state));
    file["forces"] = std::vector<double>(state.contacts.size(), 2.0);
    const std::string input = folder.file("state.json", file.dump());
    for (const Arguments& command : {Arguments{"certify", input, "-o", folder.at("c.json")}, {"inspect", input}}) {
        says(run(command), 0, {"forces in the file       differ from the proved ones by at most"});
    }
    const Outcome json = run({"certify", input, "-o", folder.at("c.json"), "--json"});
    BOOST_TEST(contains(json.out, "\"forces_in_file\""), json.out);
    const Outcome without = run({"certify", scratch::data("vertex100.txt"), "-o", folder.at("d.json")});
    BOOST_TEST(!contains(without.out, "forces in the file"), without.out);
}

BOOST_FIXTURE_TEST_CASE(certify_answers_refuted_and_undecided_with_the_reason_and_still_writes_what_is_proved,
                        scratch::InFolder) {
    const auto certify = [this](const std::string& name, const isostat::State& state) {
        scratch::write(folder / (name + ".json"), state_text(state));
        return run({"certify", (folder / (name + ".json")).string(), "-o", (folder / (name + ".cert")).string()});
    };
    says(certify("pulled", crafted::two_disks(1, 2, 1, 0.3)), 1,
         {"refuted        forces: the force in contact 1-bottom", "counting       N_f = 6"});
    BOOST_TEST(isostat::read_certificate(folder / "pulled.cert").claims.vertex.has_value());
    says(certify("lattice", crafted::square_lattice(3)), 1, {"not isostatic: N_f = 20, N = 24, rank 20, h = 4, k = 0"});
    says(certify("none", crafted::one_disk(1, 0)), 2, {"not claimed    forces", "mpfr"});
    expect(run({"certify", folder.at("absent.json"), "-o", folder.at("x.cert")}), 65, {"absent.json"});
    BOOST_TEST(!fs::exists(folder / "x.cert"));
    expect(run({"certify", folder.at("none.json"), "-o", folder.at("no/such/folder/x")}), 74);
    expect(run({"certify", folder.at("none.json")}), 64);
}

BOOST_FIXTURE_TEST_CASE(inspect_states_the_rank_as_stored_and_what_is_proved_of_the_true_configuration,
                        scratch::InFolder) {
    isostat::State state = crafted::two_disks(1, 2, 1, 1);
    says(run({"inspect", folder.file("good.json", state_text(state))}), 0,
         {"rank, stored coordinates 6 (exact)", "true configuration       exists within", "6 positive, 0 exactly 0"});
    // Far from any vertex: the first fact stands, the second is not claimed.
    state.packing.q[2] -= 0.5;
    scratch::write(folder / "far.json", state_text(state));
    const Outcome far = run({"inspect", folder.at("far.json")});
    BOOST_TEST(contains(far.out, "rank, stored coordinates 6 (exact)"), far.out);
    BOOST_TEST(contains(far.out, "true configuration       not proved to exist"), far.out);
    const Outcome json = run({"inspect", folder.at("far.json"), "--json"});
    BOOST_TEST((contains(json.out, "\"rank_exact\":\"proved\"") && contains(json.out, "\"exists\":\"undecided\"")),
               json.out);
    // A negative force at the true vertex.
    says(run({"inspect", folder.file("pulled.json", state_text(crafted::two_disks(1, 2, 1, 0.3))), "--json"}), 1,
         {"\"negative\":1"});
}
