#pragma once
/// \file
/// Makes the records of equilibria and arcs: private to the room.

#include "motion/arc.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/trajectory/records.hpp>

#include <array>
#include <optional>

namespace isostat {

struct Description {
    EquilibriumRecord record;
    std::array<std::optional<LoadLimit>, 2> limit; ///< lower and upper end; empty while a coordinate is held
    VertexEnclosure vertex;                        ///< the best enclosure that is known
};

/// The record of a vertex under its load: counts, supported interval, bounds,
/// residuals. The numbers of the run (number, segment, arcs, seconds) are left to the
/// caller. Failure: a limit of the supported interval is not decided, or a check fails.
Result<Description> describe(Vertex& vertex, const Load& load);

/// Writes into a record the smallest gap of all pairs that are not contacts, at the true vertex `at`; infinity and i =
/// -1 where there is no such pair. No gap is negative there. `candidates` make a search unnecessary where their reach
/// suffices. Failure: in a cell the nearest pair is too many periods away to be found.
std::optional<Failure> record_smallest_gap(EquilibriumRecord& record, const Vertex& vertex, const VertexEnclosure& at,
                                           const CandidateList& candidates);

/// A second check of every equilibrium: no two grains overlap by more than the uncertainty of the stored configuration,
/// all pairs included. Failure: `overlap`.
std::optional<Failure> check_no_overlap(const Vertex& vertex, const Load& load, const CandidateList& candidates);

/// Writes eps_2 at the end of an arc, with its bound.
void record_strain(ArcRecord& record, const Vertex& end, const Load& load);

/// Writes what the followed path determines in the record of an arc.
void record_path(ArcRecord& record, const Arc& path);

/// Some held coordinate bears a finite force. A held coordinate that bears none, by counting, is a free motion of a
/// clump, which hangs from the one contact that it has (proofs/clumps.md, U2).
bool holds_what_bears(const Vertex& vertex);

/// Number of contacts that bear a finite force, without bars.
int carrying_contacts(const Vertex& vertex);

/// Disks that carry no force.
std::vector<int> rattlers(const Vertex& vertex);

/// The finite forces at the load, one per contact.
std::vector<double> finite_forces(const Vertex& vertex, const Load& load);

} // namespace isostat
