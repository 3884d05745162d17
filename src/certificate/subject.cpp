#include "certificate/true_vertex.hpp"

namespace isostat {

Subject::Subject(const State& s, const IsostaticStructure& structure)
    : state(s), dofs(structure.dofs()), pattern(s.packing, structure), loaded_rows(s.load.loaded_rows(s.packing, dofs)),
      changing_rows(s.load.changing_rows(s.packing, dofs)) {
    std::vector<int> all = loaded_rows;
    all.insert(all.end(), changing_rows.begin(), changing_rows.end()); // also when their stress is 0 now
    zero = pattern.carrying(all);
    for (unsigned char& z : zero) {
        z = z == 0 ? 1 : 0;
    }
}

std::vector<int> Subject::vanish_with(int opens) const {
    const auto first = static_cast<std::size_t>(opens);
    const std::vector<unsigned char> others = pattern.carrying_without(ContactId(first), changing_rows, loaded_rows);
    std::vector<int> members;
    for (std::size_t l = 0; l < others.size(); ++l) {
        if (l != first && others[l] == 0 && zero[l] == 0) {
            members.push_back(static_cast<int>(l));
        }
    }
    return members;
}

} // namespace isostat
