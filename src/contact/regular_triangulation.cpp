#include "contact/regular_triangulation.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_face_base_2.h>
#include <CGAL/Regular_triangulation_vertex_base_2.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <cassert>
#include <utility>

// exact: all other numbers of this file: corners of a face

namespace isostat {

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Disk = Kernel::Weighted_point_2;

/// The disks, and after them the four outer ones, counter-clockwise: at
/// least 3 R_max from every centre along each axis in spite of rounding.
std::vector<Disk> weighted_points(const Packing& packing) {
    std::vector<Disk> points;
    points.reserve(packing.radius.size() + 4); // 4: contact_candidates.md Four disks far outside
    std::array<double, 2> low{packing.q[0], packing.q[1]};
    std::array<double, 2> high = low;
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        const double x = packing.q[2 * i];
        const double y = packing.q[2 * i + 1];
        low = {std::min(low[0], x), std::min(low[1], y)};
        high = {std::max(high[0], x), std::max(high[1], y)};
        points.emplace_back(Kernel::Point_2(x, y), packing.radius[i] * packing.radius[i]);
    }
    const double extent = std::max(high[0] - low[0], high[1] - low[1]);
    const double largest = std::max({-low[0], -low[1], high[0], high[1]});
    // contact_candidates.md Four disks far outside
    const double away = extent + 4 * packing.max_radius() + 0x1p-40 * largest;
    const double weight = packing.min_radius() * packing.min_radius();
    points.emplace_back(Kernel::Point_2(low[0] - away, low[1] - away), weight);
    points.emplace_back(Kernel::Point_2(high[0] + away, low[1] - away), weight);
    points.emplace_back(Kernel::Point_2(high[0] + away, high[1] + away), weight);
    points.emplace_back(Kernel::Point_2(low[0] - away, high[1] + away), weight);
    return points;
}

} // namespace

RegularTriangulation::Shared RegularTriangulation::build(const Packing& packing) {
    using Vertex =
        CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>;
    using FaceBase =
        CGAL::Triangulation_face_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_face_base_2<Kernel>>;
    using Triangulation = CGAL::Regular_triangulation_2<Kernel, CGAL::Triangulation_data_structure_2<Vertex, FaceBase>>;

    std::vector<std::pair<Disk, int>> points;
    for (const Disk& disk : weighted_points(packing)) {
        points.emplace_back(disk, static_cast<int>(points.size()));
    }
    const Triangulation triangulation(points.begin(), points.end()); // sorts them in space
    if (triangulation.number_of_vertices() != points.size()) {       // hidden disks and copies are not counted
        return nullptr;
    }
    for (const auto face : triangulation.all_face_handles()) {
        face->info() = -1;
    }
    int count = 0;
    for (const auto face : triangulation.finite_face_handles()) {
        face->info() = count++;
    }
    auto made = std::make_shared<RegularTriangulation>();
    made->disks_ = packing.disk_count();
    made->faces_.reserve(static_cast<std::size_t>(count));
    for (const auto face : triangulation.finite_face_handles()) {
        Face& copy = made->faces_.emplace_back();
        for (int k = 0; k < 3; ++k) {
            copy.vertex[static_cast<std::size_t>(k)] = face->vertex(k)->info();
            copy.neighbour[static_cast<std::size_t>(k)] = face->neighbor(k)->info();
        }
    }
    assert(count == 2 * packing.disk_count() + 2); // the hull is the rectangle
    return made;
}

/// Flips edges until every one is regular.
class RegularTriangulation::Mover {
  public:
    Mover(const RegularTriangulation& from, const Packing& packing)
        : faces_(&from.faces_), points_(weighted_points(packing)) {}

    /// Finds the faces with doubtful edges. False: a face has turned over.
    bool find_doubtful() {
        for (std::size_t f = 0; f < faces_->size(); ++f) {
            const Face& face = (*faces_)[f];
            if (!counter_clockwise(face.vertex[0], face.vertex[1], face.vertex[2])) {
                return false;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                if (face.neighbour[k] > static_cast<int>(f) && !regular(face, k)) {
                    doubtful_.push_back(static_cast<int>(f));
                    break;
                }
            }
        }
        return true;
    }
    [[nodiscard]] bool any_doubtful() const { return !doubtful_.empty(); }

