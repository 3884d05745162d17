#include "motion/kept_curve.hpp"

#include "contact/separation.hpp"
#include "motion/rounding.hpp"
#include "verified/vertex_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

KeptCurve::KeptCurve(const Packing& start_packing, std::vector<Contact> list, std::size_t slot_index, double rest)
    : start(&start_packing), contacts(std::move(list)), slot(slot_index), dofs(start_packing),
      smallest(std::numeric_limits<double>::infinity()), rest_radius(rest) {
    const std::size_t disks = start->radius.size();
    std::vector<int> count(disks, 0);
    std::vector<int> at_rest(disks + start->axes(), 0);
    double most_at_rest = 0;
    target.resize(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        target[l] = zero_distance(*start, c);
        if (l == slot) {
            continue;
        }
        if (c.of_disks()) {
            smallest = std::min(smallest, target[l]);
            for (const std::size_t k : {i, j}) {
                (start->is_fixed(DiskId(k)) ? at_rest : count)[k]++;
            }
        } else if (c.is_wall() && c.wall().at_length) {
            at_rest[disks + j] += start->walls.of(c) == WallKind::movable ? 0 : 1;
        }
    }
    find_blocks();
    if (start->cell.any()) {
        bound_in_cell();
        return;
    }
    const double degree = count.empty() ? 0 : *std::max_element(count.begin(), count.end());
    spread = 2 * std::max(degree, 1.0);
    most_at_rest = *std::max_element(at_rest.begin(), at_rest.end());
    if (std::isfinite(smallest)) {
        lipschitz = 2 * std::sqrt(std::max(degree, 1.0)) / smallest * upward;
    }
    bound_rest(most_at_rest, 1);
}

void KeptCurve::find_blocks() {
    const Cell& cell = start->cell;
    const auto moves = [](const auto& flags) { return std::find(flags.begin(), flags.end(), true) != flags.end(); };
    const bool cell_moves = moves(cell.period_moves) || moves(cell.tilt_moves);
    blocks.resize(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        for (const int disk : {c.i, c.j}) {
            if (bends(l) && c.i != c.j && !start->is_fixed(DiskId(disk))) {
                blocks[l].add(static_cast<std::size_t>(disk), 1);
            }
        }
        if (bends(l) && cell_moves && !c.image.is_here()) {
            blocks[l].add(start->radius.size(), cell_weight(c) * upward);
        }
    }
}

/// C5 and A7 (proofs/cells.md, C11): sums over the blocks that move, and over those at rest.
void KeptCurve::bound_in_cell() {
    const std::size_t disks = start->radius.size();
    std::vector<double> squares(disks + 1, 0.0);
    std::vector<double> fourths(disks + 1, 0.0);
    std::vector<double> at_rest(disks + 1, 0.0);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const double w = separation_weight_square(c);
        const double a = cell_weight(c);
        for (std::size_t b = 0; b < blocks[l].count; ++b) {
            squares[blocks[l].at[b]] += w;
            fourths[blocks[l].at[b]] += w * w / (target[l] * target[l]);
        }
        if (c.is_wall() && c.wall().at_length && start->walls.of(c) == WallKind::fixed) {
            at_rest[disks] += 1;
        }
        if (!bends(l)) {
            continue;
        }
        for (const int disk : {c.i, c.j}) {
            at_rest[static_cast<std::size_t>(disk)] += start->is_fixed(DiskId(disk)) ? 1 + a * a : 0;
        }
        at_rest[disks] += c.image.is_here() ? 0 : 1 + a * a;
    }
    spread = std::max(2.0, *std::max_element(squares.begin(), squares.end())) * upward;
    lipschitz = std::sqrt(*std::max_element(fourths.begin(), fourths.end())) * upward;
    bound_rest(*std::max_element(at_rest.begin(), at_rest.end()), root2);
}

/// `heaviest`: sum of the squares of what a block at rest does; `row`: 2-norm of the signs in a row of moving disks.
void KeptCurve::bound_rest(double heaviest, double row) {
    const double weight = std::sqrt(heaviest) * rest_radius;
    rest_residual = 1.01 * weight * upward; // arcs.md A7 (and cells.md C11)
    rest_derivative = std::isfinite(smallest) ? row * weight / smallest * upward : 0;
}

double KeptCurve::norm_of(const std::vector<double>& e) const {
    // |B|^2 = largest eigenvalue of B^T B <= max_i (B^T B x)_i / x_i for every positive x (Collatz, Wielandt).
    std::vector<double> x(start->radius.size() + (start->cell.any() ? 1 : 0), 1.0);
    std::vector<double> z(x.size());
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 6; ++round) { // cost: positive vectors tried (arcs.md A2)
        std::fill(z.begin(), z.end(), 0.0);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (e[l] == 0) {
                continue;
            }
            const Blocks& row = blocks[l];
            double sum = 0;
            for (std::size_t b = 0; b < row.count; ++b) {
                sum += row.weight[b] * x[row.at[b]];
            }
            const double y = e[l] * e[l] * sum;
            for (std::size_t b = 0; b < row.count; ++b) {
                z[row.at[b]] += row.weight[b] * y;
            }
        }
        double ratio = 0;
        double most = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            ratio = std::max(ratio, z[i] / x[i]);
            most = std::max(most, z[i]);
        }
        best = std::min(best, ratio);
        for (std::size_t i = 0; i < x.size(); ++i) {
            // 1e-3: guess: positive vector; 1e-300: guess: positive vector (arcs.md A2)
            x[i] = z[i] + 1e-3 * most + 1e-300;
        }
    }
    return std::sqrt(best) * upward;
}

} // namespace isostat
