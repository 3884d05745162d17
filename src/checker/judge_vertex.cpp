// The claims about the structure and the existence of the true vertex, and stability, which follows from the others.
#include "checker/evidence.hpp"

#include <fmt/format.h>

namespace isostat::checker {

ClaimCheck judge_counting(const Evidence& evidence, const CountingClaim& claim, bool at_vertex) {
    ClaimCheck check{.claim = "counting", .claimed = true};
    const int dofs = evidence.problem.dofs();
    const int contacts = evidence.problem.contacts();
    check.numbers = {{"dof_count", dofs}, {"contact_count", contacts}};
    if (claim.dof_count != dofs || claim.contact_count != contacts ||
        claim.hyperstaticity != claim.contact_count - claim.rank ||
        claim.hypostaticity != claim.dof_count - claim.rank) {
        return answer(check, Verdict::refuted,
                      fmt::format("the state has N_f = {}, N = {}; claimed {}, {} with rank {}, h = {}, k = {}", dofs,
                                  contacts, claim.dof_count, claim.contact_count, claim.rank, claim.hyperstaticity,
                                  claim.hypostaticity));
    }
    const std::string counts = fmt::format("N_f = {}, N = {}", dofs, contacts);
    if (!evidence.rank) {
        return answer(check, Verdict::undecided,
                      fmt::format("{}; the rank is not proved: {}", counts, evidence.why_no_inverse()));
    }
    check.numbers.emplace_back("rank", *evidence.rank);
    if (claim.rank != *evidence.rank) {
        return answer(check, Verdict::refuted,
                      fmt::format("{}; the rank is {}, not {}", counts, *evidence.rank, claim.rank));
    }
    std::string stored = fmt::format("{}, rank {} as stored (exact elimination)", counts, *evidence.rank);
    if (evidence.inverse.found) {
        const bool by_sigma = evidence.inverse.singular_value > 0;
        const double bound =
            by_sigma ? rounded_down(evidence.inverse.singular_value) : rounded_up(evidence.inverse.residual_row);
        check.numbers.emplace_back(by_sigma ? "singular_value" : "inverse_residual", bound);
        stored = fmt::format("{}, rank {} as stored ({} {:.2g}, {})", counts, *evidence.rank,
                             by_sigma ? "singular values of A >=" : "|I - RA| <=", bound, evidence.inverse.arithmetic);
    }
    if (!at_vertex) {
        return answer(check, Verdict::proved, stored);
    }
    if (!evidence.vertex.found) {
        return answer(check, Verdict::undecided,
                      stored + "; not carried over to a true vertex: " + evidence.why_no_vertex());
    }
    return answer(
        check, Verdict::proved,
        fmt::format("{} and at the true vertex (<= {:.1g})", stored, rounded_up(evidence.vertex.row_residual)));
}

ClaimCheck judge_vertex(const Evidence& evidence, const VertexClaim& claim, bool& exists) {
    ClaimCheck check{.claim = "vertex", .claimed = true};
    const TrueVertex& vertex = evidence.vertex;
    exists = false;
    if (!vertex.found) {
        return answer(check, Verdict::undecided, "no true vertex is proved nearby: " + evidence.why_no_vertex());
    }
    const double unique = largest_unique_distance(evidence.inverse, vertex);
    check.numbers = {{"radius", rounded_up(vertex.moved_most)},
                     {"unique_radius", unique},
                     {"position_error", rounded_up(vertex.radius)}};
    const std::string found = fmt::format("a true vertex within {:.3g} (known to {:.1g}), the only one within {:.3g}",
                                          rounded_up(vertex.moved_most), rounded_up(vertex.radius), unique);
    const Rational radius(claim.radius);
    if (vertex.moved_least > radius && unique_within(evidence.inverse, vertex, radius)) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed within {:.3g}", found, claim.radius));
    }
    exists = vertex.moved_most <= radius;
    const bool only_one = std::isinf(claim.unique_radius)
                              ? !evidence.inverse.regular_within
                              : unique_within(evidence.inverse, vertex, Rational(claim.unique_radius));
    if (exists && only_one) {
        return answer(check, Verdict::proved, found);
    }
    return answer(
        check, Verdict::undecided,
        fmt::format("{}; claimed within {:.3g}, the only one within {:.3g}", found, claim.radius, claim.unique_radius));
}

/// True stresses: the load is minus the volume times the gradient of sum sigma_a ln L_a (S5) when no disk carries a
/// finite force of its own.
bool has_volume_potential(const Evidence& evidence) {
    const State<2>& state = evidence.state;
    if (!std::all_of(state.load.disk_force.begin(), state.load.disk_force.end(), [](double f) { return f == 0; })) {
        return false;
    }
    for (std::size_t a = 0; a < 2; ++a) {
        const std::size_t coordinate = 2 * state.packing.radius.size() + a;
        if (!evidence.vertex.found ||
            Rational(evidence.problem.length(evidence.vertex.middle[coordinate])) <= evidence.vertex.radius) {
            return false;
        }
    }
    return true;
}

ClaimCheck judge_stability(const Evidence& evidence, const std::vector<ClaimCheck>& others) {
    ClaimCheck check{.claim = "stable", .claimed = true};
    for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
        if (evidence.forces[l].negative()) {
            return answer(check, Verdict::refuted,
                          fmt::format("the force of {} is in {}: its contact opens", evidence.name(l),
                                      shown(evidence.forces[l])));
        }
    }
    const bool nominal = evidence.state.load.kind == LoadKind::nominal;
    if (!nominal && !has_volume_potential(evidence)) {
        return answer(check, Verdict::undecided,
                      "true stresses have a potential only without forces on disks and with positive lengths");
    }
    for (const ClaimCheck& other : others) {
        if (other.claim != "load_interval" && other.verdict != Verdict::proved) {
            return answer(check, Verdict::undecided,
                          fmt::format("follows from '{}', which is not proved", other.claim));
        }
    }
    return answer(check, Verdict::proved,
                  fmt::format("strict local minimum of {}: regular, all forces positive",
                              nominal ? "the potential" : "sum sigma_a ln L_a"));
}

} // namespace isostat::checker
