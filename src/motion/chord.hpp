#pragma once
// The chord method on the kept gaps of an arc: private to the room.

#include "linear/factorisation.hpp"
#include "rigidity/isostatic.hpp"
#include "verified/arithmetic.hpp"

#include <isostat/core/result.hpp>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

namespace isostat {

/// Speeds up an iteration x <- x + y(x) whose y shrinks slowly along a few directions. From the last changes of x and
/// the resulting changes of y, the next change is chosen so that the part of y along those directions vanishes (to
/// first order). Costs a few vector operations, and changes the iterates, not the fixed point.
class Acceleration {
  public:
    void clear() { count_ = 0; }
    /// Replaces y(x) by the better change of x, and remembers both vectors.
    void improve(std::vector<double>& y);

  private:
    static constexpr std::size_t depth = 3; // guess: of the path follower
    struct Change {
        std::vector<double> x, y; ///< changes of x and y in one iteration
    };
    std::array<Change, depth> changes_;
    std::array<std::array<double, depth>, depth> products_{}; ///< scalar products of the changes of y
    std::vector<double> x_, y_;                               ///< last change of x, last y
    std::size_t count_ = 0;                                   ///< calls since the start
};

/// Newton-like iterations with the factors of one contact matrix, for the equations gap_l = 0 of all its contacts
/// except the one in the *slot*, whose row is free: the caller chooses its equation. Nothing is proved of the results.
class Chord {
  public:
    using Vector = std::vector<double>;

    /// \pre `structure` and `factorisation` outlive it.
    Chord(const IsostaticStructure& structure, const Factorisation& factorisation, std::size_t slot);

    /// All contacts, including the one in the slot.
    [[nodiscard]] const std::vector<Contact>& contacts() const { return structure().contacts(); }
    [[nodiscard]] const DofMap& dofs() const { return structure().dofs(); }
    [[nodiscard]] std::size_t slot() const { return slot_; }
    [[nodiscard]] bool is_fresh() const { return factorisation().is_fresh(); }
    /// Velocity, where the matrix was made, with unit approach in the slot and zero approach in the kept contacts.
    [[nodiscard]] const Vector& mechanism() const { return mechanism_; }

    /// Velocity with the approach velocities `approach(contact)` in the kept contacts, coordinate `still` at rest. One
    /// pass. Valid until the next call.
    template <class Approach> const Vector& velocity(Approach approach, std::size_t still) {
        for (std::size_t l = 0; l < size_; ++l) {
            approach_[l] = l == slot_ ? 0.0 : approach(contacts()[l]);
        }
        solve([&](const Vector& v) { return v[still]; }, 0.0);
        return y_;
    }

    /// From here on points and tangents are found with residuals in double-double. Needed where the kept contacts are
    /// nearly singular: there rounding moves the points that doubles find, and no iteration ends.
    void be_precise() { precise_ = true; }
    [[nodiscard]] bool is_precise() const { return precise_; }

    /// Moves `at` to where the kept gaps and the gap of `row` vanish, up to rounding; with a `held` coordinate as `row`
    /// this coordinate keeps its value. False: the iteration did not converge, and `at` is arbitrary.
    bool converge(Packing& at, const Contact& row);
    /// Iterations of the last attempt.
    [[nodiscard]] int iterations() const { return iterations_; }

    /// Tangent at a point of the curve near `guess`, scaled as `guess` in coordinate `fastest`, to a relative accuracy.
    std::optional<Vector> tangent(const Packing& at, const Vector& guess, std::size_t fastest, double accuracy);
    /// Relative size of its last correction, which bounds its accuracy where this is above the accuracy asked for.
    [[nodiscard]] double tangent_error() const { return tangent_error_; }
    /// The tangent where the matrix was made. \pre nothing was renewed.
    std::optional<Vector> tangent(const Vector& guess, std::size_t fastest, double accuracy);

    /// Proves and factorises the structure with coordinate `held` in the slot, at another configuration.
    std::optional<Failure> renew(const Packing& at, std::size_t held);

    /// Matrices factorised by `renew`, and applications of the factors.
    [[nodiscard]] int factorisations() const { return factorisations_; }
    [[nodiscard]] int passes() const { return passes_; }

  private:
    [[nodiscard]] const IsostaticStructure& structure() const { return own_ ? own_->structure : *structure_; }
    [[nodiscard]] const Factorisation& factorisation() const { return own_ ? own_->factorisation : *factorisation_; }
    void make_mechanism();
    void to_coordinates(const Vector& on_dofs, Vector& on_coordinates) const;
    template <class Row> void solve(Row row, double target);
    bool iterate(Packing& at, const Contact& row, bool accelerated);
    bool iterate_precisely(Packing& at, const Contact& row);
    void rates_at(const Packing& at, const Vector& v);
    void rates_from_matrix(const Vector& v);
    template <class Rates>
    std::optional<Vector> refined_tangent(const Vector& guess, std::size_t fastest, double accuracy, Rates rates);

    const IsostaticStructure* structure_;
    const Factorisation* factorisation_;
    std::unique_ptr<FactorisedStructure> own_; ///< replaces `structure_` and `factorisation_` after `renew`
    std::size_t slot_;
    std::size_t size_;
    double tangent_error_ = 0;
    Vector approach_; ///< per contact; overwritten by a pass
    Vector y_;        ///< on coordinates
    Vector mechanism_;
    Acceleration acceleration_;
    /// Double-double correction of the last point found. Empty: the point is in double.
    std::vector<dd_real> rest_;
    bool precise_ = false;
    int iterations_ = 0;
    int factorisations_ = 0;
    int passes_ = 0;
};

/// y_ = velocity with approach velocities `approach_` and row(y_) = target.
template <class Row> void Chord::solve(Row row, double target) {
    ++passes_;
    factorisation().approximate().velocities(approach_);
    to_coordinates(approach_, y_);
    const double scale = (target - row(y_)) / row(mechanism_);
    for (std::size_t k = 0; k < y_.size(); ++k) {
        y_[k] += scale * mechanism_[k];
    }
}

} // namespace isostat
