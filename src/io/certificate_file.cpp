#include "io/certificate_json.hpp"
#include "io/contact_json.hpp"
#include "io/state_json.hpp"

#include <isostat/io/certificate_file.hpp>
#include <isostat/io/files.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using json::Field;

double number_or_infinity(const Field& field) {
    if (field.value() == "inf") {
        return std::numeric_limits<double>::infinity();
    }
    if (field.value() == "-inf") {
        return -std::numeric_limits<double>::infinity();
    }
    return field.number();
}

Interval interval_of(const Field& field) {
    field.require_size(2, "[lower, upper]");
    const Interval interval{number_or_infinity(field.at(std::size_t{0})), number_or_infinity(field.at(std::size_t{1}))};
    if (!(interval.lower <= interval.upper)) {
        field.fail("[lower, upper] with lower <= upper");
    }
    return interval;
}

std::vector<Interval> intervals_of(const Field& field, std::size_t count, const std::string& what) {
    field.require_size(count, what);
    std::vector<Interval> intervals;
    for (std::size_t k = 0; k < count; ++k) {
        intervals.push_back(interval_of(field.at(k)));
    }
    return intervals;
}

Rung rung_of(const Field& field) {
    for (const Rung rung : json::settling_rungs) {
        if (field.string() == to_string(rung)) {
            return rung;
        }
    }
    field.fail("\"combinatorial\", \"double\", \"double-double\", \"mpfr\" or \"exact\"");
}

int count_of(const Field& field) {
    const long count = field.integer();
    if (count < 0 || count > std::numeric_limits<int>::max()) {
        field.fail("a number of things, from 0");
    }
    return static_cast<int>(count);
}

CountingClaim counting_of(const Field& field) {
    field.only({"dof_count", "contact_count", "rank", "hyperstaticity", "hypostaticity", "rung"});
    return {count_of(field.at("dof_count")),      count_of(field.at("contact_count")), count_of(field.at("rank")),
            count_of(field.at("hyperstaticity")), count_of(field.at("hypostaticity")), rung_of(field.at("rung"))};
}

VertexClaim vertex_of(const Field& field) {
    field.only({"radius", "unique_radius", "rung"});
    const VertexClaim claim{field.at("radius").number(), number_or_infinity(field.at("unique_radius")),
                            rung_of(field.at("rung"))};
    if (!(claim.radius >= 0)) {
        field.at("radius").fail("a radius >= 0");
    }
    if (!(claim.unique_radius >= claim.radius)) {
        field.at("unique_radius").fail("a radius >= vertex.radius");
    }
    return claim;
}

ForcesClaim forces_of(const Field& field, std::size_t contacts) {
    field.only({"finite", "structural_zeros", "infinitesimal", "rung"});
    ForcesClaim claim;
    claim.finite = intervals_of(field.at("finite"), contacts, "one interval per contact");
    const Field zeros = field.at("structural_zeros");
    for (std::size_t k = 0; k < zeros.size(); ++k) {
        const long position = zeros.at(k).integer();
        const long least = k == 0 ? 0 : claim.structural_zeros.back() + 1L;
        if (position < least || position >= static_cast<long>(contacts)) {
            zeros.at(k).fail(fmt::format("increasing positions in the contact list, from {} to {} here", least,
                                         static_cast<long>(contacts) - 1));
        }
        claim.structural_zeros.push_back(static_cast<int>(position));
    }
    claim.infinitesimal = intervals_of(field.at("infinitesimal"), zeros.size(), "one interval per structural zero");
    claim.rung = rung_of(field.at("rung"));
    return claim;
}

