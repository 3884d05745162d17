#include "io/state_json.hpp"

#include "contact/images.hpp"
#include "core/refuse.hpp"
#include "packing/words.hpp"

#include <algorithm>
#include <numeric>

namespace isostat::json {

namespace {

int disk_index(const Field& field, int disks) {
    const long i = field.integer();
    if (i < 0 || i >= disks) {
        field.fail("a disk from 0 to {}", disks - 1);
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
            field.at(a).fail("from {} to {} periods: put the disks into the cell first", -farthest_image,
                             farthest_image);
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
        if (std::ranges::none_of(bars, [&](const Bar& bar) { return bar.i == i && bar.j == j; })) {
            field.fail("a bar of \"bars\"");
        }
        return {ContactKind::bar, i, j};
    }
    if (first.value().is_string()) {
        field.require_size(2, "[\"held\", coordinate]");
        const long coordinate = second.integer();
        const long limit = static_cast<long>(packing.q.size());
        if (first.string() != "held" || coordinate < 0 || coordinate >= limit) {
            field.fail("[\"held\", coordinate] with a coordinate from 0 to {}", limit - 1);
        }
        return {ContactKind::held, static_cast<int>(coordinate), 0};
    }
    const int i = disk_index(first, packing.disk_count());
    if (!second.value().is_string()) {
        return pair_from_json(field, i, disk_index(second, packing.disk_count()), packing);
    }
    field.require_size(2, "[disk, \"wall\"]");
    for (int a = 0; a < packing.dimension; ++a) {
        for (const WallFacts& facts : wall_facts) {
            const Contact wall(facts.kind, i, a);
            if (second.string() != wall_name(wall)) {
                continue;
            }
            if (packing.walls.of(wall) == WallKind::absent) {
                field.fail("a wall that the packing has");
            }
            return wall;
        }
    }
    second.fail("a grain or one of \"left\", \"right\", \"bottom\", \"top\"{}",
                packing.dimension == plane ? "" : ", \"back\", \"front\"");
}

Json terms(const std::vector<std::pair<Contact, Enclosure>>& list, int dimension) {
    return array_of(list, [dimension](const auto& row) {
        return Json::array({contact_to_json(row.first, dimension), row.second.value, row.second.radius});
    });
}

Enclosure enclosure_from(const Field& value, const Field& bound) {
    if (bound.number() < 0) {
        bound.fail("a bound, which is not negative");
    }
    return {value.number(), bound.number()};
}

std::vector<std::pair<Contact, Enclosure>> terms_from(const Field& field, const Packing& packing) {
    std::vector<std::pair<Contact, Enclosure>> list;
    for (std::size_t k = 0; k < field.size(); ++k) {
        const Field row = field.at(k);
        row.require_size(3, "[contact, value, bound]");
        list.emplace_back(contact_from_json(row.at(std::size_t{0}), packing),
                          enclosure_from(row.at(std::size_t{1}), row.at(std::size_t{2})));
    }
    return list;
}

} // namespace

Json contact_to_json(const Contact& contact, int dimension) {
    if (contact.is_wall()) {
        return Json::array({contact.i, wall_name(contact)});
    }
    if (contact.kind == ContactKind::disk_disk) {
        Json pair = Json::array({contact.i, contact.j});
        if (!contact.image.is_here()) {
            pair.push_back(Json::array());
            for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
                pair.back().push_back(static_cast<int>(contact.image.m[a]));
            }
        }
        return pair;
    }
    return contact.kind == ContactKind::bar ? Json::array({"bar", contact.i, contact.j})
                                            : Json::array({"held", contact.i});
}

Contact contact_from_json(const Field& field, const Packing& packing) {
    const Contact contact = contact_of(field, packing);
    if (const Json written = contact_to_json(contact, packing.dimension); written != field.value()) {
        field.fail("{}: a contact has one spelling", written.dump());
    }
    return contact;
}

void refuse_duplicates(const std::vector<Contact>& contacts, int dimension, const std::string& source,
                       const std::string& name) {
    std::vector<std::size_t> order(contacts.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return contacts[a] < contacts[b]; });
    for (std::size_t k = 1; k < order.size(); ++k) {
        if (contacts[order[k]] == contacts[order[k - 1]]) {
            refuse(source, "{}[{}] is {}, as {}[{}] already: expected each contact once", name, order[k],
                   to_string(contacts[order[k]], dimension), name, order[k - 1]);
        }
    }
}

Json perturbation_to_json(const RadiusPerturbation& perturbation, int dimension) {
    Json object;
    object["seed"] = perturbation.seed;
    object["rho"] = perturbation.rho;
    if (perturbation.load_zero.i >= 0) {
        object["load_zero"] = contact_to_json(perturbation.load_zero, dimension);
        object["stress_rate"] = Json::array({perturbation.stress_rate.value, perturbation.stress_rate.radius});
    }
    if (!perturbation.open.empty()) {
        object["open"] = terms(perturbation.open, dimension);
    }
    if (!perturbation.zero.empty()) {
        object["zero"] = terms(perturbation.zero, dimension);
    }
    return object;
}

RadiusPerturbation perturbation_from_json(const Field& field, const Packing& packing) {
    field.only({"seed", "rho", "load_zero", "stress_rate", "open", "zero"});
    RadiusPerturbation perturbation;
    if (!field.at("seed").value().is_number_unsigned()) {
        field.at("seed").fail("an integer from 0 to 2^64 - 1");
    }
    perturbation.seed = field.at("seed").value().get<std::uint64_t>();
    perturbation.rho = field.at("rho").numbers(packing.radius.size(), "one number per disk");
    if (field.has("load_zero")) {
        perturbation.load_zero = contact_from_json(field.at("load_zero"), packing);
        const Field rate = field.at("stress_rate");
        rate.require_size(2, "[value, bound]");
        perturbation.stress_rate = enclosure_from(rate.at(std::size_t{0}), rate.at(std::size_t{1}));
    }
    if (field.has("open")) {
        perturbation.open = terms_from(field.at("open"), packing);
    }
    if (field.has("zero")) {
        perturbation.zero = terms_from(field.at("zero"), packing);
    }
    return perturbation;
}

} // namespace isostat::json
