// T7p: in channels and in cells whose tilt moves, coordinates and radii follow every change of the gaps; in rectangles
// they do not, and the lemma about one triangle on which this rests.
#include "support/cells.hpp"

#include <isostat/exact/number.hpp>

namespace {

using isostat::Contact;
using isostat::ContactKind;
using isostat::State;
using isostat::exact::Number;
using isostat::exact::NumberMatrix;

/// Disks with exact coordinates; the second ones in units of `height`, which may be irrational.
struct ExactCell {
    State state;
    Number height = 1;
    [[nodiscard]] Number x(int disk) const {
        return Number::from_double(state.packing.q[2 * static_cast<std::size_t>(disk)]);
    }
    [[nodiscard]] Number y(int disk) const {
        return height * Number::from_double(state.packing.q[2 * static_cast<std::size_t>(disk) + 1]);
    }
};

/// What moves besides the disks and the radii.
struct Free {
    bool x, y, tilt, radii;
};

/// Derivative of the gaps times |r|: one column per contact.
NumberMatrix derivative(const ExactCell& cell, const Free& free) {
    const auto& packing = cell.state.packing;
    const int n = packing.disk_count();
    NumberMatrix matrix;
    matrix.rows = 3 * n + 3;
    for (const Contact& c : cell.state.contacts) {
        std::vector<Number> entry(static_cast<std::size_t>(matrix.rows));
        const auto add = [&](int row, const Number& value) { entry[static_cast<std::size_t>(row)] += value; };
        const auto radius = [&](int disk) {
            return Number::from_double(packing.radius[static_cast<std::size_t>(disk)]);
        };
        if (c.kind == ContactKind::disk_disk) {
            const Number mx = c.image.m[0], my = c.image.m[1];
            const Number rx = cell.x(c.j) - cell.x(c.i) + mx * Number::from_double(packing.lattice(0, 0)) +
                              my * Number::from_double(packing.lattice(0, 1));
            const Number ry = cell.y(c.j) - cell.y(c.i) + my * cell.height * Number::from_double(packing.lattice(1, 1));
            const Number reach = radius(c.i) + radius(c.j);
            BOOST_TEST((rx * rx + ry * ry - reach * reach).is_zero());
            for (const auto& [disk, sign] : {std::pair(c.j, 1), {c.i, -1}}) {
                add(2 * disk, Number(sign) * rx);
                add(2 * disk + 1, Number(sign) * ry);
                add(2 * n + disk, free.radii ? -reach : Number(0));
            }
            add(3 * n, free.x ? rx * mx : Number(0));
            add(3 * n + 1, free.y ? ry * my : Number(0));
            add(3 * n + 2, free.tilt ? rx * my : Number(0));
        } else { // bottom or top wall
            const bool top = c.kind == ContactKind::upper_wall;
            add(2 * c.i + 1, Number(top ? -1 : 1));
            add(2 * n + c.i, free.radii ? Number(-1) : Number(0));
            add(3 * n + 1, top && free.y ? Number(1) : Number(0));
        }
        auto& column = matrix.column.emplace_back();
        for (std::size_t row = 0; row < entry.size(); ++row) {
            if (!entry[row].is_zero()) {
                column.emplace_back(static_cast<int>(row), entry[row]);
            }
        }
    }
    return matrix;
}

/// N - rank, proved.
int missing(const ExactCell& cell, const Free& free) {
    const auto kernel = isostat::exact::kernel(derivative(cell, free));
    BOOST_TEST((kernel.exact == isostat::Verdict::proved));
    return static_cast<int>(cell.state.contacts.size()) - kernel.rank;
}

constexpr Free tilted{true, true, true, true};
constexpr Free rectangle{true, true, false, true};
constexpr Free fixed_cell{false, false, false, true};
constexpr Free top_wall{false, true, false, true}; // the period of a channel does not move

ExactCell triangles(int columns, int rows) {
    ExactCell cell{cells::triangular_lattice(columns, rows / 2, true), Number::parse("sqrt(3)/2")};
    auto& q = cell.state.packing.q;
    const std::size_t n = cell.state.packing.radius.size();
    for (std::size_t i = 0; i < n; ++i) {
        q[2 * i + 1] = static_cast<double>(i / static_cast<std::size_t>(columns));
    }
    q[2 * n + 1] = rows;
    return cell;
}

/// `rows` rows of it between walls, which are half a diameter beyond.
ExactCell strip_of_triangles(int columns, int rows) {
    ExactCell cell = triangles(columns, 2 * ((rows + 1) / 2));
    auto& packing = cell.state.packing;
    const int n = columns * rows;
    std::vector<Contact> kept;
    std::ranges::copy_if(cell.state.contacts, std::back_inserter(kept),
                         [n](const Contact& c) { return c.image.m[1] == 0 && c.j < n && c.i < n; });
    const double tilts = packing.q.back(), period = packing.length(0);
    packing.radius.resize(static_cast<std::size_t>(n));
    packing.q.resize(2 * static_cast<std::size_t>(n));
    packing.q.insert(packing.q.end(), {period, 0, tilts});
    for (int i = 0; i < columns; ++i) {
        kept.push_back(::crafted::bottom(i));
        kept.push_back(::crafted::top(n - 1 - i));
    }
    cell.state.contacts = kept;
    return cell;
}

} // namespace

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_in_cells_with_a_tilt_and_not_in_rectangles) {
    for (const auto& [columns, rows] : {std::pair(2, 2), {3, 2}, {3, 4}, {4, 4}, {5, 6}}) {
        BOOST_TEST_INFO_SCOPE(columns << " x " << rows);
        const ExactCell cell = triangles(columns, rows); // N = 3n: the most there are
        BOOST_TEST(missing(cell, tilted) == 0);
        BOOST_TEST(missing(cell, rectangle) == 1);
        BOOST_TEST(missing(cell, fixed_cell) == 2);
        BOOST_TEST(missing(cell, {true, true, true, false}) == columns * rows - 1);
    }
    for (int m = 1; m <= 5; ++m) {
        ExactCell squares{cells::square_lattice(m, true)};
        BOOST_TEST(missing(squares, tilted) == 0);
        BOOST_TEST(missing(squares, rectangle) == 0);
        BOOST_TEST(missing(squares, fixed_cell) == 1);
    }
}

