#include "contact/separation.hpp"
#include "contact/words.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace isostat::crafted {

namespace {

/// Double bounds of a number, outwards.
struct Bounds {
    double lower, upper;
};

Bounds bounds(const Number& number) {
    const Enclosure e = number.enclosure();
    if (!std::isfinite(e.radius)) {
        return {-HUGE_VAL, HUGE_VAL};
    }
    return {std::nextafter(e.value - e.radius, -HUGE_VAL), std::nextafter(e.value + e.radius, HUGE_VAL)};
}

/// An upper bound of the distance below which two disks can touch, against a lower bound of one coordinate's
/// difference.
bool surely_apart(const Bounds& a, const Bounds& b, double reach) {
    const double between = std::max(a.lower - b.upper, b.lower - a.upper);
    return std::nextafter(between, -HUGE_VAL) > reach;
}

Words describe(const ExactPacking& packing, int i) {
    const auto& c = packing.centre[static_cast<std::size_t>(i)];
    Words disk = words("disk {} (x = {}, y = {}, r = {})", i, c[0].text(), c[1].text(),
                       packing.radius[static_cast<std::size_t>(i)].text());
    disk.disks.push_back(i);
    return disk;
}

/// Sign of gap, cheap where doubles settle it.
struct Sweep {
    explicit Sweep(const ExactPacking& p) : packing(p) {
        for (std::size_t i = 0; i < p.radius.size(); ++i) {
            x.push_back(bounds(p.centre[i][0]));
            y.push_back(bounds(p.centre[i][1]));
            r.push_back(bounds(p.radius[i]));
        }
    }

    /// |d|^2 - (R_i + R_j)^2, exactly; `apart` when doubles already show that it is positive.
    [[nodiscard]] bool apart(std::size_t i, std::size_t j) const {
        const double reach = std::nextafter(r[i].upper + r[j].upper, HUGE_VAL);
        if (surely_apart(x[i], x[j], reach) || surely_apart(y[i], y[j], reach)) {
            return true;
        }
        const double dx = std::max(0.0, std::max(x[i].lower - x[j].upper, x[j].lower - x[i].upper));
        const double dy = std::max(0.0, std::max(y[i].lower - y[j].upper, y[j].lower - y[i].upper));
        // Away from under- and overflow each side carries at most five roundings of relative size 2^-53.
        const double squares = dx * dx + dy * dy;
        return reach * reach > 1e-280 && std::isfinite(squares) &&
               squares * (1 - 0x1p-49) > reach * reach * (1 + 0x1p-49);
    }

    [[nodiscard]] Number defect(std::size_t i, std::size_t j) const {
        const Number dx = packing.centre[j][0] - packing.centre[i][0];
        const Number dy = packing.centre[j][1] - packing.centre[i][1];
        const Number reach = packing.radius[i] + packing.radius[j];
        return dx * dx + dy * dy - reach * reach;
    }

    const ExactPacking& packing;
    std::vector<Bounds> x, y, r;
};

} // namespace

ExactPacking exact_copy(const Packing<2>& packing) {
    require_box(packing, "exact numbers", "a crafted packing");
    ExactPacking out;
    for (int i = 0; i < packing.disk_count(); ++i) {
        out.radius.push_back(Number::from_double(packing.radius[static_cast<std::size_t>(i)]));
        out.centre.push_back({Number::from_double(packing.coordinate(DiskId(i), 0)),
                              Number::from_double(packing.coordinate(DiskId(i), 1))});
    }
    out.fixed = packing.fixed;
    out.walls = packing.walls;
    out.length = {Number::from_double(packing.length(0)), Number::from_double(packing.length(1))};
    return out;
}

Packing<2> approximate(const ExactPacking& packing) {
    Packing<2> out;
    out.walls = packing.walls;
    out.fixed = packing.fixed;
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        out.radius.push_back(packing.radius[i].to_double());
        out.q.push_back(packing.centre[i][0].to_double());
        out.q.push_back(packing.centre[i][1].to_double());
    }
    out.q.push_back(packing.length[0].to_double());
    out.q.push_back(packing.length[1].to_double());
    return out;
}

