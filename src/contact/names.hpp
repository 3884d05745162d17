#pragma once
/// \file
/// Lists of names for records and messages.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <string>
#include <vector>

namespace isostat {

/// "12-40", "3-left", ...
inline std::vector<std::string> contact_names(const std::vector<Contact>& contacts, int dimension = 2) {
    std::vector<std::string> names;
    for (const Contact& contact : contacts) {
        names.push_back(to_string(contact, dimension));
    }
    return names;
}

/// Names of the N_f degrees of freedom, in their order: "x of disk 3", "top wall", ...
inline std::vector<std::string> dof_names(const Packing& packing) {
    const DofMap dofs(packing);
    std::vector<std::string> names;
    for (int d = 0; d < dofs.dof_count(); ++d) {
        names.push_back(dofs.name(d));
    }
    return names;
}

} // namespace isostat
