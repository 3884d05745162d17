#pragma once
// Disks and as many contacts as degrees of freedom: regular, singular, and nearly singular. The contacts need not be
// tangent: the contact matrix does not ask.

#include "oracle/random.hpp"

#include <isostat/contact/state.hpp>

#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace isostat::oracle {

struct Structure {
    std::string family;
    Packing packing;
    std::vector<Contact> contacts;
};

/// Where disks are put: the coordinates decide what is special.
enum class Place { uniform, small_integers, far_away, scales, denormal, sizes, nearly_collinear };
inline constexpr int place_count = 7;

inline const char* name(Place place) {
    constexpr const char* names[] = {"uniform",  "small integers", "far away",        "scales 1e-150 to 1e150",
                                     "denormal", "sizes to 1e6",   "nearly collinear"};
    return names[static_cast<int>(place)];
}

/// One coordinate pair.
inline void put(Packing& packing, Place place, Random& random) {
    double x = random.real(-1, 1);
    double y = random.real(-1, 1);
    double radius = random.real(0.5, 1);
    switch (place) {
    case Place::uniform: break;
    case Place::small_integers:
        x = random.integer(4);
        y = random.integer(4);
        break;
    case Place::far_away: {
        const double far = std::ldexp(1.0, 20 + random.integer(25));
        x += far;
        y -= far / 3;
        break;
    }
    case Place::scales: {
        const double size = std::pow(10.0, random.real(-150, 150));
        x *= size;
        y *= random.integer(2) == 0 ? size : std::pow(10.0, random.real(-150, 150));
        radius *= size;
        break;
    }
    case Place::denormal:
        x *= 0x1p-1040;
        y *= 0x1p-1060;
        radius *= 0x1p-1030;
        break;
    case Place::sizes: {
        const double size = std::pow(10.0, random.real(0, 6));
        x *= size;
        y *= size;
        radius *= size;
        break;
    }
    case Place::nearly_collinear:
        x = random.integer(50) - 25 + random.real();
        y = random.integer(3) == 0 ? 0 : std::pow(10.0, -random.real(0, 300)) * (random.integer(2) == 0 ? 1 : -1);
        break;
    }
    packing.radius.push_back(radius);
    packing.q.insert(packing.q.end(), {x, y});
}

/// `count` free disks, three fixed ones, 2 * count contacts. `grown`: every disk rests on two earlier ones, regular
/// unless a pair is collinear; otherwise the contacts are drawn at random, often singular.
inline Structure random_structure(int count, Place place, bool grown, Random& random) {
    Structure s;
    s.family = std::string(name(place)) + (grown ? ", grown" : ", drawn");
    s.packing.walls = Walls::none();
    for (int i = 0; i < count + 3; ++i) {
        put(s.packing, place, random);
        s.packing.fixed.push_back(i < 3 ? 1 : 0);
    }
    s.packing.q.insert(s.packing.q.end(), {0, 0});
    std::set<std::pair<int, int>> pairs;
    const auto distinct = [&](int i, int j) { // the centres: otherwise there is no normal
        const auto a = static_cast<std::size_t>(2 * i);
        const auto b = static_cast<std::size_t>(2 * j);
        return s.packing.q[a] != s.packing.q[b] || s.packing.q[a + 1] != s.packing.q[b + 1];
    };
    const auto add = [&](int i, int j) {
        if (i != j && distinct(i, j) && pairs.insert({std::min(i, j), std::max(i, j)}).second) {
            s.contacts.push_back({ContactKind::disk_disk, std::min(i, j), std::max(i, j)});
            return true;
        }
        return false;
    };
    int tries = 0;
    if (grown) {
        for (int i = 3; i < count + 3; ++i) {
            const int before = std::min(i, 40); // keeps the structure local
            for (int made = 0; made < 2 && tries < 1000 * (count + 1); ++tries) {
                made += add(i, i - 1 - random.integer(before)) ? 1 : 0;
            }
        }
    } else {
        while (static_cast<int>(s.contacts.size()) < 2 * count && tries++ < 1000) {
            const int i = 3 + random.integer(count);
            const int j = random.integer(count + 3);
            add(i, j);
        }
    }
    return s;
}

/// A first free disk held by two fixed ones on nearly opposite sides, `delta` off collinear: sigma_min ~ delta. Every
/// further disk rests on the one before and on a fixed one of its own.
inline Structure needle(int count, double delta) {
    Structure s;
    s.family = "needle";
    s.packing.walls = Walls::none();
    s.packing.radius = {1};
    s.packing.q = {-2, 0};
    s.packing.fixed = {1};
    for (int k = 0; k < count; ++k) {
        const int anchor = static_cast<int>(s.packing.radius.size());
        s.packing.radius.insert(s.packing.radius.end(), {1, 1});
        s.packing.q.insert(s.packing.q.end(), {2.0 * (k + 1), k == 0 ? delta : 1.0 + k, 2.0 * k, k == 0 ? 0 : 0.5 * k});
        s.packing.fixed.insert(s.packing.fixed.end(), {1, 0});
        const int previous = k == 0 ? 0 : anchor - 1;
        s.contacts.push_back({ContactKind::disk_disk, std::min(previous, anchor + 1), std::max(previous, anchor + 1)});
        s.contacts.push_back({ContactKind::disk_disk, anchor, anchor + 1});
    }
    s.packing.q.insert(s.packing.q.end(), {0, 0});
    return s;
}

/// Rows of disks, each resting on two of the row below, the lowest row fixed; `height` is the distance of the rows in
/// units of the distance in a row, so that forces grow like 1 / height and sigma_min falls with it. Regular, and solved
/// from the top by hand.
inline Structure layers(int rows, int top, double height, Random& random) {
    Structure s;
    s.family = "layers";
    s.packing.walls = Walls::none();
    int below = 0; // first disk of the row below
    for (int r = 0; r <= rows; ++r) {
        const int first = static_cast<int>(s.packing.radius.size());
        for (int k = 0; k < top + rows - r; ++k) {
            s.packing.radius.push_back(0.5);
            s.packing.q.push_back(k + 0.5 * r + random.real(-0.05, 0.05));
            s.packing.q.push_back(height * (r + random.real(-0.05, 0.05)));
            s.packing.fixed.push_back(r == 0 ? 1 : 0);
            if (r > 0) {
                s.contacts.push_back({ContactKind::disk_disk, below + k, first + k});
                s.contacts.push_back({ContactKind::disk_disk, below + k + 1, first + k});
            }
        }
        below = first;
    }
    s.packing.q.insert(s.packing.q.end(), {0, 0});
    return s;
}

/// A load on `count` degrees of freedom with the magnitudes of one of several kinds.
inline std::vector<double> random_load(int count, Random& random) {
    const int kind = random.integer(5);
    std::vector<double> force(static_cast<std::size_t>(count), 0.0);
    const double scale = std::pow(10.0, random.real(-300, 150));
    for (double& f : force) {
        f = kind == 0   ? random.integer(5) - 2
            : kind == 1 ? random.real(-1, 1) * scale
            : kind == 2 ? random.real(-1, 1) * std::pow(10.0, random.real(-150, 150))
            : kind == 3 ? random.real(-1, 1) * 0x1p-1060
                        : random.real(-1, 1);
    }
    return force;
}

} // namespace isostat::oracle
