#pragma once
/// \file
/// Pairs of grains by number, as other programs list them, and the images that they mean.

#include <isostat/contact/state.hpp>
#include <isostat/packing/packing.hpp>

#include <map>
#include <utility>
#include <vector>

namespace isostat::compare {

class PairImages {
  public:
    /// Grains of the packing overlap or are near. \pre the packing outlives it
    explicit PairImages(const Packing& packing);
    /// What the next row of these two grains means: the deepest overlap of their images that no row before meant; the
    /// nearest images when all were meant, so that a row too many is one that comes twice. In a box the pair.
    Contact next(int i, int j);

  private:
    struct Images {
        std::vector<std::pair<double, Contact>> by_gap;
        std::size_t rows = 0;
    };
    std::map<std::pair<int, int>, Images> images_;
};

} // namespace isostat::compare
