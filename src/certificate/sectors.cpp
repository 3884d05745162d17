#include "certificate/sectors.hpp"

#include <isostat/contact/state.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace isostat {

std::optional<std::string> beyond_sectors(const ArcBodies& arcs, const std::vector<Contact>& contacts,
                                          double distance) {
    if (arcs.any() && !(distance < arcs.known_to())) {
        return "the vertex is not known well enough to say which arcs are nearest, or arcs are no convex curve there";
    }
    const auto outside =
        std::ranges::find_if(contacts, [&](const Contact& contact) { return !arcs.faces(contact, distance); });
    return outside == contacts.end() ? std::nullopt
                                     : std::optional(fmt::format("contact {} is not inside the arcs of its members: at "
                                                                 "a joint, or beyond",
                                                                 to_string(*outside)));
}

} // namespace isostat
