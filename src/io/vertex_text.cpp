#include "io/vertex_text.hpp"

#include "io/json.hpp"
#include "io/lines.hpp"
#include "io/state_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace isostat {

namespace {

constexpr long most = 100'000'000;

/// Types of the format: 0 disk-disk, then the walls.
constexpr std::array<Contact, 4> wall_of_type{{{ContactKind::lower_wall, 0, 0},
                                               {ContactKind::lower_wall, 0, 1},
                                               {ContactKind::upper_wall, 0, 0},
                                               {ContactKind::upper_wall, 0, 1}}};

Contact contact_of(const TextLine& row, int disks) {
    const long type = row.integer(0, "type of the contact", 0, 4);
    const auto i = static_cast<int>(row.integer(1, "first disk of the contact", 0, disks - 1));
    if (type != 0) {
        Contact contact = wall_of_type[static_cast<std::size_t>(type - 1)];
        contact.i = i;
        return contact;
    }
    const auto j = static_cast<int>(row.integer(2, "second disk of the contact", 0, disks - 1));
    if (i == j) {
        row.fail(row.field(2), "second disk of the contact", "another disk than the first");
    }
    return {ContactKind::disk_disk, std::min(i, j), std::max(i, j)};
}

/// The first row: the number of disks, and the names of the columns when the radius is not the first of them.
struct Head {
    int disks;
    bool radius_first;
};

Head head_of(TextLines& rows) {
    constexpr std::array<std::string_view, 5> names{"x", "y", "r", "gx", "gy"};
    const TextLine row = rows.next_row("the number of disks", 0);
    const Head head{static_cast<int>(row.integer(0, "number of disks", 1, most)), row.size() == 1};
    for (std::size_t k = 1; k < row.size(); ++k) {
        if (row.size() != 1 + names.size() || row.field(k) != names[k - 1]) {
            row.fail(row.field(k), "name of a column",
                     "the number of disks alone (rows radius x y gx gy), or x y r gx gy after it");
        }
    }
    return head;
}

} // namespace

State parse_vertex_text(const std::string& text, const std::string& source) {
    TextLines rows(text, source);
    State state;
    const auto [disks, radius_first] = head_of(rows);
    const std::size_t size = radius_first ? 0 : 2, first = radius_first ? 1 : 0;
    const char* const order = radius_first ? "radius x y gx gy" : "x y r gx gy";
    for (int i = 0; i < disks; ++i) {
        const TextLine row = rows.next_row(fmt::format("disk {} of {}: {}", i, disks, order), 5);
        state.packing.radius.push_back(row.positive(size, fmt::format("radius of disk {}", i)));
        state.packing.q.push_back(row.number(first, fmt::format("x of disk {}", i)));
        state.packing.q.push_back(row.number(first + 1, fmt::format("y of disk {}", i)));
        state.load.infinitesimal.push_back(row.number(3, fmt::format("gx of disk {}", i)));
        state.load.infinitesimal.push_back(row.number(4, fmt::format("gy of disk {}", i)));
    }
    const TextLine box = rows.next_row("the box: Lx Ly", 2);
    for (std::size_t a = 0; a < 2; ++a) {
        state.packing.q.push_back(box.positive(a, a == 0 ? "Lx" : "Ly"));
        state.load.stress[a] = 1;
    }
    validate(state.packing, source);
    const auto contacts =
        static_cast<int>(rows.next_row("the number of contacts", 1).integer(0, "number of contacts", 0, most));
    for (int l = 0; l < contacts; ++l) {
        state.contacts.push_back(
            contact_of(rows.next_row(fmt::format("contact {} of {}: type i j", l, contacts), 3), disks));
    }
    rows.finish(fmt::format("the end of the file after {} contacts", contacts));
    json::refuse_duplicates(state.contacts, plane, source, "contacts");
    std::ranges::sort(state.contacts);
    state.load.refer_to(state.packing);
    state.provenance = json::dumped({{"converted_from", source}});
    return state;
}

} // namespace isostat
