#include "support/bad_input.hpp"
#include "support/crafted.hpp"
#include "support/forger.hpp"
#include "support/scratch.hpp"

using namespace isostat;
using scratch::replaced;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

/// Every field is present, and every kind of number; the claims need not be true here.
Certificate full_certificate() {
    Certificate certificate;
    certificate.state = ::crafted::two_disks(1, 2, 1, 1.5);
    certificate.state.provenance = R"({"command":"by hand"})";
    certificate.input = "two disks.json";
    certificate.input_hash = sha256("two disks");
    certificate.program = "test";
    CertificateClaims& claims = certificate.claims;
    claims.counting = CountingClaim{6, 6, 6, 0, 0, Rung::exact};
    claims.vertex = VertexClaim{1e-15, 0x1.23456789abcdep-3, Rung::double_double};
    claims.forces = ForcesClaim{{{0.1, 0.3}, {1, 1}, {-inf, inf}, {5e-324, 1e308}, {-0.0, 0.0}, {1, inf}},
                                {1, 3},
                                {{0.25, 0.5}, {1, 2}},
                                Rung::multiprecision};
    claims.gaps = GapsClaim{0.125, ::crafted::right(0), Rung::double_bound};
    claims.load_interval = LoadIntervalClaim{{false, {0.3, 0.4}, ::crafted::bottom(1)}, {true, {}, {}}, Rung::exact};
    claims.stable = true;
    claims.undecided = {"nothing \"else\""};
    return certificate;
}

void refuses_certificate(const std::string& text, const std::vector<std::string>& words) {
    BOOST_TEST_INFO_SCOPE(text);
    expect_bad_input([&] { (void)parse_certificate(text, "crafted.json"); }, words);
}

/// Spoils a text and gives it the digest that belongs to it then, as a forger would.
std::string forged(const std::string& text, const std::string& from, const std::string& to) {
    BOOST_REQUIRE_MESSAGE(text.find(from) != std::string::npos, from << " is not in " << text);
    return forger::sealed_certificate(replaced(text, from, to));
}

} // namespace

BOOST_AUTO_TEST_CASE(sha256_of_the_standards_examples) {
    // FIPS 180-4 examples: "abc", the empty string, and the 448-bit message.
    BOOST_TEST(sha256("abc") == "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    BOOST_TEST(sha256("") == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    BOOST_TEST(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq") ==
               "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

BOOST_AUTO_TEST_CASE(a_certificate_comes_back_bit_for_bit) {
    const Certificate made = full_certificate();
    const std::string text = certificate_text(made);
    const Certificate back = parse_certificate(text, "text");
    BOOST_TEST(certificate_text(back) == text);
    BOOST_TEST((back.state.packing.q == made.state.packing.q));
    BOOST_TEST((back.state.contacts == made.state.contacts));
    BOOST_TEST(back.input == made.input);
    BOOST_TEST(back.input_hash == made.input_hash);
    BOOST_TEST(back.program == made.program);
    const CertificateClaims& claims = back.claims;
    BOOST_REQUIRE((claims.counting && claims.vertex && claims.forces && claims.gaps && claims.load_interval));
    BOOST_TEST(claims.counting->rank == 6);
    BOOST_TEST(claims.vertex->unique_radius == 0x1.23456789abcdep-3);
    BOOST_TEST((claims.vertex->rung == Rung::double_double));
    BOOST_TEST((claims.forces->finite == made.claims.forces->finite));
    BOOST_TEST((claims.forces->structural_zeros == made.claims.forces->structural_zeros));
    BOOST_TEST((claims.forces->infinitesimal == made.claims.forces->infinitesimal));
    BOOST_TEST((claims.gaps->where == ::crafted::right(0)));
    BOOST_TEST((claims.load_interval->low.opens == ::crafted::bottom(1)));
    BOOST_TEST(claims.load_interval->high.unbounded);
    BOOST_TEST(claims.stable);
    BOOST_TEST((claims.undecided == made.claims.undecided));
}

// The writer sorts the text that it has, the reader what it parsed: both must have the same digest.
BOOST_AUTO_TEST_CASE(texts_with_and_without_escapes_have_the_digest_of_what_they_say) {
    Certificate certificate = full_certificate();
    for (const char* words : {"a, {b: [c]} and d", "", "\u00e9, z", "nothing \"else\"", "one\ntwo", "c:\\folder"}) {
        certificate.program = words;
        certificate.claims.undecided = {words, "z"};
        for (const char* provenance :
             {"", "{}", R"({"z": 1, "a": [], "b": {"y": -0.0, "x": 1e300}, "\u0001": null})",
              R"({"zz": [[1, 2.5], {}], "Z": "", "B\"": 3, "B": 4, "B!": 12345678901234567890})",
              R"({"by hand": 1, "by": [{"B!": 2, "B": 3}]})"}) { // a space sorts before a quote
            certificate.state.provenance = provenance;
            const std::string text = certificate_text(certificate);
            BOOST_TEST(certificate_text(parse_certificate(text, "text")) == text);
        }
    }
}

