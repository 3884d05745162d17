// The names of contacts in records.
#include "checker/run_records.hpp"

#include <fmt/format.h>

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
std::optional<Contact> held_coordinate(std::string_view rest, int dimension) {
    constexpr int most_grains = 1 << 29; // cost: the largest number of a grain that is read
    const int axis = rest.empty() ? -1 : rest.front() - 'x';
    int grain = -1;
    if (axis < 0 || axis >= dimension || (rest.remove_prefix(1), !take_word(rest, " of grain ")) ||
        !take(rest, grain) || !rest.empty() || grain < 0 || grain > most_grains) {
        return {};
    }
    return Contact{ContactKind::held, dimension * grain + axis, 0};
}

/// What follows "3-": another disk, or a wall.
std::optional<Contact> contact_with(int i, std::string_view rest, int dimension) {
    for (int axis = 0; axis < dimension; ++axis) {
        for (const WallFacts& facts : wall_facts) {
            const Contact wall{facts.kind, i, axis};
            if (to_string(wall, dimension).ends_with(fmt::format("-{}", rest))) {
                return wall;
            }
        }
    }
    int j = -1;
    Image image;
    const bool pair = take(rest, j) && j >= 0;
    const bool here = rest.empty();
    constexpr auto farthest = std::numeric_limits<std::int8_t>::max(); // larger values have no opposite
    bool there = !here;
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension) && there; ++a) {
        there = take_word(rest, a == 0 ? "(" : ",") && take(rest, image.m[a]) && image.m[a] >= -farthest;
    }
    there = there && rest == ")";
    return pair && (here || there) ? std::optional(Contact{ContactKind::disk_disk, i, j, image}) : std::nullopt;
}

} // namespace

std::optional<Contact> contact_spelt(std::string_view name, int dimension) {
    std::string_view rest = name;
    int i = -1;
    const std::optional<Contact> contact = take_word(rest, "held ") ? held_coordinate(rest, dimension)
                                           : take(rest, i) && i >= 0 && take_word(rest, "-")
                                               ? contact_with(i, rest, dimension)
                                               : std::nullopt;
    const bool itself = contact && contact->of_disks() && contact->i == contact->j && contact->image.is_here();
    const bool turned =
        contact && contact->of_disks() && !(pair_of(contact->i, contact->j, contact->image) == *contact);
    return contact && !itself && !turned && to_string(*contact, dimension) == name ? contact : std::nullopt;
}

std::optional<Contact> contact_named(std::string_view name, const Packing& packing) {
    const std::optional<Contact> contact = contact_spelt(name, packing.dimension);
    if (!contact) {
        return {};
    }
    if (contact->kind == ContactKind::held) {
        return contact->i < static_cast<int>(packing.q.size()) ? contact : std::nullopt;
    }
    bool there = contact->i < packing.disk_count() && (!contact->of_disks() || contact->j < packing.disk_count());
    for (std::size_t a = 0; a < packing.axes(); ++a) {
        there = there && (contact->image.m[a] == 0 || packing.cell.periodic[a]);
    }
    return there ? contact : std::nullopt;
}

bool may_be(const Contact& columns, const Contact& pair) {
    return columns.kind == pair.kind && columns.i == pair.i && columns.j == pair.j;
}

std::optional<Contact> contact_of_columns(int i, int j, const Packing& packing) {
    const int disks = packing.disk_count();
    if (i < 0 || i >= disks || j >= disks || (j >= 0 && j < i) || (i == j && !packing.cell.any())) {
        return {};
    }
    if (j >= 0) {
        return Contact{ContactKind::disk_disk, i, j};
    }
    for (int axis = 0; axis < packing.dimension; ++axis) {
        for (const WallFacts& facts : wall_facts) {
            if (contact_columns({facts.kind, i, axis}).second == j) {
                return Contact{facts.kind, i, axis};
            }
        }
    }
    return {};
}

} // namespace isostat::checker
