#include "answers/state.hpp"
#include "contact/words.hpp"
#include "core/decimal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::answers {

namespace {

/// A claim: its values, its words, and the arithmetic that proved it.
void add_claim(Answer& claims, const char* key, Json values, Rung rung, const std::string& words) {
    values["rung"] = to_string(rung);
    claims.item(key, std::move(values), key, "{:<88} {}", words, to_string(rung));
}

/// The smallest lower end and the largest width of the intervals that are not structural zeros.
std::pair<double, double> smallest_and_widest(const ForcesClaim& forces, const std::vector<Contact>& contacts) {
    double smallest = std::numeric_limits<double>::infinity();
    double widest = 0;
    std::size_t next = 0;
    for (std::size_t l = 0; l < forces.finite.size(); ++l) {
        if (next < forces.structural_zeros.size() && forces.structural_zeros[next] == static_cast<int>(l)) {
            ++next;
            continue;
        }
        if (contacts[l].is_unilateral()) {
            smallest = std::min(smallest, forces.finite[l].lower);
        }
        widest = std::max(widest, forces.finite[l].upper - forces.finite[l].lower);
    }
    return {smallest, widest};
}

Json end_json(const LoadEndClaim& end, int dimension) {
    return end.unbounded ? Json{{"unbounded", true}}
                         : Json{{"unbounded", false},
                                {"stress", {or_null(end.stress.lower), or_null(end.stress.upper)}},
                                {"opens", to_string(end.opens, dimension)}};
}

std::string signs_text(const ForceSigns& s) {
    std::string text = fmt::format("{} positive, {} exactly 0 (structural)", s.positive, s.structural_zero);
    text += s.negative > 0 ? fmt::format(", {} negative", s.negative) : "";
    return text + (s.undecided > 0 ? fmt::format(", {} undecided", s.undecided) : "");
}

/// The claims of the true vertex, its forces and its gaps.
void add_bounds(Answer& claims, const Certification& certification, const std::vector<Contact>& contacts) {
    const CertificateClaims& c = certification.claims;
    if (c.vertex) {
        const double sigma = certification.smallest_sigma;
        add_claim(claims, "vertex",
                  {{"radius", or_null(c.vertex->radius)},
                   {"unique_radius", or_null(c.vertex->unique_radius)},
                   {"sigma_min", or_null(sigma)}},
                  c.vertex->rung,
                  fmt::format("exists within {} per coordinate, the only one within {}; sigma_min >= {}",
                              rounded_up(c.vertex->radius, 3), rounded_down(c.vertex->unique_radius, 3),
                              rounded_down(sigma, 3)));
    }
    if (c.forces) {
        const auto [smallest, widest] = smallest_and_widest(*c.forces, contacts);
        add_claim(claims, "forces",
                  {{"positive", certification.signs.positive},
                   {"structural_zeros", certification.signs.structural_zero},
                   {"smallest", or_null(smallest)},
                   {"widest_interval", or_null(widest)}},
                  c.forces->rung,
                  fmt::format("{}; smallest >= {}, each within {}", signs_text(certification.signs),
                              rounded_down(smallest, 6), rounded_up(widest, 2)));
    }
    if (c.gaps) {
        const std::string where =
            std::isfinite(c.gaps->smallest) ? to_string(c.gaps->where, certification.dimension) : "";
        add_claim(
            claims, "gaps", {{"smallest", or_null(c.gaps->smallest)}, {"where", where.empty() ? Json() : Json(where)}},
            c.gaps->rung,
            where.empty() ? "there is no other pair"
                          : fmt::format("all other gaps >= {}, nearest {}", rounded_down(c.gaps->smallest, 6), where));
    }
}

} // namespace

std::string end_text(const LoadEndClaim& end, int dimension) {
    return end.unbounded ? "unbounded"
                         : fmt::format("{} (opens {})", with_bound(end.stress.lower, end.stress.upper),
                                       to_string(end.opens, dimension));
}

