#pragma once
// When the factors that steer are renewed, and how: private to the room.

#include <isostat/core/threads.hpp>
#include <isostat/linear/approximate_inverse.hpp>

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// When new factors are due: as soon as an arc costs more than the average since the last ones, their making included,
/// which keeps that average smallest. Counts passes, never seconds.
class Wear {
  public:
    void add(double passes, int exchanges) {
        last_ = passes;
        sum_ += passes;
        exchanges_ = exchanges;
    }
    [[nodiscard]] bool out() const {
        return exchanges_ > 0 && last_ * (exchanges_ + 1) > factorisation_in_passes + sum_;
    }
    void renew() { *this = {}; }

  private:
    /// Less than KLU takes (50 at n = 1936, 4900): with two threads it is done beside the arcs.
    static constexpr double factorisation_in_passes = 40;
    double last_ = 0;
    double sum_ = 0;
    int exchanges_ = 0;
};

/// New factors made beside the arcs, which go on with the old ones meanwhile.
class Renewal {
  public:
    /// Of the matrix that `old` stands for. Nothing when one is under way.
    void begin(const ApproximateInverse& old, std::shared_ptr<const sparse::Matrix<double>> matrix) {
        if (!factors_.pending()) {
            slots_.clear();
            factors_ = Promised<ApproximateInverse>([old, matrix = std::move(matrix)] { return old.renewed(*matrix); });
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
        if (++arcs_ < arcs_beside) {
            return std::nullopt;
        }
        arcs_ = 0;
        ApproximateInverse inverse = factors_.take();
        for (const int missed : slots_) {
            inverse = inverse.exchanged(missed, matrix);
        }
        return inverse;
    }

  private:
    /// As many as take a core about the time of new factors. A fixed number: when they are ready depends on the
    /// machine, when they are taken must not.
    static constexpr int arcs_beside = 2;
    Promised<ApproximateInverse> factors_;
    std::vector<int> slots_; ///< exchanged since
    int arcs_ = 0;
};

} // namespace isostat
