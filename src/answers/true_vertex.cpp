#include "answers/state.hpp"
#include "contact/words.hpp"
#include "core/decimal.hpp"
#include "io/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::answers {

using json::Json;
using json::or_null;
using text::say;

namespace {

void line(std::string& out, const char* claim, const std::string& text, const std::string& rung) {
    say(out, "{:<14} {:<88} {}\n", claim, text, rung);
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
    Json object;
    object["unbounded"] = end.unbounded;
    if (!end.unbounded) {
        object["stress"] = {or_null(end.stress.lower), or_null(end.stress.upper)};
        object["opens"] = to_string(end.opens, dimension);
    }
    return object;
}

std::string signs_text(const ForceSigns& s) {
    std::string text = fmt::format("{} positive, {} exactly 0 (structural)", s.positive, s.structural_zero);
    text += s.negative > 0 ? fmt::format(", {} negative", s.negative) : "";
    return text + (s.undecided > 0 ? fmt::format(", {} undecided", s.undecided) : "");
}

/// Compares the forces of a state file with the proved forces: the largest difference, and its contact.
struct FileForces {
    double difference = 0;
    Contact where;
};

std::optional<FileForces> compared_forces(const StateFile& file, const Certification& truth) {
    if (file.forces.empty() || file.forces.size() != truth.finite.size()) {
        return std::nullopt;
    }
    FileForces out;
    for (std::size_t l = 0; l < file.forces.size(); ++l) {
        const double off = std::max(file.forces[l] - truth.finite[l].lower, truth.finite[l].upper - file.forces[l]);
        if (off > out.difference) {
            out = {off, file.state.contacts[l]};
        }
    }
    return out;
}

} // namespace

std::string end_text(const LoadEndClaim& end, int dimension) {
    return end.unbounded ? "unbounded"
                         : fmt::format("{} (opens {})", with_bound(end.stress.lower, end.stress.upper),
                                       to_string(end.opens, dimension));
}

void print_claims(std::string& out, const Certification& certification, const std::vector<Contact>& contacts) {
    const CertificateClaims& c = certification.claims;
    say(out, "{:<14} {:<88} {}\n", "claim", "proved of the stored coordinates (counting) and of the true vertex",
        "arithmetic");
    if (c.counting) {
        line(out, "counting",
             fmt::format("N_f = {}, N = {}, rank {}, h = {}, k = {}", c.counting->dof_count, c.counting->contact_count,
                         c.counting->rank, c.counting->hyperstaticity, c.counting->hypostaticity),
             std::string(to_string(c.counting->rung)));
    }
    if (c.vertex) {
        line(out, "vertex",
             fmt::format("exists within {} per coordinate, the only one within {}; sigma_min >= {}",
                         rounded_up(c.vertex->radius, 3), rounded_down(c.vertex->unique_radius, 3),
                         rounded_down(certification.smallest_sigma, 3)),
             std::string(to_string(c.vertex->rung)));
    }
    if (c.forces) {
        const auto [smallest, widest] = smallest_and_widest(*c.forces, contacts);
        line(out, "forces",
             fmt::format("{}; smallest >= {}, each within {}", signs_text(certification.signs),
                         rounded_down(smallest, 6), rounded_up(widest, 2)),
             std::string(to_string(c.forces->rung)));
    }
    if (c.gaps) {
        line(out, "gaps",
             std::isfinite(c.gaps->smallest)
                 ? fmt::format("all other gaps >= {}, nearest {}", rounded_down(c.gaps->smallest, 6),
                               to_string(c.gaps->where, certification.dimension))
                 : "there is no other pair",
             std::string(to_string(c.gaps->rung)));
    }
    if (c.load_interval) {
        const std::string rung(to_string(c.load_interval->rung));
        line(out, "load interval", "from " + end_text(c.load_interval->low, certification.dimension), rung);
        line(out, "", "to   " + end_text(c.load_interval->high, certification.dimension), rung);
    }
    if (c.stable) {
        line(out, "stable",
             fmt::format("strict local minimum of {}{}", certification.potential,
                         c.counting->hypostaticity > 0 ? ", but for motions that change no force" : ""),
             "");
    }
    if (c.minimum) {
        line(out, "minimum",
             fmt::format("an equilibrium within {} per coordinate, W'' >= {} along its mechanisms",
                         rounded_up(c.minimum->away, 2), rounded_down(c.minimum->curvature, 3)),
             "");
    }
    for (const std::string& reason : c.undecided) {
        const bool refuted = std::ranges::find(certification.refuted, reason) != certification.refuted.end();
        say(out, "{:<14} {}\n", refuted ? "refuted" : "not claimed", reason);
    }
}

