#include "certificate/subject.hpp"

namespace isostat {

namespace {

std::vector<unsigned char> zeros(const ContactPattern& pattern, const std::vector<int>& loaded) {
    std::vector<unsigned char> zero = pattern.carrying(loaded);
    for (unsigned char& z : zero) {
        z = z == 0 ? 1 : 0;
    }
    return zero;
}

} // namespace

Subject::Subject(const State& s, const IsostaticStructure& structure)
    : state(s), dofs(structure.dofs()), pattern(s.packing, structure), loaded_rows(s.load.loaded_rows(s.packing, dofs)),
      wall_row(s.load.loaded_wall_row(s.packing, dofs)) {
    std::vector<int> all = loaded_rows;
    if (wall_row >= 0) {
        all.push_back(wall_row); // also when its stress is 0 now
    }
    zero = zeros(pattern, all);
    zero_slope =
        wall_row < 0 ? std::vector<unsigned char>(s.contacts.size(), 1) : zeros(pattern, std::vector<int>{wall_row});
}

std::vector<int> Subject::vanish_with(int opens) const {
    const auto first = static_cast<std::size_t>(opens);
    const std::vector<unsigned char> others = pattern.carrying_without(ContactId(first), wall_row, loaded_rows);
    std::vector<int> members;
    for (std::size_t l = 0; l < others.size(); ++l) {
        if (l != first && others[l] == 0 && zero[l] == 0) {
            members.push_back(static_cast<int>(l));
        }
    }
    return members;
}

} // namespace isostat