BOOST_AUTO_TEST_CASE(absent_claims_and_infinite_radii_come_back) {
    Certificate certificate = full_certificate();
    certificate.claims = {};
    const CertificateClaims back = parse_certificate(certificate_text(certificate), "text").claims;
    BOOST_TEST((!back.counting && !back.vertex && !back.forces && !back.gaps && !back.load_interval && !back.stable));
    certificate.claims.vertex = VertexClaim{0, inf, Rung::exact};
    certificate.claims.gaps = GapsClaim{inf, {}, Rung::exact};
    const CertificateClaims infinite = parse_certificate(certificate_text(certificate), "text").claims;
    BOOST_TEST(infinite.vertex->unique_radius == inf);
    BOOST_TEST(infinite.gaps->smallest == inf);
}

BOOST_FIXTURE_TEST_CASE(a_certificate_survives_the_way_through_a_file, scratch::InFolder) {
    Certificate certificate = full_certificate();
    certificate.state = read_state(scratch::data("vertex100.txt")).state;
    certificate.claims.forces = {};
    certificate.claims.load_interval = {};
    certificate.claims.gaps = {};
    write_certificate(folder / "certificate.json", certificate);
    BOOST_TEST(certificate_text(read_certificate(folder / "certificate.json")) == certificate_text(certificate));
}

BOOST_AUTO_TEST_CASE(an_altered_certificate_with_the_old_digest_is_refused) {
    const std::string text = certificate_text(full_certificate());
    const std::vector<std::pair<std::string, std::string>> alterations{
        {"\"rank\":6", "\"rank\":5"},
        {"[0.1,0.3]", "[0.1,0.30000000000000004]"},
        {"\"stable\": true", "\"stable\": false"},
        {"[1.0,1.0,1.0]", "[1.0,1.0,1.0000000000000002]"},
        {"by hand", "by hnad"},
        {"\"test\"", "\"best\""}};
    for (const auto& [from, to] : alterations) {
        BOOST_REQUIRE(text.find(from) != std::string::npos);
        refuses_certificate(replaced(text, from, to), {"digest is", "SHA-256", "altered"});
    }
    // White space and the order of fields mean nothing, and are not part of the digest.
    BOOST_CHECK_NO_THROW((void)parse_certificate(replaced(text, "\"claims\":", "\n \"claims\" :"), "spaced"));
}

