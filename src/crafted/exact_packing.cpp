#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "contact/words.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

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
    explicit Sweep(const ExactPacking& p) {
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

    std::vector<Bounds> x, y, r;
};

/// The contacts found so far, each with its gap decided.
struct Touching {
    Touching(const ExactPacking& exact, const Packing& rounded) : packing(exact), dofs(rounded) {}

    /// A pair or a disk and a wall with this excess over touching, in the sign of the gap.
    std::optional<Failure> take(const Contact& contact, const Number& excess) {
        if (excess.sign() < 0) {
            return overlap(contact, excess);
        }
        bool moves = false;
        Separation(contact, packing.layout()).for_each_coordinate([&](std::size_t k, std::size_t, int) {
            moves = moves || dofs.dof_of(k) >= 0;
        });
        if (excess.is_zero() && moves) {
            contacts.push_back(contact);
        }
        return std::nullopt;
    }

    std::optional<Failure> take_pair(const Contact& pair) {
        const auto [dx, dy, none] =
            Separation(pair, packing.layout())
                .of_disks([&](std::size_t k) -> const Number& { return packing.coordinate(k); }, std::minus<>());
        const Number reach = touching_distance(packing.radius, pair);
        return take(pair, dx * dx + dy * dy - reach * reach);
    }

    [[nodiscard]] Failure overlap(const Contact& contact, const Number& excess) const {
        const Words first = describe(packing, contact.i);
        if (contact.kind != ContactKind::disk_disk) {
            return failed(FailureKind::overlap, "{} overlaps the wall of contact {}: gap = {}", first, named(contact),
                          excess.text());
        }
        const Words second = describe(packing, contact.j);
        if (contact.image.is_here()) {
            return failed(FailureKind::overlap, "{} and {} overlap: distance^2 - (sum of radii)^2 = {}", first, second,
                          excess.text());
        }
        return failed(FailureKind::overlap,
                      "{} and an image of {} overlap, pair {}: distance^2 - (sum of radii)^2 = {}", first, second,
                      named(contact), excess.text());
    }

    const ExactPacking& packing;
    DofMap dofs;
    std::vector<Contact> contacts;
};

std::optional<Failure> take_walls(Touching& touching) {
    const ExactPacking& packing = touching.packing;
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        for (std::size_t a = 0; a < 2; ++a) {
            const Number& c = packing.centre[i][a];
            for (const bool lower : {true, false}) {
                if ((lower ? packing.walls.lower[a] : packing.walls.upper[a]) == WallKind::absent) {
                    continue;
                }
                const Contact contact(lower ? ContactKind::lower_wall : ContactKind::upper_wall, static_cast<int>(i),
                                      static_cast<int>(a));
                const Number gap = (lower ? c : packing.length[a] - c) - packing.radius[i];
                if (auto failure = touching.take(contact, gap)) {
                    return failure;
                }
            }
        }
    }
    return std::nullopt;
}

std::optional<Failure> take_pairs(Touching& touching) {
    const Sweep sweep(touching.packing);
    std::vector<std::size_t> order(touching.packing.radius.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto left = [&](std::size_t i) { return std::nextafter(sweep.x[i].lower - sweep.r[i].upper, -HUGE_VAL); };
    const auto right = [&](std::size_t i) { return std::nextafter(sweep.x[i].upper + sweep.r[i].upper, HUGE_VAL); };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return left(i) < left(j); });
    for (std::size_t s = 0; s < order.size(); ++s) {
        for (std::size_t t = s + 1; t < order.size() && left(order[t]) <= right(order[s]); ++t) {
            if (sweep.apart(order[s], order[t])) {
                continue;
            }
            if (auto failure = touching.take_pair(pair_of(static_cast<int>(order[s]), static_cast<int>(order[t])))) {
                return failure;
            }
        }
    }
    return std::nullopt;
}

/// Rounding to doubles changes a gap by less than this: of each coordinate half a unit of the last place, of an image
/// less than 100 times that for each period.
double lost_by_rounding(const Packing& rounded) {
    double largest = rounded.max_radius();
    for (const double x : rounded.q) {
        largest = std::max(largest, std::abs(x));
    }
    return 0x1p-40 * largest;
}

std::optional<Failure> take_images(Touching& touching, const Packing& rounded) {
    for (const Contact& pair : near_pairs(rounded, lost_by_rounding(rounded)).pairs) {
        if (auto failure = touching.take_pair(pair)) {
            return failure;
        }
    }
    return std::nullopt;
}

} // namespace

ExactPacking exact_copy(const Packing& packing) {
    ExactPacking out;
    for (int i = 0; i < packing.disk_count(); ++i) {
        out.radius.push_back(Number::from_double(packing.radius[static_cast<std::size_t>(i)]));
        out.centre.push_back({Number::from_double(packing.coordinate(DiskId(i), 0)),
                              Number::from_double(packing.coordinate(DiskId(i), 1))});
    }
    out.fixed = packing.fixed;
    out.walls = packing.walls;
    out.length = {Number::from_double(packing.length(0)), Number::from_double(packing.length(1))};
    out.cell = packing.cell;
    if (packing.cell.any()) {
        out.tilt = Number::from_double(packing.lattice(0, 1));
    }
    return out;
}

Packing approximate(const ExactPacking& packing) {
    Packing out;
    out.walls = packing.walls;
    out.fixed = packing.fixed;
    for (std::size_t i = 0; i < packing.radius.size(); ++i) {
        out.radius.push_back(packing.radius[i].to_double());
        out.q.push_back(packing.centre[i][0].to_double());
        out.q.push_back(packing.centre[i][1].to_double());
    }
    out.q.push_back(packing.length[0].to_double());
    out.q.push_back(packing.length[1].to_double());
    out.cell = packing.cell;
    if (packing.cell.any()) {
        out.q.push_back(packing.tilt.to_double());
    }
    return out;
}

Result<std::vector<Contact>> exact_contacts(const ExactPacking& packing) {
    const Packing rounded = approximate(packing);
    Touching touching(packing, rounded);
    if (auto failure = take_walls(touching)) {
        return *failure;
    }
    if (auto failure = packing.cell.any() ? take_images(touching, rounded) : take_pairs(touching)) {
        return *failure;
    }
    std::sort(touching.contacts.begin(), touching.contacts.end());
    return std::move(touching.contacts);
}

exact::NumberMatrix exact_contact_matrix(const ExactPacking& packing, const DofMap& dofs,
                                         const std::vector<Contact>& contacts) {
    exact::NumberMatrix out;
    out.rows = dofs.dof_count();
    for (const Contact& contact : contacts) {
        const Separation separation(contact, packing.layout());
        PerAxis<Number> normal;
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

std::vector<Number> external_force(const ExactPacking& packing, const DofMap& dofs) {
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
    if (packing.cell.any()) {
        add(2 * packing.radius.size() + 2, -packing.load->tilt);
    }
    return out;
}

} // namespace isostat::crafted
