#include "snap/soft_list.hpp"

#include "contact/near_pairs.hpp"
#include "contact/separation.hpp"
#include "io/lines.hpp"
#include "packing/words.hpp"
#include "snap/backbone.hpp"

#include <isostat/snap/snap.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <ranges>

namespace isostat::compare {

namespace {

/// The disk nearest to a wall, and its gap.
std::pair<int, double> nearest_to(const Packing& packing, ContactKind wall, int axis) {
    std::pair<int, double> out{-1, HUGE_VAL};
    for (int i = 0; i < packing.disk_count(); ++i) {
        if (const double g = gap(packing, {wall, i, axis}); g < out.second) {
            out = {i, g};
        }
    }
    return out;
}

/// The contacts of walls with disks that overlap them.
std::vector<Contact> walls_of(const Packing& packing) {
    std::vector<Contact> out = near_contacts(packing);
    std::erase_if(out, [&](const Contact& c) { return c.of_disks() || !(gap(packing, c) <= 0); });
    return out;
}

/// Names the walls that no disk overlaps, or empty: soft grains press on each, so digits of its position are missing.
std::string walls_apart(const Packing& packing) {
    std::string out;
    for (const WallFacts& facts : wall_facts) {
        for (int axis = 0; axis < packing.dimension; ++axis) {
            const auto [disk, distance] = nearest_to(packing, facts.kind, axis);
            if (distance > 0 && packing.walls.of({facts.kind, 0, axis}) != WallKind::absent) {
                out += fmt::format("; none with the {} wall, which is {:.3g} from {} {} (are digits of its position "
                                   "rounded?)",
                                   wall_name({facts.kind, 0, axis}), distance, grain_word(packing.dimension), disk);
            }
        }
    }
    return out;
}

} // namespace

std::string far_wall(const Packing& packing) {
    for (const WallFacts& facts : wall_facts) {
        for (int axis = 0; axis < packing.dimension; ++axis) {
            const auto [nearest, distance] = nearest_to(packing, facts.kind, axis);
            if (packing.walls.of({facts.kind, 0, axis}) != WallKind::absent && nearest >= 0 &&
                distance > nearly_touching * packing.min_radius()) {
                const char* grain = grain_word(packing.dimension);
                return fmt::format("no {} is near the {} wall, the nearest gap is {:.3g} ({} {}): expected the "
                                   "positions of the walls, --box XLO:XHI,YLO:YHI{} (bounds of a file often are not "
                                   "those)",
                                   grain, wall_name({facts.kind, 0, axis}), distance, grain, nearest,
                                   packing.dimension == plane ? "" : ",ZLO:ZHI");
            }
        }
    }
    return "";
}

std::string far_disks(const Packing& packing, double largest, const crafted::Plateau& plateau) {
    const double radius = packing.min_radius();
    if (plateau.deepest_overlap < -0.5 * radius) {
        return fmt::format("two {}s overlap by {:.3g} of the smallest radius: are the sizes diameters, taken for "
                           "radii (--diameter COLUMN)?",
                           grain_word(packing.dimension), -plateau.deepest_overlap / radius);
    }
    double nearest = plateau.deepest_overlap;
    constexpr double farthest = 8; // radii
    for (double reach = nearly_touching; plateau.candidates == 0 && reach < farthest && !std::isfinite(nearest);
         reach *= 2) {
        for (const Contact& c : isostat::near_contacts(packing, reach * radius, 0)) {
            nearest = std::min(nearest, gap(packing, c));
        }
    }
    return nearest <= std::max(largest, nearly_touching * radius)
               ? ""
               : fmt::format(
                     "the smallest gap is {:.3g} of the smallest radius: are the sizes wrong by a factor (radii "
                     "taken for diameters)?",
                     nearest / radius);
}

void check_nearness(const std::string& file, const Packing& packing) {
    const double near = nearly_touching * packing.min_radius();
    if (const std::string words = far_wall(packing); !words.empty()) {
        refuse(file, words);
    }
    double deepest = HUGE_VAL;
    if (packing.dimension == plane && packing.bars.empty()) {
        deepest = crafted::plateau(packing, {near}).deepest_overlap;
    } else {
        for (const Contact& c : isostat::near_contacts(packing, near, near)) {
            deepest = std::min(deepest, gap(packing, c));
        }
    }
    if (deepest < -near) {
        refuse(file,
               "two grains overlap by {:.3g}: expected at most {:.3g}, {} of the smallest radius (members of one rigid "
               "body may: import --bodies COLUMN)",
               -deepest, near, nearly_touching);
    }
}

std::vector<double> normal_parts(const Packing& packing, const std::vector<VectorForce>& rows, const std::string& file,
                                 std::string& words) {
    std::vector<double> out;
    double sum = 0, slip = 0;
    std::size_t where = 0, attract = 0;
    for (const auto& [contact, force] : rows) {
        const PerAxis<double> normal = contact.of_disks() ? direction(separation(packing.layout(), packing.q, contact))
                                                          : wall_normal<double>(contact);
        const double part = std::inner_product(force.begin(), force.end(), normal.begin(), 0.0);
        double along = 0;
        for (std::size_t a = 0; a < packing.axes(); ++a) {
            along = std::hypot(along, force[a] - part * normal[a]);
        }
        where = along > slip ? out.size() : where;
        slip = std::max(slip, along);
        sum += part;
        out.push_back(part);
    }
    const double sign = sum < 0 ? -1 : 1; // forces act on the first grain, or on the second one
    for (double& part : out) {
        part *= sign;
        attract += part < 0 ? 1 : 0;
    }
    if (attract > 0) {
        refuse(file,
               "of {} vectors {} pull where the others push: expected forces on the first grain of each row, or on the "
               "second one of each",
               out.size(), attract);
    }
    const double mean = out.empty() ? 1 : std::abs(sum) / static_cast<double>(out.size());
    if (!(slip <= force_agreement * mean)) {
        refuse(file,
               "the tangential force of {} is {:.3g} of the mean force: expected grains without friction (are the "
               "columns the components, in their order?)",
               to_string(rows[where].contact, packing.dimension), slip / mean);
    }
    words = fmt::format(", normal parts (tangential ones: at most {:.1e} of the mean force)", slip / mean);
    return out;
}

SoftList list_by_forces(const std::string& file, const Packing& packing, const std::vector<long>& ids,
                        std::optional<long> frame, const std::string& contacts, const PairColumns& columns) {
    if (ids.empty()) {
        refuse(file,
               "has no column id: expected one, the contacts speak of ids (--ids 0, or 1: the rows in their order)");
    }
    SoftList out;
    PairImages images(packing);
    std::map<Contact, double> forces;
    std::vector<PairForce> rows = read_local_dump(contacts, columns, ids, frame);
    const auto attract = columns.force.size() > 1
                             ? std::size_t{0}
                             : std::erase_if(rows, [](const PairForce& row) { return row.force[0] < 0; });
    std::vector<VectorForce> vectors;
    for (const PairForce& row : rows) {
        vectors.push_back({images.next(row.i, row.j), row.force});
    }
    std::string parts = attract == 0
                            ? ""
                            : fmt::format(" ({} more are negative: is {} a component? I,J,FX,FY takes vectors)",
                                          attract, columns.force[0]);
    const std::vector<double> numbers =
        columns.force.size() > 1 ? normal_parts(packing, vectors, contacts, parts) : std::vector<double>();
    for (std::size_t k = 0; k < rows.size(); ++k) {
        if (!forces.emplace(vectors[k].contact, numbers.empty() ? rows[k].force[0] : numbers[k]).second) {
            refuse(fmt::format("{}:{}", contacts, rows[k].line), "{}s {} and {} come twice{}: expected each pair once",
                   grain_word(packing.dimension), ids[static_cast<std::size_t>(rows[k].i)],
                   ids[static_cast<std::size_t>(rows[k].j)],
                   packing.cell.any() ? ", and no other image of them overlaps" : "");
        }
    }
    const std::size_t pairs = forces.size();
    const std::vector<Contact> walls = walls_of(packing);
    for (const Contact& wall : walls) {
        forces.emplace(wall, NAN);
    }
    const std::string with_walls = packing.cell.all() ? "" : fmt::format(", {} overlaps with walls", walls.size());
    out.words = fmt::format("{} pairs with a force in {}{}{}, without rattlers{}", pairs, contacts, parts, with_walls,
                            walls_apart(packing));
    const auto listed = forces | std::views::keys;
    out.contacts = able_to_carry(packing, {listed.begin(), listed.end()});
    std::ranges::transform(out.contacts, std::back_inserter(out.forces),
                           [&](const Contact& c) { return forces.at(c); });
    return out;
}

std::vector<Contact> near_contacts(const Packing& packing) {
    const double reach = 0.5 * packing.min_radius();
    return isostat::near_contacts(packing, reach, reach);
}

std::vector<Contact> overlaps_of(const Packing& packing) {
    std::vector<Contact> out = near_contacts(packing);
    std::erase_if(out, [&](const Contact& c) { return !(gap(packing, c) < 0); });
    return out;
}

SoftList list_by_overlaps(const Packing& packing) {
    SoftList out;
    out.contacts = overlaps_of(packing);
    out.words = fmt::format("{} overlaps, without rattlers{}", out.contacts.size(), walls_apart(packing));
    out.contacts = able_to_carry(packing, out.contacts);
    return out;
}

PairImages::PairImages(const Packing& packing) {
    if (!packing.cell.any()) {
        return;
    }
    for (const Contact& c : near_contacts(packing)) {
        if (c.of_disks()) {
            images_[{c.i, c.j}].by_gap.emplace_back(gap(packing, c), c);
        }
    }
    for (auto& [pair, images] : images_) {
        std::ranges::sort(images.by_gap);
    }
}

Contact PairImages::next(int i, int j) {
    const auto found = images_.find({std::min(i, j), std::max(i, j)});
    if (found == images_.end()) {
        return pair_of(i, j);
    }
    Images& images = found->second;
    const std::size_t row = images.rows++;
    const bool overlaps = row < images.by_gap.size() && images.by_gap[row].first < 0;
    return images.by_gap[overlaps ? row : 0].second;
}

} // namespace isostat::compare
