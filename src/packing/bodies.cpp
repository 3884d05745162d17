#include "packing/bodies.hpp"

#include "core/refuse.hpp"
#include "packing/arc_bodies.hpp"
#include "packing/words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace isostat {

Bodies::Bodies(const Packing& packing) : first_(packing.radius.size()) {
    std::iota(first_.begin(), first_.end(), 0);
    const auto root = [this](int disk) {
        while (first_[static_cast<std::size_t>(disk)] != disk) {
            disk = first_[static_cast<std::size_t>(disk)];
        }
        return disk;
    };
    for (const Bar& bar : packing.bars) {
        const int one = root(bar.i);
        const int other = root(bar.j);
        first_[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
    }
    for (int& disk : first_) {
        disk = root(disk);
    }
}

std::vector<std::vector<int>> Bodies::members(std::size_t at_least) const {
    std::vector<std::vector<int>> all(first_.size());
    for (std::size_t i = 0; i < first_.size(); ++i) {
        all[static_cast<std::size_t>(first_[i])].push_back(static_cast<int>(i));
    }
    std::erase_if(all, [at_least](const std::vector<int>& body) { return body.size() < at_least; });
    return all;
}

namespace {

/// Distance of a member from the point, the line or the plane through one, two or three others.
double height(const Packing& packing, int member, const std::vector<int>& base) {
    using Vector = PerAxis<double>;
    const auto from_base = [&](int of) {
        Vector x{};
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            x[a] = packing.coordinate(DiskId(of), static_cast<int>(a)) -
                   packing.coordinate(DiskId(base.front()), static_cast<int>(a));
        }
        return x;
    };
    const auto cross = [](const Vector& a, const Vector& b) {
        return Vector{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    };
    const auto size = [](const Vector& x) { return std::hypot(x[0], x[1], x[2]); };
    const Vector x = from_base(member);
    if (base.size() == 1) {
        return size(x);
    }
    const Vector e = from_base(base[1]);
    if (base.size() == 2) {
        return size(cross(x, e)) / size(e);
    }
    const Vector n = cross(e, from_base(base[2]));
    return std::abs(x[0] * n[0] + x[1] * n[1] + x[2] * n[2]) / size(n);
}

/// d + 1 members of a body, or all, one after another as far as can be from those before.
std::vector<int> corners_of(const Packing& packing, const std::vector<int>& body, const std::string& source,
                            double known) {
    const auto farthest = [&](const std::vector<int>& base) {
        std::pair<int, double> out{body.front(), 0};
        for (const int member : body) {
            const double h = height(packing, member, base);
            out = h > out.second ? std::pair(member, h) : out;
        }
        return out;
    };
    std::vector<int> corners{farthest({body.front()}).first};
    while (corners.size() < std::min(body.size(), packing.axes() + 1)) {
        const auto [member, distance] = farthest(corners);
        if (!(distance > known)) {
            static constexpr std::array places{"in one place", "on one line", "in one plane"};
            refuse(source,
                   "the {} members of the body of {} {} lie {} as far as is known (to {:.2g}): expected a rigid body; "
                   "one more member beside them and inside another one touches nothing and makes it rigid",
                   body.size(), grain_word(packing.dimension), body.front(), places[corners.size() - 1], known);
        }
        corners.push_back(member);
    }
    return corners;
}

/// Those corners whose line or plane a member is farthest from, one left out.
std::vector<int> ends_of(const Packing& packing, const std::vector<int>& corners, int member) {
    std::vector<int> best;
    for (const int left_out : corners) {
        std::vector<int> others = corners;
        std::erase(others, left_out);
        if (best.empty() || height(packing, member, others) > height(packing, member, best)) {
            best = others;
        }
    }
    return best;
}

/// Angles of a circle, from and to.
using Arc = std::array<double, 2>;

/// The circle of a member without what the others cover.
std::vector<Arc> outer_arcs(const Packing& packing, const std::vector<int>& body, int i) {
    constexpr double turn = 2 * std::numbers::pi;
    const auto radius = [&](int disk) { return packing.radius[static_cast<std::size_t>(disk)]; };
    std::vector<Arc> covered;
    const auto cover = [&covered](double from, double to) {
        from < 0 ? covered.insert(covered.end(), {{from + turn, turn}, {0, to}})
                 : covered.insert(covered.end(), {{from, to}});
    };
    for (const int j : body) {
        const double x = packing.coordinate(DiskId(j), 0) - packing.coordinate(DiskId(i), 0);
        const double y = packing.coordinate(DiskId(j), 1) - packing.coordinate(DiskId(i), 1);
        const double distance = std::hypot(x, y);
        if (j == i || distance >= radius(i) + radius(j) || distance + radius(j) < radius(i)) {
            continue;
        }
        if (distance + radius(i) <= radius(j)) { // hidden; of two equal ones the second
            if (distance > 0 || radius(i) < radius(j) || j < i) {
                return {};
            }
            continue;
        }
        const double cosine =
            (distance * distance + radius(i) * radius(i) - radius(j) * radius(j)) / (2 * distance * radius(i));
        const double half = std::acos(std::clamp(cosine, -1.0, 1.0));
        double middle = std::atan2(y, x);
        middle += middle < 0 ? turn : 0;
        if (middle + half > turn) {
            cover(middle - half - turn, middle + half - turn);
        } else {
            cover(middle - half, middle + half);
        }
    }
    std::ranges::sort(covered);
    std::vector<Arc> outer;
    double end = 0;
    for (const Arc& arc : covered) {
        if (arc[0] > end) {
            outer.push_back({end, arc[0]});
        }
        end = std::max(end, arc[1]);
    }
    if (end < turn) {
        outer.push_back({end, turn});
    }
    return outer;
}

/// Half of the integral of x dy - y dx along the boundary: of the union, or the arcs of the body.
double area_of_union(const Packing& packing, const std::vector<int>& body) {
    const ArcBodies arcs(packing);
    double area = 0;
    for (const int i : body) {
        const double r = packing.radius[static_cast<std::size_t>(i)];
        const double x = packing.coordinate(DiskId(i), 0);
        const double y = packing.coordinate(DiskId(i), 1);
        const auto sector = arcs.angles(i);
        for (const auto& [from, to] : sector ? std::vector<Arc>{*sector} : outer_arcs(packing, body, i)) {
            area +=
                0.5 * r * (r * (to - from) + x * (std::sin(to) - std::sin(from)) - y * (std::cos(to) - std::cos(from)));
        }
    }
    return area;
}

/// Of two spheres what the planes of their common circle cut off; of more, where some overlap, nothing is known.
double volume_shared(const Packing& packing, const std::vector<int>& body) {
    double shared = 0;
    for (std::size_t k = 1; k < body.size(); ++k) {
        for (std::size_t m = 0; m < k; ++m) {
            const double r = packing.radius[static_cast<std::size_t>(body[k])];
            const double s = packing.radius[static_cast<std::size_t>(body[m])];
            double square = 0;
            for (int a = 0; a < packing.dimension; ++a) {
                const double x = packing.coordinate(DiskId(body[k]), a) - packing.coordinate(DiskId(body[m]), a);
                square += x * x;
            }
            const double d = std::sqrt(square);
            if (d >= r + s) {
                continue;
            }
            if (body.size() > 2) {
                return std::numeric_limits<double>::quiet_NaN();
            }
            const double least = std::min(r, s);
            shared = d <= std::abs(r - s) ? 4 * std::numbers::pi / 3 * least * least * least
                                          : std::numbers::pi * (r + s - d) * (r + s - d) *
                                                (d * d + 2 * d * (r + s) - 3 * (r - s) * (r - s)) / (12 * d);
        }
    }
    return shared;
}

} // namespace

std::vector<Contact> unilateral(std::vector<Contact> contacts) {
    std::erase_if(contacts, [](const Contact& c) { return !c.is_unilateral(); });
    return contacts;
}

std::vector<Contact> with_bars(std::vector<Contact> contacts, const Packing& packing) {
    for (const Bar& bar : packing.bars) {
        if (!packing.is_fixed(DiskId(static_cast<std::size_t>(bar.i))) ||
            !packing.is_fixed(DiskId(static_cast<std::size_t>(bar.j)))) {
            contacts.emplace_back(ContactKind::bar, bar.i, bar.j);
        }
    }
    return contacts;
}

std::vector<Bar> bars_of_bodies(const Packing& packing, const std::vector<std::vector<int>>& bodies,
                                const std::string& source, double known) {
    std::vector<Bar> bars;
    for (const std::vector<int>& body : bodies) {
        const std::vector<int> corners = corners_of(packing, body, source, known);
        for (const int member : body) {
            const auto corner = std::ranges::find(corners, member);
            for (const int end : corner == corners.end() ? ends_of(packing, corners, member)
                                                         : std::vector<int>(corners.begin(), corner)) {
                bars.push_back({std::min(member, end), std::max(member, end), height(packing, member, {end})});
            }
        }
    }
    std::ranges::sort(bars);
    return bars;
}

double shared_by_members(const Packing& packing, std::span<const int> left_out) {
    double shared = 0;
    for (const std::vector<int>& body : Bodies(packing).members()) {
        if (std::ranges::find(left_out, body.front()) != left_out.end()) {
            continue;
        }
        if (packing.dimension != plane) {
            shared += volume_shared(packing, body);
            continue;
        }
        for (const int i : body) {
            const double r = packing.radius[static_cast<std::size_t>(i)];
            shared += std::numbers::pi * r * r;
        }
        shared -= area_of_union(packing, body);
    }
    return shared;
}

void require_single_grains(const Packing& packing, const std::string& source, const std::string& what) {
    require_no_arcs(packing, source, what);
    if (!packing.bars.empty()) {
        refuse(source,
               "a packing of clumps ({} bars); {} takes single grains only; inspect, certify, run and verify (of "
               "certificates) take clumps",
               packing.bars.size(), what);
    }
}

void validate_bars(const Packing& packing, const std::string& source) {
    for (std::size_t k = 0; k < packing.bars.size(); ++k) {
        const Bar& bar = packing.bars[k];
        if (bar.i < 0 || bar.i >= bar.j || bar.j >= packing.disk_count()) {
            refuse(source, "bar {}-{}: expected two different {}s from 0 to {}, the smaller number first", bar.i, bar.j,
                   grain_word(packing.dimension), packing.disk_count() - 1);
        }
        if (!(bar.length >= shortest_length && bar.length <= longest_length)) {
            refuse(source, "the length of bar {}-{} is {}: expected a positive finite number from {} to {}", bar.i,
                   bar.j, bar.length, shortest_length, longest_length);
        }
        if (k > 0 &&
            (bar < packing.bars[k - 1] || (bar.i == packing.bars[k - 1].i && bar.j == packing.bars[k - 1].j))) {
            refuse(source, "bar {}-{} comes after bar {}-{}: expected bars in increasing order, each once", bar.i,
                   bar.j, packing.bars[k - 1].i, packing.bars[k - 1].j);
        }
    }
    if (packing.bars.empty()) {
        return;
    }
    const Bodies bodies(packing);
    std::vector<int> bars(packing.radius.size());
    for (const Bar& bar : packing.bars) {
        ++bars[static_cast<std::size_t>(bodies.of(bar.i))];
    }
    for (const std::vector<int>& body : bodies.members()) {
        const int count = static_cast<int>(body.size());
        const int expected = bars_of_rigid_body(count, packing.dimension);
        if (const int found = bars[static_cast<std::size_t>(body.front())]; found != expected) {
            refuse(source, "the body of {} {} has {} members and {} bars: expected {}, as many as make it rigid",
                   grain_word(packing.dimension), body.front(), count, found, expected);
        }
    }
}

} // namespace isostat
