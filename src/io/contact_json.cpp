#include "contact/images.hpp"
#include "io/state_json.hpp"

#include <isostat/core/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace isostat::json {

namespace {

constexpr std::array<const char*, 3> lower_name{"left", "bottom", "back"};
constexpr std::array<const char*, 3> upper_name{"right", "top", "front"};

int disk_index(const Field& field, int disks) {
    const long i = field.integer();
    if (i < 0 || i >= disks) {
        field.fail(fmt::format("a disk from 0 to {}", disks - 1));
    }
    return static_cast<int>(i);
}

/// The third element of [i, j, [mx, my]].
Image image_of(const Field& field, const Packing& packing) {
    if (!packing.cell.any()) {
        field.fail("[disk, disk]: images are of a periodic \"cell\"");
    }
    field.require_size(packing.axes(), "one number of periods per axis");
    Image image;
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const long m = field.at(a).integer();
        if (m != 0 && !packing.cell.periodic[a]) {
            field.at(a).fail("0, as that axis has walls");
        }
        if (m < -farthest_image || m > farthest_image) {
            field.at(a).fail(fmt::format("from {} to {} periods: put the disks into the cell first", -farthest_image,
                                         farthest_image));
        }
        image.m[a] = static_cast<std::int8_t>(m);
    }
    return image;
}

Contact pair_from_json(const Field& field, int i, int j, const Packing& packing) {
    const Image image = field.size() == 3 ? image_of(field.at(std::size_t{2}), packing) : Image{};
    if (i == j && image.is_here()) {
        field.fail(packing.cell.any() ? "two different disks, or the image of one that is not itself"
                                      : "two different disks");
    }
    return pair_of(i, j, image);
}

} // namespace

Json contact_to_json(const Contact& contact, int dimension) {
    const auto axis = static_cast<std::size_t>(contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk: {
        Json pair = Json::array({contact.i, contact.j});
        if (!contact.image.is_here()) {
            pair.push_back(Json::array());
            for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
                pair.back().push_back(static_cast<int>(contact.image.m[a]));
            }
        }
        return pair;
    }
    case ContactKind::lower_wall: return Json::array({contact.i, lower_name[axis]});
    case ContactKind::upper_wall: return Json::array({contact.i, upper_name[axis]});
    case ContactKind::bar: return Json::array({"bar", contact.i, contact.j});
    case ContactKind::held: return Json::array({"held", contact.i});
    }
    return {};
}

namespace {

Contact contact_of(const Field& field, const Packing& packing) {
    if (field.size() != 3) {
        field.require_size(2, "[disk, disk], [disk, disk, [mx, my]], [disk, \"wall\"] or [\"held\", coordinate]");
    }
    const Field first = field.at(std::size_t{0});
    const Field second = field.at(std::size_t{1});
    if (first.value().is_string() && first.string() == "bar") {
        field.require_size(3, "[\"bar\", disk, disk]");
        const int i = disk_index(second, packing.disk_count());
        const int j = disk_index(field.at(std::size_t{2}), packing.disk_count());
        const auto& bars = packing.bars;
        if (std::none_of(bars.begin(), bars.end(), [&](const Bar& bar) { return bar.i == i && bar.j == j; })) {
            field.fail("a bar of \"bars\"");
        }
        return {ContactKind::bar, i, j};
    }
    if (first.value().is_string()) {
        field.require_size(2, "[\"held\", coordinate]");
        const long coordinate = second.integer();
        const long limit = static_cast<long>(packing.q.size());
        if (first.string() != "held" || coordinate < 0 || coordinate >= limit) {
            field.fail(fmt::format("[\"held\", coordinate] with a coordinate from 0 to {}", limit - 1));
        }
        return {ContactKind::held, static_cast<int>(coordinate), 0};
    }
    const int i = disk_index(first, packing.disk_count());
    if (!second.value().is_string()) {
        return pair_from_json(field, i, disk_index(second, packing.disk_count()), packing);
    }
    field.require_size(2, "[disk, \"wall\"]");
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        const bool lower = second.string() == lower_name[a];
        if (!lower && second.string() != upper_name[a]) {
            continue;
        }
        if ((lower ? packing.walls.lower[a] : packing.walls.upper[a]) == WallKind::absent) {
            field.fail("a wall that the packing has");
        }
        return {lower ? ContactKind::lower_wall : ContactKind::upper_wall, i, static_cast<int>(a)};
    }
    second.fail(fmt::format("a grain or one of \"left\", \"right\", \"bottom\", \"top\"{}",
                            packing.dimension == plane ? "" : ", \"back\", \"front\""));
}

} // namespace

Contact contact_from_json(const Field& field, const Packing& packing) {
    const Contact contact = contact_of(field, packing);
    if (const Json written = contact_to_json(contact, packing.dimension); written != field.value()) {
        field.fail(fmt::format("{}: a contact has one spelling", written.dump()));
    }
    return contact;
}

void refuse_duplicates(const std::vector<Contact>& contacts, int dimension, const std::string& source,
                       const std::string& name) {
    std::vector<std::size_t> order(contacts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return contacts[a] < contacts[b]; });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (contacts[order[k]] == contacts[order[k - 1]]) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: {}[{}] is {}, as {}[{}] already: expected each contact once", source, name,
                                    order[k], to_string(contacts[order[k]], dimension), name, order[k - 1]));
        }
    }
}

} // namespace isostat::json
