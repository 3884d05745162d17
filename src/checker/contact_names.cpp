// The names of contacts in records.
#include "checker/run_records.hpp"

#include <charconv>
#include <limits>

namespace isostat::checker {

namespace {

/// Takes a number from the front of a text.
template <class Number> bool take(std::string_view& text, Number& value) {
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
    return error == std::errc();
}

bool take_word(std::string_view& text, std::string_view word) {
    const bool there = text.starts_with(word);
    text.remove_prefix(there ? word.size() : 0);
    return there;
}

/// "held x of grain 4", after the first word.
std::optional<Contact> held_coordinate(std::string_view rest) {
    constexpr int most_grains = 1 << 29;
    const bool x = take_word(rest, "x of grain ");
    int grain = -1;
    if ((!x && !take_word(rest, "y of grain ")) || !take(rest, grain) || !rest.empty() || grain < 0 ||
        grain > most_grains) {
        return {};
    }
    return Contact{ContactKind::held, 2 * grain + (x ? 0 : 1), 0};
}

/// What follows "3-": another disk, or a wall.
std::optional<Contact> contact_with(int i, std::string_view rest) {
    for (int axis = 0; axis < 2; ++axis) {
        if (rest == (axis == 0 ? "left" : "bottom")) {
            return Contact{ContactKind::lower_wall, i, axis};
        }
        if (rest == (axis == 0 ? "right" : "top")) {
            return Contact{ContactKind::upper_wall, i, axis};
        }
    }
    int j = -1;
    Image image;
    const bool pair = take(rest, j) && j >= 0;
    const bool here = rest.empty();
    constexpr auto farthest = std::numeric_limits<std::int8_t>::max(); // what has an opposite
    const bool there = take_word(rest, "(") && take(rest, image.m[0]) && take_word(rest, ",") &&
                       take(rest, image.m[1]) && rest == ")" && image.m[0] >= -farthest && image.m[1] >= -farthest;
    return pair && (here || there) ? std::optional(Contact{ContactKind::disk_disk, i, j, image}) : std::nullopt;
}

} // namespace

std::optional<Contact> contact_spelt(std::string_view name) {
    std::string_view rest = name;
    int i = -1;
    const std::optional<Contact> contact = take_word(rest, "held ")                          ? held_coordinate(rest)
                                           : take(rest, i) && i >= 0 && take_word(rest, "-") ? contact_with(i, rest)
                                                                                             : std::nullopt;
    const bool itself =
        contact && contact->kind == ContactKind::disk_disk && contact->i == contact->j && contact->image.is_here();
    const bool turned = contact && contact->kind == ContactKind::disk_disk &&
                        !(pair_of(contact->i, contact->j, contact->image) == *contact);
    return contact && !itself && !turned && to_string(*contact) == name ? contact : std::nullopt;
}

std::optional<Contact> contact_named(std::string_view name, const Packing& packing) {
    const std::optional<Contact> contact = contact_spelt(name);
    if (!contact) {
        return {};
    }
    if (contact->kind == ContactKind::held) {
        return contact->i < static_cast<int>(packing.q.size()) ? contact : std::nullopt;
    }
    bool there = contact->i < packing.disk_count() &&
                 (contact->kind != ContactKind::disk_disk || contact->j < packing.disk_count());
    for (std::size_t a = 0; a < 2; ++a) {
        there = there && (contact->image.m[a] == 0 || packing.cell.periodic[a]);
    }
    return there ? contact : std::nullopt;
}

bool may_be(const Contact& columns, const Contact& pair) {
    return columns.kind == pair.kind && columns.i == pair.i && columns.j == pair.j;
}

std::optional<Contact> contact_of_columns(int i, int j, const Packing& packing) {
    const int disks = packing.disk_count();
    if (i < 0 || i >= disks || j < -4 || j >= disks || (j >= 0 && j < i) || (i == j && !packing.cell.any())) {
        return {};
    }
    if (j >= 0) {
        return Contact{ContactKind::disk_disk, i, j};
    }
    return j >= -2 ? Contact{ContactKind::lower_wall, i, -1 - j} : Contact{ContactKind::upper_wall, i, -3 - j};
}

} // namespace isostat::checker