Result<std::vector<Contact>> exact_contacts(const ExactPacking& packing) {
    std::vector<Contact> out;
    const Sweep sweep(packing);
    const auto n = packing.radius.size();
    for (std::size_t i = 0; i < n; ++i) {
        const int disk = static_cast<int>(i);
        for (int axis = 0; axis < 2; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            for (const ContactKind kind : {ContactKind::lower_wall, ContactKind::upper_wall}) {
                const bool lower = kind == ContactKind::lower_wall;
                const WallKind wall = lower ? packing.walls.lower[a] : packing.walls.upper[a];
                if (wall == WallKind::absent) {
                    continue;
                }
                const bool moves = wall == WallKind::movable || !packing.is_fixed(disk);
                const Number& c = packing.centre[i][a];
                const Number gap = (lower ? c : packing.length[a] - c) - packing.radius[i];
                const Contact contact{kind, disk, axis};
                if (gap.sign() < 0) {
                    return failed(FailureKind::overlap, "{} overlaps the wall of contact {}: gap = {}",
                                  describe(packing, disk), named<2>(contact), gap.text());
                }
                if (gap.is_zero() && moves) {
                    out.push_back(contact);
                }
            }
        }
    }
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto left = [&](std::size_t i) { return std::nextafter(sweep.x[i].lower - sweep.r[i].upper, -HUGE_VAL); };
    const auto right = [&](std::size_t i) { return std::nextafter(sweep.x[i].upper + sweep.r[i].upper, HUGE_VAL); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return left(i) < left(j); });
    for (std::size_t s = 0; s < n; ++s) {
        for (std::size_t t = s + 1; t < n && left(order[t]) <= right(order[s]); ++t) {
            const std::size_t i = std::min(order[s], order[t]);
            const std::size_t j = std::max(order[s], order[t]);
            const int a = static_cast<int>(i);
            const int b = static_cast<int>(j);
            if (sweep.apart(i, j)) {
                continue;
            }
            const bool moves = !packing.is_fixed(a) || !packing.is_fixed(b);
            const Number defect = sweep.defect(i, j);
            if (defect.sign() < 0) {
                return failed(FailureKind::overlap, "{} and {} overlap: distance^2 - (sum of radii)^2 = {}",
                              describe(packing, a), describe(packing, b), defect.text());
            }
            if (defect.is_zero() && moves) {
                out.push_back({ContactKind::disk_disk, a, b});
            }
        }
    }
    std::sort(out.begin(), out.end());
    return out;
}

exact::NumberMatrix exact_contact_matrix(const ExactPacking& packing, const DofMap<2>& dofs,
                                         const std::vector<Contact>& contacts) {
    exact::NumberMatrix out;
    out.rows = dofs.dof_count();
    for (const Contact& contact : contacts) {
        const Separation<2> separation(contact, packing.disk_count());
        std::array<Number, 2> normal;
        if (contact.kind == ContactKind::disk_disk) {
            const Number scale = touching_distance(packing.radius, contact).inverse();
            normal = separation.of_disks([&](std::size_t k) -> const Number& { return packing.coordinate(k); },
                                         std::minus<>());
            for (Number& component : normal) {
                component *= scale;
            }
        }
        auto& column = out.column.emplace_back();
        separation.for_each_entry(dofs, normal, [&](int dof, const Number& entry) {
            if (!entry.is_zero()) {
                column.emplace_back(dof, entry);
            }
        });
    }
    return out;
}

std::vector<Number> external_force(const ExactPacking& packing, const DofMap<2>& dofs) {
    std::vector<Number> out(static_cast<std::size_t>(dofs.dof_count()));
    const auto add = [&](std::size_t coordinate, const Number& value) {
        const int dof = dofs.dof_of(coordinate);
        if (dof >= 0) {
            out[static_cast<std::size_t>(dof)] += value;
        }
    };
    for (std::size_t k = 0; k < packing.load->disk.size(); ++k) {
        add(k, packing.load->disk[k]);
    }
    for (std::size_t a = 0; a < 2; ++a) {
        add(2 * packing.radius.size() + a, -packing.load->wall[a]);
    }
    return out;
}

} // namespace isostat::crafted
