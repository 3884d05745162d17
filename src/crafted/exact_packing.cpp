#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "contact/words.hpp"
#include "core/dot.hpp"
#include "packing/bodies.hpp"
#include "packing/words.hpp"
#include "rigidity/strained_matrix.hpp"

#include <isostat/crafted/exact_packing.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace isostat::crafted {

namespace {

Words describe(const ExactPacking& packing, int i) {
    const auto& c = packing.centre[static_cast<std::size_t>(i)];
    std::string at;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        at += fmt::format("{} = {}, ", axis_names[a], c[a].text());
    }
    Words grain = words("{} {} ({}r = {})", grain_word(packing.dimension()), i, at,
                        packing.radius[static_cast<std::size_t>(i)].text());
    grain.disks.push_back(i);
    return grain;
}

/// The contacts found so far, each with its gap decided.
struct Touching {
    Touching(const ExactPacking& exact, const Packing& rounded) : packing(exact), dofs(rounded) {}

    /// Adds a pair, or a disk and a wall, when `excess` is 0; `excess` has the sign of the gap.
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
        const Number reach = touching_distance(packing.radius, pair);
        Number excess = -(reach * reach);
        for (const Number& d : exact_separation(packing, pair)) {
            excess += d * d;
        }
        return take(pair, excess);
    }

    [[nodiscard]] Failure overlap(const Contact& contact, const Number& excess) const {
        const Words first = describe(packing, contact.i);
        Words name = words("{}", to_string(contact, packing.dimension()));
        name.contacts.push_back(contact);
        if (!contact.of_disks()) {
            return failed(FailureKind::overlap, "{} overlaps the wall of contact {}: gap = {}", first, name,
                          excess.text());
        }
        const Words second = describe(packing, contact.j);
        if (contact.image.is_here()) {
            return failed(FailureKind::overlap, "{} and {} overlap: distance^2 - (sum of radii)^2 = {}", first, second,
                          excess.text());
        }
        return failed(FailureKind::overlap,
                      "{} and an image of {} overlap, pair {}: distance^2 - (sum of radii)^2 = {}", first, second, name,
                      excess.text());
    }

    const ExactPacking& packing;
    DofMap dofs;
    std::vector<Contact> contacts;
};

std::optional<Failure> take_walls(Touching& touching) {
    const ExactPacking& packing = touching.packing;
    const auto at = [&](std::size_t k) -> const Number& { return packing.coordinate(k); };
    std::optional<Failure> failure;
    for (int i = 0; i < packing.disk_count() && !failure; ++i) {
        packing.walls.for_each(packing.dimension(), i, [&](const Contact& wall) {
            const Number x = Separation(wall, packing.layout()).of_wall(at, std::minus<>());
            failure = failure ? failure : touching.take(wall, x - packing.radius[static_cast<std::size_t>(i)]);
        });
    }
    return failure;
}

/// Upper bound of the change of a gap by rounding to doubles: half a unit of the last place of each coordinate, and for
/// an image less than 100 times that per period.
double lost_by_rounding(const Packing& rounded) {
    return 0x1p-40 * std::max(rounded.max_radius(), largest(rounded.q));
}

/// The pairs whose gap may be 0, or all pairs where that is out of the range of doubles.
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
    without_hidden_pairs(all, rounded);
    return all;
}

} // namespace

PerAxis<Number> exact_separation(const ExactPacking& packing, const Contact& pair) {
    return Separation(pair, packing.layout())
        .of_disks([&](std::size_t k) -> const Number& { return packing.coordinate(k); }, std::minus<>());
}

ExactPacking exact_copy(const Packing& packing) {
    ExactPacking out;
    for (int i = 0; i < packing.disk_count(); ++i) {
        out.radius.push_back(Number::from_double(packing.radius[static_cast<std::size_t>(i)]));
        auto& centre = out.centre.emplace_back();
        for (int a = 0; a < packing.dimension; ++a) {
            centre[static_cast<std::size_t>(a)] = Number::from_double(packing.coordinate(DiskId(i), a));
        }
    }
    out.fixed = packing.fixed;
    out.bars = packing.bars;
    out.walls = packing.walls;
    out.cell = packing.cell;
    out.cell.dimension = packing.dimension;
    for (std::size_t k = packing.length_at(0); k < packing.q.size(); ++k) {
        const std::size_t behind = k - packing.length_at(0);
        (behind < packing.axes() ? out.length[behind] : out.tilt[behind - packing.axes()]) =
            Number::from_double(packing.q[k]);
    }
    return out;
}

Packing approximate(const ExactPacking& packing) {
    Packing out;
    out.dimension = packing.dimension();
    out.walls = packing.walls;
    out.fixed = packing.fixed;
    out.bars = packing.bars;
    out.cell = packing.cell;
    for (const Number& r : packing.radius) {
        out.radius.push_back(r.to_double());
    }
    for (std::size_t k = 0; k < out.coordinate_count(); ++k) {
        out.q.push_back(packing.coordinate(k).to_double());
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
    std::ranges::sort(touching.contacts);
    return with_bars(std::move(touching.contacts), rounded);
}

Number scale_of_row(const ExactPacking& packing, const Contact& pair) {
    return pair.kind == ContactKind::bar ? Number(1) : touching_distance(packing.radius, pair);
}

exact::NumberMatrix exact_contact_matrix(const ExactPacking& packing, const DofMap& dofs,
                                         const std::vector<Contact>& contacts) {
    exact::NumberMatrix out;
    out.rows = dofs.dof_count();
    for (const Contact& contact : contacts) {
        const Separation separation(contact, packing.layout());
        PerAxis<Number> normal;
        if (contact.of_disks()) {
            const Number scale = scale_of_row(packing, contact).inverse();
            normal = exact_separation(packing, contact);
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

Counting count_with_radii(const ExactPacking& packing, const std::vector<Contact>& contacts) {
    exact::NumberMatrix out = exact_contact_matrix(packing, DofMap(approximate(packing)), contacts);
    for (std::size_t l = 0; l < contacts.size(); ++l) {
        const Contact& c = contacts[l];
        if (c.kind == ContactKind::bar) {
            continue;
        }
        out.column[l].emplace_back(out.rows + c.i, Number(c.of_disks() && c.i == c.j ? 2 : 1));
        if (c.of_disks() && c.i != c.j) {
            out.column[l].emplace_back(out.rows + c.j, Number(1));
        }
    }
    out.rows += packing.disk_count();
    return count_matrix(out);
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
    const Layout layout = packing.layout();
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        add(layout.of_length(a), -packing.load->wall[a]);
        for (std::size_t b = 0; b < a && packing.cell.any(); ++b) {
            add(layout.of_tilt(b, a), -packing.load->tilt[Cell::tilt(b, a)]);
        }
    }
    return out;
}

} // namespace isostat::crafted
