#pragma once
// Jammed packings of few disks in periodic cells: soft disks that relax under dead forces on the cell, then Newton.

#include "contradictions/piles.hpp"
#include "support/cells.hpp"
#include "support/prepared.hpp"

namespace contradictions {

enum class CellKind { rectangular, tilted, channel };

struct CellOptions {
    CellKind kind = CellKind::rectangular;
    std::vector<double> radii;
    std::array<double, 2> force{1, 1}; ///< on the periods, or the movable wall
    double shear_force = 0;            ///< on the tilt
    double fixed_length = 0;           ///< along x; 0: it moves
};

namespace detail {

/// Soft disks of stiffness 1, pressed by a thousandth of `force`.
class SoftCell {
  public:
    static constexpr double pressure = 1e-3;

    explicit SoftCell(const CellOptions& options, Random& random) : options_(options) {
        auto& p = packing;
        p.radius = options.radii;
        const double side = 2.2 * p.max_radius() + 0.8 * std::sqrt(static_cast<double>(p.radius.size()));
        for (std::size_t k = 0; k < 2 * p.radius.size(); ++k) {
            p.q.push_back(random.real(0, side));
        }
        const bool tilted = options.kind == CellKind::tilted;
        p.q.insert(p.q.end(), {side, side, tilted ? side * random.real(-0.4, 0.4) : 0});
        p.walls = isostat::Walls::none();
        const bool channel = options.kind == CellKind::channel;
        const auto walled = static_cast<std::size_t>(random.integer(2));
        p.cell = {{true, true}, {true, true}, {tilted}, random.integer(p.disk_count())};
        if (channel) {
            p.cell.periodic[walled] = p.cell.period_moves[walled] = false;
            p.walls.lower[walled] = WallKind::fixed;
            p.walls.upper[walled] = WallKind::movable;
        }
        if (options.fixed_length > 0) {
            p.cell.period_moves[0] = false;
            p.q[p.length_at(0)] = options.fixed_length;
        }
        velocity_.assign(p.q.size(), 0.0);
    }

    /// FIRE. False: not at rest in the end, or the cell is sheared too far.
    bool relax() {
        double step = 0.1, mix = 0.1;
        int downhill = 0;
        for (int iteration = 0; iteration < 8'000; ++iteration) {
            const std::vector<double> force = forces();
            double power = 0, speed = 0, size = 0, largest = 0;
            for (std::size_t k = 0; k < force.size(); ++k) {
                power += force[k] * velocity_[k];
                speed += velocity_[k] * velocity_[k];
                size += force[k] * force[k];
                largest = std::max(largest, std::abs(force[k]));
            }
            const auto& p = packing;
            if (largest < 1e-4 * pressure) {
                return true;
            }
            if (std::abs(p.lattice(0, 1)) > 1.5 * p.lattice(0, 0) || p.lattice(0, 0) < 0.5 * p.min_radius()) {
                return false;
            }
            downhill = power > 0 ? downhill + 1 : 0;
            if (downhill > 5) {
                step = std::min(1.1 * step, 0.7);
                mix *= 0.99;
            } else if (downhill == 0) {
                step *= 0.5;
                mix = 0.1;
            }
            const double turn = power > 0 ? mix * std::sqrt(speed / size) : 0;
            for (std::size_t k = 0; k < force.size(); ++k) {
                velocity_[k] = power > 0 ? (1 - mix) * velocity_[k] + turn * force[k] : 0;
                velocity_[k] += step * force[k];
                packing.q[k] += std::clamp(step * velocity_[k], -0.05, 0.05);
            }
        }
        return false;
    }

    /// visit(contact, overlap, direction from the first to the second).
    template <class Visit> void overlaps(Visit visit) const {
        const auto& p = packing;
        const double lx = p.lattice(0, 0), ly = p.lattice(1, 1), tilt = p.lattice(0, 1);
        const int across = p.cell.periodic[0] ? 3 : 0;
        const int up = p.cell.periodic[1] ? 3 : 0;
        for (int i = 0; i < p.disk_count(); ++i) {
            const auto x = static_cast<std::size_t>(2 * i);
            const double r = p.radius[x / 2];
            for (int j = i; j < p.disk_count(); ++j) {
                const auto y = static_cast<std::size_t>(2 * j);
                const double down = up > 0 ? std::round((p.q[y + 1] - p.q[x + 1]) / ly) : 0;
                const double left =
                    across > 0 ? std::round((p.q[y] - p.q[x] - tilt * (p.q[y + 1] - p.q[x + 1]) / ly) / lx) : 0;
                for (int m = -across; m <= across; ++m) {
                    for (int k = -up; k <= up; ++k) {
                        const auto a = static_cast<std::int8_t>(m - left);
                        const auto b = static_cast<std::int8_t>(k - down);
                        const Contact pair(ContactKind::disk_disk, i, j, {{a, b, 0}});
                        if (i == j && !(pair.image > isostat::Image{})) {
                            continue;
                        }
                        const double dx = p.q[y] - p.q[x] + a * lx + b * tilt;
                        const double dy = p.q[y + 1] - p.q[x + 1] + b * ly;
                        const double touching = r + p.radius[y / 2];
                        if (dx * dx + dy * dy < touching * touching) {
                            const double d = std::hypot(dx, dy);
                            visit(pair, touching - d, std::array<double, 2>{dx / d, dy / d});
                        }
                    }
                }
            }
            for (int a = 0; a < 2; ++a) {
                const auto axis = static_cast<std::size_t>(a);
                std::array<double, 2> normal{0, 0};
                if (p.walls.lower[axis] == WallKind::fixed && p.q[x + axis] < r) {
                    normal[axis] = -1;
                    visit(Contact{ContactKind::lower_wall, i, a}, r - p.q[x + axis], normal);
                }
                if (p.walls.upper[axis] == WallKind::movable && p.length(a) - p.q[x + axis] < r) {
                    normal[axis] = 1;
                    visit(Contact{ContactKind::upper_wall, i, a}, r - (p.length(a) - p.q[x + axis]), normal);
                }
            }
        }
    }

