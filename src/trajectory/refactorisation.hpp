#pragma once
// When the factors that steer are made anew, and how: private to the room.

#include "core/parallel.hpp"
#include "linear/approximate_inverse.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// When new factors are due: as soon as an arc costs more than the average since the last ones, their making included,
/// which keeps that average smallest. What an arc costs is smoothed over a few: single ones cost twice as much as
/// others. Counts passes, never seconds.
class RefactorisationRule {
  public:
    /// An arc that took so many passes of `inverse`.
    void add(int passes, const ApproximateInverse& inverse) {
        const double cost = passes * inverse.relative_cost();
        recent_ = arcs_ == 0 ? cost : recent_ + (cost - recent_) / smoothed_over;
        sum_ += cost;
        ++arcs_;
    }
    [[nodiscard]] bool due(const ApproximateInverse& inverse) const {
        return inverse.exchanges() > 0 && recent_ * arcs_ > inverse.renewal_cost() + sum_;
    }
    void restart() { *this = {}; }

  private:
    static constexpr double smoothed_over = 4;
    double recent_ = 0;
    double sum_ = 0;
    int arcs_ = 0;
};

/// New factors made beside the arcs, which go on with the old ones meanwhile.
class Refactorisation {
  public:
    /// Of the matrix that `old` stands for. Nothing when one is under way.
    void begin(const ApproximateInverse& old, std::shared_ptr<const sparse::Matrix<double>> matrix) {
        if (!factors_.pending()) {
            slots_.clear();
            arcs_left_ = std::clamp(static_cast<int>(old.renewal_cost() / passes_beside_an_arc), 1, most_arcs_beside);
            factors_ = Future<ApproximateInverse>([old, matrix = std::move(matrix)] { return old.renewed(*matrix); });
        }
    }
    /// One more exchange: the new factors with all that they missed, when it is time to take them.
    std::optional<ApproximateInverse> after(int slot, const sparse::Matrix<double>& matrix) {
        if (!factors_.pending()) {
            return std::nullopt;
        }
        if (std::find(slots_.begin(), slots_.end(), slot) == slots_.end()) {
            slots_.push_back(slot);
        }
        if (--arcs_left_ > 0) {
            return std::nullopt;
        }
        ApproximateInverse inverse = factors_.get();
        for (const int missed : slots_) {
            inverse = inverse.exchanged(missed, matrix);
        }
        return inverse;
    }

  private:
    /// A core makes the new factors while the other goes so far. By count of operations: when they are ready depends
    /// on the machine, when they are taken must not.
    static constexpr double passes_beside_an_arc = 9;
    static constexpr int most_arcs_beside = 8;
    Future<ApproximateInverse> factors_;
    std::vector<int> slots_; ///< exchanged since
    int arcs_left_ = 0;
};

} // namespace isostat