BOOST_AUTO_TEST_CASE(bad_claims_are_named_with_their_value_and_what_was_expected) {
    const std::string text = certificate_text(full_certificate());
    const auto refused = [&text](const std::string& from, const std::string& to,
                                 const std::vector<std::string>& words) {
        refuses_certificate(forged(text, from, to), words);
    };
    refused("isostat-certificate", "isostat-state", {"format", "isostat-certificate"});
    refused("\"version\": 1,\n\"program\"", "\"version\": 3,\n\"program\"", {"version", "3"});
    refused("\"dof_count\":6", "\"dof_count\":-6", {"claims.counting.dof_count", "-6"});
    refused("\"dof_count\":6", "\"dof_count\":6.5", {"claims.counting.dof_count", "6.5", "integer"});
    refused("\"rank\":6,", "", {"claims.counting.rank", "missing"});
    refused("\"rank\":6", "\"rank\":6,\"ranks\":6", {"unknown field 'ranks'", "claims.counting"});
    refused("\"rank\":6", "\"rank\":6,\"rank\":6", {"'rank' comes twice"});
    refused("\"rung\":\"exact\"", "\"rung\":\"none\"", {"claims.counting.rung", "none"});
    refused("\"radius\":1e-15", "\"radius\":-1e-15", {"claims.vertex.radius", "-1e-15", ">= 0"});
    refused("\"radius\":1e-15", "\"radius\":\"inf\"", {"claims.vertex.radius", "inf", "finite"});
    refused("\"radius\":1e-15", "\"radius\":1", {"claims.vertex.unique_radius", "vertex.radius"});
    refused("\"radius\":1e-15", "\"radius\":NaN", {"not valid JSON"});
    refused("\"radius\":1e-15", "\"radius\":\"nan\"", {"claims.vertex.radius", "nan", "finite number"});
    refused("[0.1,0.3]", "[0.3,0.1]", {"claims.forces.finite[0]", "[0.3,0.1]", "lower <= upper"});
    refused("[0.1,0.3],", "", {"claims.forces.finite", "6 values, 5 found"});
    refused("[0.1,0.3]", "[0.1,0.3,0.4]", {"claims.forces.finite[0]", "[lower, upper]"});
    refused("[0.1,0.3]", "[0.1,\"Inf\"]", {"claims.forces.finite[0][1]", "Inf", "finite number"});
    refused("[0.1,0.3]", "[null,0.3]", {"claims.forces.finite[0][0]", "null"});
    refused("[1,3]", "[3,1]", {"claims.forces.structural_zeros[1]", "1", "from 4 to 5"});
    refused("[1,3]", "[1,1]", {"claims.forces.structural_zeros[1]", "increasing"});
    refused("[1,3]", "[1,6]", {"claims.forces.structural_zeros[1]", "6", "to 5"});
    refused("[1,3]", "[1]", {"claims.forces.infinitesimal", "1 values, 2 found"});
    refused("\"smallest\":0.125", "\"smallest\":0", {"claims.gaps.smallest", "positive"});
    refused("\"smallest\":0.125", "\"smallest\":\"inf\"", {"claims.gaps.where", "null"});
    refused("\"where\":[0,\"right\"]", "\"where\":null", {"claims.gaps.where", "null"});
    refused("\"where\":[0,\"right\"]", "\"where\":[2,\"right\"]", {"claims.gaps.where[0]", "2"});
    refused("\"where\":[0,\"right\"]", "\"where\":[\"held\",1]", {"claims.gaps.where", "held"});
    refused("\"opens\":[1,\"bottom\"]", "\"opens\":[0,\"right\"]", {"claims.load_interval.low.opens", "contact of"});
    refused("\"unbounded\":true", "\"unbounded\":true,\"stress\":[1,2]", {"unknown field 'stress'"});
    refused("\"unbounded\":true", "\"unbounded\":false", {"claims.load_interval.high.stress", "missing"});
    refused("\"stable\": true", "\"stable\": 1", {"claims.stable", "true or false"});
    refused("  \"stable\": true,\n", "", {"claims.stable", "missing"});
    refused("\"undecided\": [\"", "\"undecided\": [7,\"", {"claims.undecided[0]", "7", "string"});
    refused("\"input_hash\": \"", "\"input_hash\": \"0", {"input_hash", "64"});
    refused("\"contacts\": [", "\"forces\": [],\n\"contacts\": [", {"state.forces", "no such field"});
    refused("[1.0,1.0,1.0]", "[1.0,1.0,0.0]", {"state.disks[0][2]", "positive radius"});
    refuses_certificate(replaced(text, "\"digest\"", "\"digets\""), {"digets"});
    refuses_certificate("[]", {"isostat-certificate"});
    refuses_certificate(std::string(200000, '[') + std::string(200000, ']'), {"nested"});
    refuses_certificate(state_text(full_certificate().state), {"format", "isostat-state"});
}

BOOST_AUTO_TEST_CASE(what_is_no_number_or_no_interval_is_not_written) {
    Certificate certificate = full_certificate();
    certificate.claims.vertex->radius = std::nan("");
    expect_bad_input([&] { (void)certificate_text(certificate); }, {"vertex.radius", "nan"});
    certificate.claims.vertex->radius = inf;
    expect_bad_input([&] { (void)certificate_text(certificate); }, {"vertex.radius", "inf"});
    certificate = full_certificate();
    certificate.claims.gaps->smallest = std::nan("");
    expect_bad_input([&] { (void)certificate_text(certificate); }, {"gaps.smallest", "NaN"});
    certificate = full_certificate();
    certificate.claims.forces->finite[2] = {1, 0};
    expect_bad_input([&] { (void)certificate_text(certificate); }, {"forces.finite", "increasing order"});
}
