// isostat certify and the two facts of isostat inspect: exit statuses, what is printed and written.
#include "cli/program.hpp"
#include "support/crafted.hpp"

#include <isostat/io/state_file.hpp>

using namespace program;
using isostat::state_text;
namespace fs = std::filesystem;

BOOST_AUTO_TEST_CASE(a_sample_certifies_and_its_certificate_is_verified) {
    const scratch::Folder folder;
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

BOOST_AUTO_TEST_CASE(forces_in_the_file_are_compared_and_never_used) {
    const scratch::Folder folder;
    const auto state = isostat::read_any_state(scratch::data("vertex100.txt")).state;
    nlohmann::json file = nlohmann::json::parse(state_text(state));
    file["forces"] = std::vector<double>(state.contacts.size(), 2.0);
    const std::string input = folder.file("state.json", file.dump());
    for (const std::vector<std::string>& command :
         {std::vector<std::string>{"certify", input, "-o", folder.at("c.json")}, {"inspect", input}}) {
        says(run(command), 0, {"forces in the file       differ from the proved ones by at most"});
    }
    const Outcome json = run({"certify", input, "-o", folder.at("c.json"), "--json"});
    BOOST_TEST(contains(json.out, "\"forces_in_file\""), json.out);
    const Outcome without = run({"certify", scratch::data("vertex100.txt"), "-o", folder.at("d.json")});
    BOOST_TEST(!contains(without.out, "forces in the file"), without.out);
}

BOOST_AUTO_TEST_CASE(certify_answers_refuted_and_undecided_with_the_reason_and_still_writes_what_is_proved) {
    const scratch::Folder folder;
    const auto certify = [&folder](const std::string& name, const isostat::State& state) {
        scratch::write(folder / (name + ".json"), state_text(state));
        return run({"certify", (folder / (name + ".json")).string(), "-o", (folder / (name + ".cert")).string()});
    };
    says(certify("pulled", crafted::two_disks(1, 2, 1, 0.3)), 1,
         {"refuted        forces: the force in contact 1-bottom", "counting       N_f = 6"});
    BOOST_TEST(isostat::read_certificate(folder / "pulled.cert").claims.vertex.has_value());
    says(certify("lattice", crafted::square_lattice(3)), 1, {"not isostatic: N_f = 20, N = 24, rank 20, h = 4, k = 0"});
    says(certify("none", crafted::one_disk(1, 0)), 2, {"not claimed    forces", "mpfr"});
    const Outcome bad = run({"certify", folder.at("absent.json"), "-o", folder.at("x.cert")});
    expect(bad, 65, {"absent.json"});
    BOOST_TEST(!fs::exists(folder / "x.cert"));
    expect(run({"certify", folder.at("none.json"), "-o", folder.at("no/such/folder/x")}), 74);
    expect(run({"certify", folder.at("none.json")}), 64);
}

BOOST_AUTO_TEST_CASE(inspect_states_the_rank_as_stored_and_what_is_proved_of_the_true_configuration) {
    const scratch::Folder folder;
    isostat::State state = crafted::two_disks(1, 2, 1, 1);
    scratch::write(folder / "good.json", state_text(state));
    says(run({"inspect", folder.at("good.json")}), 0,
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
    scratch::write(folder / "pulled.json", state_text(crafted::two_disks(1, 2, 1, 0.3)));
    says(run({"inspect", folder.at("pulled.json"), "--json"}), 1, {"\"negative\":1"});
}
