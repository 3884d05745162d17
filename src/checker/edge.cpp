#include "checker/index.hpp"
#include "checker/structural_zeros.hpp"
#include "checker/strut.hpp"

#include <algorithm>

namespace isostat::checker {

namespace {

bool is_wall(const Contact& c) {
    return c.kind == ContactKind::lower_wall || c.kind == ContactKind::upper_wall;
}

/// The sphere of `wall` touches the two walls, and so does the other sphere of the contact.
bool with_a_sphere_there(const std::vector<Contact>& contacts, const Contact& c, const Contact& wall,
                         const Contact& other) {
    const auto touches = [&](Contact at) {
        at.i = c.i == wall.i ? c.j : c.i;
        return std::find(contacts.begin(), contacts.end(), at) != contacts.end();
    };
    return c.of_disks() && touches(wall) && touches(other);
}

} // namespace

bool equal_in_edge(const Evidence& evidence, const Forces& load, const std::vector<int>& zeros, std::size_t a,
                   std::size_t b) {
    const std::vector<Contact>& contacts = evidence.state.contacts;
    const Problem& problem = evidence.problem;
    const Contact& one = contacts[a];
    const Contact& other = contacts[b];
    if (!is_wall(one) || !is_wall(other) || one.i != other.i || one.j == other.j) {
        return false;
    }
    for (const int axis : {one.j, other.j}) {
        const int dof = problem.dof_of[problem.layout.of_disk(one.i) + static_cast<std::size_t>(axis)];
        const auto row = static_cast<std::size_t>(dof);
        if (dof < 0 || load[row].lower != 0 || load[row].upper != 0) {
            return false;
        }
        const std::vector<int>& acting = problem.acting_on[row];
        const bool alike = std::all_of(acting.begin(), acting.end(), [&](int l) {
            const auto k = static_cast<std::size_t>(l);
            return k == a || k == b || contains(zeros, k) || with_a_sphere_there(contacts, contacts[k], one, other);
        });
        if (!alike) {
            return false;
        }
    }
    return true;
}

bool vanish_with(const Evidence& evidence, const Forces& load, const std::vector<int>& contacts, std::size_t one) {
    const auto vary = [&](const std::vector<int>& some) {
        return some.size() == 1 || vary_together(evidence.problem, some, load);
    };
    if (vary(contacts)) {
        return true;
    }
    const auto zeros = structural_zeros(evidence.problem, load);
    std::vector<int> rest = contacts;
    return zeros &&
           std::erase_if(
               rest, [&](int l) { return equal_in_edge(evidence, load, *zeros, one, static_cast<std::size_t>(l)); }) >
               0 &&
           vary(rest);
}

} // namespace isostat::checker
