#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "contact/words.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace isostat::crafted {

namespace {

Words describe(const ExactPacking& packing, int i) {
    const auto& c = packing.centre[static_cast<std::size_t>(i)];
    Words disk = words("disk {} (x = {}, y = {}, r = {})", i, c[0].text(), c[1].text(),
                       packing.radius[static_cast<std::size_t>(i)].text());
    disk.disks.push_back(i);
    return disk;
}

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

/// Rounding to doubles changes a gap by less than this: of each coordinate half a unit of the last place, of an image
/// less than 100 times that for each period.
double lost_by_rounding(const Packing& rounded) {
    double largest = rounded.max_radius();
    for (const double x : rounded.q) {
        largest = std::max(largest, std::abs(x));
    }
    return 0x1p-40 * largest;
}

/// Those whose gap may be 0. All, where the range of doubles is too small for that question.
std::vector<Contact> nearest_pairs(const Packing& rounded) {
    const double lost = lost_by_rounding(rounded);
    if (rounded.cell.any() || (lost > 0x1p-1000 && lost < 0x1p900)) {
        return pairs_within(rounded, lost);
    }
    std::vector<Contact> all;
    for (int i = 0; i < rounded.disk_count(); ++i) {
        for (int j = i + 1; j < rounded.disk_count(); ++j) {
            all.push_back(pair_of(i, j));
        }
    }
    return all;
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
    for (const Contact& pair : nearest_pairs(rounded)) {
        if (auto failure = touching.take_pair(pair)) {
            return *failure;
        }
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
