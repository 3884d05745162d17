#pragma once
/// \file
/// Makes the records of equilibria and arcs: private to the room.

#include "trajectory/vertex.hpp"

#include <isostat/motion/arc.hpp>
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

/// The smallest gap at the true vertex of a description, into its record: `about` is the gap as it was decided.
template <int Dim>
void record_smallest_gap(Description<Dim>& description, const Packing<Dim>& packing, const Contact& where,
                         double about);

/// eps_2 at the end of an arc, with its bound.
template <int Dim> void record_strain(ArcRecord<Dim>& record, const Vertex<Dim>& end, const Load<Dim>& load);

/// What the path tells, into the record of an arc.
template <int Dim> void record_path(ArcRecord<Dim>& record, const Arc<Dim>& path);

/// Disks without a force-carrying contact.
template <int Dim> std::vector<int> rattlers(const Vertex<Dim>& vertex);

/// The finite forces at the load, one per contact.
template <int Dim> std::vector<double> finite_forces(const Vertex<Dim>& vertex, const Load<Dim>& load);

extern template Result<Description<2>> describe<2>(Vertex<2>&, const Load<2>&);
extern template void record_smallest_gap<2>(Description<2>&, const Packing<2>&, const Contact&, double);
extern template void record_strain<2>(ArcRecord<2>&, const Vertex<2>&, const Load<2>&);
extern template void record_path<2>(ArcRecord<2>&, const Arc<2>&);
extern template std::vector<int> rattlers<2>(const Vertex<2>&);
extern template std::vector<double> finite_forces<2>(const Vertex<2>&, const Load<2>&);

} // namespace isostat
