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
    std::array<std::optional<LoadLimit>, 2> limit; ///< lower and upper end; none while a coordinate is held
    VertexEnclosure vertex;                        ///< as near to the true one as is known
};

/// Everything that follows from the vertex and its load: counts, supported interval, bounds, residuals. The numbers of
/// the run (number, segment, arcs, seconds) are left to the caller. Failure: a limit of the supported interval is not
/// decided, or a check fails.
Result<Description> describe(Vertex& vertex, const Load& load);

/// The smallest gap of all pairs that are not contacts, at the true vertex `at`, into a record; infinity and i = -1
/// where there is no such pair. No gap is negative there. `candidates`: saves the search where they tell. Failure: in a
/// cell the nearest pair is too many periods away to be found.
std::optional<Failure> record_smallest_gap(EquilibriumRecord& record, const Vertex& vertex, const VertexEnclosure& at,
                                           const CandidateList& candidates);

/// What holds of every equilibrium, looked at once more: no two grains overlap by more than the uncertainty of the
/// stored configuration, all pairs included. Failure: `overlap`.
std::optional<Failure> check_no_overlap(const Vertex& vertex, const Load& load, const CandidateList& candidates);

/// eps_2 at the end of an arc, with its bound.
void record_strain(ArcRecord& record, const Vertex& end, const Load& load);

/// What the path tells, into the record of an arc.
void record_path(ArcRecord& record, const Arc& path);

/// Some held coordinate bears a finite force. What is held and bears nothing, by counting, is a free motion of a clump:
/// a part that hangs below the one contact that it has (proofs/clumps.md, U2).
bool holds_what_bears(const Vertex& vertex);

/// Rows that bear a finite force, without bars.
int carrying_contacts(const Vertex& vertex);

/// Disks without a force-carrying contact.
std::vector<int> rattlers(const Vertex& vertex);

/// The finite forces at the load, one per contact.
std::vector<double> finite_forces(const Vertex& vertex, const Load& load);

} // namespace isostat