void add_claims(Answer& out, const Certification& certification, const std::vector<Contact>& contacts) {
    const CertificateClaims& c = certification.claims;
    const int dimension = certification.dimension;
    Answer claims{.width = 14};
    claims.json = {{"counting", nullptr}, {"vertex", nullptr},        {"forces", nullptr},
                   {"gaps", nullptr},     {"load_interval", nullptr}, {"stable", c.stable}};
    claims.line("claim", "{:<88} {}", "proved of the stored coordinates (counting) and of the true vertex",
                "arithmetic");
    if (c.counting) {
        const auto& [n_f, n, rank, h, k, rung] = *c.counting;
        add_claim(claims, "counting", {{"N_f", n_f}, {"N", n}, {"rank", rank}, {"h", h}, {"k", k}}, rung,
                  fmt::format("N_f = {}, N = {}, rank {}, h = {}, k = {}", n_f, n, rank, h, k));
    }
    add_bounds(claims, certification, contacts);
    if (c.load_interval) {
        const auto& [low, high, rung] = *c.load_interval;
        claims.item("load_interval",
                    {{"low", end_json(low, dimension)}, {"high", end_json(high, dimension)}, {"rung", to_string(rung)}},
                    "load interval", "{:<88} {}", "from " + end_text(low, dimension), to_string(rung));
        claims.line("", "{:<88} {}", "to   " + end_text(high, dimension), to_string(rung));
    }
    if (c.stable) {
        claims.line("stable", "{:<88} ",
                    fmt::format("strict local minimum of {}{}", certification.potential,
                                c.counting->hypostaticity > 0 ? ", but for motions that change no force" : ""));
    }
    if (c.minimum) {
        claims.item("minimum", {{"away", or_null(c.minimum->away)}, {"curvature", or_null(c.minimum->curvature)}},
                    "minimum", "{:<88} ",
                    fmt::format("an equilibrium within {} per coordinate, W'' >= {} along its mechanisms",
                                rounded_up(c.minimum->away, 2), rounded_down(c.minimum->curvature, 3)));
    }
    for (const std::string& reason : c.undecided) {
        const bool refuted = std::ranges::find(certification.refuted, reason) != certification.refuted.end();
        claims.line(refuted ? "refuted" : "not claimed", "{}", reason);
    }
    out.part("claims", std::move(claims));
    out.item("refuted", certification.refuted);
    out.item("undecided", c.undecided);
}

void add_true_vertex(Answer& out, const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    Answer there;
    if (!c.vertex) {
        there.item("exists", "undecided", "true configuration", "not proved to exist");
    } else {
        const double sigma = certification.smallest_sigma;
        there.item("exists", "proved", "true configuration",
                   "exists within {} of the stored coordinates ({}); rank {}, h = 0, k = {} there (sigma_min >= {})",
                   rounded_up(c.vertex->radius, 3), to_string(c.vertex->rung), c.counting->rank,
                   c.counting->hypostaticity, rounded_down(sigma, 3));
        there.json.update({{"radius", or_null(c.vertex->radius)},
                           {"unique_radius", or_null(c.vertex->unique_radius)},
                           {"rank", c.counting->rank},
                           {"h", 0},
                           {"k", c.counting->hypostaticity},
                           {"sigma_min", or_null(sigma)},
                           {"decided_by", to_string(c.forces ? c.forces->rung : c.vertex->rung)}});
        const ForceSigns& s = certification.signs;
        there.item("forces",
                   {{"positive", s.positive},
                    {"structural_zeros", s.structural_zero},
                    {"negative", s.negative},
                    {"undecided", s.undecided}},
                   "  its forces", "{}", signs_text(s));
    }
    there.item("not_proved", c.undecided);
    for (const std::string& reason : c.undecided) {
        there.line("  not proved there", "{}", reason);
    }
    out.part("true_configuration", std::move(there));
}

void add_forces_in_file(Answer& out, const StateFile& file, const Certification& truth) {
    if (file.forces.empty() || file.forces.size() != truth.finite.size()) {
        return;
    }
    double difference = 0; // the largest
    Contact where;
    for (std::size_t l = 0; l < file.forces.size(); ++l) {
        const double off = std::max(file.forces[l] - truth.finite[l].lower, truth.finite[l].upper - file.forces[l]);
        if (off > difference) {
            difference = off;
            where = file.state.contacts[l];
        }
    }
    out.item("forces_in_file", {{"difference", or_null(difference)}, {"contact", to_string(where, truth.dimension)}},
             "forces in the file      ", "differ from the proved ones by at most {}, in {}", rounded_up(difference, 2),
             to_string(where, truth.dimension));
}

void add_untold(Answer& out, const compare::Untold& untold, Verdict of_the_doubles) {
    if (untold.any()) {
        out.item("untold", {{"rounding", or_null(untold.rounding)},
                            {"gaps", contact_names(untold.gaps, untold.dimension)},
                            {"forces", contact_names(untold.forces, untold.dimension)},
                            {"verdict_of_the_doubles", to_string(of_the_doubles)}});
    }
}

} // namespace isostat::answers