BOOST_AUTO_TEST_CASE(two_disks_of_a_centred_rectangle_for_many_radii) {
    // X = 9/8, Y = 3/2, D = 15/8: dyadic, and images apart for radii from 3/4 to 9/8.
    for (const double radius : {0.75, 0.875, 0.9375, 1.0, 1.109375}) {
        const State state = cells::in_cell({{radius, 0, 0}, {1.875 - radius, 1.125, 1.5}}, {2.25, 3, 0}, true, 1, 1,
                                           cells::two_disks(true, 1, 1).contacts);
        BOOST_TEST(missing({state}, tilted) == 0);
        BOOST_TEST(missing({state}, rectangle) == 1);
    }
}

BOOST_AUTO_TEST_CASE(radii_and_coordinates_follow_every_gap_in_channels) {
    for (const auto& [columns, rows] : {std::pair(1, 1), {2, 1}, {2, 2}, {3, 3}, {4, 2}, {3, 5}}) {
        BOOST_TEST_INFO_SCOPE(columns << " x " << rows);
        const ExactCell cell = strip_of_triangles(columns, rows);
        BOOST_TEST(static_cast<int>(cell.state.contacts.size()) == 3 * columns * rows);
        BOOST_TEST(missing(cell, top_wall) == 0); // 3n + 1 coordinates less a translation: the most there are
        BOOST_TEST(missing(cell, fixed_cell) == 1);
    }
}

BOOST_AUTO_TEST_CASE(angles_tell_radii_of_which_inversive_distances_are_given) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    int triangles = 0, outside = 0;
    while (triangles < 20000) {
        std::array<double, 3> radius{}, inversive{}; // those of the side opposite to k
        for (std::size_t k = 0; k < 3; ++k) {
            radius[k] = std::exp(4 * uniform(random) - 2);
            inversive[k] = std::exp(8 * uniform(random) - 4);
        }
        std::array<double, 3> square{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double a = radius[(k + 1) % 3], b = radius[(k + 2) % 3];
            square[k] = a * a + b * b + 2 * inversive[k] * a * b;
        }
        const std::array<double, 3> side{std::sqrt(square[0]), std::sqrt(square[1]), std::sqrt(square[2])};
        if (2 * *std::ranges::max_element(side) > 0.999 * (side[0] + side[1] + side[2])) {
            continue;
        }
        ++triangles;
        // a_k of the side opposite to k: d angle_i / d ln R_j = a_k, here from the lengths alone.
        std::array<double, 3> weight{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            const auto angle = [&](double grown) { // at i, with R_j times exp(grown)
                const double r = radius[j] * std::exp(grown);
                const double ij = radius[i] * radius[i] + r * r + 2 * inversive[k] * radius[i] * r;
                const double jk = radius[k] * radius[k] + r * r + 2 * inversive[i] * radius[k] * r;
                return std::acos((ij + square[j] - jk) / (2 * std::sqrt(ij * square[j])));
            };
            constexpr double step = 1e-5;
            weight[k] = (angle(step) - angle(-step)) / (2 * step);
        }
        const double pairs = weight[0] * weight[1] + weight[1] * weight[2] + weight[2] * weight[0];
        BOOST_TEST_REQUIRE(pairs > -1e-9);
        BOOST_TEST_REQUIRE(weight[0] + weight[1] + weight[2] > 0);
        outside += *std::ranges::min_element(weight) < 0 ? 1 : 0;
    }
    BOOST_TEST(outside > 1000); // the radical centre need not be in the triangle
}
