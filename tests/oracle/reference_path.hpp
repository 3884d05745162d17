#pragma once
// A trajectory of the program, every event of it polished to 320 bits and certified (reference_vertex.hpp): what errors
// of events and stresses are measured against.

#include "motion/arc.hpp"
#include "oracle/reference_vertex.hpp"
#include "support/recorder.hpp"
#include "support/segments.hpp"

#include <isostat/trajectory/trajectory.hpp>

#include <string>

namespace isostat::oracle {

/// One arc: where it starts in double, what opens and closes, and the true place where it ends.
struct ReferenceArc {
    Packing start;
    std::vector<Contact> contacts; ///< at the start
    ContactId opened;
    bool infinitesimal = false, at_limit = false;
    Load load;
    Contact closed;
    std::vector<Contact> end_contacts;
    std::vector<Reference> end;
    double bound = 0;        ///< proved: |end - true end| in the maximum norm
    int limit = -1;          ///< the arc ends in an equilibrium: number of its limit stress in `limits`
    int equilibrium = -1;    ///< and of that equilibrium
    ContactId limit_contact; ///< whose force vanishes there
    bool proved = false;     ///< the program's own certificate of the arc (level `arcs`)
};

struct ReferencePath {
    std::vector<ReferenceArc> arcs;
    std::vector<LimitReference> limits;
    std::vector<EquilibriumRecord> equilibria;
    std::vector<State> states;
    std::string stopped; ///< why it ends before the equilibria asked for
    double worst_bound = 0, worst_limit_bound = 0;
    double lowest_gap = 0; ///< smallest gap of a pair that is not a contact, at the true ends / smallest radius
    double lowest_force = 0;
    int certified = 0; ///< arcs certified by the program
    int skipped = 0;   ///< arcs left out
};

namespace path_parts {

/// Smallest gap of a pair that is no contact at q, in 320 bits where it is small in double.
inline double lowest_gap(const Packing& near, const std::vector<Reference>& q, const std::vector<Contact>& contacts) {
    const ContactEquations<Reference> equations(near, contacts, q);
    double lowest = 1;
    const auto candidates = find_candidates(near, 0.5).contacts;
    for (const Contact& c : candidates) {
        if (std::ranges::find(contacts, c) == contacts.end()) {
            double h = gap(near, c) / near.min_radius();
            if (h < 1e-6) {
                h = static_cast<double>(equations.value(c)) / near.min_radius();
            }
            lowest = std::min(lowest, h);
        }
    }
    return lowest;
}

} // namespace path_parts

/// Loads `start` over `equilibria` rearrangements at level `arcs` and polishes every event. From the first arc of a
/// rearrangement that ends at a power turn (no contact closes there, a coordinate is held) to the next equilibrium the
/// arcs are left out.
inline ReferencePath reference_path(const State& start, int equilibria) {
    ReferencePath path;
    crafted::Recorder records;
    State state = start;
    RunOptions options{.certify = CertifyLevel::arcs};
    RunCounters counters;
    const SegmentOutcome outcome = run_segment(state, towards(equilibria), 0, options, counters, records);
    if (outcome.failure) {
        path.stopped = outcome.failure->message();
    }
    path.equilibria = records.equilibria;
    path.states = records.states;
    if (records.equilibria.empty() || records.equilibria[0].arcs != 0) {
        path.stopped = "the start is no equilibrium";
        return path;
    }
    path.lowest_gap = 1;
    Packing here = records.states[0].packing;
    std::vector<Contact> contacts = records.states[0].contacts;
    int equilibrium = -1; // that the next arc starts from, or that its rearrangement started from
    bool skip = false;
    for (std::size_t a = 0; a < records.arcs.size(); ++a) {
        const ArcRecord& record = records.arcs[a];
        if (record.kind == isostat::ArcKind::limit) {
            ++equilibrium;
            const auto number = static_cast<std::size_t>(equilibrium);
            here = records.states[number].packing;
            contacts = records.states[number].contacts;
            skip = false;
        }
        skip = skip || record.power_turn;
        if (skip) {
            ++path.skipped;
            continue;
        }
        ReferenceArc arc;
        arc.start = here;
        arc.contacts = contacts;
        arc.opened = ContactId(static_cast<std::size_t>(std::ranges::find(contacts, record.opened) - contacts.begin()));
        arc.infinitesimal = record.kind == isostat::ArcKind::rattler;
        arc.at_limit = record.kind == isostat::ArcKind::limit;
        arc.load = start.load;
        arc.load.stress[1] = record.stress;
        arc.closed = record.closed;
        arc.proved = record.certificate && record.certificate->verdict == Verdict::proved;
        contacts[arc.opened.index()] = record.closed;
        arc.end_contacts = contacts;
        auto structure = IsostaticStructure::prove(here, arc.contacts);
        if (!structure.ok()) {
            path.stopped = structure.failure().message();
            break;
        }
        const Factorisation factorisation(structure.value());
        CandidateList candidates = find_candidates(here, candidate_fraction);
        ArcOptions arc_options;
        arc_options.closes = record.closed;
        const PowerLoad power{&arc.load, arc.infinitesimal, arc.at_limit};
        auto followed =
            follow_arc(ArcOrigin{here, structure.value(), factorisation, arc.opened}, power, candidates, arc_options);
        if (!followed.ok() || followed.value().closed != record.closed) {
            path.stopped = "arc " + std::to_string(a + 1) + " was not followed again";
            break;
        }
        here = followed.value().end;
        auto polished = polish(here, std::vector<Reference>(here.q.begin(), here.q.end()), contacts, 1e-93);
        const VertexCertificate certificate = certify_vertex(here, polished.q, contacts);
        if (!certificate.proved()) {
            path.stopped = "no certificate at the end of arc " + std::to_string(a + 1);
            break;
        }
        arc.end = std::move(polished.q);
        arc.bound = certificate.radius;
        path.worst_bound = std::max(path.worst_bound, arc.bound);
        path.lowest_gap = std::min(path.lowest_gap, path_parts::lowest_gap(here, arc.end, contacts));
        path.certified += arc.proved ? 1 : 0;
        const bool last_of_rearrangement =
            a + 1 < records.arcs.size() && records.arcs[a + 1].kind == isostat::ArcKind::limit;
        if (last_of_rearrangement) {
            Load load = arc.load;
            const auto unit = load.unit_force(here);
            const auto fixed = load.fixed_force(here);
            const auto l =
                static_cast<std::size_t>(std::ranges::find(contacts, records.arcs[a + 1].opened) - contacts.begin());
            const LimitReference limit = certified_limit(here, arc.end, certificate, contacts, fixed, unit, l);
            arc.limit = static_cast<int>(path.limits.size());
            arc.equilibrium = equilibrium + 1;
            arc.limit_contact = ContactId(l);
            path.limits.push_back(limit);
            path.worst_limit_bound = std::max(path.worst_limit_bound, limit.bound);
            path.lowest_force = std::min(path.lowest_force, limit.lowest);
        }
        path.arcs.push_back(std::move(arc));
    }
    return path;
}

} // namespace isostat::oracle
