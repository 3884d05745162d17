#include <isostat/core/error.hpp>
#include <isostat/packing/packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isostat {

namespace {

constexpr std::array<const char*, 3> axis_name{"x", "y", "z"};
constexpr std::array<const char*, 3> upper_name{"right wall", "top wall", "front wall"};

} // namespace

template <int Dim> Walls<Dim> Walls<Dim>::box() {
    Walls walls;
    walls.lower.fill(WallKind::fixed);
    walls.upper.fill(WallKind::movable);
    return walls;
}

template <int Dim> Walls<Dim> Walls<Dim>::none() {
    Walls walls;
    walls.lower.fill(WallKind::absent);
    walls.upper.fill(WallKind::absent);
    return walls;
}

template <int Dim> double Packing<Dim>::min_radius() const {
    return *std::min_element(radius.begin(), radius.end());
}
template <int Dim> double Packing<Dim>::max_radius() const {
    return *std::max_element(radius.begin(), radius.end());
}

template <int Dim> double Packing<Dim>::solid_fraction() const {
    static_assert(Dim == 2);
    double area = 0;
    for (const double r : radius) {
        area += std::numbers::pi * r * r;
    }
    return area / (length(0) * length(1));
}

template <int Dim>
DofMap<Dim>::DofMap(const Packing<Dim>& packing) : disks_(packing.disk_count()), dof_of_(packing.q.size(), -1) {
    coordinate_of_.reserve(packing.q.size());
    const auto add = [&](std::size_t coordinate) {
        dof_of_[coordinate] = static_cast<int>(coordinate_of_.size());
        coordinate_of_.push_back(static_cast<int>(coordinate));
    };
    for (int i = 0; i < disks_; ++i) {
        for (int a = 0; a < Dim && !packing.is_fixed(DiskId(i)); ++a) {
            add(static_cast<std::size_t>(Dim * i + a));
        }
    }
    for (int a = 0; a < Dim; ++a) {
        if (packing.walls.upper[static_cast<std::size_t>(a)] == WallKind::movable) {
            add(static_cast<std::size_t>(Dim * disks_ + a));
        }
    }
}

template <int Dim> std::string DofMap<Dim>::name(int dof) const {
    const int coordinate = coordinate_of(dof);
    const auto axis = static_cast<std::size_t>(coordinate % Dim);
    const int disk = coordinate / Dim;
    return disk == disks_ ? std::string(upper_name[axis]) : fmt::format("{} of disk {}", axis_name[axis], disk);
}

template <int Dim> void validate(const Packing<Dim>& packing, const std::string& source) {
    const auto bad = [&](const std::string& what) { throw Error(ErrorKind::bad_input, source + ": " + what); };
    if (packing.radius.empty()) {
        bad("no disks: a packing needs at least one disk");
    }
    if (packing.q.size() != static_cast<std::size_t>(Dim) * (packing.radius.size() + 1)) {
        bad(fmt::format("{} coordinates for {} disks: expected {}", packing.q.size(), packing.radius.size(),
                        static_cast<std::size_t>(Dim) * (packing.radius.size() + 1)));
    }
    if (!packing.fixed.empty() && packing.fixed.size() != packing.radius.size()) {
        bad(fmt::format("{} flags 'fixed' for {} disks", packing.fixed.size(), packing.radius.size()));
    }
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        const double r = packing.radius[i];
        if (!(r >= shortest_length && r <= longest_length)) {
            bad(fmt::format("radius of disk {} is {}: expected a positive finite number from {} to {}", i, r,
                            shortest_length, longest_length));
        }
        for (std::size_t a = 0; a < Dim; ++a) {
            const double x = packing.q[Dim * i + a];
            if (!(std::abs(x) <= longest_length)) {
                bad(fmt::format("{} of disk {} is {}: expected a finite number of size at most {}", axis_name[a], i, x,
                                longest_length));
            }
        }
    }
    for (std::size_t a = 0; a < Dim; ++a) {
        if (packing.walls.upper[a] == WallKind::absent) {
            continue;
        }
        const double length = packing.length(static_cast<int>(a));
        if (!(std::abs(length) <= longest_length) || (packing.walls.lower[a] != WallKind::absent && !(length > 0))) {
            bad(fmt::format("position of the {} is {}: expected a positive finite number of at most {}", upper_name[a],
                            length, longest_length));
        }
        if (packing.walls.lower[a] == WallKind::absent) {
            continue;
        }
        for (std::size_t i = 0; i < packing.radius.size(); ++i) {
            // 2R > L beyond one rounding of L: the disk cannot fit, whatever the configuration.
            if (2 * packing.radius[i] > length * (1 + 1e-9)) {
                bad(fmt::format("disk {} of diameter {} is larger than the box: its length along {} is {}", i,
                                2 * packing.radius[i], axis_name[a], length));
            }
        }
    }
}

template <int Dim> double grid_step(const Packing<Dim>& packing) {
    double largest = 0;
    const std::size_t disks = Dim * packing.radius.size();
    for (std::size_t k = 0; k < packing.q.size(); ++k) {
        if (k < disks || packing.walls.upper[k - disks] != WallKind::absent) {
            largest = std::max(largest, std::abs(packing.q[k]));
        }
    }
    int exponent = 0;
    const double mantissa = std::frexp(largest, &exponent);
    if (mantissa == 0.5) {
        --exponent; // an exact power of two is its own bound
    }
    return std::ldexp(1.0, exponent - 52);
}

template <int Dim> double snap_to_grid(Packing<Dim>& packing) {
    // With |x| <= 2^e, x +- 2^e away from 0 lies in the binade whose spacing is the step, 2^(e-52): the sum is rounded
    // to nearest there, and the difference is exact.
    const double shift = std::ldexp(grid_step(packing), 52);
    double moved = 0;
    if (!std::isfinite(2 * shift)) {
        return moved;
    }
    const auto snap = [shift, &moved](double& x) {
        const double away = std::copysign(shift, x);
        const double shifted = x + away;
        const double snapped = shifted - away;
        moved = std::max(moved, std::abs(snapped - x));
        x = snapped;
    };
    const std::size_t disks = packing.radius.size();
    for (std::size_t i = 0; i < disks; ++i) {
        for (std::size_t a = 0; a < Dim && !packing.is_fixed(DiskId(i)); ++a) {
            snap(packing.q[Dim * i + a]);
        }
    }
    for (std::size_t a = 0; a < Dim; ++a) {
        if (packing.walls.upper[a] == WallKind::movable) {
            snap(packing.q[Dim * disks + a]);
        }
    }
    return moved;
}

template struct Walls<2>;
template struct Packing<2>;
template class DofMap<2>;
template void validate<2>(const Packing<2>&, const std::string&);
template double snap_to_grid<2>(Packing<2>&);
template double grid_step<2>(const Packing<2>&);

} // namespace isostat
