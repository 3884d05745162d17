#include "exact/rank.hpp"
#include "rigidity/rigid_group.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

namespace isostat {

namespace {

/// R_i + R_j exactly: the rounded sum and its error (Knuth).
std::pair<double, double> length_of_bar(const std::vector<double>& radius, int i, int j) {
    const double a = radius[static_cast<std::size_t>(i)];
    const double b = radius[static_cast<std::size_t>(j)];
    const double sum = a + b;
    const double part = sum - a;
    return {sum, (a - (sum - part)) + (b - part)};
}

/// Classes of edges that turn by one angle, in equal or opposite sense; an edge opposite to itself does not turn.
class Turning {
  public:
    explicit Turning(std::size_t edges) : parent_(edges), against_(edges, false), fixed_(edges, false) {
        std::iota(parent_.begin(), parent_.end(), std::size_t{0});
    }
    void join(std::size_t a, std::size_t b, bool against) {
        const auto [one, mine] = root(a);
        const auto [other, its] = root(b);
        const bool opposite = (mine != its) != against;
        if (one == other) {
            fixed_[one] = fixed_[one] || opposite;
            return;
        }
        parent_[one] = other;
        against_[one] = opposite;
        fixed_[other] = fixed_[other] || fixed_[one];
    }
    void fix(std::size_t a) { fixed_[root(a).first] = true; }
    /// Number of free angles.
    [[nodiscard]] int count() const {
        int free = 0;
        for (std::size_t e = 0; e < parent_.size(); ++e) {
            free += parent_[e] == e && !fixed_[e] ? 1 : 0;
        }
        return free;
    }

  private:
    [[nodiscard]] std::pair<std::size_t, bool> root(std::size_t e) const {
        bool against = false;
        while (parent_[e] != e) {
            against = against != against_[e];
            e = parent_[e];
        }
        return {e, against};
    }
    std::vector<std::size_t> parent_;
    std::vector<bool> against_; ///< relative to the parent
    std::vector<bool> fixed_;   ///< of the roots of the classes
};

/// Disks and walls as nodes, touching pairs as edges, and the cycles that close for all angles of the classes.
class Linkage {
  public:
    Linkage(const Packing& packing, const std::vector<Contact>& touching)
        : packing_(packing), disks_(packing.disk_count()), touching_(touching), turning_(touching.size()) {
        assert(packing.dimension == plane);
        for (std::size_t e = 0; e < touching.size(); ++e) {
            for (const auto& [from, to] : {ends(e), std::pair{ends(e).second, ends(e).first}}) {
                adjacent_[from][to] = e;
            }
            if (!touching[e].of_disks()) {
                turning_.fix(e); // the normal of a wall does not turn
            }
        }
        for (const auto& [node, neighbours] : adjacent_) {
            node < disks_ ? find_cells(node) : find_cells_at_wall(node);
        }
    }
    /// Dimension of the motions in which classes turn and connected pieces move, if all cycles close; else -1.
    [[nodiscard]] int motions() const {
        int count = turning_.count();
        for (int axis = 0; axis < plane; ++axis) {
            const int pieces = pieces_that_move(axis);
            if (pieces < 0) {
                return -1;
            }
            count += pieces;
        }
        return count;
    }
    /// Degrees of freedom of the grains.
    [[nodiscard]] int free() const {
        int count = 0;
        for (const auto& [node, neighbours] : adjacent_) {
            count += node < disks_ ? plane : is_ground(node) ? 0 : 1;
        }
        return count;
    }

  private:
    /// A closed path: edges, ascending, with the direction of each; valid along one axis, or along all (`plane`).
    struct Cell {
        int axis;
        std::vector<std::pair<std::size_t, int>> way;
    };

    [[nodiscard]] int axis_of(int wall) const { return (wall - disks_) / 2; }
    [[nodiscard]] bool is_ground(int wall) const {
        const auto axis = static_cast<std::size_t>(axis_of(wall));
        return (wall - disks_) % 2 == 0 || packing_.walls.upper[axis] != WallKind::movable;
    }
    [[nodiscard]] std::pair<int, int> ends(std::size_t e) const {
        const Contact& c = touching_[e];
        return {c.i, c.of_disks() ? c.j : disks_ + static_cast<int>(c.wall_number())};
    }
    [[nodiscard]] bool touch(int a, int b) const { return adjacent_.at(a).count(b) != 0; }
    [[nodiscard]] std::size_t edge(int a, int b) const { return adjacent_.at(a).at(b); }
    [[nodiscard]] auto bar(int i, int j) const { return length_of_bar(packing_.radius, i, j); }

    void add_cell(int axis, const std::vector<int>& nodes) {
        Cell cell{axis, {}};
        for (std::size_t k = 0; k < nodes.size(); ++k) {
            const int from = nodes[k];
            const int to = nodes[(k + 1) % nodes.size()];
            cell.way.emplace_back(edge(from, to), from < to ? 1 : -1);
        }
        std::ranges::sort(cell.way);
        cells_.push_back(std::move(cell));
    }

