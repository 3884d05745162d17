#include "contact/regular_triangulation.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_cell_base_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <algorithm>
#include <cassert>

namespace isostat {

std::optional<std::vector<std::pair<int, int>>> regular_edges_in_space(const Packing& packing) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertex =
        CGAL::Triangulation_vertex_base_with_info_3<int, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>;
    using Structure = CGAL::Triangulation_data_structure_3<Vertex, CGAL::Regular_triangulation_cell_base_3<Kernel>>;
    using Triangulation = CGAL::Regular_triangulation_3<Kernel, Structure>;

    assert(packing.axes() == most_axes);
    std::vector<std::pair<Kernel::Weighted_point_3, int>> spheres;
    spheres.reserve(packing.radius.size());
    for (int i = 0; i < packing.disk_count(); ++i) {
        const double* const x = &packing.q[packing.layout().of_disk(i)];
        const double radius = packing.radius[static_cast<std::size_t>(i)];
        spheres.emplace_back(Kernel::Weighted_point_3(Kernel::Point_3(x[0], x[1], x[2]), radius * radius), i);
    }
    const Triangulation triangulation(spheres.begin(), spheres.end()); // sorts them in space
    if (triangulation.number_of_vertices() != spheres.size()) {        // without hidden spheres and copies
        return std::nullopt;
    }
    std::vector<std::pair<int, int>> edges;
    for (const auto& [cell, first, second] : triangulation.finite_edges()) {
        edges.push_back(std::minmax({cell->vertex(first)->info(), cell->vertex(second)->info()}));
    }
    return edges;
}

} // namespace isostat
