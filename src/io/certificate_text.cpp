#include "io/certificate_json.hpp"
#include "io/contact_json.hpp"

#include <isostat/core/error.hpp>
#include <isostat/io/certificate_file.hpp>
#include <isostat/io/files.hpp>
#include <isostat/io/state_file.hpp>

#include <fmt/format.h>

#include <cmath>

namespace isostat {

namespace {

using json::Json;

Json number(double value, const char* field) {
    if (std::isnan(value)) {
        throw Error(ErrorKind::bad_input, fmt::format("{} is NaN: expected a number in a certificate", field));
    }
    if (std::isinf(value)) {
        return value > 0 ? "inf" : "-inf";
    }
    return value;
}

Json interval(const Interval& value, const char* field) {
    Json ends = Json::array({number(value.lower, field), number(value.upper, field)});
    if (!(value.lower <= value.upper)) {
        throw Error(ErrorKind::bad_input,
                    fmt::format("{} is [{}, {}]: expected ends in increasing order", field, value.lower, value.upper));
    }
    return ends;
}

Json intervals(const std::vector<Interval>& values, const char* field) {
    Json list = Json::array();
    for (const Interval& value : values) {
        list.push_back(interval(value, field));
    }
    return list;
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
        throw Error(ErrorKind::bad_input,
                    fmt::format("vertex.radius is {}: expected a finite number in a certificate", vertex.radius));
    }
    return {{"radius", vertex.radius},
            {"unique_radius", number(vertex.unique_radius, "vertex.unique_radius")},
            {"rung", to_string(vertex.rung)}};
}

Json claim(const ForcesClaim& forces) {
    return {{"finite", intervals(forces.finite, "forces.finite")},
            {"structural_zeros", forces.structural_zeros},
            {"infinitesimal", intervals(forces.infinitesimal, "forces.infinitesimal")},
            {"rung", to_string(forces.rung)}};
}

Json claim(const GapsClaim& gaps) {
    return {{"smallest", number(gaps.smallest, "gaps.smallest")},
            {"where", std::isinf(gaps.smallest) ? Json(nullptr) : json::contact_to_json<2>(gaps.where)},
            {"rung", to_string(gaps.rung)}};
}

Json claim(const LoadEndClaim& end) {
    if (end.unbounded) {
        return {{"unbounded", true}};
    }
    return {{"unbounded", false},
            {"stress", interval(end.stress, "load_interval")},
            {"opens", json::contact_to_json<2>(end.opens)}};
}

Json claim(const LoadIntervalClaim& load) {
    return {{"low", claim(load.low)}, {"high", claim(load.high)}, {"rung", to_string(load.rung)}};
}

template <class Claim> Json or_absent(const std::optional<Claim>& value) {
    return value ? claim(*value) : Json(nullptr);
}

/// A member of the document in one line.
std::string line(const char* name, const Json& value) {
    return fmt::format("\"{}\": {}", name, json::dumped(value));
}

} // namespace

std::string certificate_text(const Certificate& certificate) {
    std::string state = state_text(certificate.state);
    while (state.ends_with('\n')) {
        state.pop_back();
    }
    const CertificateClaims& claims = certificate.claims;
    std::string text = "{\n\"format\": \"isostat-certificate\",\n\"version\": 1,\n";
    text += line("program", certificate.program) + ",\n";
    text += line("input", certificate.input) + ",\n";
    text += line("input_hash", certificate.input_hash) + ",\n";
    text += "\"claims\": {\n";
    text += "  " + line("counting", or_absent(claims.counting)) + ",\n";
    text += "  " + line("vertex", or_absent(claims.vertex)) + ",\n";
    text += "  " + line("forces", or_absent(claims.forces)) + ",\n";
    text += "  " + line("gaps", or_absent(claims.gaps)) + ",\n";
    text += "  " + line("load_interval", or_absent(claims.load_interval)) + ",\n";
    text += "  " + line("stable", claims.stable) + ",\n";
    text += "  " + line("undecided", claims.undecided) + "\n},\n";
    text += "\"state\": " + state;
    return text + ",\n" + line("digest", json::digest_of(Json::parse(text + "}"))) + "\n}\n";
}

void write_certificate(const std::filesystem::path& path, const Certificate& certificate) {
    write_atomically(path, certificate_text(certificate));
}

} // namespace isostat