    /// Every edge whose last test did not succeed is one of a face in `doubtful_`. False: no flip is possible.
    bool flip(std::vector<Face>& faces) {
        faces_ = &faces;
        while (!doubtful_.empty()) {
            const int f = doubtful_.back();
            doubtful_.pop_back();
            for (std::size_t k = 0; k < 3; ++k) {
                const Face& face = faces[static_cast<std::size_t>(f)];
                const int g = face.neighbour[k];
                if (g < 0 || regular(face, k)) {
                    continue;
                }
                if (!flip(faces, f, k)) {
                    return false;
                }
                doubtful_.push_back(f);
                doubtful_.push_back(g);
                break;
            }
        }
        return true;
    }

  private:
    [[nodiscard]] const Disk& point(int vertex) const { return points_[static_cast<std::size_t>(vertex)]; }
    [[nodiscard]] bool counter_clockwise(int a, int b, int c) const {
        return orientation_(point(a).point(), point(b).point(), point(c).point()) == CGAL::LEFT_TURN;
    }
    /// The vertex of the neighbouring face opposite to edge k.
    [[nodiscard]] std::size_t mirror(const Face& face, std::size_t k) const {
        const Face& other = (*faces_)[static_cast<std::size_t>(face.neighbour[k])];
        std::size_t m = 0;
        while (other.vertex[(m + 2) % 3] != face.vertex[(k + 1) % 3]) {
            ++m;
        }
        return m;
    }
    /// Whether the lifted point beyond edge k is not below the plane of the face. \pre such a point exists.
    [[nodiscard]] bool regular(const Face& face, std::size_t k) const {
        const int beyond = (*faces_)[static_cast<std::size_t>(face.neighbour[k])].vertex[mirror(face, k)];
        return side_(point(face.vertex[0]), point(face.vertex[1]), point(face.vertex[2]), point(beyond)) !=
               CGAL::ON_POSITIVE_SIDE;
    }
    /// Faces (a, b, c) and (d, c, b) become (a, b, d) and (a, d, c). False: these would not be counter-clockwise.
    bool flip(std::vector<Face>& faces, int f, std::size_t k) {
        const Face one = faces[static_cast<std::size_t>(f)];
        const int g = one.neighbour[k];
        const std::size_t m = mirror(one, k);
        const Face other = faces[static_cast<std::size_t>(g)];
        const int a = one.vertex[k];
        const int b = one.vertex[(k + 1) % 3];
        const int c = one.vertex[(k + 2) % 3];
        const int d = other.vertex[m];
        if (!counter_clockwise(a, b, d) || !counter_clockwise(a, d, c)) {
            return false;
        }
        const int beyond_ab = one.neighbour[(k + 2) % 3];
        const int beyond_ca = one.neighbour[(k + 1) % 3];
        const int beyond_bd = other.neighbour[(m + 1) % 3];
        const int beyond_dc = other.neighbour[(m + 2) % 3];
        faces[static_cast<std::size_t>(f)] = {{a, b, d}, {beyond_bd, g, beyond_ab}};
        faces[static_cast<std::size_t>(g)] = {{a, d, c}, {beyond_dc, beyond_ca, f}};
        replace(faces, beyond_bd, g, f);
        replace(faces, beyond_ca, f, g);
        return true;
    }
    static void replace(std::vector<Face>& faces, int of, int was, int is) {
        if (of >= 0) {
            std::array<int, 3>& neighbour = faces[static_cast<std::size_t>(of)].neighbour;
            *std::ranges::find(neighbour, was) = is;
        }
    }

    const std::vector<Face>* faces_;
    std::vector<Disk> points_;
    std::vector<int> doubtful_;
    Kernel::Orientation_2 orientation_;
    Kernel::Power_side_of_oriented_power_circle_2 side_;
};

RegularTriangulation::Shared RegularTriangulation::carry(const Shared& from, const Packing& packing) {
    assert(from->disks_ == packing.disk_count());
    Mover mover(*from, packing);
    if (!mover.find_doubtful()) {
        return nullptr;
    }
    if (!mover.any_doubtful()) {
        return from;
    }
    auto moved = std::make_shared<RegularTriangulation>(*from);
    return mover.flip(moved->faces_) ? moved : nullptr;
}

} // namespace isostat
