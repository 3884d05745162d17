#pragma once
/// \file
/// Pairs of grains by number, as other programs list them, and the images that these pairs stand for.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <map>
#include <utility>
#include <vector>

namespace isostat::compare {

class PairImages {
  public:
    /// Finds all images that overlap or are near. \pre the packing outlives the object
    explicit PairImages(const Packing& packing);
    /// The contact of the next row with these two grains: the deepest overlap of their images that no earlier row used;
    /// the nearest images when all are used, so that a surplus row repeats a contact. In a box the pair.
    Contact next(int i, int j);

  private:
    struct Images {
        std::vector<std::pair<double, Contact>> by_gap;
        std::size_t rows = 0;
    };
    std::map<std::pair<int, int>, Images> images_;
};

} // namespace isostat::compare
