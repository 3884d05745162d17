#include "io/contact_json.hpp"

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

} // namespace

template <int Dim> Json contact_to_json(const Contact& contact) {
    const auto axis = static_cast<std::size_t>(contact.j);
    switch (contact.kind) {
    case ContactKind::disk_disk: return Json::array({contact.i, contact.j});
    case ContactKind::lower_wall: return Json::array({contact.i, lower_name[axis]});
    case ContactKind::upper_wall: return Json::array({contact.i, upper_name[axis]});
    case ContactKind::held: return Json::array({"held", contact.i});
    }
    return {};
}

template <int Dim> Contact contact_from_json(const Field& field, const Packing<Dim>& packing) {
    field.require_size(2, "[disk, disk], [disk, \"wall\"] or [\"held\", coordinate]");
    const Field first = field.at(std::size_t{0});
    const Field second = field.at(std::size_t{1});
    if (first.value().is_string()) {
        const long coordinate = second.integer();
        const long limit = static_cast<long>(packing.q.size());
        if (first.string() != "held" || coordinate < 0 || coordinate >= limit) {
            field.fail(fmt::format("[\"held\", coordinate] with a coordinate from 0 to {}", limit - 1));
        }
        return {ContactKind::held, static_cast<int>(coordinate), 0};
    }
    const int i = disk_index(first, packing.disk_count());
    if (!second.value().is_string()) {
        const int j = disk_index(second, packing.disk_count());
        if (i == j) {
            field.fail("two different disks");
        }
        return {ContactKind::disk_disk, std::min(i, j), std::max(i, j)};
    }
    for (std::size_t a = 0; a < Dim; ++a) {
        const bool lower = second.string() == lower_name[a];
        if (!lower && second.string() != upper_name[a]) {
            continue;
        }
        if ((lower ? packing.walls.lower[a] : packing.walls.upper[a]) == WallKind::absent) {
            field.fail("a wall that the packing has");
        }
        return {lower ? ContactKind::lower_wall : ContactKind::upper_wall, i, static_cast<int>(a)};
    }
    second.fail("a disk or one of \"left\", \"right\", \"bottom\", \"top\"");
}

template <int Dim>
void refuse_duplicates(const std::vector<Contact>& contacts, const std::string& source, const std::string& name) {
    std::vector<std::size_t> order(contacts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return contacts[a] < contacts[b]; });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (contacts[order[k]] == contacts[order[k - 1]]) {
            throw Error(ErrorKind::bad_input,
                        fmt::format("{}: {}[{}] is {}, as {}[{}] already: expected each contact once", source, name,
                                    order[k], to_string<Dim>(contacts[order[k]]), name, order[k - 1]));
        }
    }
}

template Json contact_to_json<2>(const Contact&);
template Contact contact_from_json<2>(const Field&, const Packing<2>&);
template void refuse_duplicates<2>(const std::vector<Contact>&, const std::string&, const std::string&);

} // namespace isostat::json
