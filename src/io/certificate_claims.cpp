// The claims of a certificate as text, both ways.
#include "core/refuse.hpp"
#include "io/state_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::json {

namespace {

Json number(double value, const char* field) {
    if (std::isnan(value)) {
        refuse(ErrorKind::bad_input, "{} is NaN: expected a number in a certificate", field);
    }
    if (std::isinf(value)) {
        return value > 0 ? "inf" : "-inf";
    }
    return value;
}

Json interval(const Interval& value, const char* field) {
    Json ends = Json::array({number(value.lower, field), number(value.upper, field)});
    if (!(value.lower <= value.upper)) {
        refuse(ErrorKind::bad_input, "{} is [{}, {}]: expected ends in increasing order", field, value.lower,
               value.upper);
    }
    return ends;
}

Json intervals(const std::vector<Interval>& values, const char* field) {
    return array_of(values, [field](const Interval& value) { return interval(value, field); });
}

Json claim(const CountingClaim& counting) {
    return {{"dof_count", counting.dof_count},
            {"contact_count", counting.contact_count},
            {"rank", counting.rank},
            {"hyperstaticity", counting.hyperstaticity},
            {"hypostaticity", counting.hypostaticity},
            {"rung", to_string(counting.rung)}};
}

Json claim(const VertexClaim& vertex) {
    if (!std::isfinite(vertex.radius)) {
        refuse(ErrorKind::bad_input, "vertex.radius is {}: expected a finite number in a certificate", vertex.radius);
    }
    return {{"radius", vertex.radius},
            {"unique_radius", number(vertex.unique_radius, "vertex.unique_radius")},
            {"rung", to_string(vertex.rung)}};
}

/// As `intervals(...).dump()`, of as many as there are contacts.
std::string intervals_text(const std::vector<Interval>& values, const char* field) {
    std::string text = "[";
    for (const Interval& value : values) {
        text += text.size() == 1 ? "[" : ",[";
        if (std::isfinite(value.lower) && std::isfinite(value.upper) && value.lower <= value.upper) {
            append_number(text, value.lower);
            text += ',';
            append_number(text, value.upper);
            text += ']';
        } else {
            text.pop_back();
            text += interval(value, field).dump();
        }
    }
    return text + "]";
}

std::string forces_line(const ForcesClaim& forces) {
    return fmt::format(R"("forces": {{"finite":{},"structural_zeros":{},"infinitesimal":{},"rung":{}}})",
                       intervals_text(forces.finite, "forces.finite"), Json(forces.structural_zeros).dump(),
                       intervals_text(forces.infinitesimal, "forces.infinitesimal"),
                       Json(to_string(forces.rung)).dump());
}

Json claim(const GapsClaim& gaps, int dimension) {
    return {{"smallest", number(gaps.smallest, "gaps.smallest")},
            {"where", std::isinf(gaps.smallest) ? Json(nullptr) : contact_to_json(gaps.where, dimension)},
            {"rung", to_string(gaps.rung)}};
}

Json claim(const LoadEndClaim& end, int dimension) {
    if (end.unbounded) {
        return {{"unbounded", true}};
    }
    return {{"unbounded", false},
            {"stress", interval(end.stress, "load_interval")},
            {"opens", contact_to_json(end.opens, dimension)}};
}

Json claim(const LoadIntervalClaim& load, int dimension) {
    return {{"low", claim(load.low, dimension)}, {"high", claim(load.high, dimension)}, {"rung", to_string(load.rung)}};
}

Json claim(const MinimumClaim& minimum, int dimension) {
    return {{"away", number(minimum.away, "minimum.away")},
            {"curvature", number(minimum.curvature, "minimum.curvature")},
            {"held", array_of(minimum.held, [dimension](const Contact& c) { return contact_to_json(c, dimension); })},
            {"form", intervals(minimum.form, "minimum.form")}};
}

template <class Claim, class... More> Json or_absent(const std::optional<Claim>& value, More... more) {
    return value ? claim(*value, more...) : Json(nullptr);
}

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

/// The rung that settled a claim.
Rung rung_of(const Field& field) {
    const auto rung = value_of(field.string(), rung_words);
    if (!rung || *rung == Rung::none) {
        field.fail("\"combinatorial\", \"double\", \"double-double\", \"mpfr\" or \"exact\"");
    }
    return *rung;
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
            zeros.at(k).fail("increasing positions in the contact list, from {} to {} here", least,
                             static_cast<long>(contacts) - 1);
        }
        claim.structural_zeros.push_back(static_cast<int>(position));
    }
    claim.infinitesimal = intervals_of(field.at("infinitesimal"), zeros.size(), "one interval per structural zero");
    claim.rung = rung_of(field.at("rung"));
    return claim;
}

