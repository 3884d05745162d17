#include "contact/gap_sign.hpp"

#include <isostat/contact/candidates.hpp>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using VertexBase =
    CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<VertexBase, CGAL::Regular_triangulation_face_base_2<Kernel>>;
using Triangulation = CGAL::Regular_triangulation_2<Kernel, Structure>;

/// Overlap, in units of the smallest radius, up to which the edges are still complete: C4 needs the overlaps to be
/// below one hundredth of the slack between 0.82 and 2 (sqrt 2 - 1); 1e-9 leaves seven orders.
constexpr double tolerated_overlap = 1e-9;

Contact disk_pair(int i, int j) {
    return {ContactKind::disk_disk, std::min(i, j), std::max(i, j)};
}

/// Edges of the regular triangulation with weights R^2; empty optional-like flag when a vertex is hidden.
struct Edges {
    std::vector<Contact> pairs;
    bool hidden = false;
};

template <int Dim> Edges triangulation_edges(const Packing<Dim>& packing) {
    static_assert(Dim == 2);
    std::vector<std::pair<Triangulation::Weighted_point, int>> points;
    points.reserve(packing.radius.size());
    for (int i = 0; i < packing.disk_count(); ++i) {
        const double r = packing.radius[static_cast<std::size_t>(i)];
        points.emplace_back(
            Triangulation::Weighted_point(
                Kernel::Point_2(packing.coordinate(DiskId(i), 0), packing.coordinate(DiskId(i), 1)), r * r),
            i);
    }
    Triangulation triangulation(points.begin(), points.end());
    Edges edges;
    edges.hidden = triangulation.number_of_vertices() != points.size();
    if (edges.hidden) {
        return edges;
    }
    edges.pairs.reserve(3 * points.size());
    for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end(); ++edge) {
        const int i = edge->first->vertex(Triangulation::cw(edge->second))->info();
        const int j = edge->first->vertex(Triangulation::ccw(edge->second))->info();
        edges.pairs.push_back(disk_pair(i, j));
    }
    return edges;
}

/// Every pair with gap < reach, whatever overlaps: disks sorted into square cells of side 2 R_max + reach.
template <int Dim> std::vector<Contact> pairs_by_cells(const Packing<Dim>& packing, double reach) {
    static_assert(Dim == 2);
    const double side = (2 * packing.max_radius() + reach) * (1 + 1e-9);
    struct Entry {
        std::array<double, 2> cell;
        int disk;
    };
    std::vector<Entry> entries;
    for (int i = 0; i < packing.disk_count(); ++i) {
        entries.push_back(
            {{std::floor(packing.coordinate(DiskId(i), 0) / side), std::floor(packing.coordinate(DiskId(i), 1) / side)},
             i});
    }
    const auto before = [](const Entry& a, const Entry& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.disk < b.disk;
    };
    std::sort(entries.begin(), entries.end(), before);
    std::vector<Contact> pairs;
    for (const Entry& entry : entries) {
        for (double ox = -1; ox <= 1; ++ox) {
            const Entry low{{entry.cell[0] + ox, entry.cell[1] - 1}, -1};
            for (auto other = std::lower_bound(entries.begin(), entries.end(), low, before);
                 other != entries.end() && other->cell[0] == low.cell[0] && other->cell[1] <= entry.cell[1] + 1;
                 ++other) {
                if (other->disk > entry.disk && gap(packing, disk_pair(entry.disk, other->disk)) < reach) {
                    pairs.push_back(disk_pair(entry.disk, other->disk));
                }
            }
        }
    }
    return pairs;
}

template <int Dim> void append_walls(const Packing<Dim>& packing, double reach, std::vector<Contact>& contacts) {
    for (int a = 0; a < Dim; ++a) {
        const auto axis = static_cast<std::size_t>(a);
        for (int i = 0; i < packing.disk_count(); ++i) {
            for (const auto& [kind, wall] : {std::pair{ContactKind::lower_wall, packing.walls.lower[axis]},
                                             std::pair{ContactKind::upper_wall, packing.walls.upper[axis]}}) {
                const Contact contact{kind, i, a};
                if (wall != WallKind::absent && gap(packing, contact) < reach) {
                    contacts.push_back(contact);
                }
            }
        }
    }
}

/// The disk pairs with gap < reach: from the triangulation when its hypotheses hold, else by cells.
template <int Dim> std::vector<Contact> complete_pairs(const Packing<Dim>& packing, double reach) {
    Edges edges = triangulation_edges(packing);
    const double overlap = -tolerated_overlap * packing.min_radius();
    bool usable = !edges.hidden;
    std::vector<Contact> near;
    for (std::size_t e = 0; e < edges.pairs.size() && usable; ++e) {
        const double h = gap(packing, edges.pairs[e]);
        usable = h >= overlap;
        if (h < reach) {
            near.push_back(edges.pairs[e]);
        }
    }
    return usable ? near : pairs_by_cells(packing, reach);
}

} // namespace

template <int Dim> bool CandidateList<Dim>::covers(const Packing<Dim>& packing) const {
    if (reference.size() != packing.q.size()) {
        return false;
    }
    for (std::size_t k = 0; k + Dim <= packing.q.size(); k += Dim) {
        double square = 0;
        for (std::size_t a = 0; a < Dim; ++a) {
            const double d = packing.q[k + a] - reference[k + a];
            square += d * d;
        }
        if (!(2 * std::sqrt(square) * (1 + 1e-14) < reach)) {
            return false;
        }
    }
    return true;
}

template <int Dim> CandidateList<Dim> find_candidates(const Packing<Dim>& packing, double fraction) {
    CandidateList<Dim> list;
    list.reach = std::min(fraction, 0.82) * packing.min_radius();
    list.reference = packing.q;
    list.contacts = complete_pairs(packing, list.reach);
    append_walls(packing, list.reach, list.contacts);
    std::sort(list.contacts.begin(), list.contacts.end());
    return list;
}

template <int Dim> Admissibility certify_admissible(const Packing<Dim>& packing, double allowance) {
    // The list holds every pair with gap < 0.4 R_min (C4, or unconditionally by cells); each of them is then decided
    // exactly.
    std::vector<Contact> near = complete_pairs(packing, 0.4 * packing.min_radius());
    append_walls(packing, 0.4 * packing.min_radius(), near);
    Admissibility result;
    result.verdict = Verdict::proved;
    result.worst_gap = std::numeric_limits<double>::infinity();
    for (const Contact& contact : near) {
        const double h = gap(packing, contact);
        if (h < result.worst_gap) {
            result.worst_gap = h;
            result.worst = contact;
        }
    }
    for (const Contact& contact : near) {
        if (sign_of_gap_plus(packing, contact, allowance) < 0) {
            result.verdict = Verdict::refuted;
            result.worst = contact;
            result.worst_gap = gap(packing, contact);
            break;
        }
    }
    return result;
}

template struct CandidateList<2>;
template CandidateList<2> find_candidates<2>(const Packing<2>&, double);
template Admissibility certify_admissible<2>(const Packing<2>&, double);

} // namespace isostat
