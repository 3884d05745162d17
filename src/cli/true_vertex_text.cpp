#include "cli/true_vertex_text.hpp"

#include "cli/commands.hpp"
#include "cli/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat::cli {

namespace {

void line(const char* claim, const std::string& text, const std::string& rung) {
    say("{:<14} {:<88} {}\n", claim, text, rung);
}

/// Smallest lower end, and the largest width, of the intervals that are not structural zeros.
std::pair<double, double> smallest_and_widest(const ForcesClaim& forces) {
    double smallest = std::numeric_limits<double>::infinity();
    double widest = 0;
    std::size_t next = 0;
    for (std::size_t l = 0; l < forces.finite.size(); ++l) {
        if (next < forces.structural_zeros.size() && forces.structural_zeros[next] == static_cast<int>(l)) {
            ++next;
            continue;
        }
        smallest = std::min(smallest, forces.finite[l].lower);
        widest = std::max(widest, forces.finite[l].upper - forces.finite[l].lower);
    }
    return {smallest, widest};
}

Json end_json(const LoadEndClaim& end, int dimension) {
    Json object;
    object["unbounded"] = end.unbounded;
    if (!end.unbounded) {
        object["stress"] = {number(end.stress.lower), number(end.stress.upper)};
        object["opens"] = to_string(end.opens, dimension);
    }
    return object;
}

std::string signs_text(const ForceSigns& s) {
    std::string text = fmt::format("{} positive, {} exactly 0 (structural)", s.positive, s.structural_zero);
    text += s.negative > 0 ? fmt::format(", {} negative", s.negative) : "";
    return text + (s.undecided > 0 ? fmt::format(", {} undecided", s.undecided) : "");
}

/// Forces that a state file holds against the proved ones: how far apart at most, and where.
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

void print_claims(const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    say("{:<14} {:<88} {}\n", "claim", "proved of the stored coordinates (counting) and of the true vertex",
        "arithmetic");
    if (c.counting) {
        line("counting",
             fmt::format("N_f = {}, N = {}, rank {}, h = {}, k = {}", c.counting->dof_count, c.counting->contact_count,
                         c.counting->rank, c.counting->hyperstaticity, c.counting->hypostaticity),
             std::string(to_string(c.counting->rung)));
    }
    if (c.vertex) {
        line("vertex",
             fmt::format("exists within {} per coordinate, the only one within {}; sigma_min >= {}",
                         rounded_up(c.vertex->radius, 3), rounded_down(c.vertex->unique_radius, 3),
                         rounded_down(certification.smallest_sigma, 3)),
             std::string(to_string(c.vertex->rung)));
    }
    if (c.forces) {
        const auto [smallest, widest] = smallest_and_widest(*c.forces);
        line("forces",
             fmt::format("{}; smallest >= {}, each within {}", signs_text(certification.signs),
                         rounded_down(smallest, 6), rounded_up(widest, 2)),
             std::string(to_string(c.forces->rung)));
    }
    if (c.gaps) {
        line("gaps",
             std::isfinite(c.gaps->smallest)
                 ? fmt::format("all other gaps >= {}, nearest {}", rounded_down(c.gaps->smallest, 6),
                               to_string(c.gaps->where, certification.dimension))
                 : "there is no other pair",
             std::string(to_string(c.gaps->rung)));
    }
    if (c.load_interval) {
        const std::string rung(to_string(c.load_interval->rung));
        line("load interval", "from " + end_text(c.load_interval->low, certification.dimension), rung);
        line("", "to   " + end_text(c.load_interval->high, certification.dimension), rung);
    }
    if (c.stable) {
        line("stable", "strict local minimum of " + certification.potential, "");
    }
    for (const std::string& reason : c.undecided) {
        const bool refuted = std::find(certification.refuted.begin(), certification.refuted.end(), reason) !=
                             certification.refuted.end();
        say("{:<14} {}\n", refuted ? "refuted" : "not claimed", reason);
    }
}

Json claims_json(const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    Json object;
    object["counting"] = c.counting ? Json{{"N_f", c.counting->dof_count},   {"N", c.counting->contact_count},
                                           {"rank", c.counting->rank},       {"h", c.counting->hyperstaticity},
                                           {"k", c.counting->hypostaticity}, {"rung", to_string(c.counting->rung)}}
                                    : Json();
    object["vertex"] = c.vertex ? Json{{"radius", number(c.vertex->radius)},
                                       {"unique_radius", number(c.vertex->unique_radius)},
                                       {"sigma_min", number(certification.smallest_sigma)},
                                       {"rung", to_string(c.vertex->rung)}}
                                : Json();
    object["forces"] = nullptr;
    if (c.forces) {
        const auto [smallest, widest] = smallest_and_widest(*c.forces);
        object["forces"] = {{"positive", certification.signs.positive},
                            {"structural_zeros", certification.signs.structural_zero},
                            {"smallest", number(smallest)},
                            {"widest_interval", number(widest)},
                            {"rung", to_string(c.forces->rung)}};
    }
    object["gaps"] =
        c.gaps
            ? Json{{"smallest", number(c.gaps->smallest)},
                   {"where",
                    std::isfinite(c.gaps->smallest) ? Json(to_string(c.gaps->where, certification.dimension)) : Json()},
                   {"rung", to_string(c.gaps->rung)}}
            : Json();
    object["load_interval"] = c.load_interval ? Json{{"low", end_json(c.load_interval->low, certification.dimension)},
                                                     {"high", end_json(c.load_interval->high, certification.dimension)},
                                                     {"rung", to_string(c.load_interval->rung)}}
                                              : Json();
    object["stable"] = c.stable;
    return object;
}

void print_true_vertex(const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    if (!c.vertex) {
        say("true configuration       not proved to exist\n");
    } else {
        say("true configuration       exists within {} of the stored coordinates ({}); rank {}, h = 0, k = 0 "
            "there (sigma_min >= {})\n",
            rounded_up(c.vertex->radius, 3), to_string(c.vertex->rung), c.counting->rank,
            rounded_down(certification.smallest_sigma, 3));
        say("  its forces             {}\n", signs_text(certification.signs));
    }
    for (const std::string& reason : c.undecided) {
        say("  not proved there       {}\n", reason);
    }
}

Json true_vertex_json(const Certification& certification) {
    const CertificateClaims& c = certification.claims;
    Json object;
    object["exists"] = c.vertex ? "proved" : "undecided";
    if (c.vertex) {
        object["radius"] = number(c.vertex->radius);
        object["unique_radius"] = number(c.vertex->unique_radius);
        object["rank"] = c.counting->rank;
        object["h"] = 0;
        object["k"] = 0;
        object["sigma_min"] = number(certification.smallest_sigma);
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

void print_forces_in_file(const StateFile& file, const Certification& truth) {
    if (const auto forces = compared_forces(file, truth)) {
        say("forces in the file       differ from the proved ones by at most {}, in {}\n",
            rounded_up(forces->difference, 2), to_string(forces->where, truth.dimension));
    }
}

void add_forces_in_file(Json& object, const StateFile& file, const Certification& truth) {
    if (const auto forces = compared_forces(file, truth)) {
        object["forces_in_file"] = {{"difference", number(forces->difference)},
                                    {"contact", to_string(forces->where, truth.dimension)}};
    }
}

void add_untold(Json& object, const compare::Untold& untold, Verdict of_the_doubles) {
    if (!untold.any()) {
        return;
    }
    object["untold"] = {{"rounding", number(untold.rounding)},
                        {"gaps", contact_names(untold.gaps)},
                        {"forces", contact_names(untold.forces)},
                        {"verdict_of_the_doubles", to_string(of_the_doubles)}};
}

} // namespace isostat::cli