    Packing packing;

  private:
    [[nodiscard]] std::vector<double> forces() const {
        const auto& p = packing;
        std::vector<double> force(p.q.size(), 0.0);
        const std::size_t cell = p.length_at(0);
        overlaps([&](const Contact& c, double overlap, const std::array<double, 2>& n) {
            const auto i = static_cast<std::size_t>(2 * c.i);
            const auto j = static_cast<std::size_t>(2 * c.j);
            for (std::size_t a = 0; a < 2; ++a) {
                force[i + a] -= overlap * n[a];
                if (c.kind == ContactKind::disk_disk) {
                    force[j + a] += overlap * n[a];
                    force[cell + a] += overlap * n[a] * c.image.m[a];
                } else if (c.kind == ContactKind::upper_wall) {
                    force[cell + a] += overlap * n[a];
                }
            }
            if (c.kind == ContactKind::disk_disk) {
                force[cell + 2] += overlap * n[0] * c.image.m[1];
            }
        });
        force[cell] -= pressure * options_.force[0];
        force[cell + 1] -= pressure * options_.force[1];
        force[cell + 2] -= pressure * options_.shear_force;
        if (!p.cell.tilt_moves[0]) {
            force[cell + 2] = 0;
        }
        if (options_.fixed_length > 0) {
            force[cell] = 0;
        }
        return force;
    }

    CellOptions options_;
    std::vector<double> velocity_;
};

/// The packing that a soft one is next to, when the overlaps are its contacts.
inline std::optional<State> hard(const SoftCell& soft, const CellOptions& options) {
    State state;
    state.packing = soft.packing;
    soft.overlaps([&](const Contact& c, double, const auto&) { state.contacts.push_back(c); });
    state.load.reference_length = {1, 1};
    state.load.stress = {options.force[0], options.force[1]};
    state.load.shear = {options.kind == CellKind::tilted ? options.shear_force : 0};
    state.load.infinitesimal.assign(2 * options.radii.size(), 0.0);
    std::ranges::sort(state.contacts);
    return polish(state) ? std::optional(state) : std::nullopt;
}

} // namespace detail

/// An equilibrium, or nearly one; without rattlers, but for those that `find_vertex` puts to rest.
inline std::optional<State> make_cell(const CellOptions& options, Random& random) {
    detail::SoftCell soft(options, random);
    if (!soft.relax()) {
        return {};
    }
    auto state = detail::hard(soft, options);
    if (!state && options.kind != CellKind::channel && options.shear_force == 0 && options.fixed_length == 0) {
        isostat::PreparationOptions preparation{.stress = options.force[0]};
        preparation.ratio = options.force[1] / options.force[0];
        isostat::PreparationReport report;
        Packing apart = soft.packing; // no disk may overlap its own image
        for (std::size_t k = 0; k < apart.q.size(); ++k) {
            apart.q[k] *= 1.01;
        }
        const auto found = isostat::find_vertex(apart, preparation, report);
        state = found.ok() ? std::optional(found.value()) : std::nullopt;
    }
    return state;
}

/// Grains in the cell, but for some that are a period beside it, and another pin: the same packing.
inline void describe_otherwise(State& state, Random& random) {
    const auto& p = state.packing;
    const std::size_t axes = p.axes();
    std::vector<isostat::Image> by;
    for (std::size_t i = 0; i < p.radius.size(); ++i) {
        std::array<double, isostat::most_axes> periods{};
        isostat::Image image;
        for (std::size_t a = axes; a-- > 0;) {
            periods[a] = p.q[axes * i + a];
            for (std::size_t b = a + 1; b < axes; ++b) {
                periods[a] -= periods[b] * p.lattice(a, b);
            }
            periods[a] /= p.lattice(a, a);
            const int beside = random.integer(4) == 0 ? random.integer(3) - 1 : 0;
            image.m[a] =
                p.cell.periodic[a] ? static_cast<std::int8_t>(beside - static_cast<int>(std::floor(periods[a]))) : 0;
        }
        by.push_back(image);
    }
    state = cells::with_other_representatives(std::move(state), by);
    std::ranges::sort(state.contacts);
    state.packing.cell.pin = random.integer(p.disk_count());
}

} // namespace contradictions
