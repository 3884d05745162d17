#pragma once
// A free disk that rolls over a fixed one past obstacles: where it meets them is known.

#include "support/crafted.hpp"
#include "support/free_grains.hpp"

namespace crafted {

constexpr double start_angle = 0.2;

/// Disk 2 free on disk 0, which is fixed at the origin; at `start_angle` it touches the fixed disk 1 as well; all of
/// radius 1. Further fixed disks stop it or are obstacles. No walls.
struct RollingDisk {
    isostat::Packing packing;
    isostat::Load load;

    RollingDisk() {
        packing = without_walls::free_grains({1}, {});
        packing.fixed = {1};
        load.disk_force = {0, 0};
        beside(start_angle, 1);
        add(0, 0, 1, false);
        put(start_angle);
    }
    /// The rolling disk at `angle`.
    void put(double angle) {
        packing.q[4] = 2 * std::cos(angle);
        packing.q[5] = 2 * std::sin(angle);
    }
    /// A fixed disk that the rolling one touches (clearance 0), overlaps (< 0) or passes (> 0) when it is at `angle`.
    void obstacle(double angle, double radius, double clearance) {
        const double distance = 3 + radius + clearance;
        add(distance * std::cos(angle), distance * std::sin(angle), radius, true);
    }
    /// A fixed disk of radius 1 that stops the rolling one at `angle`.
    void stop(double angle) { beside(angle, -1); }
    void push(double fx, double fy) {
        load.disk_force[4] = fx;
        load.disk_force[5] = fy;
    }

  private:
    void add(double x, double y, double radius, bool fixed) {
        packing.q.insert(packing.q.end() - 2, {x, y});
        packing.radius.push_back(radius);
        packing.fixed.push_back(fixed ? 1 : 0);
        load.disk_force.insert(load.disk_force.end(), {0.0, 0.0});
    }
    /// A fixed disk on the tangent at `angle`, behind the rolling one (+1) or before it (-1).
    void beside(double angle, double side) {
        add(2 * std::cos(angle) + side * 2 * std::sin(angle), 2 * std::sin(angle) - side * 2 * std::cos(angle), 1,
            true);
    }
};

} // namespace crafted
