#include "motion/kept_curve.hpp"

#include "contact/separation.hpp"
#include "motion/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace isostat {

template <int Dim>
KeptCurve<Dim>::KeptCurve(const Packing<Dim>& start_packing, std::vector<Contact> list, std::size_t slot_index,
                          double rest)
    : start(&start_packing), contacts(std::move(list)), slot(slot_index), dofs(start_packing),
      smallest(std::numeric_limits<double>::infinity()), rest_radius(rest) {
    const std::size_t disks = start->radius.size();
    std::vector<int> count(disks, 0);
    std::vector<int> at_rest(disks + Dim, 0);
    double most_at_rest = 0;
    target.resize(contacts.size());
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        const auto i = static_cast<std::size_t>(c.i);
        const auto j = static_cast<std::size_t>(c.j);
        target[l] = touching_distance(start->radius, c);
        if (l == slot) {
            continue;
        }
        if (c.kind == ContactKind::disk_disk) {
            smallest = std::min(smallest, target[l]);
            for (const std::size_t k : {i, j}) {
                (start->is_fixed(DiskId(k)) ? at_rest : count)[k]++;
            }
        } else if (c.kind == ContactKind::upper_wall) {
            at_rest[disks + j] += start->walls.upper[j] == WallKind::movable ? 0 : 1;
        }
    }
    degree = count.empty() ? 0 : *std::max_element(count.begin(), count.end());
    most_at_rest = *std::max_element(at_rest.begin(), at_rest.end());
    if (std::isfinite(smallest)) {
        lipschitz = 2 * std::sqrt(std::max(degree, 1.0)) / smallest * up;
    }
    const double weight = std::sqrt(most_at_rest) * rest_radius;
    rest_residual = 1.01 * weight * up;
    rest_derivative = std::isfinite(smallest) ? weight / smallest * up : 0;
}

template <int Dim> double KeptCurve<Dim>::norm_of(const std::vector<double>& e) const {
    // |B|^2 = largest eigenvalue of B^T B <= max_i (B^T B x)_i / x_i for every positive x (Collatz, Wielandt).
    std::vector<double> x(start->radius.size(), 1.0);
    std::vector<double> z(x.size());
    double best = std::numeric_limits<double>::infinity();
    for (int round = 0; round < 6; ++round) {
        std::fill(z.begin(), z.end(), 0.0);
        for (std::size_t l = 0; l < contacts.size(); ++l) {
            if (e[l] == 0) {
                continue;
            }
            const auto i = static_cast<std::size_t>(contacts[l].i);
            const auto j = static_cast<std::size_t>(contacts[l].j);
            const bool i_moves = !start->is_fixed(DiskId(i));
            const bool j_moves = !start->is_fixed(DiskId(j));
            const double y = e[l] * e[l] * ((i_moves ? x[i] : 0) + (j_moves ? x[j] : 0));
            z[i] += i_moves ? y : 0;
            z[j] += j_moves ? y : 0;
        }
        double ratio = 0;
        double most = 0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            ratio = std::max(ratio, z[i] / x[i]);
            most = std::max(most, z[i]);
        }
        best = std::min(best, ratio);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] = z[i] + 1e-3 * most + 1e-300;
        }
    }
    return std::sqrt(best) * up;
}

template struct KeptCurve<2>;

} // namespace isostat
