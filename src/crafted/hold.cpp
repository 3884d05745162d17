#include "contact/separation.hpp"
#include "crafted/able.hpp"
#include "crafted/inspection_parts.hpp"

namespace isostat::crafted {

namespace {

/// A contact of a grain and the direction to it.
struct ContactDirection {
    std::size_t contact;
    PerAxis<Number> normal;
};

struct ExactSigns {
    template <std::size_t Count, class Expression>
    [[nodiscard]] int of(const std::array<ContactDirection, Count>& arms, Expression expression) const {
        std::array<PerAxis<Number>, Count> in;
        std::ranges::transform(arms, in.begin(), [](const ContactDirection& arm) { return arm.normal; });
        return expression(in).sign();
    }
};

/// Whether the directions span the space. Because 0 is a combination of them with positive factors, 0 is then in the
/// interior of their convex hull.
bool span_all(const std::vector<ContactDirection>& arms, int dimension) {
    exact::NumberMatrix matrix;
    matrix.rows = dimension;
    for (const ContactDirection& arm : arms) {
        auto& column = matrix.column.emplace_back();
        for (int a = 0; a < dimension; ++a) {
            const Number& component = arm.normal[static_cast<std::size_t>(a)];
            if (!component.is_zero()) {
                column.emplace_back(a, component);
            }
        }
    }
    const exact::Kernel kernel = exact::kernel(matrix);
    return kernel.rank == dimension;
}

/// Clears `carrying` of contacts that can carry no force until nothing changes, and sets `hold` of the grains whose
/// hold is not `fixed`, `loaded` or `member`.
void exclude_contacts(const std::vector<std::vector<ContactDirection>>& arms, Inspection& inspection, int dimension) {
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t i = 0; i < arms.size(); ++i) {
            DiskHold& hold = inspection.hold[i];
            if (hold >= DiskHold::fixed) {
                continue;
            }
            std::vector<ContactDirection> left = arms[i];
            std::erase_if(left, [&](const ContactDirection& arm) { return inspection.carrying[arm.contact] == 0; });
            const std::vector<ContactDirection> stay = able(left, ExactSigns{}, dimension == plane);
            for (const ContactDirection& arm : left) {
                inspection.carrying[arm.contact] = 0;
            }
            for (const ContactDirection& arm : stay) {
                inspection.carrying[arm.contact] = 1;
            }
            changed = changed || stay.size() < left.size();
            hold = stay.empty() ? DiskHold::rattler : (span_all(stay, dimension) ? DiskHold::held : DiskHold::bridge);
        }
    }
}

} // namespace

void judge_holds(Inspection& inspection, const ExactPacking& packing) {
    const auto n = packing.radius.size();
    std::vector<std::vector<ContactDirection>> arms(n);
    inspection.carrying.assign(inspection.contacts.size(), 1);
    for (std::size_t l = 0; l < inspection.contacts.size(); ++l) {
        const Contact& contact = inspection.contacts[l];
        const auto i = static_cast<std::size_t>(contact.i);
        const auto j = static_cast<std::size_t>(contact.j);
        if (contact.of_disks()) {
            const PerAxis<Number> r = exact_separation(packing, contact);
            arms[i].push_back({l, r});
            arms[j].push_back({l, {-r[0], -r[1], -r[2]}});
            continue;
        }
        arms[i].push_back({l, wall_normal<Number>(contact)});
        // A movable wall without load carries no force, because all its normals have the same direction.
        if (packing.walls.of(contact) == WallKind::movable && packing.load && packing.load->wall[j].is_zero()) {
            inspection.carrying[l] = 0;
        }
    }
    inspection.hold.assign(n, DiskHold::held);
    for (std::size_t k = 0; packing.load && k < packing.load->disk.size(); ++k) {
        if (!packing.load->disk[k].is_zero()) {
            inspection.hold[k / packing.axes()] = DiskHold::loaded;
        }
    }
    for (const Bar& bar : packing.bars) {
        inspection.hold[static_cast<std::size_t>(bar.i)] = DiskHold::member;
        inspection.hold[static_cast<std::size_t>(bar.j)] = DiskHold::member;
    }
    for (std::size_t i = 0; i < n; ++i) {
        inspection.hold[i] = packing.is_fixed(static_cast<int>(i)) ? DiskHold::fixed : inspection.hold[i];
    }
    exclude_contacts(arms, inspection, packing.dimension());
}

} // namespace isostat::crafted
