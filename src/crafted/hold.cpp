#include "crafted/hold.hpp"

#include "contact/separation.hpp"
#include "crafted/carrying.hpp"

#include <functional>

namespace isostat::crafted {

namespace {

struct ExactNormal {
    Number x, y;
};

int cross_sign(const ExactNormal& a, const ExactNormal& b) {
    return (a.x * b.y - a.y * b.x).sign();
}
int dot_sign(const ExactNormal& a, const ExactNormal& b) {
    return (a.x * b.x + a.y * b.y).sign();
}

} // namespace

void judge_holds(Inspection& inspection, const ExactPacking& packing) {
    const auto n = packing.radius.size();
    std::vector<Arms<ExactNormal>> arms(n);
    inspection.carrying.assign(inspection.contacts.size(), 1);
    inspection.hold.assign(n, DiskHold::held);
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Contact& contact = inspection.contacts[l];
        const auto i = static_cast<std::size_t>(contact.i);
        const auto j = static_cast<std::size_t>(contact.j);
        if (contact.kind == ContactKind::disk_disk) {
            const auto [x, y, none] =
                Separation(contact, packing.layout())
                    .of_disks([&](std::size_t k) -> const Number& { return packing.coordinate(k); }, std::minus<>());
            arms[i].push_back({l, {x, y}});
            arms[j].push_back({l, {-x, -y}});
            continue;
        }
        const int side = contact.kind == ContactKind::lower_wall ? -1 : 1;
        arms[i].push_back({l, {Number(j == 0 ? side : 0), Number(j == 1 ? side : 0)}});
        // A movable wall under no force carries none: all its normals point the same way.
        if (side > 0 && packing.walls.upper[j] == WallKind::movable && packing.load &&
            packing.load->wall[j].is_zero()) {
            inspection.carrying[l] = 0;
        }
    }
    for (std::size_t i = 0; i < n; ++i) {
        const bool loaded = packing.load && !packing.load->disk.empty() &&
                            !(packing.load->disk[2 * i].is_zero() && packing.load->disk[2 * i + 1].is_zero());
        inspection.hold[i] =
            packing.is_fixed(static_cast<int>(i)) ? DiskHold::fixed : (loaded ? DiskHold::loaded : DiskHold::held);
    }
    exclude_contacts(arms, inspection.carrying, inspection.hold);
}

} // namespace isostat::crafted