Json claims_json(const Certification& certification, const std::vector<Contact>& contacts) {
    const CertificateClaims& c = certification.claims;
    Json object;
    object["counting"] = c.counting ? Json{{"N_f", c.counting->dof_count},   {"N", c.counting->contact_count},
                                           {"rank", c.counting->rank},       {"h", c.counting->hyperstaticity},
                                           {"k", c.counting->hypostaticity}, {"rung", to_string(c.counting->rung)}}
                                    : Json();
    object["vertex"] = c.vertex ? Json{{"radius", or_null(c.vertex->radius)},
                                       {"unique_radius", or_null(c.vertex->unique_radius)},
                                       {"sigma_min", or_null(certification.smallest_sigma)},
                                       {"rung", to_string(c.vertex->rung)}}
                                : Json();
    object["forces"] = nullptr;
    if (c.forces) {
        const auto [smallest, widest] = smallest_and_widest(*c.forces, contacts);
        object["forces"] = {{"positive", certification.signs.positive},
                            {"structural_zeros", certification.signs.structural_zero},
                            {"smallest", or_null(smallest)},
                            {"widest_interval", or_null(widest)},
                            {"rung", to_string(c.forces->rung)}};
    }
    object["gaps"] =
        c.gaps
            ? Json{{"smallest", or_null(c.gaps->smallest)},
                   {"where",
                    std::isfinite(c.gaps->smallest) ? Json(to_string(c.gaps->where, certification.dimension)) : Json()},
                   {"rung", to_string(c.gaps->rung)}}
            : Json();
    object["load_interval"] = c.load_interval ? Json{{"low", end_json(c.load_interval->low, certification.dimension)},
                                                     {"high", end_json(c.load_interval->high, certification.dimension)},
                                                     {"rung", to_string(c.load_interval->rung)}}
                                              : Json();
    object["stable"] = c.stable;
    if (c.minimum) {
        object["minimum"] = {{"away", or_null(c.minimum->away)}, {"curvature", or_null(c.minimum->curvature)}};
    }
    return object;
}

void print_true_vertex(std::string& out, const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    if (!c.vertex) {
        say(out, "true configuration       not proved to exist\n");
    } else {
        say(out,
            "true configuration       exists within {} of the stored coordinates ({}); rank {}, h = 0, k = {} "
            "there (sigma_min >= {})\n",
            rounded_up(c.vertex->radius, 3), to_string(c.vertex->rung), c.counting->rank, c.counting->hypostaticity,
            rounded_down(certification.smallest_sigma, 3));
        say(out, "  its forces             {}\n", signs_text(certification.signs));
    }
    for (const std::string& reason : c.undecided) {
        say(out, "  not proved there       {}\n", reason);
    }
}

Json true_vertex_json(const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    Json object;
    object["exists"] = c.vertex ? "proved" : "undecided";
    if (c.vertex) {
        object["radius"] = or_null(c.vertex->radius);
        object["unique_radius"] = or_null(c.vertex->unique_radius);
        object["rank"] = c.counting->rank;
        object["h"] = 0;
        object["k"] = 0;
        object["sigma_min"] = or_null(certification.smallest_sigma);
        const ForceSigns& s = certification.signs;
        object["forces"] = {{"positive", s.positive},
                            {"structural_zeros", s.structural_zero},
                            {"negative", s.negative},
                            {"undecided", s.undecided}};
        object["decided_by"] = to_string(c.forces ? c.forces->rung : c.vertex->rung);
    }
    object["not_proved"] = c.undecided;
    return object;
}

void print_forces_in_file(std::string& out, const StateFile& file, const Certification& truth) {
    if (const auto forces = compared_forces(file, truth)) {
        say(out, "forces in the file       differ from the proved ones by at most {}, in {}\n",
            rounded_up(forces->difference, 2), to_string(forces->where, truth.dimension));
    }
}

void add_forces_in_file(Json& object, const StateFile& file, const Certification& truth) {
    if (const auto forces = compared_forces(file, truth)) {
        object["forces_in_file"] = {{"difference", or_null(forces->difference)},
                                    {"contact", to_string(forces->where, truth.dimension)}};
    }
}

void add_untold(Json& object, const compare::Untold& untold, Verdict of_the_doubles) {
    if (!untold.any()) {
        return;
    }
    object["untold"] = {{"rounding", or_null(untold.rounding)},
                        {"gaps", contact_names(untold.gaps)},
                        {"forces", contact_names(untold.forces)},
                        {"verdict_of_the_doubles", to_string(of_the_doubles)}};
}

} // namespace isostat::answers
