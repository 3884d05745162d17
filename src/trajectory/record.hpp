#pragma once
/// \file
/// Makes the records of equilibria and arcs: private to the room.

#include "motion/arc.hpp"
#include "trajectory/vertex.hpp"

#include <isostat/trajectory/records.hpp>

#include <array>
#include <optional>

namespace isostat {

template <int Dim> struct Description {
    EquilibriumRecord<Dim> record;
    std::array<std::optional<LoadLimit>, 2> limit; ///< lower and upper end; none while a coordinate is held
    VertexEnclosure vertex;                        ///< as near to the true one as is known
};

/// Everything that follows from the vertex and its load: counts, supported interval, bounds, residuals. The numbers of
/// the run (number, segment, arcs, seconds) are left to the caller. Failure: a limit of the supported interval is not
/// decided, or a check fails.
template <int Dim> Result<Description<Dim>> describe(Vertex<Dim>& vertex, const Load<Dim>& load);

/// The smallest gap of all pairs that are not contacts, at the true vertex `at`, into a record; infinity and i = -1
/// where there is no such pair. No gap is negative there. `candidates`: saves the search where they tell. Failure: in a
/// cell the nearest pair is too many periods away to be found.
template <int Dim>
std::optional<Failure> record_smallest_gap(EquilibriumRecord<Dim>& record, const Vertex<Dim>& vertex,
                                           const VertexEnclosure& at, const CandidateList<Dim>& candidates);

/// What holds of every equilibrium, looked at once more: no two grains overlap by more than the uncertainty of the
/// stored configuration, all pairs included; the contacts that carry force are as many as the degrees of freedom of the
/// grains that do. Failure: `overlap`, `undecided`.
template <int Dim>
std::optional<Failure> check_equilibrium(const EquilibriumRecord<Dim>& record, const Vertex<Dim>& vertex,
                                         const Load<Dim>& load, const CandidateList<Dim>& candidates);

/// eps_2 at the end of an arc, with its bound.
template <int Dim> void record_strain(ArcRecord<Dim>& record, const Vertex<Dim>& end, const Load<Dim>& load);

/// What the path tells, into the record of an arc.
template <int Dim> void record_path(ArcRecord<Dim>& record, const Arc<Dim>& path);

/// Disks without a force-carrying contact.
template <int Dim> std::vector<int> rattlers(const Vertex<Dim>& vertex);

/// The finite forces at the load, one per contact.
template <int Dim> std::vector<double> finite_forces(const Vertex<Dim>& vertex, const Load<Dim>& load);

extern template Result<Description<2>> describe<2>(Vertex<2>&, const Load<2>&);
extern template std::optional<Failure> record_smallest_gap<2>(EquilibriumRecord<2>&, const Vertex<2>&,
                                                              const VertexEnclosure&, const CandidateList<2>&);
extern template std::optional<Failure> check_equilibrium<2>(const EquilibriumRecord<2>&, const Vertex<2>&,
                                                            const Load<2>&, const CandidateList<2>&);
extern template void record_strain<2>(ArcRecord<2>&, const Vertex<2>&, const Load<2>&);
extern template void record_path<2>(ArcRecord<2>&, const Arc<2>&);
extern template std::vector<int> rattlers<2>(const Vertex<2>&);
extern template std::vector<double> finite_forces<2>(const Vertex<2>&, const Load<2>&);

} // namespace isostat