GapsClaim gaps_of(const Field& field, const Packing<2>& packing) {
    field.only({"smallest", "where", "rung"});
    GapsClaim claim;
    claim.smallest = number_or_infinity(field.at("smallest"));
    if (!(claim.smallest > 0)) {
        field.at("smallest").fail("a positive gap");
    }
    const Field where = field.at("where");
    if (std::isinf(claim.smallest) != where.value().is_null()) {
        where.fail("a pair of grains, or null exactly when the smallest gap is infinite");
    }
    if (!where.value().is_null()) {
        claim.where = json::contact_from_json<2>(where, packing);
        if (claim.where.kind == ContactKind::held) {
            where.fail("a pair of grains");
        }
    }
    claim.rung = rung_of(field.at("rung"));
    return claim;
}

LoadEndClaim load_end_of(const Field& field, const State<2>& state) {
    LoadEndClaim claim;
    claim.unbounded = field.at("unbounded").boolean();
    if (claim.unbounded) {
        field.only({"unbounded"});
        return claim;
    }
    field.only({"unbounded", "stress", "opens"});
    claim.stress = interval_of(field.at("stress"));
    claim.opens = json::contact_from_json<2>(field.at("opens"), state.packing);
    if (std::find(state.contacts.begin(), state.contacts.end(), claim.opens) == state.contacts.end()) {
        field.at("opens").fail("a contact of the state");
    }
    return claim;
}

LoadIntervalClaim load_interval_of(const Field& field, const State<2>& state) {
    field.only({"low", "high", "rung"});
    return {load_end_of(field.at("low"), state), load_end_of(field.at("high"), state), rung_of(field.at("rung"))};
}

CertificateClaims claims_of(const Field& field, const State<2>& state) {
    field.only({"counting", "vertex", "forces", "gaps", "load_interval", "stable", "undecided"});
    const auto given = [&field](const char* name) { return !field.at(name).value().is_null(); };
    CertificateClaims claims;
    if (given("counting")) {
        claims.counting = counting_of(field.at("counting"));
    }
    if (given("vertex")) {
        claims.vertex = vertex_of(field.at("vertex"));
    }
    if (given("forces")) {
        claims.forces = forces_of(field.at("forces"), state.contacts.size());
    }
    if (given("gaps")) {
        claims.gaps = gaps_of(field.at("gaps"), state.packing);
    }
    if (given("load_interval")) {
        claims.load_interval = load_interval_of(field.at("load_interval"), state);
    }
    claims.stable = field.at("stable").boolean();
    const Field undecided = field.at("undecided");
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        claims.undecided.push_back(undecided.at(k).string());
    }
    return claims;
}

bool is_hash(const std::string& text) {
    return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

} // namespace

Certificate parse_certificate(const std::string& text, const std::string& source) {
    const json::Json parsed = Field::parse(text, source);
    const Field document(parsed, source);
    if (!document.value().is_object()) {
        document.fail("an object with \"format\": \"isostat-certificate\"");
    }
    if (document.at("format").string() != "isostat-certificate") {
        document.at("format").fail("\"isostat-certificate\"");
    }
    if (document.at("version").integer() != 1) {
        document.at("version").fail("1, the version that this program reads");
    }
    document.only({"format", "version", "program", "input", "input_hash", "claims", "state", "digest"});
    const std::string digest = json::digest_of(parsed);
    if (document.at("digest").string() != digest) {
        document.at("digest").fail("\"" + digest + "\", the SHA-256 of the content: was the file altered?");
    }
    Certificate certificate;
    certificate.program = document.at("program").string();
    certificate.input = document.at("input").string();
    certificate.input_hash = document.at("input_hash").string();
    if (!is_hash(certificate.input_hash)) {
        document.at("input_hash").fail("a SHA-256 of 64 hexadecimal digits");
    }
    const Field state = document.at("state");
    if (state.has("forces")) {
        state.at("forces").fail("no such field in a certificate: forces are claims");
    }
    certificate.state = json::state_from_json<2>(state, source).state;
    certificate.claims = claims_of(document.at("claims"), certificate.state);
    return certificate;
}

Certificate read_certificate(const std::filesystem::path& path) {
    return parse_certificate(read_text(path), path.string());
}

} // namespace isostat
