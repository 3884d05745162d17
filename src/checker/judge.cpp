// One function per claim: its proof again, by other means; and the order in which they are asked. Those about forces
// and about the load have their own files.
#include "checker/arcs.hpp"
#include "checker/evidence.hpp"
#include "checker/vertex.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace isostat::checker {

namespace {

ClaimCheck judge_counting(const Evidence& evidence, const CountingClaim& claim, bool at_vertex) {
    ClaimCheck check{.claim = "counting", .claimed = true};
    const int bars = evidence.count(ContactKind::bar);
    const int dofs = evidence.problem.dofs() - bars;
    const int contacts = evidence.problem.contacts() - bars - evidence.count(ContactKind::held);
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
    if (evidence.has_other_rows() && !evidence.inverse.found) {
        return answer(check, Verdict::undecided,
                      counts + "; whether bars and held coordinates are independent is open");
    }
    const int rank = evidence.has_other_rows() ? contacts : *evidence.rank; // all rows are independent
    check.numbers.emplace_back("rank", rank);
    if (claim.rank != rank) {
        return answer(check, Verdict::refuted, fmt::format("{}; the rank is {}, not {}", counts, rank, claim.rank));
    }
    std::string stored = fmt::format("{}, rank {} as stored (exact elimination)", counts, rank);
    if (evidence.inverse.found) {
        const bool by_sigma = evidence.inverse.singular_value > 0;
        const double bound =
            by_sigma ? rounded_down(evidence.inverse.singular_value) : rounded_up(evidence.inverse.residual_row);
        check.numbers.emplace_back(by_sigma ? "singular_value" : "inverse_residual", bound);
        stored = fmt::format("{}, rank {} as stored ({} {:.2g}, {})", counts, rank,
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

/// Gaps that differ by less are equally near: 2^-46 of the largest coordinate or radius.
Rational equally_near(const State& state) {
    double largest = 0;
    const Packing& packing = state.packing;
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        const std::size_t walls = packing.length_at(0);
        const bool exists = k < walls || packing.cell.any() || packing.walls.upper[k - walls] != WallKind::absent;
        largest = exists ? std::max(largest, std::abs(packing.q[k])) : largest;
    }
    for (const double r : packing.radius) {
        largest = std::max(largest, r);
    }
    return Rational(largest) * power_of_two(-46); // checker.md K9, gaps that count as equally near
}

constexpr const char* too_far = "the cell is too sheared, or a disk too far from it, for a search among its images";

ClaimCheck judge_gaps(const Evidence& evidence, const GapsClaim& claim) {
    ClaimCheck check{.claim = "gaps", .claimed = true};
    if (const auto pair = fixed_overlap(evidence.problem, evidence.state)) {
        return pair->i < 0
                   ? answer(check, Verdict::undecided, too_far)
                   : answer(check, Verdict::refuted, fmt::format("{} overlap, and cannot move", evidence.named(*pair)));
    }
    if (const std::string unfit = unfit_arcs(evidence.problem, evidence.state, evidence.vertex); !unfit.empty()) {
        return answer(check, Verdict::undecided, unfit);
    }
    const std::vector<Gap> near = smallest_gaps(evidence.problem, evidence.state, evidence.vertex);
    if (near.empty()) {
        return answer(check, std::isinf(claim.smallest) ? Verdict::proved : Verdict::refuted,
                      "there is no pair besides the contacts");
    }
    if (near[0].pair.i < 0) {
        return answer(check, Verdict::undecided, too_far);
    }
    const Gap* nearest = near.data();
    const Gap* named = nullptr;
    Rational least = near[0].value.lower;
    for (const Gap& gap : near) {
        nearest = gap.value.upper < nearest->value.upper ? &gap : nearest;
        named = gap.pair == claim.where ? &gap : named;
        least = std::min(least, gap.value.lower);
    }
    const Rational& most = nearest->value.upper;
    check.numbers = {{"smallest_gap", rounded_down(least)}};
    const std::string found =
        fmt::format("smallest gap in {}, of {}", shown(Range(least, most)), evidence.named(nearest->pair));
    if (std::isinf(claim.smallest) || most < Rational(claim.smallest)) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed >= {:.17g}", found, claim.smallest));
    }
    const Rational room = equally_near(evidence.state);
    if (named == nullptr || named->value.lower > most + room) {
        return answer(check, Verdict::refuted, fmt::format("{}; claimed of {}", found, evidence.named(claim.where)));
    }
    if (least >= Rational(claim.smallest) && named->value.upper <= least + room) {
        return answer(check, Verdict::proved, found);
    }
    return answer(check, Verdict::undecided,
                  fmt::format("{}; claimed >= {:.17g} of {}", found, claim.smallest, evidence.named(claim.where)));
}

/// True stresses: the load is minus the volume times the gradient of sum sigma_a ln L_a (S5) when no disk carries a
/// finite force of its own.
bool has_volume_potential(const Evidence& evidence) {
    const State& state = evidence.state;
    if (!std::all_of(state.load.disk_force.begin(), state.load.disk_force.end(), [](double f) { return f == 0; })) {
        return false;
    }
    for (std::size_t a = 0; a < state.packing.axes(); ++a) {
        if (!evidence.vertex.found ||
            !coordinate_at(evidence.problem, evidence.vertex, state.packing.length_at(a)).positive()) {
            return false;
        }
    }
    return true;
}

ClaimCheck judge_stability(const Evidence& evidence, const std::vector<ClaimCheck>& others) {
    ClaimCheck check{.claim = "stable", .claimed = true};
    for (std::size_t l = 0; l < evidence.forces.size(); ++l) {
        if (evidence.forces[l].negative() && evidence.state.contacts[l].is_unilateral()) {
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
                  fmt::format("strict local minimum of {}{}: regular, all forces positive",
                              nominal ? "the potential" : "sum sigma_a ln L_a",
                              evidence.count(ContactKind::held) == 0 ? "" : ", but for motions that change no force"));
}

/// What stands in the way of judging a claim at all; empty: nothing.
std::string obstacle(const Evidence& evidence, bool claimed) {
    return claimed ? evidence.problem.unsupported : "not claimed";
}

/// The same for a claim about the true vertex, which must be claimed and proved to exist where it is claimed.
std::string vertex_obstacle(const Evidence& evidence, const CertificateClaims& claims, bool claimed, bool exists) {
    std::string first = obstacle(evidence, claimed);
    if (!first.empty()) {
        return first;
    }
    if (!claims.vertex) {
        return "speaks of a true vertex, which is not claimed";
    }
    if (!evidence.vertex.found) {
        return "speaks of a true vertex, which is not proved: " + evidence.why_no_vertex();
    }
    return exists ? "" : "speaks of a true vertex within the claimed radius, which is not proved";
}

} // namespace

Verification judge(const CertificateClaims& claims, const Evidence& evidence) {
    Verification result;
    bool exists = false;
    const auto add = [&result](const char* name, bool claimed, const std::string& why_not, const auto& ask) {
        result.checks.push_back(why_not.empty() ? ask()
                                                : ClaimCheck{.claim = name, .claimed = claimed, .detail = why_not});
    };
    const auto about_vertex = [&](bool claimed) { return vertex_obstacle(evidence, claims, claimed, exists); };

    const bool counting = claims.counting.has_value();
    add("counting", counting, obstacle(evidence, counting),
        [&] { return judge_counting(evidence, *claims.counting, claims.vertex.has_value()); });
    const bool vertex = claims.vertex.has_value();
    add("vertex", vertex, obstacle(evidence, vertex), [&] { return judge_vertex(evidence, *claims.vertex, exists); });
    const bool forces = claims.forces.has_value();
    add("forces", forces, about_vertex(forces), [&] { return judge_forces(evidence, *claims.forces); });
    const bool gaps = claims.gaps.has_value();
    add("gaps", gaps, about_vertex(gaps), [&] { return judge_gaps(evidence, *claims.gaps); });
    const bool load = claims.load_interval.has_value();
    add("load_interval", load, about_vertex(load),
        [&] { return judge_load_interval(evidence, *claims.load_interval); });
    add("stable", claims.stable, about_vertex(claims.stable), [&] { return judge_stability(evidence, result.checks); });

    if (claims.minimum) {
        add("minimum", true, evidence.problem.unsupported, [&] { return judge_minimum(evidence, *claims.minimum); });
    }
    result.verdict = Verdict::proved;
    for (const ClaimCheck& check : result.checks) {
        if (check.claimed || !claims.minimum) { // which is in the place of all others
            result.verdict = both(result.verdict, check.verdict);
        }
    }
    return result;
}

} // namespace isostat::checker
