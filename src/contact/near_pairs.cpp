#include "contact/near_pairs.hpp"

#include "contact/pair_distance.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_vertex_base_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

namespace isostat {

namespace {

constexpr double u = 0x1p-53;

// Constants of proofs/contact_candidates.md, section "Rounded weights". Disks shrunk by the common shift 0.002 R_min^2
// of their weights have exactly the power diagram of the rounded weights; an edge may overlap by half of what that
// shift allows.
constexpr double edge_overlap = 0.0005;    // times R_min^2 (1/R_i + 1/R_j)
constexpr double largest_ratio = 1e5;      // beyond it the rounding of R_max^2 is not small against the shift
constexpr double largest_length = 1e100;   // squares neither overflow
constexpr double smallest_length = 1e-100; // nor underflow

/// \pre `distances_are_plain`.
Distance measure(const Packing<2>& packing, std::size_t i, std::size_t j) {
    const double dx = packing.q[2 * j] - packing.q[2 * i];
    const double dy = packing.q[2 * j + 1] - packing.q[2 * i + 1];
    return distance_of(dx * dx + dy * dy, packing.radius[i] + packing.radius[j]);
}

/// The same for any lengths: hypot neither overflows nor underflows, and its error is below 1 ulp.
Distance measure_any(const Packing<2>& packing, std::size_t i, std::size_t j) {
    const double distance =
        std::hypot(packing.q[2 * j] - packing.q[2 * i], packing.q[2 * j + 1] - packing.q[2 * i + 1]);
    return distance_between(distance, packing.radius[i] + packing.radius[j]);
}

} // namespace

bool distances_are_plain(const Packing<2>& packing) {
    return packing.min_radius() >= smallest_length && packing.max_radius() <= largest_length &&
           std::all_of(packing.q.begin(), packing.q.end(),
                       [](double x) { return std::abs(x) <= largest_length; }); // also false for a NaN
}

// Buckets by the first disk, each a few pairs long.
void sort_pairs(std::vector<Contact>& pairs, std::size_t disk_count) {
    std::vector<std::size_t> end(disk_count + 1, 0);
    for (const Contact& pair : pairs) {
        ++end[static_cast<std::size_t>(pair.i) + 1];
    }
    std::partial_sum(end.begin(), end.end(), end.begin());
    std::vector<Contact> sorted(pairs.size());
    std::vector<std::size_t> next(end.begin(), end.end() - 1);
    for (const Contact& pair : pairs) {
        sorted[next[static_cast<std::size_t>(pair.i)]++] = pair;
    }
    for (std::size_t i = 0; i < disk_count; ++i) {
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(end[i]),
                  sorted.begin() + static_cast<std::ptrdiff_t>(end[i + 1]));
    }
    pairs = std::move(sorted);
}

template <>
std::optional<std::vector<Contact>> near_pairs_by_triangulation<2>(const Packing<2>& packing, double reach) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Vertex =
        CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>;
    using Structure = CGAL::Triangulation_data_structure_2<Vertex, CGAL::Regular_triangulation_face_base_2<Kernel>>;
    using Triangulation = CGAL::Regular_triangulation_2<Kernel, Structure>;

    const double smallest = packing.min_radius();
    const double largest = packing.max_radius();
    if (!distances_are_plain(packing) || largest > largest_ratio * smallest) {
        return std::nullopt;
    }
    std::vector<std::pair<Triangulation::Weighted_point, int>> points;
    points.reserve(packing.radius.size());
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        points.emplace_back(Triangulation::Weighted_point({packing.q[2 * i], packing.q[2 * i + 1]},
                                                          packing.radius[i] * packing.radius[i]),
                            static_cast<int>(i));
    }
    const Triangulation triangulation(points.begin(), points.end());
    if (triangulation.number_of_hidden_vertices() != 0) {
        return std::nullopt;
    }
    std::vector<Contact> pairs;
    pairs.reserve(3 * points.size());
    for (const auto& [face, opposite] : triangulation.finite_edges()) {
        const int a = face->vertex(Triangulation::ccw(opposite))->info();
        const int b = face->vertex(Triangulation::cw(opposite))->info();
        const auto i = static_cast<std::size_t>(std::min(a, b));
        const auto j = static_cast<std::size_t>(std::max(a, b));
        const Distance d = measure(packing, i, j);
        if (!(d.gap >= -edge_overlap * smallest * (smallest / packing.radius[i] + smallest / packing.radius[j]))) {
            return std::nullopt;
        }
        if (d.gap - d.error < reach) {
            pairs.push_back({ContactKind::disk_disk, static_cast<int>(i), static_cast<int>(j)});
        }
    }
    sort_pairs(pairs, packing.radius.size());
    return pairs;
}

template <> std::vector<Contact> near_pairs_by_sweep<2>(const Packing<2>& packing, double reach) {
    const std::size_t n = packing.radius.size();
    std::vector<std::pair<double, std::size_t>> left(n);
    double extent = reach;
    for (std::size_t i = 0; i < n; ++i) {
        left[i] = {packing.q[2 * i] - packing.radius[i], i};
        extent = std::max({extent, std::abs(packing.q[2 * i]) + packing.radius[i], std::abs(packing.q[2 * i + 1])});
    }
    std::sort(left.begin(), left.end());
    const double slack = reach + 16 * u * extent;
    std::vector<Contact> pairs;
    for (std::size_t a = 0; a < n; ++a) {
        const std::size_t i = left[a].second;
        const double right = packing.q[2 * i] + packing.radius[i] + slack;
        for (std::size_t b = a + 1; b < n && left[b].first <= right; ++b) {
            const std::size_t j = left[b].second;
            if (std::abs(packing.q[2 * j + 1] - packing.q[2 * i + 1]) > packing.radius[i] + packing.radius[j] + slack) {
                continue; // apart along the other axis already
            }
            const Distance d = measure_any(packing, i, j);
            if (d.gap - d.error < reach) {
                pairs.push_back(
                    {ContactKind::disk_disk, static_cast<int>(std::min(i, j)), static_cast<int>(std::max(i, j))});
            }
        }
    }
    sort_pairs(pairs, n);
    return pairs;
}

template <int Dim> std::vector<Contact> near_pairs(const Packing<Dim>& packing, double reach) {
    assert(reach > 0 && reach <= 0.82 * (1 + 2 * u) * packing.min_radius());
    if (auto pairs = near_pairs_by_cells(packing, reach)) {
        return std::move(*pairs);
    }
    if (auto pairs = near_pairs_by_triangulation(packing, reach)) {
        return std::move(*pairs);
    }
    return near_pairs_by_sweep(packing, reach);
}

template std::vector<Contact> near_pairs<2>(const Packing<2>&, double);

} // namespace isostat