    /// Finds triangles and parallelograms in which i is the disk of lowest number.
    void find_cells(int i) {
        for (const auto& [j, first] : adjacent_.at(i)) {
            for (const auto& [l, last] : adjacent_.at(i)) {
                if (j >= disks_ || l >= disks_ || j <= i || l <= j) {
                    continue;
                }
                if (touch(j, l)) {
                    turning_.join(first, last, false);
                    turning_.join(first, edge(j, l), false);
                    add_cell(plane, {i, j, l});
                }
                for (const auto& [k, second] : adjacent_.at(j)) {
                    if (k > i && k < disks_ && k != l && touch(k, l) && bar(i, j) == bar(k, l) &&
                        bar(j, k) == bar(l, i)) {
                        turning_.join(first, edge(k, l), false);
                        turning_.join(second, last, false);
                        add_cell(plane, {i, j, k, l});
                    }
                }
            }
        }
    }

    /// Finds cells at a wall: two of its disks that touch each other, or two of equal size that touch a third disk.
    void find_cells_at_wall(int w) {
        for (const auto& [i, at_i] : adjacent_.at(w)) {
            for (const auto& [j, at_j] : adjacent_.at(w)) {
                if (j <= i) {
                    continue;
                }
                if (touch(i, j)) {
                    turning_.fix(edge(i, j));
                    add_cell(axis_of(w), {w, i, j});
                }
                for (const auto& [k, at_k] : adjacent_.at(i)) {
                    if (k < disks_ && touch(k, j) && bar(i, i) == bar(j, j)) {
                        turning_.join(edge(i, k), edge(j, k), true);
                        add_cell(axis_of(w), {w, i, k, j});
                    }
                }
            }
        }
    }

    /// Number of pieces free to move along an axis, if the cells make up all cycles; else -1.
    [[nodiscard]] int pieces_that_move(int axis) const {
        const auto takes_part = [&](std::size_t e) {
            return ends(e).second < disks_ || axis_of(ends(e).second) == axis;
        };
        std::map<int, int> piece; // a node to another node of its piece
        const auto root = [&piece](int node) {
            while (piece.at(node) != node) {
                node = piece.at(node);
            }
            return node;
        };
        for (const auto& [node, neighbours] : adjacent_) {
            if (node < disks_ || axis_of(node) == axis) {
                piece.emplace(node, node);
            }
        }
        int pieces = static_cast<int>(piece.size());
        int edges = 0;
        for (std::size_t e = 0; e < touching_.size(); ++e) {
            if (takes_part(e)) {
                ++edges;
                const int from = root(ends(e).first);
                const int to = root(ends(e).second);
                pieces -= from != to ? 1 : 0;
                piece[from] = to;
            }
        }
        int ground = 0;
        for (const auto& [node, neighbours] : adjacent_) {
            ground += node >= disks_ && axis_of(node) == axis && is_ground(node) ? 1 : 0;
        }
        const int cycles = edges - static_cast<int>(piece.size()) + pieces;
        return ground > 1 || rank_of_cells(axis) < cycles ? -1 : pieces - ground;
    }

    /// Rank modulo a prime: a lower bound of the rank, which is at most the number of cycles.
    [[nodiscard]] int rank_of_cells(int axis) const {
        sparse::Matrix<std::uint64_t> matrix;
        matrix.rows = static_cast<int>(touching_.size());
        matrix.start.push_back(0);
        for (const Cell& cell : cells_) {
            if (cell.axis != plane && cell.axis != axis) {
                continue;
            }
            for (const auto& [e, direction] : cell.way) {
                matrix.row.push_back(static_cast<int>(e));
                matrix.value.push_back(direction > 0 ? 1 : exact::mersenne61 - 1);
            }
            matrix.start.push_back(static_cast<int>(matrix.row.size()));
            ++matrix.cols;
        }
        return matrix.cols == 0 ? 0 : exact::rank(matrix);
    }

    const Packing& packing_;
    int disks_;
    const std::vector<Contact>& touching_;
    std::map<int, std::map<int, std::size_t>> adjacent_; ///< the edges by their two ends
    Turning turning_;
    std::vector<Cell> cells_;
};

} // namespace

bool moves_as_linkage(const Packing& packing, const std::vector<Contact>& among, const Contact& pair) {
    std::vector<Contact> all = among;
    all.push_back(pair);
    const auto stands = [&packing](int i) { return packing.is_fixed(DiskId(static_cast<std::size_t>(i))); };
    const auto foreign = [&](const Contact& c) {
        return c.kind == ContactKind::held || stands(c.i) || (c.of_disks() && (c.i == c.j || stands(c.j)));
    };
    if (std::ranges::any_of(all, foreign)) {
        return false;
    }
    const auto touching = unwound(packing.disk_count(), std::move(all));
    if (!touching) {
        return false;
    }
    const Linkage linkage(packing, *touching);
    const int motions = linkage.motions();
    return motions >= 0 && motions == linkage.free() - static_cast<int>(among.size());
}

} // namespace isostat
