#pragma once
// When and how the factors that steering uses are made anew: private to the room.

#include "core/parallel.hpp"
#include "linear/approximate_inverse.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// New factors are due as soon as an arc costs more than the average since the last ones, including the cost of making
/// factors, because this keeps the average smallest. The cost of an arc is smoothed over a few arcs, because single
/// ones cost twice as much as others. Cost is counted in passes, never in seconds.
class RefactorisationRule {
  public:
    /// Counts an arc that took `passes` of `inverse`.
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

/// New factors computed by another thread, while the arcs continue with the old ones.
class Refactorisation {
  public:
    /// Begins factors of the matrix that `old` stands for. Does nothing when others are under way.
    void begin(const ApproximateInverse& old, std::shared_ptr<const sparse::Matrix<double>> matrix) {
        if (!factors_.pending()) {
            slots_.clear();
            arcs_left_ =
                std::clamp(static_cast<int>(old.renewal_cost() / passes_during_an_arc), 1, most_arcs_meanwhile);
            factors_ = Future<ApproximateInverse>([old, matrix = std::move(matrix)] { return old.renewed(*matrix); });
        }
    }
    /// After an exchange: the new factors, with all exchanges that they missed, when it is time to take them.
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
    /// One core makes the new factors while the other follows arcs. They are taken after a fixed number of operations,
    /// because the time at which they are ready depends on the machine, and results must not.
    static constexpr double passes_during_an_arc = 9;
    static constexpr int most_arcs_meanwhile = 8;
    Future<ApproximateInverse> factors_;
    std::vector<int> slots_; ///< slots exchanged since `begin`
    int arcs_left_ = 0;
};

} // namespace isostat