GapsClaim gaps_of(const Field& field, const Packing& packing) {
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
        claim.where = contact_from_json(where, packing);
        if (claim.where.kind == ContactKind::held) {
            where.fail("a pair of grains");
        }
    }
    claim.rung = rung_of(field.at("rung"));
    return claim;
}

LoadEndClaim load_end_of(const Field& field, const State& state) {
    LoadEndClaim claim;
    claim.unbounded = field.at("unbounded").boolean();
    if (claim.unbounded) {
        field.only({"unbounded"});
        return claim;
    }
    field.only({"unbounded", "stress", "opens"});
    claim.stress = interval_of(field.at("stress"));
    claim.opens = contact_from_json(field.at("opens"), state.packing);
    if (std::ranges::find(state.contacts, claim.opens) == state.contacts.end()) {
        field.at("opens").fail("a contact of the state");
    }
    return claim;
}

MinimumClaim minimum_of(const Field& field, const Packing& packing) {
    field.only({"away", "curvature", "held", "form"});
    MinimumClaim claim{field.at("away").number(), field.at("curvature").number()};
    if (!(claim.away >= 0)) {
        field.at("away").fail("a distance >= 0");
    }
    if (!(claim.curvature > 0)) {
        field.at("curvature").fail("a positive number");
    }
    const Field held = field.at("held");
    for (std::size_t k = 0; k < held.size(); ++k) {
        claim.held.push_back(contact_from_json(held.at(k), packing));
    }
    const std::size_t entries = held.size() * (held.size() + 1) / 2;
    claim.form = intervals_of(field.at("form"), entries, "one interval per entry of the upper triangle");
    return claim;
}

LoadIntervalClaim load_interval_of(const Field& field, const State& state) {
    field.only({"low", "high", "rung"});
    return {load_end_of(field.at("low"), state), load_end_of(field.at("high"), state), rung_of(field.at("rung"))};
}

} // namespace

std::string claims_text(const CertificateClaims& claims, int dimension) {
    std::string text = "\"claims\": {\n";
    text += "  " + member_line("counting", or_absent(claims.counting)) + ",\n";
    text += "  " + member_line("vertex", or_absent(claims.vertex)) + ",\n";
    text += "  " + (claims.forces ? forces_line(*claims.forces) : member_line("forces", nullptr)) + ",\n";
    text += "  " + member_line("gaps", or_absent(claims.gaps, dimension)) + ",\n";
    text += "  " + member_line("load_interval", or_absent(claims.load_interval, dimension)) + ",\n";
    text += "  " + member_line("stable", claims.stable) + ",\n";
    if (claims.minimum) {
        text += "  " + member_line("minimum", claim(*claims.minimum, dimension)) + ",\n";
    }
    text += "  " + member_line("undecided", claims.undecided) + "\n}";
    return text;
}

CertificateClaims claims_of(const Field& field, const State& state) {
    field.only({"counting", "vertex", "forces", "gaps", "load_interval", "stable", "minimum", "undecided"});
    const auto take = [&field](auto& claim, const char* name, const auto& claim_of, const auto&... more) {
        if (const Field given = field.at(name); !given.value().is_null()) {
            claim = claim_of(given, more...);
        }
    };
    CertificateClaims claims;
    take(claims.counting, "counting", counting_of);
    take(claims.vertex, "vertex", vertex_of);
    take(claims.forces, "forces", forces_of, state.contacts.size());
    take(claims.gaps, "gaps", gaps_of, state.packing);
    take(claims.load_interval, "load_interval", load_interval_of, state);
    claims.stable = field.at("stable").boolean();
    if (field.has("minimum")) {
        claims.minimum = minimum_of(field.at("minimum"), state.packing);
    }
    const Field undecided = field.at("undecided");
    for (std::size_t k = 0; k < undecided.size(); ++k) {
        claims.undecided.push_back(undecided.at(k).string());
    }
    return claims;
}

} // namespace isostat::json
