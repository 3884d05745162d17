#pragma once
/// \file
/// The number of self-stresses of a growing list of contacts: private to the room.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <utility>
#include <vector>

namespace isostat::crafted {

/// h of the first m contacts of a list, m = 0 .. M: it only grows. Ranks are computed where this leaves h open.
class Hyperstaticity {
  public:
    /// `contacts[m]`: contacts among the first m candidates; `compute(m)`: their rank; `most`: bound of all ranks.
    Hyperstaticity(std::vector<int> contacts, int most, std::function<int(int)> compute)
        : contacts_(std::move(contacts)), most_(most), compute_(std::move(compute)), known_(contacts_.size(), -1) {
        known_[0] = 0;
    }

    /// h with the first m candidates.
    int at(int m) {
        const auto k = static_cast<std::size_t>(m);
        if (known_[k] < 0) {
            auto below = k, above = k;
            while (known_[below] < 0) {
                --below;
            }
            while (above < known_.size() && known_[above] < 0) {
                ++above;
            }
            // The rank never falls either, so equal values on both sides determine the values between.
            const int low = contacts_[below] - known_[below];
            if (low == most_ || (above < known_.size() && contacts_[above] - known_[above] == low)) {
                known_[k] = contacts_[k] - low;
            } else if (contacts_[k] == contacts_[below] || (above < known_.size() && known_[above] == known_[below])) {
                known_[k] = known_[below];
            } else {
                known_[k] = contacts_[k] - compute_(m);
                ++computed_;
            }
        }
        return known_[k];
    }

    /// h for every one of `lists` (sorted), in the order that needs the fewest ranks.
    void at_all(const std::vector<int>& lists) {
        if (!lists.empty()) {
            at(lists.back());
            halve(lists, 0, lists.size() - 1);
        }
    }

    /// Largest of the sorted `ends` with h = 0; `most`: by counting, h > 0 at every end beyond this one. 0 when none.
    int last_without(const std::vector<int>& ends, int most) {
        auto in = ends.begin();
        auto outside = std::ranges::upper_bound(ends, most);
        if (outside == in) {
            return 0;
        }
        if (at(*(outside - 1)) == 0) { // the usual case: one rank decides everything
            return *(outside - 1);
        }
        --outside;
        // h = 0 up to `in`, and h > 0 at `outside`.
        while (in != outside) {
            const auto middle = in + (outside - in) / 2;
            (at(*middle) == 0 ? in : outside) = at(*middle) == 0 ? middle + 1 : middle;
        }
        return in == ends.begin() ? 0 : *(in - 1);
    }

    [[nodiscard]] int computed() const { return computed_; }

  private:
    void halve(const std::vector<int>& lists, std::size_t first, std::size_t last) {
        at(lists[first]);
        at(lists[last]);
        if (last - first > 1) {
            const std::size_t middle = first + (last - first) / 2;
            halve(lists, first, middle);
            halve(lists, middle, last);
        }
    }

    std::vector<int> contacts_;
    int most_;
    std::function<int(int)> compute_;
    std::vector<int> known_; ///< -1: not computed yet
    int computed_ = 0;
};

} // namespace isostat::crafted
